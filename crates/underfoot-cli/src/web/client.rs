//! One web client: lines and frames out, requests in, on one thread that never blocks on it.

use std::io::ErrorKind;
use std::net::{SocketAddr, TcpStream};
use std::sync::atomic::Ordering;
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

use socket2::SockRef;
use tracing::debug;
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::{StatusCode, header};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Bytes, Error, Message, WebSocket, accept_hdr_with_config};

use super::broadcast::ClientLines;
use super::budget::Budget;
use super::greeting::{greeting, mirror_greeting};
use super::layout;
use super::origin::may_connect;
use super::request::{StandingRequests, process};
use super::{MOST_BYTES, Shared};

/// Interval between two checks for requests of the client.
const LOOK_EVERY: Duration = Duration::from_millis(10);

/// Maximum number of requests in one check: a thousand a second, as over OSC.
const MOST_REQUESTS: usize = 10;

/// Maximum number of bytes of requests in a second: a thousand requests of usual length.
const BYTES_A_SECOND: usize = 256 * 1024;

/// Send buffer of the system for a client that does not read, in bytes: small, since waiting data becomes outdated.
const WAITING_BYTES: usize = 64 * 1024;

/// Maximum time for which output may wait for the client. It should not act on older data, and may connect again.
const STALLED: Duration = Duration::from_secs(1);

/// Interval between pings of the client, and maximum time of its silence.
const PING_EVERY: Duration = Duration::from_secs(1);
const SILENT: Duration = Duration::from_secs(5);

/// The reason for the end of a connection.
#[derive(Clone, Copy, PartialEq)]
enum End {
    /// The client left, or the floor has ended.
    Gone,
    /// The client does not read.
    Slow,
}

/// Serves one client until it leaves.
#[allow(clippy::result_large_err, reason = "what refuses a client is as tungstenite has it")]
pub(super) fn serve(stream: TcpStream, peer: SocketAddr, shared: &Shared, joins: bool) {
    let Ok(own) = stream.local_addr() else { return };
    // With a larger buffer, a slow client would only be dropped later.
    let _ = SockRef::from(&stream).set_send_buffer_size(WAITING_BYTES);
    let check = |request: &Request, response: Response| -> Result<Response, ErrorResponse> {
        let origin = request.headers().get(header::ORIGIN).map(|origin| origin.to_str().unwrap_or("null"));
        if may_connect(origin, own, &shared.origins) {
            return Ok(response);
        }
        let origin = origin.unwrap_or_default().escape_debug().to_string();
        shared.clients.refuse(&origin);
        let mut refused = ErrorResponse::new(Some(format!("pages from {origin} are not let in\n")));
        *refused.status_mut() = StatusCode::FORBIDDEN;
        Err(refused)
    };
    let most = if joins && shared.checks.is_some() { layout::MOST_BYTES } else { MOST_BYTES };
    let config = WebSocketConfig::default()
        .max_message_size(Some(most))
        .max_frame_size(Some(most))
        .write_buffer_size(0);
    let socket = match accept_hdr_with_config(stream, check, Some(config)) {
        Ok(socket) => socket,
        Err(error) => return debug!("the web client {peer} made no connection: {error}"),
    };
    if socket.get_ref().set_nonblocking(true).is_err() {
        return;
    }
    let lines = shared.clients.join(peer, joins);
    let now = Instant::now();
    let mut client = Client {
        socket,
        peer,
        shared,
        joins,
        standing: StandingRequests::default(),
        budget: Budget::new(most.max(BYTES_A_SECOND), now),
        waits_since: None,
        heard: now,
    };
    let end = client.talk(&lines);
    shared.clients.leave(peer, end == End::Slow);
}

struct Client<'a> {
    socket: WebSocket<TcpStream>,
    peer: SocketAddr,
    shared: &'a Shared,
    /// Whether it is a window that shows the floor as well.
    joins: bool,
    standing: StandingRequests,
    budget: Budget,
    /// Time since which output waits for the client.
    waits_since: Option<Instant>,
    /// Time of the last input from it.
    heard: Instant,
}

impl Client<'_> {
    fn talk(&mut self, lines: &ClientLines) -> End {
        match self.try_talk(lines) {
            Ok(end) | Err(end) => end,
        }
    }

    fn try_talk(&mut self, lines: &ClientLines) -> Result<End, End> {
        let mut shown = None;
        let mut pinged = Instant::now();
        loop {
            let seen_layout = self.shared.session.snapshot();
            if shown.replace(seen_layout.floor.layout_revision) != Some(seen_layout.floor.layout_revision) {
                let greeting = if self.joins { mirror_greeting } else { greeting };
                self.send(Message::text(greeting(&seen_layout, self.shared)))?;
            }
            // Until the next check of the layout.
            let look = Instant::now() + PING_EVERY;
            while Instant::now() < look {
                let is_over = self.pass_on(lines)?;
                self.hear()?;
                if lines.dropped.load(Ordering::Relaxed) {
                    return Err(End::Slow);
                }
                if is_over {
                    return Ok(self.say_goodbye());
                }
            }
            if pinged.elapsed() >= PING_EVERY {
                pinged = Instant::now();
                self.send(Message::Ping(Bytes::new()))?;
            }
            if self.heard.elapsed() > SILENT {
                return Err(End::Slow);
            }
        }
    }

    /// Sends the waiting messages, or waits for one briefly; returns whether no more follow.
    fn pass_on(&mut self, lines: &ClientLines) -> Result<bool, End> {
        if self.waits_since.is_some() {
            std::thread::sleep(LOOK_EVERY / 2);
            self.flush()?;
            return Ok(false);
        }
        match lines.queue.recv_timeout(LOOK_EVERY) {
            Ok(message) => self.send(message)?,
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(true),
        }
        Ok(false)
    }

    fn send(&mut self, message: Message) -> Result<(), End> {
        let written = self.socket.write(message);
        self.judge(written)?;
        self.flush()
    }

    fn flush(&mut self) -> Result<(), End> {
        let flushed = self.socket.flush();
        if self.judge(flushed)? {
            self.waits_since = None;
            return Ok(());
        }
        let since = *self.waits_since.get_or_insert_with(Instant::now);
        if since.elapsed() > STALLED { Err(End::Slow) } else { Ok(()) }
    }

    /// Whether the operation is complete, not postponed.
    fn judge(&self, done: tungstenite::Result<()>) -> Result<bool, End> {
        match done {
            Ok(()) => Ok(true),
            Err(Error::Io(error)) if error.kind() == ErrorKind::WouldBlock => Ok(false),
            Err(Error::WriteBufferFull(_)) => Err(End::Slow),
            Err(error) => {
                debug!("the web client {} went: {error}", self.peer);
                Err(End::Gone)
            }
        }
    }

    /// Processes the requests of the client.
    fn hear(&mut self) -> Result<(), End> {
        if let Some(refusal) = self.standing.refusal() {
            self.send(Message::text(refusal))?;
        }
        for _ in 0..MOST_REQUESTS {
            if !self.budget.allows(Instant::now()) {
                return Ok(());
            }
            let message = match self.socket.read() {
                Ok(message) => message,
                Err(error) => return self.judge(Err(error)).map(|_| ()),
            };
            self.heard = Instant::now();
            self.budget.spend(message.len());
            match message {
                Message::Text(text) => {
                    if let Err(refusal) = process(&text, self.peer, self.shared, &mut self.standing) {
                        self.send(Message::text(refusal))?;
                    }
                }
                Message::Close(_) => return Err(End::Gone),
                _ => {}
            }
        }
        Ok(())
    }

    fn say_goodbye(&mut self) -> End {
        // The client may be gone.
        let _ = self.socket.close(None);
        let _ = self.socket.flush();
        End::Gone
    }
}
