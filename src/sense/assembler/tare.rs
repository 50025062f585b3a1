//! Measurement of the tare while the floor is empty and quiet.

use std::time::Duration;

use crate::floor::{Floor, SensorId};
use crate::sense::scatter::Scatter;
use crate::units::Newtons;

/// Source of the tare, the force on the empty floor, which is subtracted from every reading.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Tare {
    /// From the floor's description.
    #[default]
    FromFloor,
    /// Measured on each board's first samples, while the floor is empty.
    AtStart(TareRules),
}

impl Tare {
    /// The suitable choice for this floor: its own tare if it has one, otherwise one measured at the start.
    #[must_use]
    pub fn suited_to(floor: &Floor) -> Self {
        let has_one = floor.tare.iter().flatten().any(|&tare| tare != Newtons::ZERO);
        if has_one { Self::FromFloor } else { Self::AtStart(TareRules::default()) }
    }
}

/// Conditions under which a floor is empty and quiet enough to measure its tare.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TareRules {
    /// Averaging time.
    pub span: Duration,
    /// Standard deviation of a sensor during the average above which a person moves on the floor.
    pub quiet: Newtons,
    /// Mean of a sensor above which the floor is loaded: more than the weight of plate and actuator.
    pub most: Newtons,
    /// Time-out after which the floor's own tare is used.
    pub patience: Duration,
}

impl Default for TareRules {
    /// Half a second, 0.5 N, 60 N, five seconds (our choice): the built-in sensor's own noise is near 0.02 N; a
    /// person standing still sways by several newtons and puts about 90 N on a corner.
    fn default() -> Self {
        Self {
            span: Duration::from_millis(500),
            quiet: Newtons(0.5),
            most: Newtons(60.0),
            patience: Duration::from_secs(5),
        }
    }
}

/// Result of the tare.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TareOutcome {
    /// The floor's own tare is in use, as requested.
    FromFloor,
    /// The measurement is running; the floor must stay empty.
    Measuring,
    /// The tare has been measured.
    Taken,
    /// The floor was never quiet; its own tare is in use.
    Refused {
        /// The worst sensor.
        sensor: SensorId,
        /// Mean of its readings.
        mean: Newtons,
        /// Standard deviation of its readings.
        deviation: Newtons,
    },
}

/// Result of a tare meter.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum TareResult {
    /// Mean of each channel; `None` for a channel without a good reading.
    Quiet(Vec<Option<f32>>),
    /// The floor was never quiet.
    Noisy {
        /// The worst channel.
        channel: usize,
        /// Mean of its readings.
        mean: Newtons,
        /// Standard deviation of its readings.
        deviation: Newtons,
    },
}

/// Measures the tare of one board.
#[derive(Clone, Debug)]
pub(super) struct TareMeter {
    rules: TareRules,
    /// Time of the first sample.
    begun_ns: Option<i64>,
    /// Start of the present average.
    span_began_ns: Option<i64>,
    channels: Vec<Scatter>,
}

impl TareMeter {
    pub(super) fn new(channels: usize, rules: TareRules) -> Self {
        Self { rules, begun_ns: None, span_began_ns: None, channels: vec![Scatter::default(); channels] }
    }

    /// Restarts the average after a gap in the stream; the time-out continues.
    pub(super) fn interrupt(&mut self) {
        self.span_began_ns = None;
        self.channels.fill(Scatter::default());
    }

    /// Adds one sample of all channels, NaN for a bad reading or an unused channel.
    pub(super) fn add(&mut self, at_ns: i64, forces: impl Iterator<Item = f32>) -> Option<TareResult> {
        let begun = *self.begun_ns.get_or_insert(at_ns);
        let span_began = *self.span_began_ns.get_or_insert(at_ns);
        for (scatter, force) in self.channels.iter_mut().zip(forces) {
            if force.is_finite() {
                scatter.add(f64::from(force));
            }
        }
        if passed(span_began, at_ns) < self.rules.span {
            return None;
        }
        let found = match self.worst() {
            Some((channel, scatter)) => TareResult::Noisy {
                channel,
                mean: Newtons(scatter.mean() as f32),
                deviation: Newtons(scatter.deviation() as f32),
            },
            None => TareResult::Quiet(self.means()),
        };
        self.interrupt();
        let give_up = passed(begun, at_ns) >= self.rules.patience;
        (give_up || matches!(found, TareResult::Quiet(_))).then_some(found)
    }

    /// The channel furthest beyond the limits; `None` if all are within.
    fn worst(&self) -> Option<(usize, Scatter)> {
        let excess = |readings: &Scatter| {
            let scatter = readings.deviation() / f64::from(self.rules.quiet.0);
            let load = readings.mean() / f64::from(self.rules.most.0);
            scatter.max(load)
        };
        let worst = self.channels.iter().enumerate().max_by(|a, b| excess(a.1).total_cmp(&excess(b.1)))?;
        // A limit of NaN rejects the tare.
        let keeps_to_them = excess(worst.1) <= 1.0;
        (!keeps_to_them).then_some((worst.0, *worst.1))
    }

    fn means(&self) -> Vec<Option<f32>> {
        self.channels.iter().map(|scatter| (scatter.count() > 0).then_some(scatter.mean() as f32)).collect()
    }
}

fn passed(since_ns: i64, now_ns: i64) -> Duration {
    Duration::from_nanos(now_ns.saturating_sub(since_ns).max(0).cast_unsigned())
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    fn measure(forces: impl Fn(i64) -> [f32; 2]) -> (i64, TareResult) {
        let mut meter = TareMeter::new(2, TareRules::default());
        (0..).find_map(|ms| Some((ms, meter.add(ms * MS, forces(ms).into_iter())?))).unwrap()
    }

    #[test]
    fn a_quiet_floor_is_averaged_for_half_a_second() {
        let (ms, found) = measure(|ms| [12.0 + if ms % 2 == 0 { 0.1 } else { -0.1 }, f32::NAN]);
        assert_eq!(ms, 500);
        let TareResult::Quiet(means) = found else { panic!("{found:?}") };
        assert!((means[0].unwrap() - 12.0).abs() < 0.01);
        assert_eq!(means[1], None);
    }

    #[test]
    fn somebody_who_leaves_in_time_only_delays_it() {
        let (ms, found) = measure(|ms| [if ms < 1200 { (ms % 100) as f32 } else { 8.0 }, 5.0]);
        assert!((1700..2300).contains(&ms), "{ms}");
        assert_eq!(found, TareResult::Quiet(vec![Some(8.0), Some(5.0)]));
    }

    #[test]
    fn somebody_who_stays_is_named_by_the_sensor_under_the_foot() {
        let (ms, found) = measure(|ms| [4.0, 90.0 + (ms % 10) as f32]);
        assert!((5000..5600).contains(&ms), "{ms}");
        assert!(matches!(found, TareResult::Noisy { channel: 1, .. }), "{found:?}");
    }

    #[test]
    fn something_heavy_and_still_is_no_empty_floor() {
        assert!(matches!(measure(|_| [4.0, 90.0]).1, TareResult::Noisy { channel: 1, .. }));
    }

    #[test]
    fn floors_with_a_tare_keep_it() {
        let mut floor = Floor::default();
        assert!(matches!(Tare::suited_to(&floor), Tare::AtStart(_)));
        floor.tare[7][2] = Newtons(3.0);
        assert_eq!(Tare::suited_to(&floor), Tare::FromFloor);
    }
}
