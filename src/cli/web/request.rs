//! What a web client asks: one JSON object, answered where it is refused.

use std::net::SocketAddr;
use std::sync::mpsc::sync_channel;
use std::time::Duration;

use serde::Deserialize;
use serde_json::{Value, json};
use underfoot::runtime::{ControlsOff, Session};
use underfoot::serve::Command;
use underfoot::wire::{ControlMessage, read_json};

use super::{Shared, layout};

/// How long an answer of the floor is waited for.
const PATIENCE: Duration = Duration::from_millis(200);

/// `{"request":"widget/zoom/set","args":[0.5]}`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Asked {
    request: String,
    #[serde(default)]
    args: Vec<Value>,
}

/// Keeps controls off for as long as whoever asks for it is there, such as a window that checks the floor.
const CONTROLS_OFF: &str = "controls_off";

/// Does what `text` asks; the line that says why not.
pub(super) fn process(
    text: &str,
    peer: SocketAddr,
    shared: &Shared,
    off: &mut Option<ControlsOff>,
) -> Result<(), String> {
    let refused =
        |request: &str, why: &str| json!({"event": "error", "request": request, "why": why}).to_string();
    let asked: Asked = serde_json::from_str(text).map_err(|error| refused("", &error.to_string()))?;
    let why = |why: String| refused(&asked.request, &why);
    if !shared.apps.iter().any(|network| network.contains(peer.ip())) {
        return Err(why("requests from this address are not taken".into()));
    }
    if asked.request == layout::REQUEST {
        return layout::put(&asked.args, shared).map_err(why);
    }
    if asked.request == CONTROLS_OFF {
        let [Value::Bool(is_off)] = asked.args[..] else { return Err(why("expected true or false".into())) };
        *off = is_off.then(|| shared.session.controls_off());
        return Ok(());
    }
    let message = read_json(&asked.request, &asked.args).map_err(why)?;
    ask(&shared.session, message).map_err(why)
}

fn ask(session: &Session, message: ControlMessage) -> Result<(), String> {
    const OVER: &str = "the floor has ended";
    if matches!(message, ControlMessage::Mute { .. } | ControlMessage::MuteTile { .. }) {
        return if session.send(Command::Control(message)) { Ok(()) } else { Err(OVER.into()) };
    }
    let (answer, answered) = sync_channel(1);
    if !session.send(Command::Ask(message, answer)) {
        return Err(OVER.into());
    }
    match answered.recv_timeout(PATIENCE) {
        Ok(done) => done.map_err(|error| error.to_string()),
        Err(_) => Err("the floor does not answer".into()),
    }
}
