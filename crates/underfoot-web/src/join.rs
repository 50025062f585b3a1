//! The start in a page that a floor serves: joins the floor by itself, and again whenever the connection is lost.

use std::cell::RefCell;
use std::future::poll_fn;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};
use std::time::Duration;

use js_sys::Function;
use underfoot_window::link::SharedLayout;
use underfoot_window::preview::{PreviewInput, run};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{HtmlCanvasElement, Performance, Window};

use super::joined::JoinedFloor;
use super::kinds::OwnTexts;
use super::page::{PageLinks, address, no_window, options};
use super::socket::{PageSocket, SocketNews};

/// Interval between two looks at commands and at the time, in milliseconds.
const LOOK_MS: i32 = 8;

/// Interval between attempts to reach an absent server.
const AGAIN: Duration = Duration::from_secs(1);

/// Shows the floor that the server of this page serves at `path`, in `canvas`. `hint` names to the user the
/// functions that the browser withholds from this page; empty if none. `say` shows a text in place of the window until the page has
/// joined.
///
/// # Errors
/// A sentence for the user if there is no window: no WebGL, for example.
#[wasm_bindgen]
#[allow(clippy::needless_pass_by_value, reason = "JavaScript passes values")]
pub async fn join(
    canvas: HtmlCanvasElement,
    path: String,
    hint: String,
    say: Function,
) -> Result<(), JsValue> {
    let window = web_sys::window().ok_or("there is no page")?;
    let fragment = window.location().hash()?;
    let read = (fragment.len() > 1).then(|| SharedLayout::of_link(&fragment));
    let link = Rc::new(RefCell::new(PageLink::new(&window, &path, say)?));
    let mut told = vec![hint];
    match read.transpose() {
        Ok(shared) => {
            if shared.as_ref().is_some_and(|shared| shared.visit.is_some()) {
                told.push("The visit of the link plays on a page that no floor serves.".into());
            }
            link.borrow_mut().shared = shared;
        }
        Err(error) => told.push(format!("The layout of the link cannot be shown; {error}")),
    }
    keep(&window, &link)?;
    let (mut input, own) = poll_fn(|context| link.borrow_mut().poll_joined(context, &told)).await;
    let (address, geometry) = (address(&window)?, input.floor.geometry);
    input.share = Some(Box::new(PageLinks { address, geometry, own }));
    run(input, options(), canvas).await.map_err(no_window)
}

/// Looks after the connection from now on.
fn keep(window: &Window, link: &Rc<RefCell<PageLink>>) -> Result<(), JsValue> {
    let own = Rc::clone(link);
    let look = Closure::<dyn Fn()>::new(move || look(&own)).into_js_value();
    window.set_interval_with_callback_and_timeout_and_arguments_0(look.unchecked_ref(), LOOK_MS)?;
    Ok(())
}

/// Advances the floor, sends its requests, and connects where there is no connection.
fn look(link: &Rc<RefCell<PageLink>>) {
    let is_due = link.borrow_mut().advance();
    if is_due {
        let own = Rc::clone(link);
        link.borrow_mut().connect(move |news| own.borrow_mut().hear(news));
    }
}

/// The connection of the page to its server, and the floor once it has joined.
struct PageLink {
    url: String,
    /// The server as the address of the page names it.
    host: String,
    clock: Performance,
    /// The layout of the address.
    shared: Option<SharedLayout>,
    socket: Option<PageSocket>,
    /// The time of the next attempt, once the connection is lost.
    again: Option<Duration>,
    floor: Option<JoinedFloor>,
    /// The input of the window, until that opens.
    input: Option<PreviewInput>,
    /// Wakes the start of the window once the page has joined.
    waker: Option<Waker>,
    say: Function,
}

impl PageLink {
    /// The link to the server of this page at `path`, not connected yet.
    fn new(window: &Window, path: &str, say: Function) -> Result<Self, JsValue> {
        let clock = window.performance().ok_or("the page has no clock")?;
        let location = window.location();
        let scheme = if location.protocol()? == "https:" { "wss" } else { "ws" };
        let host = location.host()?;
        Ok(Self {
            url: format!("{scheme}://{host}{path}"),
            host,
            clock,
            shared: None,
            socket: None,
            again: Some(Duration::ZERO),
            floor: None,
            input: None,
            waker: None,
            say,
        })
    }

    /// The time of the page.
    fn now(&self) -> Duration {
        Duration::from_secs_f64((self.clock.now() / 1e3).max(0.0))
    }

    /// Waits until the page has joined: then gives the input of the window, which shows `told`, and the user's kinds.
    fn poll_joined(&mut self, context: &Context<'_>, told: &[String]) -> Poll<(PreviewInput, OwnTexts)> {
        if let (Some(floor), Some(input)) = (&self.floor, self.input.take()) {
            told.iter().filter(|text| !text.is_empty()).for_each(|text| floor.tell(text));
            return Poll::Ready((input, floor.own_texts()));
        }
        self.waker = Some(context.waker().clone());
        Poll::Pending
    }

    /// Advances the floor and sends its requests. Returns whether a new connection is due.
    fn advance(&mut self) -> bool {
        let now = self.now();
        match self.floor.as_mut().map(|floor| floor.run_until(now)) {
            Some(Ok(requests)) => {
                // An absent server gets no requests later: they are of the past.
                let _ = self.socket.as_ref().map(|socket| requests.iter().all(|asked| socket.send(asked)));
            }
            Some(Err(why)) => self.lose(&why),
            None => {}
        }
        self.again.is_some_and(|due| now >= due)
    }

    /// Connects to the server.
    fn connect(&mut self, tell: impl Fn(SocketNews) + Clone + 'static) {
        // The old one is closed; here none of its calls is at work.
        self.socket = None;
        self.again = None;
        match PageSocket::open(&self.url, tell) {
            Ok(socket) => self.socket = Some(socket),
            Err(_) => self.lose("the browser makes no connection"),
        }
    }

    fn hear(&mut self, news: SocketNews) {
        let now = self.now();
        let heard = match (news, &mut self.floor) {
            (SocketNews::Closed, None) => {
                Err("the server has ended, or does not let this page in".to_owned())
            }
            (SocketNews::Closed, Some(_)) => Err("the connection broke".to_owned()),
            (SocketNews::Text(text), Some(floor)) => floor.hear(&text, now),
            (SocketNews::Frame(frame), Some(floor)) => floor.take(&frame, now),
            (SocketNews::Text(text), None) => self.begin(&text, now),
            (SocketNews::Frame(_), None) => Ok(()),
        };
        if let Err(why) = heard {
            self.lose(&why);
        }
    }

    /// Begins with the first text of the server.
    fn begin(&mut self, text: &str, now: Duration) -> Result<(), String> {
        let (floor, input) = JoinedFloor::join(text, &self.host, self.shared.as_ref(), now)?;
        (self.floor, self.input) = (Some(floor), Some(input));
        if let Some(waker) = self.waker.take() {
            waker.wake();
        }
        Ok(())
    }

    /// Closes the connection for this reason; the next attempt is due in a second.
    fn lose(&mut self, why: &str) {
        let now = self.now();
        if let Some(socket) = &self.socket {
            socket.close();
        }
        self.again = Some(now + AGAIN);
        match &mut self.floor {
            Some(floor) => floor.lose(why, now),
            None => {
                let text = format!("The floor at {} cannot be joined: {why}. Trying again …", self.host);
                let _ = self.say.call1(&JsValue::NULL, &text.into());
            }
        }
    }
}
