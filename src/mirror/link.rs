//! The connection to a server, with reconnection.

use std::io::{self, ErrorKind};
use std::net::{SocketAddr, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, Builder};
use std::time::{Duration, Instant};

use serde_json::Value;
use tungstenite::handshake::HandshakeError;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket};

use super::{Greeting, MirrorInput, MirrorSource, MirrorText};
use crate::outgoing::json::{Line, RequestRecord};

/// Interval between attempts to reach an absent server.
const AGAIN: Duration = Duration::from_secs(1);

/// Maximum time for connecting to a server.
const PATIENCE: Duration = Duration::from_secs(1);

/// Maximum silence of a server, which sends something every few milliseconds.
const SILENT: Duration = Duration::from_secs(2);

/// Interval between two checks for requests to send.
const LOOK_EVERY: Duration = Duration::from_millis(5);

/// Maximum size of a received message: a layout with thousands of controls, on the largest floor with all its
/// calibration.
const LARGEST: usize = 16 << 20;

/// Maximum number of waiting messages to the window, and of waiting requests to the server; further messages block
/// the connection, further requests are dropped.
const WAITING: usize = 64;

/// News from a server.
#[derive(Debug)]
pub enum MirrorNews {
    /// The link has joined the server, for the first time or again: the state of its floor, and the source of its
    /// packets from now on.
    Joined(Box<Greeting>, MirrorSource),
    /// The server has another layout, or repeats the state of its floor. Packets continue; the layout is among them.
    Again(Box<Greeting>),
    /// A report about the server's controls or pages, or the reason for a refused request.
    Line(Box<Line>),
    /// The server is lost or can't be joined, with the reason. The link tries again.
    Lost(String),
}

/// A connection to a server, on a thread of its own that ends when this is dropped.
#[derive(Debug)]
pub struct MirrorLink {
    asks: SyncSender<String>,
    over: Arc<AtomicBool>,
}

impl MirrorLink {
    /// Joins the server that serves web pages at `address`, and again whenever the connection is lost.
    ///
    /// # Errors
    /// An error if the system provides no thread.
    pub fn start(address: SocketAddr) -> io::Result<(Self, Receiver<MirrorNews>)> {
        let ((asks, asked), (news, told)) = (sync_channel(WAITING), sync_channel(WAITING));
        let over = Arc::<AtomicBool>::default();
        let link = Link { address, news, asked, over: Arc::clone(&over) };
        Builder::new().name("mirror link".into()).spawn(move || link.keep())?;
        Ok((Self { asks, over }, told))
    }

    /// Sends a request to the server, as web pages do: `widget/zoom/set` with `[0.5]`. A refusal arrives as a line;
    /// while the server is absent or accepts no requests, the request is dropped.
    pub fn ask(&self, request: &str, arguments: &[Value]) {
        let record = RequestRecord { args: arguments.to_vec(), request: request.to_owned() };
        let line = serde_json::to_string(&record).unwrap_or_default();
        // A failed link has reported its failure.
        let _ = self.asks.try_send(line);
    }
}

impl Drop for MirrorLink {
    fn drop(&mut self) {
        // The thread notices this within milliseconds; while it connects, within a second.
        self.over.store(true, Ordering::Relaxed);
    }
}

struct Link {
    address: SocketAddr,
    news: SyncSender<MirrorNews>,
    asked: Receiver<String>,
    over: Arc<AtomicBool>,
}

/// The receiver of the news is gone.
struct Over;

impl Link {
    fn keep(self) {
        loop {
            let begun = Instant::now();
            let why = match self.connect() {
                Ok(socket) => self.talk(socket),
                Err(why) => Ok(why),
            };
            let Ok(why) = why else { return };
            if self.tell(MirrorNews::Lost(why)).is_err() {
                return;
            }
            while begun.elapsed() < AGAIN {
                if self.over.load(Ordering::Relaxed) {
                    return;
                }
                thread::sleep(LOOK_EVERY);
            }
            // Drops requests to a server that was absent.
            self.asked.try_iter().for_each(drop);
        }
    }

    fn tell(&self, news: MirrorNews) -> Result<(), Over> {
        self.news.send(news).map_err(|_| Over)
    }

    fn connect(&self) -> Result<WebSocket<TcpStream>, String> {
        let stream =
            TcpStream::connect_timeout(&self.address, PATIENCE).map_err(|error| match error.kind() {
                ErrorKind::ConnectionRefused => format!("nobody serves at {}", self.address),
                _ => format!("{} can't be reached: {error}", self.address),
            })?;
        let set = stream
            .set_nodelay(true)
            .and_then(|()| stream.set_read_timeout(Some(PATIENCE)))
            .and_then(|()| stream.set_write_timeout(Some(PATIENCE)));
        set.map_err(|error| error.to_string())?;
        let config = WebSocketConfig::default().max_message_size(Some(LARGEST)).max_frame_size(Some(LARGEST));
        let url = format!("ws://{}/mirror", self.address);
        let joined = tungstenite::client::client_with_config(url, stream, Some(config));
        let (socket, _) = joined.map_err(|error| match error {
            HandshakeError::Interrupted(_) => "the server does not answer".to_owned(),
            HandshakeError::Failure(Error::Http(answer)) => {
                format!("the server lets no window in: {}", answer.status())
            }
            HandshakeError::Failure(error) => error.to_string(),
        })?;
        socket.get_ref().set_read_timeout(Some(LOOK_EVERY)).map_err(|error| error.to_string())?;
        Ok(socket)
    }

    /// Passes on messages until the server is gone; returns the reason.
    fn talk(&self, mut socket: WebSocket<TcpStream>) -> Result<String, Over> {
        let (mut input, mut heard) = (None::<MirrorInput>, Instant::now());
        loop {
            match socket.read() {
                Ok(Message::Text(text)) => {
                    heard = Instant::now();
                    if let Err(why) = self.hear(&text, &mut input)? {
                        return Ok(why);
                    }
                }
                Ok(Message::Binary(frame)) => {
                    heard = Instant::now();
                    if let Some(input) = &input {
                        // Invalid frames are counted with the refused packets.
                        let _ = input.put(&frame);
                    }
                }
                Ok(Message::Close(_)) => return Ok("the server has ended".into()),
                Ok(_) => {}
                Err(Error::Io(error))
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) =>
                {
                    if heard.elapsed() > SILENT {
                        return Ok("the server is silent".into());
                    }
                }
                Err(error) => return Ok(format!("the connection broke: {error}")),
            }
            for line in self.asked.try_iter() {
                if let Err(error) = socket.send(Message::text(line)) {
                    return Ok(format!("the connection broke: {error}"));
                }
            }
            if self.over.load(Ordering::Relaxed) {
                return Err(Over);
            }
        }
    }

    /// Processes a line; the inner error is the reason why the server can't be shown.
    fn hear(&self, text: &str, input: &mut Option<MirrorInput>) -> Result<Result<(), String>, Over> {
        let greeting = match MirrorText::read(text) {
            Ok(MirrorText::Greeting(greeting)) => greeting,
            Ok(MirrorText::Line(line)) => return self.tell(MirrorNews::Line(line)).map(Ok),
            Ok(MirrorText::Other) => return Ok(Ok(())),
            Err(why) => return Ok(Err(why)),
        };
        match input {
            Some(input) => {
                input.put_layout(greeting.layout_text.clone());
                self.tell(MirrorNews::Again(greeting))?;
            }
            None => {
                let (given, source) = MirrorSource::new(&greeting);
                *input = Some(given);
                self.tell(MirrorNews::Joined(greeting, source))?;
            }
        }
        Ok(Ok(()))
    }
}
