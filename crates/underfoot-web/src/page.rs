//! The start in a page: the layout of the address, the floor in the frames of the page, and the window in a canvas.

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

use js_sys::{Float32Array, Function};
use underfoot::floor::Geometry;
use underfoot_window::link::SharedLayout;
use underfoot_window::preview::{
    LayoutToShare, NextFloor, PreviewError, PreviewInput, PreviewOptions, ProjectionOptions, ShareDesk, run,
    usual_state,
};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{CustomEvent, CustomEventInit, HtmlCanvasElement, Window};

use super::floor::PageFloor;
use super::kinds::OwnTexts;
use super::plan::{FIRST, shipped};
use super::played::Played;
use super::recording::RecordingReel;
use super::sound::FrameSound;
use super::visit::VisitReel;

/// Shows the window in `canvas`, on a floor with the layout behind `#` in the address of the page. `sound` describes
/// the sound, `play` gets its samples as a `Float32Array`, and `click` is called when a control clicks.
///
/// # Errors
/// A sentence for the user if there is no window: no WebGL, for example.
#[wasm_bindgen]
#[allow(clippy::needless_pass_by_value, reason = "JavaScript passes values")]
pub async fn start(
    canvas: HtmlCanvasElement,
    sound: String,
    play: Function,
    click: Function,
) -> Result<(), JsValue> {
    let window = web_sys::window().ok_or("there is no page")?;
    let fragment = window.location().hash()?;
    let heard = FrameSound::default();
    let page = OpenPage::default();
    let (stage, input) = opened(&fragment, &heard, &address(&window)?, &page)?;
    stage.floor().tell_sound(sound);
    *page.stage.borrow_mut() = Some(stage);
    PAGE.with_borrow_mut(|open| *open = Some(page.clone()));
    // A link has its layout already.
    let options = PreviewOptions { begins_with_gallery: fragment.len() < 2, ..options() };
    run_in_frames(&window, page, PageHooks { play, click }, heard);
    run(input, options, canvas).await.map_err(no_window)
}

/// The options of the window in a page, which keeps its settings in the storage of the browser.
pub(super) fn options() -> PreviewOptions {
    PreviewOptions {
        settings: Some(usual_state().join("window")),
        projection: ProjectionOptions {
            corners: Some(usual_state().join("projection.txt")),
            ..ProjectionOptions::default()
        },
        ..PreviewOptions::default()
    }
}

/// The sentence for a user whose browser shows no window.
#[allow(clippy::needless_pass_by_value, reason = "it stands in `map_err`")]
pub(super) fn no_window(PreviewError::NoWindow(reason): PreviewError) -> JsValue {
    format!("this browser gives the page no WebGL ({reason})").into()
}

thread_local! {
    /// The page, for files that are dropped on it; a page has one thread.
    static PAGE: RefCell<Option<OpenPage>> = const { RefCell::new(None) };
}

/// The floor of the page, and the way to the window that is to show another one. Clones share both.
#[derive(Clone, Default)]
struct OpenPage {
    /// `None` before the start.
    stage: Rc<RefCell<Option<PageStage>>>,
    next: NextFloor,
}

impl OpenPage {
    /// Lets the window of `input` show the next floor, once there is one.
    fn follow(&self, input: &mut PreviewInput) {
        input.channels.next_floor = Some(Rc::clone(&self.next));
    }

    /// Shows `stage` in the window by `input` from now on.
    fn show(&self, stage: PageStage, mut input: PreviewInput) {
        self.follow(&mut input);
        *self.stage.borrow_mut() = Some(stage);
        *self.next.borrow_mut() = Some(Box::new(input));
    }

    fn tell(&self, text: &str) {
        if let Some(stage) = &*self.stage.borrow() {
            stage.tell(text);
        }
    }
}

/// Plays the recording in `bytes` in the place of the present floor, or tells the user why it cannot be played.
#[wasm_bindgen]
#[allow(clippy::needless_pass_by_value, reason = "JavaScript passes values")]
pub fn open_recording(name: String, bytes: Vec<u8>) {
    let Some(page) = PAGE.with_borrow(Clone::clone) else { return };
    let opened = RecordingReel::new(&name, bytes).and_then(|reel| Played::new(Box::new(reel), &name));
    match opened {
        Ok((played, input)) => page.show(PageStage::Played(Box::new(played)), input),
        Err(error) => page.tell(&format!("{name} is not opened: {error}")),
    }
}

/// Returns whether the window takes layouts now; if it shows a visit or a recording, tells the user how it takes them.
#[wasm_bindgen]
#[must_use]
pub fn takes_layouts() -> bool {
    let Some(page) = PAGE.with_borrow(Clone::clone) else { return false };
    let takes = page.stage.borrow().as_ref().is_some_and(PageStage::is_live);
    if !takes {
        page.tell("A layout opens on a floor of your own: take over from the visit, or load the page without a link.");
    }
    takes
}

/// The floor that the page shows.
enum PageStage {
    /// A floor under the window's feet.
    Live(Box<PageFloor>),
    /// A visit, which the window's feet may take over.
    Played(Box<Played>),
}

impl PageStage {
    fn floor(&self) -> &PageFloor {
        match self {
            Self::Live(floor) => floor,
            Self::Played(played) => played.floor(),
        }
    }

    /// Advances the floor by a frame at `now`, the time of the page.
    fn run_until(&mut self, now: Duration, clock: &dyn Fn() -> Duration) {
        match self {
            Self::Live(floor) => floor.run_until(now),
            Self::Played(played) => played.run_until(now, clock),
        }
    }

    fn is_live(&self) -> bool {
        match self {
            Self::Live(_) => true,
            Self::Played(played) => played.is_live(),
        }
    }

    fn tell(&self, text: &str) {
        match self {
            Self::Live(floor) => floor.tell(text),
            Self::Played(played) => played.tell(text),
        }
    }

    /// Whether the sound of this frame is played.
    fn is_heard(&self) -> bool {
        match self {
            Self::Live(_) => true,
            Self::Played(played) => played.is_heard(),
        }
    }
}

/// The stage with the layout in `fragment`, and its visit if it has one; for a link that cannot be read, the floor with
/// the first layout, and a message that says why.
fn opened(
    fragment: &str,
    heard: &FrameSound,
    address: &str,
    page: &OpenPage,
) -> Result<(PageStage, PreviewInput), String> {
    let stage = |shared: &SharedLayout| {
        let (heard, address, own_page) = (heard.clone(), address.to_owned(), page.clone());
        let play = move |samples: &[f32]| heard.add(samples);
        let dress = move |floor: &PageFloor, input: &mut PreviewInput| {
            let (address, own) = (address.clone(), floor.own_texts());
            input.share = Some(Box::new(PageLinks { address, geometry: input.floor.geometry, own }));
            own_page.follow(input);
        };
        let opened = if shared.visit.is_some() {
            VisitReel::new(shared, play, Box::new(dress))
                .and_then(|reel| Played::new(Box::new(reel), "a visit"))
                .map(|(played, mut input)| {
                    page.follow(&mut input);
                    (PageStage::Played(Box::new(played)), input)
                })
        } else {
            PageFloor::new(shared, play).map(|(floor, mut input)| {
                dress(&floor, &mut input);
                (PageStage::Live(Box::new(floor)), input)
            })
        };
        opened.map_err(|error| error.to_string())
    };
    let first = || stage(&shipped(FIRST));
    if fragment.len() < 2 {
        return first();
    }
    let read = SharedLayout::of_link(fragment).map_err(|error| error.to_string());
    match read.and_then(|shared| stage(&shared)) {
        Ok(opened) => Ok(opened),
        Err(wrong) => {
            let (stage, input) = first()?;
            stage.tell(&format!("The layout of the link cannot be shown; {wrong}"));
            Ok((stage, input))
        }
    }
}

/// The address of this page, up to `#`.
pub(super) fn address(window: &Window) -> Result<String, JsValue> {
    let whole = window.location().href()?;
    Ok(whole.split('#').next().unwrap_or_default().to_owned())
}

/// Links to this page.
pub(super) struct PageLinks {
    pub(super) address: String,
    pub(super) geometry: Geometry,
    pub(super) own: OwnTexts,
}

impl ShareDesk for PageLinks {
    fn link(&self, layout: &LayoutToShare) -> Result<String, String> {
        let (name, text) = (layout.name.clone(), layout.text.clone());
        let grid =
            (self.geometry != Geometry::default()).then(|| (self.geometry.columns(), self.geometry.rows()));
        let shared = SharedLayout { name, text, grid, ..self.own.of_layout(layout.path.as_deref()) };
        let mut used = shared.with_used_only(&self.geometry).map_err(|problems| problems.to_string())?;
        used.visit.clone_from(&layout.visit);
        let fragment = used.fragment().map_err(|error| error.to_string())?;
        Ok(format!("{}{fragment}", self.address))
    }
}

/// Functions of the page.
struct PageHooks {
    /// Plays samples.
    play: Function,
    /// Buzzes for a click.
    click: Function,
}

/// The event of the page for each event of the floor; its `detail` is a line of JSON.
const EVENT: &str = "underfoot-event";

/// A function for frames of the page, which gets their times (ms).
type FrameCall = Closure<dyn FnMut(f64)>;

/// Holds that function, for the function itself too.
type FrameSlot = Rc<RefCell<Option<FrameCall>>>;

/// Advances the floor in each frame of the page from now on.
fn run_in_frames(window: &Window, open: OpenPage, hooks: PageHooks, heard: FrameSound) {
    let frame = FrameSlot::default();
    let (own, page) = (Rc::clone(&frame), window.clone());
    let machine = window.performance();
    let clock = move || {
        let now_ms = machine.as_ref().map_or(0.0, web_sys::Performance::now);
        Duration::from_secs_f64((now_ms / 1e3).max(0.0))
    };
    *frame.borrow_mut() = Some(Closure::new(move |now_ms: f64| {
        let lines = {
            let mut stage = open.stage.borrow_mut();
            let Some(stage) = stage.as_mut() else { return };
            stage.run_until(Duration::from_secs_f64((now_ms / 1e3).max(0.0)), &clock);
            let is_heard = stage.is_heard();
            // A page that cannot play has said so.
            heard.play(|samples| {
                if is_heard {
                    let _ = hooks.play.call1(&JsValue::NULL, &Float32Array::from(samples));
                }
            });
            if stage.floor().has_clicked() && is_heard {
                let _ = hooks.click.call0(&JsValue::NULL);
            }
            stage.floor().event_lines().collect::<Vec<_>>()
        };
        // The scripts that get them may open a recording.
        lines.iter().for_each(|line| report(&page, line));
        request(&page, &own);
    }));
    request(window, &frame);
}

/// Reports an event of the floor to the scripts of the page.
fn report(page: &Window, line: &str) {
    let content = CustomEventInit::new();
    content.set_detail(&JsValue::from_str(line));
    // Neither fails: the name of the event is a plain word.
    if let Ok(event) = CustomEvent::new_with_event_init_dict(EVENT, &content) {
        let _ = page.dispatch_event(&event);
    }
}

/// Requests a call in the next frame of the page; a hidden page has none, and its floor stands still.
fn request(window: &Window, frame: &RefCell<Option<FrameCall>>) {
    if let Some(frame) = frame.borrow().as_ref() {
        // It fails only while the page is being left.
        let _ = window.request_animation_frame(frame.as_ref().unchecked_ref());
    }
}
