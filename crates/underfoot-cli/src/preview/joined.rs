//! A server's floor behind the window: sensed again here from the packets of its boards. This program has no outputs
//! then.

use std::net::SocketAddr;
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, Builder};
use std::time::{Duration, Instant as HostInstant};

use serde_json::{Value, json};
use underfoot::engine::Snapshot;
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::mirror::{Follower, Greeting, MirrorLink, MirrorNews, MirrorSource};
use underfoot::outgoing::json::{JsonValue, Message, RefusalRecord};
use underfoot::runtime::Session;
use underfoot::schema;
use underfoot::serve::FloorCommand;
use underfoot::source::{PacketTap, TappedPackets};
use underfoot_window::preview::{
    EventNews, LayoutCause, LayoutNews, Notice, PreviewCommand, ProgramChannels, ServerFeed, ServerLink,
    ServerState, ToWindow, announced,
};

use super::super::failure::Failure;
use super::super::layout_args::LayoutArgs;
use super::super::watch::FileWatch;
use super::LOOK;
use super::commands::keep_floor;
use super::stop_and_wait;

/// Interval between comparisons of the controls with the server's.
const COMPARE_EVERY: Duration = Duration::from_millis(100);

/// Minimum interval between two sent layouts: a server checks one a second.
const LAYOUTS_EVERY: Duration = Duration::from_millis(1100);

/// Maximum time for the server's greeting; without it, the window does not open.
const PATIENCE: Duration = Duration::from_secs(3);

/// A server's floor that is shown; ends when the window closes its channels.
pub(super) struct Joined {
    pub(super) floor: Floor,
    pub(super) layout: Arc<Layout>,
    pub(super) layout_text: String,
    pub(super) snapshots: triple_buffer::Output<Snapshot>,
    /// The packets of the boards.
    pub(super) packets: TappedPackets,
    shared: Shared,
}

/// State of the server, for the window.
#[derive(Clone)]
struct Shared(Arc<Mutex<ServerState>>);

impl Shared {
    fn state(&self) -> MutexGuard<'_, ServerState> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Joined {
    /// Joins the server that serves web pages at `address`; `files` belong to the layout that is designed here.
    pub(super) fn start(
        address: SocketAddr,
        window: ProgramChannels,
        files: LayoutArgs,
    ) -> Result<Self, Failure> {
        let failed = |error: std::io::Error| Failure::Other(format!("can't join {address}: {error}"));
        let (link, news) = MirrorLink::start(address).map_err(failed)?;
        let (greeting, source) = first(&news, address)?;
        let (tap, packets) = TappedPackets::new();
        let run = Run::begin(&greeting, source, &window, &tap)?;
        let state = ServerState {
            address: address.to_string(),
            link: ServerLink::Joined,
            takes_layouts: greeting.takes_layouts,
            left_out: 0,
            areas: Vec::new(),
        };
        let shared = Shared(Arc::new(Mutex::new(state)));
        let (input, snapshots) = triple_buffer::triple_buffer(&Snapshot::default());
        let (floor, layout_text) = (greeting.floor.clone(), greeting.layout_text.clone());
        let layout = Arc::new(greeting.layout.clone());
        let mut served = ServedFloor {
            link,
            news,
            run,
            tap,
            window,
            floor: floor.clone(),
            served: layout_text.clone(),
            tried: None,
            waiting: None,
            sent: None,
            controls_off: false,
            snapshots: input,
            follower: Follower::default(),
            begun: HostInstant::now(),
            compared: HostInstant::now(),
            shared: shared.clone(),
            watch: None,
            files,
        };
        served.follower.begin(&greeting, Duration::ZERO);
        served.watch = served.watch();
        Builder::new().name("joined".into()).spawn(move || served.run()).map_err(failed)?;
        Ok(Self { floor, layout, layout_text, snapshots, packets, shared })
    }

    /// Reports the state of the server to the window.
    pub(super) fn feed(&self) -> ServerFeed {
        let shared = self.shared.clone();
        Box::new(move || shared.state().clone())
    }
}

/// The first greeting, which the window needs before it can open.
fn first(news: &Receiver<MirrorNews>, address: SocketAddr) -> Result<(Box<Greeting>, MirrorSource), Failure> {
    let until = HostInstant::now() + PATIENCE;
    let mut why = "it says nothing".to_owned();
    loop {
        match news.recv_timeout(until.saturating_duration_since(HostInstant::now())) {
            Ok(MirrorNews::Joined(greeting, source)) => return Ok((greeting, source)),
            Ok(MirrorNews::Lost(reason)) => why = reason,
            Ok(_) => {}
            Err(_) => {
                return Err(Failure::Other(format!(
                    "can't join the floor at {address}: {why}; it must be served by `underfoot run` with --web {address}"
                )));
            }
        }
    }
}

/// One connection to the server, from its greeting until it is lost.
struct Run {
    session: Session,
    snapshots: triple_buffer::Output<Snapshot>,
    left_out: Box<dyn Fn() -> u64 + Send>,
}

impl Run {
    fn begin(
        greeting: &Greeting,
        source: MirrorSource,
        window: &ProgramChannels,
        tap: &PacketTap,
    ) -> Result<Self, Failure> {
        let (clock, left_out) = (source.clock(), Box::new(source.left_out()));
        let input = announced(source, window.layouts.clone(), LayoutCause::Served);
        let input = tap.wrap(input);
        let session = Session::source(input, clock)
            .floor(greeting.floor.clone())
            .layout(greeting.layout.clone())
            .method(greeting.method)
            .sink(ToWindow::new(window.events.clone()))
            .start()?;
        let snapshots = session.take_snapshots();
        Ok(Self { session, snapshots, left_out })
    }
}

struct ServedFloor {
    link: MirrorLink,
    news: Receiver<MirrorNews>,
    run: Run,
    tap: PacketTap,
    window: ProgramChannels,
    /// The floor that the window shows.
    floor: Floor,
    /// The text of the server's layout.
    served: String,
    /// The name of the last layout sent to it.
    tried: Option<String>,
    /// Name and text of the latest layout to send, and the time of the last one sent.
    waiting: Option<(String, String)>,
    sent: Option<HostInstant>,
    /// Whether its controls must be off during a check of the floor.
    controls_off: bool,
    snapshots: triple_buffer::Input<Snapshot>,
    follower: Follower,
    begun: HostInstant,
    compared: HostInstant,
    shared: Shared,
    /// Dropped when the next one starts.
    watch: Option<FileWatch>,
    files: LayoutArgs,
}

impl ServedFloor {
    /// Shows the floor until the window closes its channels.
    fn run(mut self) {
        loop {
            match self.news.recv_timeout(LOOK) {
                Ok(news) => self.hear(news),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => thread::sleep(LOOK),
            }
            loop {
                match self.window.commands.try_recv() {
                    Ok(command) => self.apply(command),
                    Err(TryRecvError::Empty) => break,
                    Err(TryRecvError::Disconnected) => return stop_and_wait(&self.run.session),
                }
            }
            self.look();
        }
    }

    fn say(&self, notice: impl Into<Notice>) {
        // Messages never wait for a window that is closed or does not draw.
        let _ = self.window.notices.try_send(notice.into());
    }

    fn hear(&mut self, news: MirrorNews) {
        match news {
            MirrorNews::Joined(greeting, source) => self.join_again(&greeting, source),
            MirrorNews::Again(greeting) => self.take(&greeting),
            MirrorNews::Line(line) => self.hear_line(&line.message),
            MirrorNews::Lost(why) => self.shared.state().link = ServerLink::Lost(why),
        }
    }

    /// Starts again from a new greeting: all earlier state is discarded.
    fn join_again(&mut self, greeting: &Greeting, source: MirrorSource) {
        if !is_same(&greeting.floor, &self.floor) {
            let why = "the server has another floor now: open the window anew to see it";
            self.shared.state().link = ServerLink::Lost(why.into());
            return;
        }
        stop_and_wait(&self.run.session);
        let layout = Arc::new(greeting.layout.clone());
        let _ = self.window.events.send(EventNews::Restarted(layout));
        match Run::begin(greeting, source, &self.window, &self.tap) {
            Ok(run) => self.run = run,
            Err(failure) => return self.say(failure.to_string()),
        }
        self.shared.state().link = ServerLink::Joined;
        self.take(greeting);
        if self.controls_off {
            self.link.ask(CONTROLS_OFF, &[json!(true)]);
        }
    }

    /// Stores the server's state as its greeting reports it.
    fn take(&mut self, greeting: &Greeting) {
        self.served.clone_from(&greeting.layout_text);
        self.shared.state().takes_layouts = greeting.takes_layouts;
        self.follower.begin(greeting, self.begun.elapsed());
    }

    fn hear_line(&mut self, message: &Message) {
        let Message::Error(RefusalRecord { request, why }) = message else {
            return self.follower.hear(message, self.begun.elapsed());
        };
        let (request, why) = (request.as_str(), why.0.clone());
        match self.tried.take_if(|_| request == LAYOUT) {
            Some(name) => drop(self.window.layouts.try_send(LayoutNews::Refused { name, diagnostics: why })),
            None => self.say(format!("The server refuses {request}: {why}")),
        }
    }

    /// Passes on the latest snapshot, and sets controls to the server's state.
    fn look(&mut self) {
        self.send_layout();
        if self.run.snapshots.update() {
            self.snapshots.input_buffer_mut().clone_from(self.run.snapshots.output_buffer());
            self.snapshots.publish();
        }
        if self.compared.elapsed() < COMPARE_EVERY {
            return;
        }
        self.compared = HostInstant::now();
        self.shared.state().left_out = (self.run.left_out)();
        let (layout, here) = (self.run.session.snapshot().layout, self.run.snapshots.output_buffer());
        // Between two layouts, names and places may not match.
        if here.widgets.len() == layout.widgets.len() {
            for message in self.follower.corrections(&layout, here, self.begun.elapsed()) {
                self.run.session.send(FloorCommand::Control(message));
            }
        }
    }

    /// Translates a command of the window into a request to the server.
    fn apply(&mut self, command: PreviewCommand) {
        match command {
            PreviewCommand::Enable { id, enabled } => {
                self.link.ask(&format!("widget/{id}/{}", if enabled { "enable" } else { "disable" }), &[]);
            }
            PreviewCommand::Set { id, value } => {
                let arguments = match json!(JsonValue::from(value)) {
                    serde_json::Value::Array(pair) => pair,
                    one => vec![one],
                };
                self.link.ask(&format!("widget/{id}/set"), &arguments);
            }
            PreviewCommand::Mute(on) => self.link.ask("mute/set", &[json!(on)]),
            PreviewCommand::MuteTile { tile, on } => {
                self.link.ask("mute/tile", &[json!(tile.column), json!(tile.row), json!(on)]);
            }
            PreviewCommand::Try { layout, name, .. } => self.try_layout(&layout, name),
            PreviewCommand::Watch(path) => {
                self.files.layout = path;
                self.watch = self.watch();
            }
            PreviewCommand::TurnControlsOff(off) => {
                self.controls_off = off;
                self.link.ask(CONTROLS_OFF, &[json!(off)]);
            }
            PreviewCommand::SaveFloor { floor, path } => self.say(keep_floor(&floor, &path)),
            PreviewCommand::Open(_) | PreviewCommand::Feel { .. } | PreviewCommand::SaveEffect { .. } => {
                self.say("That is done where the floor is served.");
            }
        }
    }

    /// Sends the server a layout, if it accepts layouts.
    fn try_layout(&mut self, layout: &Layout, name: String) {
        let text = schema::write_layout(layout);
        if text == self.served {
            return;
        }
        if !self.shared.state().takes_layouts {
            return self.say(KEEPS);
        }
        self.waiting = Some((name, text));
    }

    /// Sends the latest layout that the window tried, at the rate that a server accepts.
    fn send_layout(&mut self) {
        if self.sent.is_some_and(|sent| sent.elapsed() < LAYOUTS_EVERY) {
            return;
        }
        if let Some((name, text)) = self.waiting.take() {
            self.sent = Some(HostInstant::now());
            self.tried = Some(name);
            self.link.ask(LAYOUT, &[Value::String(text)]);
        }
    }

    /// Reports each change of the layout's files to the window.
    fn watch(&self) -> Option<FileWatch> {
        let news = self.window.layouts.clone();
        let watch = FileWatch::on_change(&self.files, move || {
            // If the queue is full, it already contains changes.
            let _ = news.try_send(LayoutNews::Changed);
        });
        watch.inspect_err(|failure| self.say(failure.to_string())).ok().flatten()
    }
}

/// The request that puts a layout on the server's floor.
const LAYOUT: &str = "layout";

/// The request that keeps controls off while this window checks the floor.
const CONTROLS_OFF: &str = "controls_off";

/// Message to a user who designs a layout for a server that accepts none.
const KEEPS: &str = "A design made here stays in this window: the server keeps its layout, and would take another if it were \
                     started with --web-layouts.";

/// Whether the window that shows `shown` can show `now`: measured values may differ.
fn is_same(now: &Floor, shown: &Floor) -> bool {
    now.geometry == shown.geometry && now.boards == shown.boards
}
