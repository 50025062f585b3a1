//! Accepts connections within the limits of a server, each on a thread of its own.

use std::io::ErrorKind;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, Builder, JoinHandle};
use std::time::{Duration, Instant};

use tracing::warn;

use super::rooms::{Refusals, Rooms};
use crate::failure::Failure;

/// Interval between two checks for new connections.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// Opens a port at `address` for `what`; it accepts no clients yet.
pub(super) fn open(address: SocketAddr, what: &str) -> Result<TcpListener, Failure> {
    let failed = |error| Failure::Other(format!("can't listen on {address} for {what}: {error}"));
    let listener = TcpListener::bind(address).map_err(failed)?;
    listener.set_nonblocking(true).map_err(failed)?;
    Ok(listener)
}

/// A thread that accepts connections; ends when dropped, after the connections.
pub(super) struct Accepting {
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Accepting {
    /// Starts to accept connections; `serve` serves one of them, on a thread of its own, until it ends.
    pub(super) fn start(
        listener: TcpListener,
        serve: impl Fn(TcpStream, SocketAddr) + Send + Sync + 'static,
    ) -> std::io::Result<Self> {
        let is_over = Arc::<AtomicBool>::default();
        let over = Arc::clone(&is_over);
        let serve = Arc::new(serve);
        let accept = move || accept(&listener, &over, &serve);
        let thread = Some(Builder::new().name("web server".into()).spawn(accept)?);
        Ok(Self { is_over, thread })
    }
}

impl Drop for Accepting {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        // A panic of the thread has been reported.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// Accepts clients until the server ends, and waits for the connected ones.
fn accept<S>(listener: &TcpListener, is_over: &AtomicBool, serve: &Arc<S>)
where
    S: Fn(TcpStream, SocketAddr) + Send + Sync + 'static,
{
    let (mut rooms, refusals) = (Rooms::default(), Refusals::start());
    while !is_over.load(Ordering::Relaxed) {
        match listener.accept() {
            Ok((stream, peer)) => {
                let now = Instant::now();
                if let Some(why) = rooms.why_not(peer.ip(), now) {
                    refusals.refuse(stream, why);
                    continue;
                }
                let serve = Arc::clone(serve);
                match Builder::new().name("web client".into()).spawn(move || serve(stream, peer)) {
                    Ok(room) => rooms.take(peer.ip(), room, now),
                    Err(error) => warn!("a web client can't be served: {error}"),
                }
            }
            Err(error) => {
                if error.kind() != ErrorKind::WouldBlock {
                    warn!("a web client can't come in: {error}");
                }
                thread::sleep(LOOK_EVERY);
            }
        }
    }
    rooms.wait();
}
