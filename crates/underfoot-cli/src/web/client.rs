//! One web client: lines and frames out, requests in.

use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use tungstenite::Message;

use super::broadcast::ClientLines;
use super::greeting::{greeting, mirror_greeting};
use super::layout;
use super::off::OffNews;
use super::request::{StandingRequests, process};
use super::socket::{ClientSocket, End};
use super::{MOST_BYTES, Shared};

/// Interval between two checks for another layout, and for controls that went off or on.
const LAYOUT_EVERY: Duration = Duration::from_secs(1);

/// Serves one client until it leaves; `joins` if it is a window that shows the floor as well.
pub(super) fn serve(stream: TcpStream, peer: SocketAddr, shared: &Shared, joins: bool) {
    let most = if joins && shared.checks.is_some() { layout::MOST_BYTES } else { MOST_BYTES };
    let refuse = |origin: &str| shared.clients.refuse(origin);
    let Some(mut socket) = ClientSocket::accept(stream, peer, most, &shared.origins, refuse) else { return };
    let lines = shared.clients.join(peer, joins);
    let (Ok(end) | Err(end)) = talk(&mut socket, peer, shared, joins, &lines);
    shared.clients.leave(peer, end == End::Slow);
}

fn talk(
    socket: &mut ClientSocket,
    peer: SocketAddr,
    shared: &Shared,
    joins: bool,
    lines: &ClientLines,
) -> Result<End, End> {
    let (mut shown, mut standing, mut off) = (None, StandingRequests::default(), OffNews::default());
    let greeting = if joins { mirror_greeting } else { greeting };
    loop {
        let seen = shared.session.snapshot();
        if shown.replace(seen.floor.layout_revision) != Some(seen.floor.layout_revision) {
            socket.send(Message::text(greeting(&seen, shared)))?;
            off.greeted(&seen);
        }
        // Windows compute it from the packets.
        let states = if joins { Vec::new() } else { off.lines(&seen) };
        for state in states {
            socket.send(Message::text(state))?;
        }
        let next_look = Instant::now() + LAYOUT_EVERY;
        while Instant::now() < next_look {
            if let Some(refusal) = standing.refusal() {
                socket.send(Message::text(refusal))?;
            }
            if socket.turn(lines, |text| process(text, peer, shared, &mut standing))? {
                return Ok(socket.say_goodbye());
            }
        }
    }
}
