//! A node's source in slow motion, so that more nodes than a machine can run can be measured on it: each millisecond
//! of the floor takes several of the machine.

use std::sync::Arc;
use std::time::Duration;

use underfoot::source::{SensorSource, SourceError};
use underfoot::units::{HostClock, Instant};
use underfoot::wire::{LinkCounters, SensorPacket};

/// A source on a clock that runs `times` slower than the machine's.
pub(super) struct SlowedSource {
    inner: Box<dyn SensorSource>,
    times: u32,
}

/// `clock`, `times` slower.
pub(super) fn slowed(clock: HostClock, times: u32) -> HostClock {
    Arc::new(move || slow(clock(), times))
}

/// The time `at` on a clock that runs `times` slower.
pub(super) fn slow(at: Instant, times: u32) -> Instant {
    Instant::from_micros(at.micros() / u64::from(times.max(1)))
}

impl SlowedSource {
    pub(super) fn new(inner: Box<dyn SensorSource>, times: u32) -> Self {
        Self { inner, times }
    }
}

impl SensorSource for SlowedSource {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        let next = self.inner.next(patience * self.times)?;
        Ok(next.map(|packet| SensorPacket { received: slow(packet.received, self.times), ..packet }))
    }

    fn now(&self) -> Instant {
        slow(self.inner.now(), self.times)
    }

    fn counters(&self) -> LinkCounters {
        self.inner.counters()
    }
}
