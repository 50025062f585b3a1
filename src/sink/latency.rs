//! Histograms of latency, filled from any thread.

#![deny(clippy::disallowed_macros, clippy::disallowed_methods, clippy::disallowed_types)]

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use crate::feel::Onset;
use crate::units::{HostClock, Instant};

/// Buckets per doubling of the latency: the error of a quantile is at most 0.1 %.
const FINENESS: u64 = 1024;

/// Maximum latency with its own bucket, in microseconds: 67 seconds.
const LONGEST_US: u64 = (1 << 26) - 1;

const BUCKETS: usize = bucket(LONGEST_US) + 1;

/// Collects latencies from any thread and gives their quantiles; clones share their counts.
///
/// # Real-time
/// Recording adds one to a counter: no allocation, no lock.
#[derive(Clone)]
pub struct LatencyMeter {
    buckets: Arc<[AtomicU64]>,
}

impl LatencyMeter {
    /// A meter without any latencies yet.
    #[must_use]
    pub fn new() -> Self {
        Self { buckets: (0..BUCKETS).map(|_| AtomicU64::new(0)).collect() }
    }

    /// Records one latency; longer ones than 67 s count as 67 s.
    pub fn record(&self, latency: Duration) {
        let micros = u64::try_from(latency.as_micros()).unwrap_or(u64::MAX).min(LONGEST_US);
        if let Some(counter) = self.buckets.get(bucket(micros)) {
            counter.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Returns the buckets with at least one latency, shortest first.
    pub fn buckets(&self) -> impl Iterator<Item = Bucket> + '_ {
        self.buckets.iter().enumerate().filter_map(|(index, count)| {
            let count = count.load(Ordering::Relaxed);
            let (from, to) = (bucket_low(index), bucket_low(index + 1));
            (count > 0).then(|| Bucket {
                from: Duration::from_micros(from),
                to: Duration::from_micros(to),
                count,
            })
        })
    }

    /// Returns the distribution so far; `None` if nothing was recorded.
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

/// Latencies within the bounds of one bucket.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bucket {
    /// Lower bound, inclusive.
    pub from: Duration,
    /// Upper bound, exclusive.
    pub to: Duration,
    /// Number of latencies, at least 1.
    pub count: u64,
}

/// The distribution of the latencies in a [`LatencyMeter`]; exact to 0.1 %.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatencySummary {
    /// Number of latencies, at least 1.
    pub count: u64,
    /// 5 % are at most this long.
    pub p5: Duration,
    /// Half are at most this long.
    pub median: Duration,
    /// 95 % are at most this long.
    pub p95: Duration,
    /// 99 % are at most this long.
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

/// The latency from packet to actuator, stage by stage; clones share their counts.
#[derive(Clone, Debug, Default)]
pub struct LatencyStages {
    /// From the packet's arrival, as stamped by the system, until the sensing thread takes it.
    pub link: LatencyMeter,
    /// From there until the sensing thread sends its cue to the renderer.
    pub engine: LatencyMeter,
    /// From there until the device's callback returns its first sample.
    pub audio: LatencyMeter,
    /// All of these: from the packet to the callback.
    pub whole: LatencyMeter,
    /// From the packet until the first sample sounds, by the device's own account.
    pub sounding: LatencyMeter,
}

/// Time at which the samples of a block sound; unknown by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HandedOn {
    /// Time at which the block's first sample sounds, if the device reports it.
    pub sounds: Option<Instant>,
    /// The block's samples per second.
    pub sample_rate: u32,
}

/// Measures the time from a packet to the output of its first sample.
#[derive(Clone)]
pub struct LatencyProbe {
    stages: LatencyStages,
    clock: HostClock,
}

impl LatencyProbe {
    /// A probe that fills `meter`; `clock` must be the one that stamps the arrival of packets.
    #[must_use]
    pub fn new(meter: LatencyMeter, clock: HostClock) -> Self {
        Self::of_stages(LatencyStages { whole: meter, ..LatencyStages::default() }, clock)
    }

    /// A probe that fills those of `stages` that end with the device; `clock` must be the one that stamps the arrival
    /// of packets.
    #[must_use]
    pub fn of_stages(stages: LatencyStages, clock: HostClock) -> Self {
        Self { stages, clock }
    }

    /// The time on the probe's clock.
    #[must_use]
    pub fn now(&self) -> Instant {
        (self.clock)()
    }

    /// Records that the block with these onsets is output now.
    ///
    /// # Real-time
    /// Reads the clock once, and only if there is an onset.
    pub fn handed_on(&self, onsets: &[Onset], block: HandedOn) {
        if onsets.is_empty() {
            return;
        }
        let now = self.now();
        for onset in onsets {
            self.stages.audio.record(now.since(onset.sent));
            self.stages.whole.record(now.since(onset.received));
            if let Some(sounds) = block.sounds {
                let into = onset.frame as f64 / f64::from(block.sample_rate.max(1));
                let sounds = sounds + Duration::from_secs_f64(into);
                self.stages.sounding.record(sounds.since(onset.received));
            }
        }
    }
}

impl fmt::Debug for LatencyProbe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LatencyProbe").field("stages", &self.stages).finish_non_exhaustive()
    }
}

/// Returns the bucket of a latency: one per microsecond at first, then [`FINENESS`] per doubling.
const fn bucket(micros: u64) -> usize {
    if micros < FINENESS {
        return micros as usize;
    }
    let octave = (micros / FINENESS).ilog2() as u64;
    (FINENESS * (octave + 1) + (micros >> octave) - FINENESS) as usize
}

/// Returns the lower bound of a bucket, in microseconds.
const fn bucket_low(index: usize) -> u64 {
    let index = index as u64;
    if index < FINENESS {
        return index;
    }
    (index % FINENESS + FINENESS) << (index / FINENESS - 1)
}

/// Returns the middle of a bucket, in microseconds.
const fn bucket_middle(index: usize) -> u64 {
    let low = bucket_low(index);
    low + (bucket_low(index + 1) - low) / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_latency_falls_near_the_middle_of_its_bucket() {
        for micros in (0..5000).chain([4567, 99_999, 1_234_567, LONGEST_US]) {
            let middle = bucket_middle(bucket(micros));
            assert!(middle.abs_diff(micros) <= micros / 1024, "{micros}: {middle}");
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
        let (received, sent) = (Instant::from_millis(5), Instant::from_micros(5050));
        let block = HandedOn { sounds: Some(Instant::from_millis(6)), sample_rate: 48_000 };
        probe.handed_on(&[Onset { frame: 48, received, sent }], block);
        let median = |meter: &LatencyMeter| meter.summary().map(|summary| summary.median.as_micros());
        assert_eq!((median(&meter), median(&probe.stages.audio)), (Some(90), Some(40)));
        // The first sample of the click is the block's 49th: 1 ms later.
        let sounding = median(&probe.stages.sounding).unwrap();
        assert!(sounding.abs_diff(2000) <= 16, "{sounding}");
    }

    #[test]
    fn buckets_hold_everything_between_their_bounds() {
        let meter = LatencyMeter::new();
        [3, 3, 130, 50_000].into_iter().for_each(|micros| meter.record(Duration::from_micros(micros)));
        let buckets: Vec<_> = meter.buckets().collect();
        assert_eq!(buckets.iter().map(|bucket| bucket.count).collect::<Vec<_>>(), [2, 1, 1]);
        assert_eq!((buckets[0].from, buckets[0].to), (Duration::from_micros(3), Duration::from_micros(4)));
        assert!(buckets[2].from <= Duration::from_millis(50) && Duration::from_millis(50) < buckets[2].to);
    }
}
