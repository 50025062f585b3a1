//! Events as JSON lines.

mod line;
#[cfg(test)]
mod tests;

use std::borrow::Cow;
use std::io::{self, Write};
use std::mem::{Discriminant, discriminant};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant as HostInstant};

use super::backlog::{Backlog, Gap, Worth};
use super::crack_rate::CrackRateLimiter;
use super::periodic::PeriodicSender;
use super::worker::Worker;
use super::{EventSink, Report, SinkError, WaitFreeReceiver};
use crate::units::Instant;
use crate::widget::{EventKind, WidgetId};
use crate::wire::LinkState;

/// Writes one JSON object per event and line.
///
/// ```json
/// {"t_s":1.234,"event":"changed","id":"zoom","value":0.5,"force_n":120.5,"x_m":0.61,"y_m":1.2,"contact":3}
/// {"t_s":2.345,"event":"ignored","id":"zoom","reason":"too_light","why":"too light","force_n":12.5,"contact":4}
/// {"t_s":9.876,"event":"link","state":"lost"}
/// {"t_s":9.9,"event":"link_cause","cause":"rate_low","board":0,"why":"board 0 sends 12 packets a second: 20 at least are needed for presses in time"}
/// {"t_s":9.9,"event":"page","page":"settings"}
/// {"t_s":9.9,"event":"health","live":143,"degraded":0,"stale":0,"faulty":1,"uncalibrated":0,"foreign":false,"troubles":[{"col":2,"row":1,"corner":"sw","trouble":"stuck"}]}
/// {"t_s":9.9,"event":"device","device":"Card","state":"lost","why":"unplugged","channels":36,"sample_rate":96000,"block":64,"underruns":0,"reopened":0,"priority":"real-time"}
/// {"t_s":9.9,"event":"mute","all":false,"tiles":[[2,1]]}
/// {"t_s":9.9,"held":["zoom"],"sequence":12}
/// {"t_s":9.9,"event":"state","id":"zoom","value":0.5,"range":[0.0,1.0],"step":null,"options":null,"enabled":true,"off":null,"off_text":null,"locked":false,"pressed":false,"armed":false,"indicator":"off","label":"Zoom","page":null}
/// {"t_s":9.9,"event":"area","area":"west","state":"lost","why":"nothing new from its node for 100 ms","uncertainty_s":0.0}
/// {"t_s":9.9,"event":"crack","seed":3,"energy_j":0.4,"x_m":0.61,"y_m":1.2,"skipped":0}
/// ```
///
/// `value` is a number (for a choice its index, from 0), true or false, two numbers in a list, the direction of a
/// swipe, or null for events without a value; `contact` is null if no foot caused the event. A number that JSON
/// cannot express (the engine never produces one) is null. The held controls are written 50 times a second while
/// there are any, and once when the last one ends. Contacts are written on request ([`JsonSink::with_contacts`]):
///
/// ```json
/// {"t_s":9.9,"event":"contacts","contacts":[{"id":3,"x_m":0.61,"y_m":1.2,"force_n":350.0,"x_velocity_m_s":0.0,"y_velocity_m_s":0.0}]}
/// ```
///
/// A slow reader delays nothing else. Beyond a thousand lines only the latest value and state of each kind wait for
/// it, and everything that begins or ends a press; a gap line gives the number of lines dropped in its place:
/// ```json
/// {"t_s":9.9,"event":"gap","dropped":17}
/// ```
#[derive(Debug)]
pub struct JsonSink {
    worker: Worker<Job>,
    /// Count of lines that `out` did not accept.
    unwritten: Arc<AtomicU64>,
    backlog: Backlog<Job, Key>,
    /// Times of the contact lines, if contacts are written.
    contacts: Option<PeriodicSender>,
    /// Whether no frames come, so that the sink itself must report an empty floor.
    lost: bool,
    cracks: CrackRateLimiter,
    waits: bool,
}

#[derive(Debug)]
enum Job {
    Report(Report<'static>),
    Gap(Gap),
}

impl From<Gap> for Job {
    fn from(gap: Gap) -> Self {
        Self::Gap(gap)
    }
}

/// Lines with the same key may replace each other.
#[derive(Clone, Debug, PartialEq)]
enum Key {
    Event(WidgetId, &'static str),
    Control(WidgetId),
    Message(usize, WidgetId),
    Area(String),
    /// Every other kind of report has only one state.
    State(Discriminant<Report<'static>>),
}

/// Returns the importance of a report for a slow reader.
fn worth(report: &Report<'static>) -> Worth<Key> {
    match report {
        Report::Event(event) => {
            let key = Key::Event(event.id.clone(), event.kind.name());
            match event.kind {
                EventKind::Changed(_) | EventKind::Ticked => Worth::Latest(key),
                _ => Worth::Each(key),
            }
        }
        Report::Message(news) => {
            let key = Key::Message(news.order.target, news.order.control.clone());
            if news.is_replaceable() { Worth::Latest(key) } else { Worth::Each(key) }
        }
        Report::Ignored(_) | Report::Ground(_) | Report::Crack(_) | Report::Alive(..) => Worth::None,
        Report::Control(_, state) => Worth::Latest(Key::Control(state.id.clone())),
        Report::Area(news) => Worth::Latest(Key::Area(news.area.clone())),
        Report::Contacts(..)
        | Report::Page(_)
        | Report::Link(..)
        | Report::LinkCause(..)
        | Report::Health(..)
        | Report::Device(..)
        | Report::Held(_)
        | Report::Muted(..) => Worth::Latest(Key::State(discriminant(report))),
    }
}

/// Maximum wait for a slow reader to read the waiting lines at the end of the program.
const LAST_WAIT: Duration = Duration::from_secs(2);

impl JsonSink {
    /// A sink that writes to `out` on a thread of its own. It flushes lines as soon as no other line waits. If `out`
    /// rejects a line, the line is dropped and counted; the first failure is logged, and the next line is tried
    /// again.
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system gives no thread.
    pub fn new(out: impl Write + Send + 'static) -> Result<Self, SinkError> {
        let failed = |source| SinkError::Output { message: format!("cannot write events: {source}"), source };
        let unwritten = Arc::<AtomicU64>::default();
        let counter = Arc::clone(&unwritten);
        let worker = Worker::spawn("json out", move |jobs| write_all(jobs, out, &counter)).map_err(failed)?;
        Ok(Self {
            worker,
            unwritten,
            backlog: Backlog::default(),
            contacts: None,
            lost: true,
            cracks: CrackRateLimiter::default(),
            waits: false,
        })
    }

    /// Writes contacts as well: 100 times a second while there are any, once a second while there are none.
    #[must_use]
    pub fn with_contacts(mut self) -> Self {
        self.contacts = Some(PeriodicSender::default());
        self
    }

    /// Blocks the reporting thread for at most two seconds each time before a line is dropped: for floors that are
    /// not live.
    #[must_use]
    pub fn waiting(mut self) -> Self {
        self.waits = true;
        self
    }

    fn put(&mut self, report: Report<'static>) {
        self.flush();
        if self.waits {
            self.wait();
        }
        let job = Job::Report(report);
        let waits = if self.backlog.is_empty() { self.worker.hand(job) } else { Some(job) };
        if let Some(Job::Report(report)) = waits {
            let (at, worth) = (report.at(), worth(&report));
            self.backlog.push(at, Job::Report(report), worth);
        }
    }

    /// Waits until the reader has read the waiting lines.
    fn wait(&mut self) {
        let end = HostInstant::now() + LAST_WAIT;
        while !self.backlog.is_empty() && HostInstant::now() < end {
            std::thread::sleep(Duration::from_millis(1));
            self.flush();
        }
    }

    /// Passes waiting lines on as far as there is room.
    fn flush(&mut self) {
        if !self.backlog.is_empty() {
            self.backlog.flush(|job| self.worker.hand(job));
        }
    }
}

impl Drop for JsonSink {
    fn drop(&mut self) {
        self.flush();
        self.wait();
    }
}

impl EventSink for JsonSink {
    fn report(&mut self, report: &Report<'_>) {
        match *report {
            Report::Alive(..) => return,
            Report::Contacts(at, ref contacts) => {
                self.flush();
                match self.contacts.as_mut().filter(|periodic| periodic.is_due(at, contacts)) {
                    Some(periodic) => periodic.reported(at, contacts),
                    None => return,
                }
            }
            Report::Link(_, state) => self.lost = matches!(state, LinkState::Lost | LinkState::Waiting),
            _ => {}
        }
        if let Some(report) = report.limited(&mut self.cracks) {
            self.put(report);
        }
    }

    fn poll(&mut self, now: Instant) {
        self.flush();
        let due = self.contacts.as_mut().filter(|periodic| self.lost && periodic.is_silence_due(now));
        if let Some(periodic) = due {
            periodic.reported(now, &[]);
            self.put(Report::Contacts(now, Cow::Borrowed(&[])));
        }
    }

    fn dropped(&self) -> u64 {
        self.worker.dropped() + self.backlog.dropped() + self.unwritten.load(Ordering::Relaxed)
    }
}

fn write_all(jobs: &mut WaitFreeReceiver<Job>, mut out: impl Write, unwritten: &AtomicU64) {
    let (mut is_told, mut is_torn) = (false, false);
    while let Ok(mut job) = jobs.recv() {
        loop {
            // A fragment of the last line on a full disk must not run into this one.
            let ended = if is_torn { out.write_all(b"\n") } else { Ok(()) };
            let mut written = ended.and_then(|()| write_line(&job, &mut out));
            let next = jobs.try_recv();
            if next.is_none() {
                written = written.and_then(|()| out.flush());
            }
            is_torn = written.is_err();
            if let Err(error) = written {
                unwritten.fetch_add(1, Ordering::Relaxed);
                if !std::mem::replace(&mut is_told, true) {
                    tracing::warn!("events are not written: {error}; each one is tried again");
                }
            }
            match next {
                Some(next) => job = next,
                None => break,
            }
        }
    }
}

fn write_line(job: &Job, out: &mut impl Write) -> io::Result<()> {
    let Some(line) = line::line(job) else { return Ok(()) };
    let mut line = serde_json::to_vec(&line)?;
    line.push(b'\n');
    out.write_all(&line)
}
