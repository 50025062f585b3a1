//! Events and contacts as OSC over UDP.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::Receiver;

use super::crack_rate::{CrackNews, CrackRateLimiter};
use super::periodic::{Latest, PeriodicSender};
use super::udp::UdpOut;
use super::worker::Worker;
use super::{EventSink, HeldReport, SinkError};
use crate::engine::{ControlState, PageShown};
use crate::feel::{DeviceStatus, Muted};
use crate::ground::GroundEvent;
use crate::outgoing::{
    write_alive, write_contacts, write_control, write_crack, write_device, write_event, write_health,
    write_held, write_mute, write_page,
};
use crate::sense::{Contact, SensorHealth};
use crate::units::Instant;
use crate::widget::WidgetEvent;
use crate::widget::WidgetId;
use crate::wire::{LinkState, Prefix};

/// Sends events, contacts and how link and sensors are doing as OSC over UDP.
///
/// Events go out at once, in order. Contacts go out 100 times a second while
/// there are any, always the latest, and once a second while there are none, also while no
/// frames come. What is held is repeated 50 times a second, and a sign of life ten times. The
/// messages are those of [`write_event`], [`write_contacts`], [`write_held`],
/// [`write_alive`], [`write_crack`], [`write_page`], [`write_health`],
/// [`write_device`], [`write_mute`] and [`write_control`].
#[derive(Debug)]
pub struct OscSink {
    worker: Worker<Job>,
    latest: Arc<Latest>,
    undelivered: Arc<AtomicU64>,
    periodic: PeriodicSender,
    cracks: CrackRateLimiter,
    /// What was last reported of link and sensors: each message tells of both.
    link: LinkState,
    health: SensorHealth,
}

#[derive(Debug)]
enum Job {
    Event(WidgetEvent),
    Page(WidgetId),
    Crack(CrackNews),
    Health(LinkState, SensorHealth),
    Device(DeviceStatus),
    Muted(Muted),
    Held(HeldReport),
    Alive(u32),
    Control(Box<ControlState>),
    /// Whatever the latest contacts are when it is its turn.
    Contacts,
    /// Nobody is there any more, as far as anybody can tell.
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

    /// A sink that sends to `target` and begins addresses with `prefix`.
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system gives no socket or no thread.
    pub fn under(target: SocketAddr, prefix: Prefix) -> Result<Self, SinkError> {
        let out = UdpOut::new(target, "OSC")?;
        let undelivered = out.undelivered();
        let latest = Arc::new(Latest::default());
        let sender = Sender { out, prefix, bytes: Vec::new() };
        let worker = Worker::spawn("osc out", {
            let latest = latest.clone();
            move |jobs| sender.run(jobs, &latest)
        })
        .map_err(|source| SinkError::Output {
            message: format!("cannot send OSC to {target}: {source}"),
            source,
        })?;
        let (link, health) = (LinkState::default(), SensorHealth::default());
        Ok(Self {
            worker,
            latest,
            undelivered,
            periodic: PeriodicSender::default(),
            cracks: CrackRateLimiter::default(),
            link,
            health,
        })
    }
}

impl OscSink {
    /// Nobody is on the floor, as far as this program can tell.
    fn say_nobody_is_there(&mut self, now: Instant) {
        // While the worker copies the last ones, the next poll tries again.
        if self.latest.store(now, &[], || self.worker.try_offer(Job::Contacts)) {
            self.periodic.reported(now, &[]);
        }
    }
}

impl EventSink for OscSink {
    fn events(&mut self, events: &[WidgetEvent]) {
        for event in events {
            self.worker.offer(Job::Event(event.clone()));
        }
    }

    fn contacts(&mut self, at: Instant, contacts: &[Contact]) {
        let queue = || self.worker.try_offer(Job::Contacts);
        if self.periodic.is_due(at, contacts) && self.latest.store(at, contacts, queue) {
            self.periodic.reported(at, contacts);
        }
    }

    fn page(&mut self, page: &PageShown) {
        self.worker.offer(Job::Page(page.page.clone()));
    }

    fn ground(&mut self, events: &[GroundEvent]) {
        for event in events {
            if let Some(news) = self.cracks.news(event) {
                self.worker.offer(Job::Crack(news));
            }
        }
    }

    fn link(&mut self, at: Instant, state: LinkState) {
        self.link = state;
        self.worker.offer(Job::Health(state, self.health.clone()));
        if state == LinkState::Lost {
            self.say_nobody_is_there(at);
        }
    }

    fn control(&mut self, _at: Instant, state: &ControlState) {
        self.worker.offer(Job::Control(Box::new(state.clone())));
    }

    fn poll(&mut self, now: Instant) {
        let no_frames = matches!(self.link, LinkState::Lost | LinkState::Waiting);
        if no_frames && self.periodic.is_silence_due(now) {
            self.say_nobody_is_there(now);
        }
    }

    fn health(&mut self, _at: Instant, health: &SensorHealth) {
        self.health.clone_from(health);
        self.worker.offer(Job::Health(self.link, health.clone()));
    }

    fn device(&mut self, _at: Instant, status: &DeviceStatus) {
        self.worker.offer(Job::Device(status.clone()));
    }

    fn muted(&mut self, _at: Instant, muted: &Muted) {
        self.worker.offer(Job::Muted(muted.clone()));
    }

    fn held(&mut self, report: &HeldReport) {
        let job = Job::Held(report.clone());
        // A repetition may be missed; that something has ended may not.
        let _ = if report.ended.is_empty() { self.worker.try_offer(job) } else { self.worker.offer(job) };
    }

    fn alive(&mut self, sequence: u32) {
        self.worker.try_offer(Job::Alive(sequence));
    }

    fn dropped(&self) -> u64 {
        self.worker.dropped() + self.undelivered.load(Ordering::Relaxed)
    }
}

impl Drop for OscSink {
    /// Says that nobody is on the floor any more, as far as this program can tell.
    fn drop(&mut self) {
        // A job of its own: contacts that wait already would say so before what was held is cancelled.
        if self.periodic.is_somebody_there() {
            self.worker.offer(Job::Nobody);
        }
    }
}

/// What the worker thread owns.
struct Sender {
    out: UdpOut,
    prefix: Prefix,
    bytes: Vec<u8>,
}

impl Sender {
    fn run(self, jobs: &Receiver<Job>, latest: &Latest) {
        let Self { out, prefix, mut bytes } = self;
        for job in jobs {
            match job {
                Job::Event(event) => {
                    write_event(&prefix, &event, &mut bytes);
                    out.send(&bytes);
                }
                Job::Page(page) => {
                    write_page(&prefix, page.as_str(), &mut bytes);
                    out.send(&bytes);
                }
                Job::Crack(CrackNews { seed, energy_j, x_m, y_m, skipped, .. }) => {
                    write_crack(&prefix, seed, [energy_j, x_m, y_m], skipped, &mut bytes);
                    out.send(&bytes);
                }
                Job::Health(state, health) => {
                    write_health(&prefix, state, &health, &mut bytes);
                    out.send(&bytes);
                }
                Job::Device(status) => {
                    write_device(&prefix, &status, &mut bytes);
                    out.send(&bytes);
                }
                Job::Muted(muted) => {
                    write_mute(&prefix, &muted, &mut bytes);
                    out.send(&bytes);
                }
                Job::Held(report) => write_held(&prefix, &report, &mut bytes, |datagram| out.send(datagram)),
                Job::Alive(sequence) => {
                    write_alive(&prefix, sequence, &mut bytes);
                    out.send(&bytes);
                }
                Job::Control(state) => {
                    write_control(&prefix, &state, &mut bytes);
                    out.send(&bytes);
                }
                Job::Contacts => {
                    write_contacts(&prefix, &latest.fetch().1, &mut bytes, |datagram| out.send(datagram));
                }
                Job::Nobody => write_contacts(&prefix, &[], &mut bytes, |datagram| out.send(datagram)),
            }
        }
    }
}
