use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use crate::feel::Onset;
use crate::units::{HostClock, Instant};

/// Buckets per doubling of the latency: a quantile is at most 0.8 % off.
const FINENESS: u64 = 128;

/// Longest latency told apart: 67 seconds.
const LONGEST_US: u64 = (1 << 26) - 1;

const BUCKETS: usize = bucket(LONGEST_US) + 1;

/// Gathers latencies from any thread and tells their quantiles; clones share what they gather.
///
/// # Real-time
/// Recording adds one to a counter: no allocation, no lock.
#[derive(Clone)]
pub struct LatencyMeter {
    buckets: Arc<[AtomicU64]>,
}

impl LatencyMeter {
    /// A meter that has seen nothing.
    #[must_use]
    pub fn new() -> Self {
        Self { buckets: (0..BUCKETS).map(|_| AtomicU64::new(0)).collect() }
    }

    /// Takes one latency; longer ones than 67 s count as 67 s.
    pub fn record(&self, latency: Duration) {
        let micros = u64::try_from(latency.as_micros()).unwrap_or(u64::MAX).min(LONGEST_US);
        if let Some(counter) = self.buckets.get(bucket(micros)) {
            counter.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// What was recorded so far; `None` if nothing was.
    #[must_use]
    pub fn summary(&self) -> Option<LatencySummary> {
        let counts: Vec<u64> = self.buckets.iter().map(|bucket| bucket.load(Ordering::Relaxed)).collect();
        let count = counts.iter().sum();
        if count == 0 {
            return None;
        }
        let quantile = |share: f64| {
            let rank = ((count as f64 * share).ceil() as u64).clamp(1, count);
            let mut seen = 0;
            let index = counts.iter().position(|in_bucket| {
                seen += in_bucket;
                seen >= rank
            });
            Duration::from_micros(bucket_middle(index.unwrap_or(0)))
        };
        Some(LatencySummary {
            count,
            p5: quantile(0.05),
            median: quantile(0.5),
            p95: quantile(0.95),
            p99: quantile(0.99),
            max: quantile(1.0),
        })
    }
}

impl Default for LatencyMeter {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Debug for LatencyMeter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("LatencyMeter").field(&self.summary()).finish()
    }
}

/// The distribution of the latencies that a [`LatencyMeter`] has gathered; exact to 0.8 %.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatencySummary {
    /// How many there were, at least 1.
    pub count: u64,
    /// 5 % were at most this long.
    pub p5: Duration,
    /// Half were at most this long.
    pub median: Duration,
    /// 95 % were at most this long.
    pub p95: Duration,
    /// 99 % were at most this long.
    pub p99: Duration,
    /// The longest.
    pub max: Duration,
}

impl fmt::Display for LatencySummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ms = |span: Duration| span.as_secs_f64() * 1e3;
        write!(
            f,
            "median {:.2} ms, 99th percentile {:.2} ms, longest {:.2} ms of {} cues",
            ms(self.median),
            ms(self.p99),
            ms(self.max),
            self.count
        )
    }
}

/// Measures how long packets take until the first sample they caused is handed on.
#[derive(Clone)]
pub struct LatencyProbe {
    meter: LatencyMeter,
    clock: HostClock,
}

impl LatencyProbe {
    /// A probe that fills `meter`; `clock` is the one that stamped the packets' arrival.
    #[must_use]
    pub fn new(meter: LatencyMeter, clock: HostClock) -> Self {
        Self { meter, clock }
    }

    /// The time on the probe's clock.
    #[must_use]
    pub fn now(&self) -> Instant {
        (self.clock)()
    }

    /// Notes that the block with these onsets is handed on now.
    ///
    /// # Real-time
    /// Reads the clock once, and only if there is an onset.
    pub fn handed_on(&self, onsets: &[Onset]) {
        if onsets.is_empty() {
            return;
        }
        let now = self.now();
        for onset in onsets {
            self.meter.record(now.since(onset.received));
        }
    }
}

impl fmt::Debug for LatencyProbe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LatencyProbe").field("meter", &self.meter).finish_non_exhaustive()
    }
}

/// The bucket of a latency: one per microsecond at first, then [`FINENESS`] per doubling.
const fn bucket(micros: u64) -> usize {
    if micros < FINENESS {
        return micros as usize;
    }
    let octave = (micros / FINENESS).ilog2() as u64;
    (FINENESS * (octave + 1) + (micros >> octave) - FINENESS) as usize
}

/// The middle of the latencies that fall into a bucket, in microseconds.
const fn bucket_middle(index: usize) -> u64 {
    let index = index as u64;
    if index < FINENESS {
        return index;
    }
    let octave = index / FINENESS - 1;
    let low = (index % FINENESS + FINENESS) << octave;
    low + (1 << octave) / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_latency_falls_near_the_middle_of_its_bucket() {
        for micros in (0..2000).chain([4567, 99_999, 1_234_567, LONGEST_US]) {
            let middle = bucket_middle(bucket(micros));
            assert!(middle.abs_diff(micros) <= micros / 128, "{micros}: {middle}");
        }
    }

    #[test]
    fn quantiles_of_a_known_distribution() {
        let meter = LatencyMeter::new();
        assert_eq!(meter.summary(), None);
        let clone = meter.clone();
        for micros in 1..=1000 {
            clone.record(Duration::from_micros(micros));
        }
        clone.record(Duration::from_secs(1000));
        let summary = meter.summary().unwrap();
        assert_eq!(summary.count, 1001);
        let near = |got: Duration, wanted: f64| (got.as_secs_f64() / wanted - 1.0).abs() < 0.01;
        assert!(near(summary.median, 501e-6) && near(summary.p99, 991e-6), "{summary:?}");
        assert!(
            near(summary.p5, 51e-6) && near(summary.p95, 951e-6) && near(summary.max, 67.1),
            "{summary:?}"
        );
        assert_eq!(summary.to_string().split(',').next(), Some("median 0.50 ms"));
    }

    #[test]
    fn a_probe_measures_from_arrival_to_hand_over() {
        let meter = LatencyMeter::new();
        let probe = LatencyProbe::new(meter.clone(), Arc::new(|| Instant::from_micros(5090)));
        probe.handed_on(&[Onset { frame: 0, received: Instant::from_millis(5) }]);
        assert_eq!(meter.summary().map(|summary| summary.median), Some(Duration::from_micros(90)));
    }
}
