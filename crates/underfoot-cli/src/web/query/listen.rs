//! Clients that listen to addresses over WebSocket: `{"COMMAND": "LISTEN", "DATA": "/underfoot/alive"}` sends each
//! message of that address as a binary message, `IGNORE` ends that, and `PATH_CHANGED` reports another layout.

use std::collections::BTreeSet;
use std::net::{SocketAddr, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use rosc::{OscMessage, OscPacket};
use serde::Deserialize;
use serde_json::json;
use tracing::{debug, warn};
use tungstenite::{Bytes, Message};

use super::super::MOST_BYTES;
use super::super::broadcast::ClientLines;
use super::super::socket::{ClientSocket, End};
use super::QueryShared;
use super::answer::tree;
use super::values::each_message;

/// Maximum number of messages that wait for one client: more than a second of all contacts of a crowd.
const WAITING: usize = 1024;

/// Maximum number of addresses to which one client listens: as many as a large layout has.
const MOST_ADDRESSES: usize = 8192;

/// Interval between two checks for another layout.
const LAYOUT_EVERY: Duration = Duration::from_secs(1);

/// A command of a client.
#[derive(Debug, Deserialize)]
struct ListenCommand {
    #[serde(rename = "COMMAND")]
    command: String,
    #[serde(rename = "DATA", default)]
    data: String,
}

/// All clients that listen.
#[derive(Debug, Default)]
pub(super) struct Listeners {
    state: Mutex<ListenerState>,
    /// Number of addresses to which clients listen: without any, no message is read.
    addresses: AtomicUsize,
}

#[derive(Debug, Default)]
struct ListenerState {
    there: Vec<Listener>,
    /// Whether the floor has ended: no more messages follow.
    has_ended: bool,
}

#[derive(Debug)]
struct Listener {
    peer: SocketAddr,
    addresses: BTreeSet<String>,
    messages: SyncSender<Message>,
    dropped: Arc<AtomicBool>,
}

impl Listeners {
    fn lock(&self) -> MutexGuard<'_, ListenerState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn join(&self, peer: SocketAddr) -> ClientLines {
        let (messages, queue) = sync_channel(WAITING);
        let dropped = Arc::<AtomicBool>::default();
        let mut state = self.lock();
        if !state.has_ended {
            let (addresses, dropped) = (BTreeSet::new(), Arc::clone(&dropped));
            state.there.push(Listener { peer, addresses, messages, dropped });
        }
        ClientLines { queue, dropped }
    }

    fn leave(&self, peer: SocketAddr) {
        self.change(|state| state.there.retain(|listener| listener.peer != peer));
    }

    /// Changes the clients, and counts their addresses anew.
    fn change(&self, change: impl FnOnce(&mut ListenerState)) {
        let mut state = self.lock();
        change(&mut state);
        let count = state.there.iter().map(|listener| listener.addresses.len()).sum();
        self.addresses.store(count, Ordering::Relaxed);
    }

    /// Begins or ends to listen to an address.
    fn set(&self, peer: SocketAddr, address: &str, listens: bool) {
        self.change(|state| {
            let Some(listener) = state.there.iter_mut().find(|listener| listener.peer == peer) else {
                return;
            };
            if !listens {
                listener.addresses.remove(address);
            } else if listener.addresses.len() < MOST_ADDRESSES {
                listener.addresses.insert(address.to_owned());
            } else {
                warn!("the OSCQuery client {peer} listens to {MOST_ADDRESSES} addresses; more are refused");
            }
        });
    }

    /// Sends the messages of a datagram to the clients that listen to their addresses.
    fn send(&self, datagram: &[u8]) {
        if self.addresses.load(Ordering::Relaxed) == 0 {
            return;
        }
        each_message(datagram, &mut |address, args| {
            let mut state = self.lock();
            let is_heard = |listener: &Listener| listener.addresses.contains(address);
            if !state.there.iter().any(is_heard) {
                return;
            }
            let packet = OscPacket::Message(OscMessage { addr: address.to_owned(), args });
            let Ok(bytes) = rosc::encoder::encode(&packet) else { return };
            let message = Message::Binary(Bytes::from(bytes));
            state.there.retain(|listener| {
                if !is_heard(listener) {
                    return true;
                }
                let sent = listener.messages.try_send(message.clone());
                if let Err(TrySendError::Full(_)) = sent {
                    warn!("the OSCQuery client {} does not read and was dropped", listener.peer);
                    listener.dropped.store(true, Ordering::Relaxed);
                }
                sent.is_ok()
            });
        });
    }
}

/// The sender of messages; the clients' connections end when it is dropped.
pub(super) struct ListenerSender(Arc<Listeners>);

impl ListenerSender {
    pub(super) fn new(listeners: Arc<Listeners>) -> Self {
        Self(listeners)
    }

    /// Sends the messages of one datagram.
    pub(super) fn send(&self, datagram: &[u8]) {
        self.0.send(datagram);
    }
}

impl Drop for ListenerSender {
    fn drop(&mut self) {
        self.0.change(|state| {
            state.has_ended = true;
            // The clients' threads send the waiting messages, and end.
            state.there.clear();
        });
    }
}

/// Serves one client until it leaves.
pub(super) fn serve(stream: TcpStream, peer: SocketAddr, shared: &QueryShared) {
    let refuse = |origin: &str| warn!("a web page from {origin} was refused by OSCQuery");
    let Some(mut socket) = ClientSocket::accept(stream, peer, MOST_BYTES, &[], refuse) else { return };
    let messages = shared.listeners.join(peer);
    // Either end closes the connection.
    let (Ok(_) | Err(_)) = talk(&mut socket, peer, shared, &messages);
    shared.listeners.leave(peer);
}

fn talk(
    socket: &mut ClientSocket,
    peer: SocketAddr,
    shared: &QueryShared,
    messages: &ClientLines,
) -> Result<End, End> {
    let mut shown = shared.session.snapshot().floor.layout_revision;
    loop {
        let revision = shared.session.snapshot().floor.layout_revision;
        if std::mem::replace(&mut shown, revision) != revision {
            let changed = json!({"COMMAND": "PATH_CHANGED", "DATA": shared.prefix.as_str()});
            socket.send(Message::text(changed.to_string()))?;
        }
        let next_look = Instant::now() + LAYOUT_EVERY;
        while Instant::now() < next_look {
            let take = |text: &str| {
                process(text, peer, shared);
                Ok(())
            };
            if socket.turn(messages, take)? {
                return Ok(socket.say_goodbye());
            }
        }
    }
}

/// Carries out a command; the protocol has no answer to a wrong one.
fn process(text: &str, peer: SocketAddr, shared: &QueryShared) {
    let asked: ListenCommand = match serde_json::from_str(text) {
        Ok(asked) => asked,
        Err(error) => return debug!("the OSCQuery client {peer} sent no command: {error}"),
    };
    let listens = match asked.command.as_str() {
        "LISTEN" => true,
        "IGNORE" => false,
        other => return debug!("the OSCQuery client {peer} sent the command {other:?}, which there is not"),
    };
    let root = tree(shared, &shared.session.snapshot().layout);
    if !listens || root.find(&asked.data).is_some_and(super::tree::QueryNode::is_sent) {
        shared.listeners.set(peer, &asked.data, listens);
    } else {
        debug!("the OSCQuery client {peer} listens to {:?}, which this floor does not send", asked.data);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use underfoot::outgoing::write_alive;
    use underfoot::wire::Prefix;

    use super::*;

    fn peer(port: u16) -> SocketAddr {
        ([127, 0, 0, 1], port).into()
    }

    fn alive(sender: &ListenerSender, sequence: u32) {
        let mut bytes = Vec::new();
        write_alive(&Prefix::default(), sequence, &mut bytes);
        sender.send(&bytes);
    }

    #[test]
    fn a_client_gets_the_messages_of_the_addresses_it_listens_to_until_it_ignores_them() {
        let listeners = Arc::<Listeners>::default();
        let sender = ListenerSender::new(Arc::clone(&listeners));
        let [one, other] = [1, 2].map(|port| listeners.join(peer(port)));
        alive(&sender, 1);
        listeners.set(peer(1), "/underfoot/alive", true);
        listeners.set(peer(2), "/underfoot/contacts", true);
        alive(&sender, 2);
        listeners.set(peer(1), "/underfoot/alive", false);
        alive(&sender, 3);
        let heard: Vec<Message> = one.queue.try_iter().collect();
        assert_eq!(heard.len(), 1);
        each_message(&heard[0].clone().into_data(), &mut |address, args| {
            assert_eq!((address, args), ("/underfoot/alive", vec![rosc::OscType::Int(2)]));
        });
        assert_eq!(other.queue.try_iter().count(), 0);
    }

    #[test]
    fn a_client_that_does_not_read_is_dropped_and_the_end_of_the_floor_ends_the_others() {
        let listeners = Arc::<Listeners>::default();
        let sender = ListenerSender::new(Arc::clone(&listeners));
        let [stalled, idle] = [1, 2].map(|port| listeners.join(peer(port)));
        listeners.set(peer(1), "/underfoot/alive", true);
        (0..=WAITING as u32).for_each(|sequence| alive(&sender, sequence));
        assert!(stalled.dropped.load(Ordering::Relaxed) && !idle.dropped.load(Ordering::Relaxed));
        drop(sender);
        assert!(idle.queue.recv().is_err());
        assert!(listeners.join(peer(3)).queue.recv().is_err(), "no client joins an ended floor");
    }
}
