//! The connection to a server, made again and again.

use std::io::{self, ErrorKind};
use std::net::{SocketAddr, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, Builder};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::handshake::HandshakeError;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket};

use super::{Greeting, MirrorInput, MirrorSource, ServerLine};

/// How often a server that is not there is tried again.
const AGAIN: Duration = Duration::from_secs(1);

/// How long a server may take to let somebody in.
const PATIENCE: Duration = Duration::from_secs(1);

/// How long a server may be silent: it sends something every few milliseconds.
const SILENT: Duration = Duration::from_secs(2);

/// How often it is looked whether something is to be asked.
const LOOK_EVERY: Duration = Duration::from_millis(5);

/// The largest message that is taken: a layout with thousands of controls, on the largest floor with all its
/// calibration.
const LARGEST: usize = 16 << 20;

/// What may wait for whoever joined, and for the server; more of the former holds up the server, more of the latter is
/// dropped.
const WAITING: usize = 64;

/// Lines that are passed on; whoever senses the same packets knows the rest.
const PASSED_ON: [&str; 4] = ["state", "changed", "page", "error"];

/// What comes from a server.
#[derive(Debug)]
pub enum MirrorNews {
    /// It is joined, for the first time or anew: how its floor is, and what its boards send from now on.
    Joined(Box<Greeting>, MirrorSource),
    /// It has another layout, or says again how its floor is. Packets go on; the layout comes with them.
    Again(Box<Greeting>),
    /// What it says of its controls and pages, and why it refused a request.
    Line(Box<ServerLine>),
    /// It is gone, or can't be joined; why. It is tried again.
    Lost(String),
}

/// A connection to a server, on a thread of its own that ends with this.
#[derive(Debug)]
pub struct MirrorLink {
    asks: SyncSender<String>,
    over: Arc<AtomicBool>,
}

impl MirrorLink {
    /// Joins the server that serves web pages at `address`, and does so again whenever it is lost.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(address: SocketAddr) -> io::Result<(Self, Receiver<MirrorNews>)> {
        let ((asks, asked), (news, told)) = (sync_channel(WAITING), sync_channel(WAITING));
        let over = Arc::<AtomicBool>::default();
        let link = Link { address, news, asked, over: Arc::clone(&over) };
        Builder::new().name("mirror link".into()).spawn(move || link.keep())?;
        Ok((Self { asks, over }, told))
    }

    /// Asks the server something, as web pages do: `widget/zoom/set` with `[0.5]`. A refusal comes as a line; while it
    /// is not there, or takes nothing, nothing is asked.
    pub fn ask(&self, request: &str, arguments: &[Value]) {
        let line = json!({"request": request, "args": arguments}).to_string();
        // A link that has failed has said so.
        let _ = self.asks.try_send(line);
    }
}

impl Drop for MirrorLink {
    fn drop(&mut self) {
        // Its thread notices within milliseconds; while it connects, within a second.
        self.over.store(true, Ordering::Relaxed);
    }
}

struct Link {
    address: SocketAddr,
    news: SyncSender<MirrorNews>,
    asked: Receiver<String>,
    over: Arc<AtomicBool>,
}

/// Nobody wants to hear of the server any more.
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
            // What was asked of a server that was not there is past.
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

    /// Passes on what comes until the server is gone; why it is.
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
                        // One that makes no sense is counted with the packets that were refused.
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

    /// Takes a line; why the server can't be shown.
    fn hear(&self, text: &str, input: &mut Option<MirrorInput>) -> Result<Result<(), String>, Over> {
        let line = match ServerLine::read(text) {
            Ok(line) => line,
            Err(error) => return Ok(Err(format!("the server says what makes no sense: {error}"))),
        };
        if !Greeting::is_in(&line) {
            if PASSED_ON.contains(&line.event()) {
                self.tell(MirrorNews::Line(Box::new(line)))?;
            }
            return Ok(Ok(()));
        }
        let greeting = match Greeting::read(text) {
            Ok(greeting) => Box::new(greeting),
            Err(error) => return Ok(Err(error.to_string())),
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
