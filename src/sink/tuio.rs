//! Contacts as TUIO over UDP.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::SystemTime;

use rosc::OscTime;

use super::periodic::{Latest, PeriodicSender};
use super::udp::UdpOut;
use super::worker::Worker;
use super::{EventSink, Report, SinkError, WaitFreeReceiver};
use crate::floor::Geometry;
use crate::outgoing::{Tuio1, Tuio2, TuioProfiles, tuio_first_frame};
use crate::sense::Contact;
use crate::units::Instant;
use crate::wire::LinkState;

/// Number of goodbyes, since one datagram may be lost.
const GOODBYES: usize = 2;

/// The TUIO version.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TuioVersion {
    /// TUIO 1.1: cursors and blobs, each in bundles of its own.
    One(TuioProfiles),
    /// TUIO 2.0: pointers with pressure.
    Two,
}

/// Sends the contacts as TUIO over UDP.
///
/// The latest contacts go out 100 times a second while there are any, and once a second while there are none. When
/// the sink ends, and when the floor is lost, it reports an empty floor: clients have no time-out of their own. TUIO
/// carries no control events.
#[derive(Debug)]
pub struct TuioSink {
    worker: Worker<Job>,
    latest: Arc<Latest>,
    undelivered: Arc<AtomicU64>,
    periodic: PeriodicSender,
    /// Whether no frames come, so that the sink itself must report an empty floor.
    lost: bool,
}

#[derive(Debug)]
enum Job {
    /// Send the contacts that are the latest when the job runs.
    Contacts,
    /// The floor counts as empty.
    Lost(Instant),
}

impl TuioSink {
    /// A sink that sends the contacts on a floor of this `geometry` to `target`.
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system gives no socket or no thread.
    pub fn new(target: SocketAddr, geometry: &Geometry, version: TuioVersion) -> Result<Self, SinkError> {
        let out = UdpOut::new(target, "TUIO")?;
        let undelivered = out.undelivered();
        let latest = Arc::new(Latest::default());
        let speaker = Speaker::new(version, geometry, &out.own_name());
        let worker = Worker::spawn("tuio out", {
            let latest = latest.clone();
            move |jobs| run(jobs, &latest, speaker, &out)
        })
        .map_err(|source| SinkError::Output {
            message: format!("cannot send TUIO to {target}: {source}"),
            source,
        })?;
        Ok(Self { worker, latest, undelivered, periodic: PeriodicSender::default(), lost: true })
    }
}

impl EventSink for TuioSink {
    fn report(&mut self, report: &Report<'_>) {
        match *report {
            Report::Contacts(at, ref contacts) => {
                let queue = || self.worker.try_offer(Job::Contacts);
                if self.periodic.is_due(at, contacts) && self.latest.store(at, contacts, queue) {
                    self.periodic.reported(at, contacts);
                }
            }
            Report::Link(at, state) => {
                self.lost = matches!(state, LinkState::Lost | LinkState::Waiting);
                if state == LinkState::Lost {
                    self.worker.offer(Job::Lost(at));
                    self.periodic.reported(at, &[]);
                }
            }
            _ => {}
        }
    }

    fn poll(&mut self, now: Instant) {
        if self.lost && self.periodic.is_silence_due(now) {
            self.worker.offer(Job::Lost(now));
            self.periodic.reported(now, &[]);
        }
    }

    fn dropped(&self) -> u64 {
        self.worker.dropped() + self.undelivered.load(Ordering::Relaxed)
    }
}

/// Sends until the jobs end, then says goodbye.
fn run(jobs: &mut WaitFreeReceiver<Job>, latest: &Latest, mut speaker: Speaker, out: &UdpOut) {
    let mut now = Instant::START;
    for job in jobs.iter() {
        match job {
            Job::Contacts => {
                let (at, contacts) = latest.fetch();
                now = at;
                speaker.say(at, &contacts, out);
            }
            Job::Lost(at) => {
                now = at;
                speaker.say(at, &[], out);
            }
        }
    }
    for _ in 0..GOODBYES {
        speaker.say(now, &[], out);
    }
}

/// An encoder of either version.
enum Speaker {
    One(Tuio1),
    Two(Tuio2),
}

impl Speaker {
    fn new(version: TuioVersion, geometry: &Geometry, host: &str) -> Self {
        let first = tuio_first_frame(clock());
        match version {
            TuioVersion::One(profiles) => {
                let tuio = Tuio1::new(geometry, &format!("underfoot@{host}"), first);
                Self::One(tuio.with_profiles(profiles))
            }
            TuioVersion::Two => Self::Two(Tuio2::new(geometry, &format!("underfoot:0@{host}"), first)),
        }
    }

    fn say(&mut self, at: Instant, contacts: &[Contact], out: &UdpOut) {
        let send = |datagram: &[u8]| out.send(datagram);
        let left_out = match self {
            Self::One(tuio) => tuio.write(at, contacts, send),
            Self::Two(tuio) => tuio.write(at, clock(), contacts, send),
        };
        out.count(left_out);
    }
}

/// Returns the wall clock, which is only sent and never used for a decision. Before 1900 it returns "at once".
fn clock() -> OscTime {
    OscTime::try_from(SystemTime::now()).unwrap_or(OscTime { seconds: 0, fractional: 1 })
}
