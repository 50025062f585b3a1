use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex, PoisonError, TryLockError};
use std::time::Duration;

use super::worker::Worker;
use super::{EventSink, SinkError};
use crate::engine::LinkState;
use crate::sense::{Contact, SensorHealth};
use crate::units::Instant;
use crate::widget::WidgetEvent;
use crate::wire::{write_contacts, write_event, write_health};

/// Time between two reports of the contacts: the paper's 100 Hz.
const CONTACT_PERIOD: Duration = Duration::from_millis(10);

/// Sends events, contacts and how link and sensors are doing as OSC over UDP.
///
/// Events go out at once, in order. Contacts go out 100 times a second while
/// there are any, always the latest, and once more when there are none. The
/// messages are those of [`write_event`], [`write_contacts`] and [`write_health`].
#[derive(Debug)]
pub struct OscSink {
    worker: Worker<Job>,
    latest: Arc<Latest>,
    undelivered: Arc<AtomicU64>,
    /// When the next report of the contacts is due; `None` while nobody is on the floor.
    due: Option<Instant>,
    /// What was last heard of link and sensors: each message tells of both.
    link: LinkState,
    health: SensorHealth,
}

#[derive(Debug)]
enum Job {
    Event(WidgetEvent),
    Health(LinkState, SensorHealth),
    /// Whatever the latest contacts are when it is its turn.
    Contacts,
}

/// The contacts to be reported next; an older report not yet sent is overwritten.
#[derive(Debug, Default)]
struct Latest {
    contacts: Mutex<Vec<Contact>>,
    queued: AtomicBool,
}

impl OscSink {
    /// A sink that sends to `target`; a broadcast address reaches all machines of a network.
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system gives no socket or no thread.
    pub fn new(target: SocketAddr) -> Result<Self, SinkError> {
        let failed =
            |source| SinkError::Output { message: format!("cannot send OSC to {target}: {source}"), source };
        let any: SocketAddr = match target {
            SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
            SocketAddr::V6(_) => (Ipv6Addr::UNSPECIFIED, 0).into(),
        };
        // Never connected: a closed port at the other end must not become an error at ours.
        let socket = UdpSocket::bind(any).map_err(failed)?;
        if target.is_ipv4() {
            socket.set_broadcast(true).map_err(failed)?;
        }
        let latest = Arc::new(Latest::default());
        let undelivered = Arc::new(AtomicU64::new(0));
        let sender = Sender { socket, target, undelivered: undelivered.clone(), bytes: Vec::new() };
        let worker = Worker::spawn("osc out", {
            let latest = latest.clone();
            move |jobs| sender.run(jobs, &latest)
        })
        .map_err(failed)?;
        let (link, health) = (LinkState::default(), SensorHealth::default());
        Ok(Self { worker, latest, undelivered, due: None, link, health })
    }

    /// Stores `contacts` for the next report; false if the worker is reading the last ones just now.
    fn report(&self, contacts: &[Contact]) -> bool {
        let mut stored = match self.latest.contacts.try_lock() {
            Ok(stored) => stored,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => return false,
        };
        stored.clear();
        stored.extend_from_slice(contacts);
        drop(stored);
        if !self.latest.queued.swap(true, Ordering::AcqRel) && !self.worker.try_offer(Job::Contacts) {
            self.latest.queued.store(false, Ordering::Release);
        }
        true
    }
}

impl EventSink for OscSink {
    fn events(&mut self, events: &[WidgetEvent]) {
        for event in events {
            self.worker.offer(Job::Event(event.clone()));
        }
    }

    fn contacts(&mut self, at: Instant, contacts: &[Contact]) {
        let is_due = self.due.is_none_or(|due| at >= due);
        if !is_due || (self.due.is_none() && contacts.is_empty()) || !self.report(contacts) {
            return;
        }
        self.due = if contacts.is_empty() {
            None
        } else {
            // Keep the beat, unless it has been missed.
            let next = self.due.unwrap_or(at) + CONTACT_PERIOD;
            Some(if next > at { next } else { at + CONTACT_PERIOD })
        };
    }

    fn link(&mut self, _at: Instant, state: LinkState) {
        self.link = state;
        self.worker.offer(Job::Health(state, self.health.clone()));
    }

    fn health(&mut self, _at: Instant, health: &SensorHealth) {
        self.health.clone_from(health);
        self.worker.offer(Job::Health(self.link, health.clone()));
    }

    fn dropped(&self) -> u64 {
        self.worker.dropped() + self.undelivered.load(Ordering::Relaxed)
    }
}

impl Drop for OscSink {
    /// Says that nobody is on the floor any more, as far as this program can tell.
    fn drop(&mut self) {
        if self.due.is_some() {
            self.report(&[]);
        }
    }
}

/// What the worker thread owns.
struct Sender {
    socket: UdpSocket,
    target: SocketAddr,
    undelivered: Arc<AtomicU64>,
    bytes: Vec<u8>,
}

impl Sender {
    fn run(mut self, jobs: &Receiver<Job>, latest: &Latest) {
        for job in jobs {
            let Self { socket, target, undelivered, bytes } = &mut self;
            let send = |datagram: &[u8]| {
                if socket.send_to(datagram, *target).is_err() {
                    undelivered.fetch_add(1, Ordering::Relaxed);
                }
            };
            match job {
                Job::Event(event) => {
                    write_event(&event, bytes);
                    send(bytes);
                }
                Job::Health(state, health) => {
                    write_health(state, &health, bytes);
                    send(bytes);
                }
                Job::Contacts => {
                    latest.queued.store(false, Ordering::Release);
                    let contacts = latest.contacts.lock().unwrap_or_else(PoisonError::into_inner).clone();
                    write_contacts(&contacts, bytes, send);
                }
            }
        }
    }
}
