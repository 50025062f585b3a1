//! Events and contacts as OSC over UDP.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::crack_rate::{CrackNews, CrackRateLimiter};
use super::periodic::{Latest, PeriodicSender};
use super::udp::UdpOut;
use super::worker::Worker;
use super::{EventSink, Report, SinkError, WaitFreeReceiver};
use crate::outgoing::{
    write_alive, write_area, write_contacts, write_control, write_crack, write_device, write_event,
    write_health, write_held, write_ignored, write_mute, write_page,
};
use crate::sense::{Contact, SensorHealth};
use crate::units::Instant;
use crate::wire::{LinkCause, LinkState, Prefix};

/// Sends events, contacts and the state of link and sensors as OSC over UDP.
///
/// Events go out at once, in order. The latest contacts go out 100 times a second while there are any, and once a
/// second while there are none, also while no frames come. The held controls go out 50 times a second, and an alive
/// message ten times. The messages are those of `write_event`, `write_ignored`, `write_contacts`, `write_held`, `write_alive`,
/// `write_crack`, `write_page`, `write_health`, `write_device`, `write_mute` and `write_control`.
#[derive(Debug)]
pub struct OscSink {
    worker: Worker<Job>,
    latest: Arc<Latest>,
    undelivered: Arc<AtomicU64>,
    periodic: PeriodicSender,
    cracks: CrackRateLimiter,
    link: LinkState,
}

#[derive(Debug)]
enum Job {
    Report(Report<'static>),
    /// Send the contacts that are the latest when the job runs.
    Contacts,
    /// The floor counts as empty.
    Nobody,
}

impl OscSink {
    /// A sink that sends to `target`; a broadcast address reaches all machines of a network.
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system gives no socket or no thread.
    pub fn new(target: SocketAddr) -> Result<Self, SinkError> {
        Self::under(target, Prefix::default())
    }

    /// A sink that sends to `target` and puts `prefix` before its addresses.
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system gives no socket or no thread.
    pub fn under(target: SocketAddr, prefix: Prefix) -> Result<Self, SinkError> {
        let out = UdpOut::new(target, "OSC")?;
        let undelivered = out.undelivered();
        let mut sink = Self::through(prefix, move |datagram| out.send(datagram))?;
        sink.undelivered = undelivered;
        Ok(sink)
    }

    /// A sink that passes each datagram to `send`, on a thread of its own, and puts `prefix` before its addresses.
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system gives no thread.
    pub fn through(prefix: Prefix, send: impl FnMut(&[u8]) + Send + 'static) -> Result<Self, SinkError> {
        let latest = Arc::new(Latest::default());
        let (link, health) = (LinkState::default(), SensorHealth::default());
        let sender = Sender { send, prefix, link, cause: None, health };
        let worker = Worker::spawn("osc out", {
            let latest = latest.clone();
            move |jobs| sender.run(jobs, &latest)
        })
        .map_err(|source| SinkError::Output { message: format!("cannot send OSC: {source}"), source })?;
        Ok(Self {
            worker,
            latest,
            undelivered: Arc::default(),
            periodic: PeriodicSender::default(),
            cracks: CrackRateLimiter::default(),
            link: LinkState::default(),
        })
    }
}

impl OscSink {
    /// Reports an empty floor.
    fn say_nobody_is_there(&mut self, now: Instant) {
        // If the worker is copying the contacts, the next poll tries again.
        if self.latest.store(now, &[], || self.worker.try_offer(Job::Contacts)) {
            self.periodic.reported(now, &[]);
        }
    }
}

impl EventSink for OscSink {
    fn report(&mut self, report: &Report<'_>) {
        if let Report::Message(_) = report {
            return;
        }
        if let Report::Contacts(at, contacts) = report {
            let queue = || self.worker.try_offer(Job::Contacts);
            if self.periodic.is_due(*at, contacts) && self.latest.store(*at, contacts, queue) {
                self.periodic.reported(*at, contacts);
            }
            return;
        }
        let Some(owned) = report.limited(&mut self.cracks) else { return };
        // A repeated report may be lost; the end of a hold may not.
        let is_repeated = match report {
            Report::Held(report) => report.ended.is_empty(),
            Report::Alive(..) => true,
            _ => false,
        };
        let job = Job::Report(owned);
        let _ = if is_repeated { self.worker.try_offer(job) } else { self.worker.offer(job) };
        if let &Report::Link(at, state) = report {
            self.link = state;
            if state == LinkState::Lost {
                self.say_nobody_is_there(at);
            }
        }
    }

    fn poll(&mut self, now: Instant) {
        let no_frames = matches!(self.link, LinkState::Lost | LinkState::Waiting);
        if no_frames && self.periodic.is_silence_due(now) {
            self.say_nobody_is_there(now);
        }
    }

    fn dropped(&self) -> u64 {
        self.worker.dropped() + self.undelivered.load(Ordering::Relaxed)
    }
}

impl Drop for OscSink {
    /// Reports an empty floor at the end.
    fn drop(&mut self) {
        // A job of its own: contacts already in the queue would report that before the held controls are cancelled.
        if self.periodic.is_somebody_there() {
            self.worker.offer(Job::Nobody);
        }
    }
}

/// State of the worker thread.
struct Sender<S> {
    send: S,
    prefix: Prefix,
    /// The last reports of link and sensors: each message contains all of them.
    link: LinkState,
    cause: Option<LinkCause>,
    health: SensorHealth,
}

impl<S: FnMut(&[u8])> Sender<S> {
    fn run(mut self, jobs: &mut WaitFreeReceiver<Job>, latest: &Latest) {
        let mut bytes = Vec::new();
        for job in jobs.iter() {
            match job {
                Job::Report(report) => self.write(&report, &mut bytes),
                Job::Contacts => self.contacts(&latest.fetch().1, &mut bytes),
                Job::Nobody => self.contacts(&[], &mut bytes),
            }
        }
    }

    fn contacts(&mut self, contacts: &[Contact], bytes: &mut Vec<u8>) {
        write_contacts(&self.prefix, contacts, bytes, &mut self.send);
    }

    fn write(&mut self, report: &Report<'_>, bytes: &mut Vec<u8>) {
        let prefix = &self.prefix;
        match report {
            Report::Event(event) => write_event(prefix, event, bytes),
            Report::Ignored(press) => write_ignored(prefix, press, bytes),
            Report::Contacts(_, contacts) => return self.contacts(contacts, bytes),
            Report::Page(shown) => write_page(prefix, shown.page.as_str(), bytes),
            // The queue has the cracks in their place.
            Report::Ground(_) => return,
            &Report::Crack(CrackNews { seed, energy_j, x_m, y_m, skipped, .. }) => {
                write_crack(prefix, seed, [energy_j, x_m, y_m], skipped, bytes);
            }
            Report::Link(_, state) => {
                self.link = *state;
                write_health(prefix, *state, self.cause.as_ref(), &self.health, bytes);
            }
            Report::LinkCause(_, cause) => {
                write_health(prefix, self.link, cause.as_deref(), &self.health, bytes);
                self.cause = cause.as_deref().cloned();
            }
            Report::Health(_, health) => {
                write_health(prefix, self.link, self.cause.as_ref(), health, bytes);
                self.health.clone_from(health);
            }
            Report::Device(_, status) => write_device(prefix, status, bytes),
            Report::Held(report) => {
                return write_held(prefix, report, bytes, &mut self.send);
            }
            Report::Alive(_, sequence) => write_alive(prefix, *sequence, bytes),
            Report::Muted(_, muted) => write_mute(prefix, muted, bytes),
            Report::Control(_, state) => write_control(prefix, state, bytes),
            Report::Area(news) => write_area(prefix, news, bytes),
            // They have targets of their own.
            Report::Message(_) => return,
        }
        (self.send)(bytes);
    }
}
