//! The WebSocket of one client, on a thread that never blocks on it: messages out, texts in.

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
use super::origin::{PageOrigin, may_connect};

/// Interval between two checks for texts of the client.
const LOOK_EVERY: Duration = Duration::from_millis(10);

/// Maximum number of texts in one check: a thousand a second, as over OSC.
const MOST_REQUESTS: usize = 10;

/// Maximum number of bytes of texts in a second: a thousand requests of usual length.
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
pub(super) enum End {
    /// The client left, or the floor has ended.
    Gone,
    /// The client does not read.
    Slow,
}

/// The connection to one client.
pub(super) struct ClientSocket {
    socket: WebSocket<TcpStream>,
    peer: SocketAddr,
    budget: Budget,
    /// Time since which output waits for the client.
    waits_since: Option<Instant>,
    /// Time of the last input from it.
    heard: Instant,
    pinged: Instant,
}

impl ClientSocket {
    /// Accepts a client whose texts have `most` bytes at most; `None` if there is no connection. `refuse` gets the
    /// origin of a page that may not connect.
    #[allow(clippy::result_large_err, reason = "what refuses a client is as tungstenite has it")]
    pub(super) fn accept(
        stream: TcpStream,
        peer: SocketAddr,
        most: usize,
        origins: &[PageOrigin],
        refuse: impl FnOnce(&str),
    ) -> Option<Self> {
        let own = stream.local_addr().ok()?;
        // With a larger buffer, a slow client would only be dropped later.
        let _ = SockRef::from(&stream).set_send_buffer_size(WAITING_BYTES);
        let check = |request: &Request, response: Response| -> Result<Response, ErrorResponse> {
            let origin = request.headers().get(header::ORIGIN);
            let origin = origin.map(|origin| origin.to_str().unwrap_or("null"));
            if may_connect(origin, own, origins) {
                return Ok(response);
            }
            let origin = origin.unwrap_or_default().escape_debug().to_string();
            refuse(&origin);
            let mut refused = ErrorResponse::new(Some(format!("pages from {origin} are not let in\n")));
            *refused.status_mut() = StatusCode::FORBIDDEN;
            Err(refused)
        };
        let config = WebSocketConfig::default()
            .max_message_size(Some(most))
            .max_frame_size(Some(most))
            .write_buffer_size(0);
        let socket = accept_hdr_with_config(stream, check, Some(config))
            .inspect_err(|error| debug!("the web client {peer} made no connection: {error}"))
            .ok()?;
        socket.get_ref().set_nonblocking(true).ok()?;
        let (now, waits_since) = (Instant::now(), None);
        let budget = Budget::new(most.max(BYTES_A_SECOND), now);
        Some(Self { socket, peer, budget, waits_since, heard: now, pinged: now })
    }

    /// Sends the waiting messages, or waits for one briefly, and gives each text of the client to `take`, whose error is
    /// an answer. Returns whether no more messages follow.
    pub(super) fn turn(
        &mut self,
        lines: &ClientLines,
        take: impl FnMut(&str) -> Result<(), String>,
    ) -> Result<bool, End> {
        let is_over = self.pass_on(lines)?;
        self.hear(take)?;
        if lines.dropped.load(Ordering::Relaxed) || self.heard.elapsed() > SILENT {
            return Err(End::Slow);
        }
        if self.pinged.elapsed() >= PING_EVERY {
            self.pinged = Instant::now();
            self.send(Message::Ping(Bytes::new()))?;
        }
        Ok(is_over)
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

    /// Sends one message, or leaves it to the next turn.
    pub(super) fn send(&mut self, message: Message) -> Result<(), End> {
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

    /// Gives the texts of the client to `take`.
    fn hear(&mut self, mut take: impl FnMut(&str) -> Result<(), String>) -> Result<(), End> {
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
                    if let Err(answer) = take(&text) {
                        self.send(Message::text(answer))?;
                    }
                }
                Message::Close(_) => return Err(End::Gone),
                _ => {}
            }
        }
        Ok(())
    }

    /// Closes the connection.
    pub(super) fn say_goodbye(&mut self) -> End {
        // The client may be gone.
        let _ = self.socket.close(None);
        let _ = self.socket.flush();
        End::Gone
    }
}
