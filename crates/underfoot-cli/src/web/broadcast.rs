//! One stream of lines to many clients, and of frames to joined windows; no client delays another.

use std::io::{self, Write};
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::Serialize;
use tracing::warn;
use tungstenite::{Bytes, Message};
use underfoot::outgoing::json::{self, ClientsRecord, Line};

/// Maximum number of lines that wait for one client: two seconds of contacts.
const WAITING: usize = 256;

/// Maximum number of lines and frames that wait for one window: two seconds of both.
const WAITING_FRAMES: usize = 1024;

/// All connected clients.
#[derive(Debug, Default)]
pub(super) struct Clients {
    state: Mutex<State>,
    /// Number of joined windows.
    windows: Arc<AtomicUsize>,
}

/// Numbers of clients.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub(super) struct ClientCounts {
    /// Clients that are connected now.
    pub(super) connected: usize,
    /// Clients since the start.
    pub(super) served: u64,
    /// Clients that did not read.
    pub(super) dropped: u64,
    /// Web pages of other origins.
    pub(super) refused: u64,
}

#[derive(Debug, Default)]
struct State {
    there: Vec<Client>,
    served: u64,
    dropped: u64,
    /// Number of refused web pages.
    refused: u64,
    /// Whether the floor has ended: no more messages follow.
    ended: bool,
}

#[derive(Debug)]
struct Client {
    peer: SocketAddr,
    lines: SyncSender<Message>,
    /// Whether it is a window, which also gets frames.
    joins: bool,
    dropped: Arc<AtomicBool>,
}

/// The messages to one client.
pub(super) struct ClientLines {
    pub(super) queue: Receiver<Message>,
    /// Whether too many messages wait for it: no more follow, and the waiting ones are old.
    pub(super) dropped: Arc<AtomicBool>,
}

impl Clients {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The counter of joined windows.
    pub(super) fn windows(&self) -> Arc<AtomicUsize> {
        Arc::clone(&self.windows)
    }

    /// Adds a client, which gets messages from now on; `joins` if it is a window, which also gets the boards'
    /// packets.
    pub(super) fn join(&self, peer: SocketAddr, joins: bool) -> ClientLines {
        let (lines, queue) = sync_channel(if joins { WAITING_FRAMES } else { WAITING });
        let dropped = Arc::<AtomicBool>::default();
        let mut state = self.lock();
        state.served += 1;
        if !state.ended {
            state.there.push(Client { peer, lines, joins, dropped: Arc::clone(&dropped) });
        }
        state.tell_counts();
        self.count_windows(&state);
        ClientLines { queue, dropped }
    }

    /// Removes a client; `slow` if it does not read.
    pub(super) fn leave(&self, peer: SocketAddr, slow: bool) {
        let mut state = self.lock();
        let place = state.there.iter().position(|client| client.peer == peer);
        if let Some(place) = place {
            state.there.swap_remove(place);
            if slow {
                state.count_slow(peer);
            }
            state.tell_counts();
        }
        self.count_windows(&state);
    }

    fn count_windows(&self, state: &State) {
        let joined = state.there.iter().filter(|client| client.joins).count();
        self.windows.store(joined, Ordering::Relaxed);
    }

    /// Sends a frame of the boards' packets to all windows.
    pub(super) fn tell_frame(&self, frame: Vec<u8>) {
        let mut state = self.lock();
        state.send(&Message::Binary(Bytes::from(frame)), |client| client.joins);
        self.count_windows(&state);
    }

    /// Counts a refused web page. Logs it only when the count is a power of two: a page may retry as long as it is
    /// open.
    pub(super) fn refuse(&self, origin: &str) {
        let mut state = self.lock();
        state.refused += 1;
        if state.refused.is_power_of_two() {
            let refused = state.refused;
            warn!("a web page from {origin} was refused ({refused} so far); --web-origin lets it in");
        }
    }

    /// The numbers of clients so far.
    pub(super) fn counts(&self) -> ClientCounts {
        let State { ref there, served, dropped, refused, .. } = *self.lock();
        ClientCounts { connected: there.len(), served, dropped, refused }
    }
}

impl State {
    fn tell(&mut self, line: &str) {
        self.send(&Message::text(line), |_| true);
    }

    fn send(&mut self, message: &Message, concerns: impl Fn(&Client) -> bool) {
        let mut slow = Vec::new();
        self.there.retain(|client| match concerns(client).then(|| client.lines.try_send(message.clone())) {
            None | Some(Ok(())) => true,
            Some(Err(TrySendError::Disconnected(_))) => false,
            Some(Err(TrySendError::Full(_))) => {
                client.dropped.store(true, Ordering::Relaxed);
                slow.push(client.peer);
                false
            }
        });
        slow.into_iter().for_each(|peer| self.count_slow(peer));
    }

    fn count_slow(&mut self, peer: SocketAddr) {
        self.dropped += 1;
        if self.dropped.is_power_of_two() {
            warn!("the web client {peer} does not read and was dropped; {} so far", self.dropped);
        }
    }

    /// Sends the numbers of clients to all of them.
    fn tell_counts(&mut self) {
        let (connected, dropped) = (self.there.len(), self.dropped);
        let counts = ClientsRecord { connected, dropped };
        self.tell(&Line::timeless(json::Message::Clients(counts)).text());
    }
}

/// A writer that sends its input to all clients line by line.
pub(super) struct Broadcast {
    clients: Arc<Clients>,
    line: Vec<u8>,
}

impl Broadcast {
    pub(super) fn new(clients: Arc<Clients>) -> Self {
        Self { clients, line: Vec::new() }
    }
}

impl Write for Broadcast {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let (taken, is_whole) = match bytes.iter().position(|&byte| byte == b'\n') {
            Some(end) => (end + 1, true),
            None => (bytes.len(), false),
        };
        self.line.extend(&bytes[..taken]);
        if is_whole {
            let line = String::from_utf8_lossy(&self.line);
            self.clients.lock().tell(line.trim_end());
            self.line.clear();
        }
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Drop for Broadcast {
    fn drop(&mut self) {
        let mut state = self.clients.lock();
        state.ended = true;
        // The clients' threads send the waiting messages, and end.
        state.there.clear();
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// The numbers of served and of dropped clients.
    fn served_and_dropped(clients: &Clients) -> (u64, u64) {
        let ClientCounts { served, dropped, .. } = clients.counts();
        (served, dropped)
    }

    #[test]
    fn who_does_not_read_is_dropped_and_the_others_hear_of_it() {
        let clients = Arc::<Clients>::default();
        let [stalled, reading] = [1, 2].map(|port| clients.join(([127, 0, 0, 1], port).into(), false));
        let mut out = Broadcast::new(Arc::clone(&clients));
        let mut heard = 0;
        for number in 0..=WAITING {
            write!(out, "{{\"number\":{number}").unwrap();
            out.write_all(b"}\n").unwrap();
            heard += reading.queue.try_iter().filter(|line| line.to_string().contains("number")).count();
        }
        assert_eq!((heard, served_and_dropped(&clients)), (WAITING + 1, (2, 1)));
        assert!(stalled.dropped.load(Ordering::Relaxed) && !reading.dropped.load(Ordering::Relaxed));
        clients.leave(([127, 0, 0, 1], 1).into(), true);
        assert_eq!(served_and_dropped(&clients), (2, 1), "counted once");
        drop(out);
        assert!(reading.queue.recv().is_err(), "the floor has ended");
    }

    #[test]
    fn only_windows_get_frames_and_one_that_does_not_read_is_counted() {
        let clients = Arc::<Clients>::default();
        let [page, window] =
            [false, true].map(|joins| clients.join(([127, 0, 0, 1], 1 + u16::from(joins)).into(), joins));
        let is_frame = |message: &Message| message.is_binary();
        clients.tell_frame(vec![1]);
        assert_eq!(window.queue.try_iter().filter(is_frame).count(), 1);
        assert_eq!(page.queue.try_iter().filter(is_frame).count(), 0);
        assert_eq!(clients.windows().load(Ordering::Relaxed), 1);
        (0..=WAITING_FRAMES).for_each(|_| clients.tell_frame(vec![1]));
        assert!(window.dropped.load(Ordering::Relaxed) && !page.dropped.load(Ordering::Relaxed));
        assert_eq!((clients.windows().load(Ordering::Relaxed), served_and_dropped(&clients)), (0, (2, 1)));
    }
}
