//! Requests of a web client: one JSON object each, answered only if they are refused.

use std::net::SocketAddr;
use std::sync::mpsc::sync_channel;
use std::time::{Duration, Instant};

use serde_json::Value;
use underfoot::outgoing::json::{Line, Message, RefusalRecord, RequestRecord, Sentence};
use underfoot::runtime::{ControlsOff, Session};
use underfoot::serve::FloorCommand;
use underfoot::wire::{ControlMessage, read_json};

use super::layout::{self, ClientLayouts};
use super::{MOST_BYTES, Shared};

/// Maximum time to wait for an answer of the floor.
const PATIENCE: Duration = Duration::from_millis(200);

/// Keeps controls off as long as the requesting client is connected, such as a window that checks the floor.
const CONTROLS_OFF: &str = "controls_off";

/// Requests of a client that stay in effect.
#[derive(Default)]
pub(super) struct StandingRequests {
    /// Present while it keeps the controls off, and the time of the last start.
    off: Option<ControlsOff>,
    off_since: Option<Instant>,
    layouts: ClientLayouts,
}

impl StandingRequests {
    /// The line with the reason for the refusal of a layout, as soon as it is known.
    pub(super) fn refusal(&mut self) -> Option<String> {
        self.layouts.checked()?.err().map(|why| refused(layout::REQUEST, &why))
    }
}

/// The line with the reason for the refusal of a request.
fn refused(request: &str, why: &str) -> String {
    let (request, why) = (request.into(), Sentence::from(why));
    Line::timeless(Message::Error(RefusalRecord { request, why })).text()
}

/// Minimum interval between two requests of one client to switch all controls off.
const CONTROLS_OFF_EVERY: Duration = Duration::from_secs(1);

/// Executes the request in `text`; the error is a line with the reason for the refusal.
pub(super) fn process(
    text: &str,
    peer: SocketAddr,
    shared: &Shared,
    standing: &mut StandingRequests,
) -> Result<(), String> {
    // Only a layout is this large: if it will be refused anyway, it is not parsed.
    if text.len() > MOST_BYTES
        && let Some(why) = standing.layouts.why_not(Instant::now())
    {
        return Err(refused(layout::REQUEST, why));
    }
    let asked: RequestRecord = serde_json::from_str(text).map_err(|error| refused("", &error.to_string()))?;
    let why = |why: String| refused(&asked.request, &why);
    if !shared.apps.iter().any(|network| network.contains(peer.ip())) {
        return Err(why("requests from this address are not taken".into()));
    }
    if asked.request == layout::REQUEST {
        return standing
            .layouts
            .put(asked.args, shared, Instant::now())
            .map_err(|why| refused(layout::REQUEST, &why));
    }
    if asked.request == CONTROLS_OFF {
        let [Value::Bool(is_off)] = asked.args[..] else { return Err(why("expected true or false".into())) };
        if !is_off || standing.off.is_some() {
            standing.off.take_if(|_| !is_off);
            return Ok(());
        }
        if standing.off_since.is_some_and(|since| since.elapsed() < CONTROLS_OFF_EVERY) {
            return Err(why("controls are switched off once a second at most".into()));
        }
        standing.off_since = Some(Instant::now());
        standing.off = Some(shared.session.controls_off());
        return Ok(());
    }
    let message = read_json(&asked.request, &asked.args).map_err(why)?;
    ask(&shared.session, message).map_err(why)
}

fn ask(session: &Session, message: ControlMessage) -> Result<(), String> {
    let refused = || {
        let why = if session.has_ended() { "the floor has ended" } else { "the floor is busy: ask again" };
        Err(why.to_owned())
    };
    if matches!(message, ControlMessage::Mute { .. } | ControlMessage::MuteTile { .. }) {
        return if session.send(FloorCommand::Control(message)) { Ok(()) } else { refused() };
    }
    let (answer, answered) = sync_channel(1);
    if !session.send(FloorCommand::Ask(message, answer)) {
        return refused();
    }
    match answered.recv_timeout(PATIENCE) {
        Ok(done) => done.map_err(|refusal| refusal.reason()),
        Err(_) => Err("the floor does not answer".into()),
    }
}
