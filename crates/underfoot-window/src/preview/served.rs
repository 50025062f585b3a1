//! The commands of a window that has joined a server, as requests to it; and the server's answers.

use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use serde_json::{Value, json};

use super::channels::{Notice, ProgramChannels};
use super::feed::{LayoutNews, PreviewCommand, ServerFeed, ServerLink, ServerState};
use underfoot::engine::Snapshot;
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::mirror::{Follower, Greeting};
use underfoot::outgoing::json::{JsonValue, Message, RefusalRecord, RequestRecord};
use underfoot::schema;
use underfoot::wire::ControlMessage;

/// Interval between comparisons of the controls with the server's.
const COMPARE_EVERY: Duration = Duration::from_millis(100);

/// Minimum interval between two sent layouts: a server checks one a second.
const LAYOUTS_EVERY: Duration = Duration::from_millis(1100);

/// The request that puts a layout on the server's floor.
const LAYOUT: &str = "layout";

/// The request that keeps controls off while this window checks the floor.
const CONTROLS_OFF: &str = "controls_off";

/// Message to a user who designs a layout for a server that accepts none.
const KEEPS: &str = "A design made here stays in this window: the server keeps its layout, and would take another if it were \
                     started with --web-layouts.";

/// The window's side of a server: translates commands into requests, keeps the controls here equal to the server's, and
/// knows the state of the connection. All times are those of one monotonic clock of the caller.
pub struct ServedDesk {
    state: Arc<Mutex<ServerState>>,
    notices: SyncSender<Notice>,
    layouts: SyncSender<LayoutNews>,
    /// The floor that the window shows.
    floor: Floor,
    follower: Follower,
    compared: Duration,
    /// The text of the server's layout.
    served: String,
    /// The name of the last layout sent to it.
    tried: Option<String>,
    /// Name and text of the latest layout to send, and the time of the last one sent.
    waiting: Option<(String, String)>,
    sent: Option<Duration>,
    /// Whether its controls must be off during a check of the floor.
    controls_off: bool,
    requests: Vec<RequestRecord>,
}

impl ServedDesk {
    /// The desk of a window that has joined the server at `address`, by its greeting.
    #[must_use]
    pub fn new(greeting: &Greeting, address: String, window: &ProgramChannels, now: Duration) -> Self {
        let state = ServerState {
            address,
            link: ServerLink::Joined,
            takes_layouts: greeting.takes_layouts,
            left_out: 0,
            areas: Vec::new(),
        };
        let mut follower = Follower::default();
        follower.begin(greeting, now);
        Self {
            state: Arc::new(Mutex::new(state)),
            notices: window.notices.clone(),
            layouts: window.layouts.clone(),
            floor: greeting.floor.clone(),
            follower,
            compared: now,
            served: greeting.layout_text.clone(),
            tried: None,
            waiting: None,
            sent: None,
            controls_off: false,
            requests: Vec::new(),
        }
    }

    fn state(&self) -> MutexGuard<'_, ServerState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reports the state of the server to the window.
    #[must_use]
    pub fn feed(&self) -> ServerFeed {
        let state = Arc::clone(&self.state);
        Box::new(move || state.lock().unwrap_or_else(PoisonError::into_inner).clone())
    }

    /// Shows a message in the window.
    pub fn say(&self, notice: impl Into<Notice>) {
        // Messages never wait for a window that is closed or does not draw.
        let _ = self.notices.try_send(notice.into());
    }

    /// Notes the number of packets that the server could not pass on.
    pub fn note_left_out(&self, packets: u64) {
        self.state().left_out = packets;
    }

    /// Notes that the server is lost, with the reason.
    pub fn lose(&self, why: impl Into<String>) {
        self.state().link = ServerLink::Lost(why.into());
    }

    /// Whether this window can show the floor of the greeting of a server that has come back; if not, it reports the
    /// reason. Measured values may differ.
    #[must_use]
    pub fn suits(&self, greeting: &Greeting) -> bool {
        let (now, shown) = (&greeting.floor, &self.floor);
        let suits = now.geometry == shown.geometry && now.boards == shown.boards;
        if !suits {
            self.lose("the server has another floor now: open the window anew to see it");
        }
        suits
    }

    /// Notes that the window has joined the server again.
    pub fn join_again(&mut self, greeting: &Greeting, now: Duration) {
        self.state().link = ServerLink::Joined;
        self.take(greeting, now);
        if self.controls_off {
            self.ask(CONTROLS_OFF, vec![json!(true)]);
        }
    }

    /// Stores the server's state as its greeting reports it.
    pub fn take(&mut self, greeting: &Greeting, now: Duration) {
        self.served.clone_from(&greeting.layout_text);
        self.state().takes_layouts = greeting.takes_layouts;
        self.follower.begin(greeting, now);
    }

    /// Processes a line of the server.
    pub fn hear(&mut self, message: &Message, now: Duration) {
        let Message::Error(RefusalRecord { request, why }) = message else {
            return self.follower.hear(message, now);
        };
        let (request, why) = (request.as_str(), why.0.clone());
        match self.tried.take_if(|_| request == LAYOUT) {
            // A full channel has more than the window can show.
            Some(name) => {
                drop(self.layouts.try_send(LayoutNews::Refused { name, diagnostics: why }));
            }
            None => self.say(format!("The server refuses {request}: {why}")),
        }
    }

    /// Translates a command of the window into a request.
    ///
    /// # Errors
    /// Returns a command unchanged that concerns files: the program carries it out.
    pub fn apply(&mut self, command: PreviewCommand) -> Result<(), PreviewCommand> {
        match command {
            PreviewCommand::Enable { id, enabled } => {
                self.ask(&format!("widget/{id}/{}", if enabled { "enable" } else { "disable" }), Vec::new());
            }
            PreviewCommand::Set { id, value } => {
                let arguments = match json!(JsonValue::from(value)) {
                    Value::Array(pair) => pair,
                    one => vec![one],
                };
                self.ask(&format!("widget/{id}/set"), arguments);
            }
            PreviewCommand::Mute(on) => self.ask("mute/set", vec![json!(on)]),
            PreviewCommand::MuteTile { tile, on } => {
                self.ask("mute/tile", vec![json!(tile.column), json!(tile.row), json!(on)]);
            }
            PreviewCommand::Try { layout, name, .. } => self.try_layout(&layout, name),
            PreviewCommand::TurnControlsOff(off) => {
                self.controls_off = off;
                self.ask(CONTROLS_OFF, vec![json!(off)]);
            }
            PreviewCommand::Open(_) | PreviewCommand::Feel { .. } | PreviewCommand::SaveEffect { .. } => {
                self.say("That is done where the floor is served.");
            }
            PreviewCommand::Watch(_) | PreviewCommand::SaveFloor { .. } => return Err(command),
        }
        Ok(())
    }

    fn ask(&mut self, request: &str, args: Vec<Value>) {
        self.requests.push(RequestRecord { args, request: request.to_owned() });
    }

    /// Queues a layout for the server, if it accepts layouts.
    fn try_layout(&mut self, layout: &Layout, name: String) {
        let text = schema::write_layout(layout);
        if text == self.served {
            return;
        }
        if !self.state().takes_layouts {
            return self.say(KEEPS);
        }
        self.waiting = Some((name, text));
    }

    /// The requests to send now. Of several layouts that the window tried, the latest is sent, at the rate that a
    /// server accepts.
    pub fn requests(&mut self, now: Duration) -> Vec<RequestRecord> {
        let is_soon = self.sent.is_some_and(|sent| now.saturating_sub(sent) < LAYOUTS_EVERY);
        if let Some((name, text)) = self.waiting.take_if(|_| !is_soon) {
            self.sent = Some(now);
            self.tried = Some(name);
            self.ask(LAYOUT, vec![Value::String(text)]);
        }
        std::mem::take(&mut self.requests)
    }

    /// Whether a comparison of the controls with the server's is due.
    #[must_use]
    pub fn is_due(&self, now: Duration) -> bool {
        now.saturating_sub(self.compared) >= COMPARE_EVERY
    }

    /// The requests that make the controls here equal to the server's, where a comparison is due.
    pub fn corrections(&mut self, layout: &Layout, here: &Snapshot, now: Duration) -> Vec<ControlMessage> {
        // Between two layouts, names and places may not match.
        if !self.is_due(now) || here.widgets.len() != layout.widgets.len() {
            return Vec::new();
        }
        self.compared = now;
        self.follower.corrections(layout, here, now)
    }
}
