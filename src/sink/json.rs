//! Events as JSON lines.

mod line;
#[cfg(test)]
mod tests;

use std::io::{self, Write};
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant as HostInstant};

use self::line::Line;
use super::backlog::{Backlog, Gap, Worth};
use super::crack_rate::{CrackNews, CrackRateLimiter};
use super::periodic::PeriodicSender;
use super::worker::Worker;
use super::{EventSink, HeldReport, SinkError};
use crate::engine::{ControlState, PageShown};
use crate::feel::{DeviceStatus, Muted};
use crate::ground::GroundEvent;
use crate::sense::{Contact, SensorHealth};
use crate::units::Instant;
use crate::widget::{EventKind, WidgetEvent, WidgetId};
use crate::wire::LinkState;

/// Writes one JSON object per event and line.
///
/// ```json
/// {"t_s":1.234,"event":"changed","id":"zoom","value":0.5,"force_n":120.5,"x_m":0.61,"y_m":1.2,"contact":3}
/// {"t_s":9.876,"event":"link","state":"lost"}
/// {"t_s":9.9,"event":"page","page":"settings"}
/// {"t_s":9.9,"event":"health","live":143,"degraded":0,"stale":0,"faulty":1,"uncalibrated":0,"foreign":false,"troubles":[{"col":2,"row":1,"corner":"sw","trouble":"stuck"}]}
/// {"t_s":9.9,"event":"device","device":"Card","state":"lost","why":"unplugged","channels":36,"sample_rate":96000,"block":64,"underruns":0,"reopened":0,"priority":"real-time"}
/// {"t_s":9.9,"event":"mute","all":false,"tiles":[[2,1]]}
/// {"t_s":9.9,"held":["zoom"],"sequence":12}
/// {"t_s":9.9,"event":"state","id":"zoom","value":0.5,"range":[0.0,1.0],"enabled":true,"locked":false,"pressed":false,"armed":false,"indicator":"off","label":"Zoom","page":null}
/// {"t_s":9.9,"event":"crack","seed":3,"energy_j":0.4,"x_m":0.61,"y_m":1.2,"skipped":0}
/// ```
///
/// `value` is a number (of a choice: which, from 0), true or false, two numbers
/// in a list, the direction of a swipe, or null for events without a value;
/// `contact` is null if no foot did it. A number that JSON cannot express
/// (which the engine never gives) is null. Which controls are held is written 50
/// times a second while any is, and once when none is any longer. Contacts are written on request ([`JsonSink::with_contacts`]):
///
/// ```json
/// {"t_s":9.9,"event":"contacts","contacts":[{"id":3,"x_m":0.61,"y_m":1.2,"force_n":350.0,"x_velocity_m_s":0.0,"y_velocity_m_s":0.0}]}
/// ```
///
/// A reader that stops reading holds nobody up. Beyond a thousand lines only the latest value and state of
/// each kind wait for it, and everything that begins or ends a press; where lines were left out stands how many:
///
/// ```json
/// {"t_s":9.9,"event":"gap","dropped":17}
/// ```
#[derive(Debug)]
pub struct JsonSink {
    worker: Worker<Job>,
    backlog: Backlog<Job, Key>,
    /// When contacts are written, if they are.
    contacts: Option<PeriodicSender>,
    /// Whether no frames come, so that nobody else says that nobody is there.
    lost: bool,
    cracks: CrackRateLimiter,
}

#[derive(Debug)]
enum Job {
    Event(WidgetEvent),
    Link(Instant, LinkState),
    Page(PageShown),
    Crack(CrackNews),
    Health(Instant, SensorHealth),
    Device(Instant, DeviceStatus),
    Muted(Instant, Muted),
    Held(HeldReport),
    Gap(Gap),
    Control(Instant, Box<ControlState>),
    Contacts(Instant, Vec<Contact>),
}

impl From<Gap> for Job {
    fn from(gap: Gap) -> Self {
        Self::Gap(gap)
    }
}

/// What one line has to have in common with another to take its place.
#[derive(Clone, Debug, PartialEq)]
enum Key {
    Event(WidgetId, &'static str),
    Link,
    Page,
    Health,
    Device,
    Muted,
    Held,
    Control(WidgetId),
    Contacts,
}

impl Job {
    /// When it happened, and how much it matters to a reader that has been away.
    fn worth(&self) -> (Instant, Worth<Key>) {
        match self {
            Self::Event(event) => {
                let key = Key::Event(event.id.clone(), event.kind.name());
                let worth = match event.kind {
                    EventKind::Changed(_) | EventKind::Ticked => Worth::Latest(key),
                    _ => Worth::Each(key),
                };
                (event.at, worth)
            }
            Self::Link(at, _) => (*at, Worth::Latest(Key::Link)),
            Self::Page(shown) => (shown.at, Worth::Latest(Key::Page)),
            Self::Crack(news) => (news.at, Worth::None),
            Self::Health(at, _) => (*at, Worth::Latest(Key::Health)),
            Self::Device(at, _) => (*at, Worth::Latest(Key::Device)),
            Self::Muted(at, _) => (*at, Worth::Latest(Key::Muted)),
            Self::Held(report) => (report.at, Worth::Latest(Key::Held)),
            Self::Gap(gap) => (gap.at, Worth::None),
            Self::Control(at, state) => (*at, Worth::Latest(Key::Control(state.id.clone()))),
            Self::Contacts(at, _) => (*at, Worth::Latest(Key::Contacts)),
        }
    }
}

/// How long the end of the program waits for a reader that has stopped to take what has waited for it.
const LAST_WAIT: Duration = Duration::from_secs(2);

impl JsonSink {
    /// A sink that writes to `out`, which lives on a thread of its own from
    /// now on. Lines are flushed as soon as no other waits. Once `out` fails,
    /// what follows is dropped and counted.
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system gives no thread.
    pub fn new(out: impl Write + Send + 'static) -> Result<Self, SinkError> {
        let failed = |source| SinkError::Output { message: format!("cannot write events: {source}"), source };
        let worker = Worker::spawn("json out", move |jobs| {
            if let Err(error) = write_all(jobs, out) {
                tracing::warn!("events are no longer written: {error}");
            }
        })
        .map_err(failed)?;
        Ok(Self {
            worker,
            backlog: Backlog::default(),
            contacts: None,
            lost: true,
            cracks: CrackRateLimiter::default(),
        })
    }

    /// Writes contacts as well: 100 times a second while there are any, once a second while there are none.
    #[must_use]
    pub fn with_contacts(mut self) -> Self {
        self.contacts = Some(PeriodicSender::default());
        self
    }

    fn put(&mut self, job: Job) {
        self.flush();
        let waits = if self.backlog.is_empty() { self.worker.hand(job) } else { Some(job) };
        if let Some(job) = waits {
            let (at, worth) = job.worth();
            self.backlog.push(at, job, worth);
        }
    }

    /// Hands on what has waited, as far as there is room.
    fn flush(&mut self) {
        if !self.backlog.is_empty() {
            self.backlog.flush(|job| self.worker.hand(job));
        }
    }
}

impl Drop for JsonSink {
    fn drop(&mut self) {
        let end = HostInstant::now() + LAST_WAIT;
        self.flush();
        while !self.backlog.is_empty() && HostInstant::now() < end {
            std::thread::sleep(Duration::from_millis(1));
            self.flush();
        }
    }
}

impl EventSink for JsonSink {
    fn events(&mut self, events: &[WidgetEvent]) {
        for event in events {
            self.put(Job::Event(event.clone()));
        }
    }

    fn contacts(&mut self, at: Instant, contacts: &[Contact]) {
        self.flush();
        if let Some(periodic) = self.contacts.as_mut().filter(|periodic| periodic.is_due(at, contacts)) {
            periodic.reported(at, contacts);
            self.put(Job::Contacts(at, contacts.to_vec()));
        }
    }

    fn page(&mut self, page: &PageShown) {
        self.put(Job::Page(page.clone()));
    }

    fn ground(&mut self, events: &[GroundEvent]) {
        for event in events {
            if let Some(news) = self.cracks.news(event) {
                self.put(Job::Crack(news));
            }
        }
    }

    fn link(&mut self, at: Instant, state: LinkState) {
        self.lost = matches!(state, LinkState::Lost | LinkState::Waiting);
        self.put(Job::Link(at, state));
    }

    fn health(&mut self, at: Instant, health: &SensorHealth) {
        self.put(Job::Health(at, health.clone()));
    }

    fn device(&mut self, at: Instant, status: &DeviceStatus) {
        self.put(Job::Device(at, status.clone()));
    }

    fn muted(&mut self, at: Instant, muted: &Muted) {
        self.put(Job::Muted(at, muted.clone()));
    }

    fn control(&mut self, at: Instant, state: &ControlState) {
        self.put(Job::Control(at, Box::new(state.clone())));
    }

    fn poll(&mut self, now: Instant) {
        self.flush();
        let due = self.contacts.as_mut().filter(|periodic| self.lost && periodic.is_silence_due(now));
        if let Some(periodic) = due {
            periodic.reported(now, &[]);
            self.put(Job::Contacts(now, Vec::new()));
        }
    }

    fn held(&mut self, report: &HeldReport) {
        self.put(Job::Held(report.clone()));
    }

    fn dropped(&self) -> u64 {
        self.worker.dropped() + self.backlog.dropped()
    }
}

fn write_all(jobs: &Receiver<Job>, mut out: impl Write) -> io::Result<()> {
    while let Ok(mut job) = jobs.recv() {
        loop {
            write_line(&job, &mut out)?;
            match jobs.try_recv() {
                Ok(next) => job = next,
                Err(_) => break,
            }
        }
        out.flush()?;
    }
    Ok(())
}

fn write_line(job: &Job, out: &mut impl Write) -> io::Result<()> {
    let mut line = serde_json::to_vec(&Line::of(job))?;
    line.push(b'\n');
    out.write_all(&line)
}
