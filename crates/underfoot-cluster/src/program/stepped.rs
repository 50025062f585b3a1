//! A node's source with a clock that can be set while it runs, as an operator or a time server sets a computer's.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use underfoot::source::{SensorSource, SourceError};
use underfoot::units::{HostClock, Instant};
use underfoot::wire::{LinkCounters, SensorPacket};

use super::ClusterFailure;

/// Size of one step.
const STEP: Duration = Duration::from_secs(1);

/// Interval between two checks for the signal.
const LOOK_EVERY: Duration = Duration::from_millis(1);

/// The steps of a clock so far, in microseconds.
#[derive(Clone, Default)]
pub(super) struct Steps(Arc<AtomicU64>);

impl Steps {
    /// Adds one step at each SIGUSR1; an error on systems without that signal.
    pub(super) fn by_signal() -> Result<Self, ClusterFailure> {
        let (asked, steps_us) = (Arc::new(AtomicBool::new(false)), Arc::<AtomicU64>::default());
        register(&asked)?;
        let steps = Arc::clone(&steps_us);
        thread::spawn(move || {
            loop {
                if asked.swap(false, Ordering::Relaxed) {
                    steps.fetch_add(STEP.as_micros() as u64, Ordering::Relaxed);
                }
                thread::sleep(LOOK_EVERY);
            }
        });
        Ok(Self(steps_us))
    }

    /// `clock` with these steps.
    pub(super) fn clock(&self, clock: HostClock) -> HostClock {
        let steps = self.clone();
        Arc::new(move || clock() + steps.so_far())
    }

    fn so_far(&self) -> Duration {
        Duration::from_micros(self.0.load(Ordering::Relaxed))
    }
}

#[cfg(unix)]
fn register(asked: &Arc<AtomicBool>) -> Result<(), ClusterFailure> {
    signal_hook::flag::register(signal_hook::consts::SIGUSR1, Arc::clone(asked))
        .map(drop)
        .map_err(|error| ClusterFailure::Other(format!("signals can't be handled: {error}")))
}

#[cfg(not(unix))]
fn register(_: &Arc<AtomicBool>) -> Result<(), ClusterFailure> {
    Err(ClusterFailure::Other("this system has no signal that steps the clock".into()))
}

/// A source on a clock with steps.
pub(super) struct SteppedSource {
    inner: Box<dyn SensorSource>,
    steps: Steps,
}

impl SteppedSource {
    pub(super) fn new(inner: Box<dyn SensorSource>, steps: Steps) -> Self {
        Self { inner, steps }
    }
}

impl SensorSource for SteppedSource {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        let next = self.inner.next(patience)?;
        let later = self.steps.so_far();
        Ok(next.map(|packet| SensorPacket { received: packet.received + later, ..packet }))
    }

    fn now(&self) -> Instant {
        self.inner.now() + self.steps.so_far()
    }

    fn counters(&self) -> LinkCounters {
        self.inner.counters()
    }
}
