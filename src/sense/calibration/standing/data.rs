//! The measurements of a calibration by standing.

use std::collections::{BTreeMap, BTreeSet};

use super::marks::StandingMark;
use crate::floor::{Calibration, SensorId, TileId};

/// Everything that was measured: the empty floor, and a person on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StandData {
    /// The sensors and their outputs on the empty floor. Other lists refer to positions in this one.
    pub empty: Vec<SensorVolts>,
    /// Moments at which the person stood still on a mark.
    pub stands: Vec<MeasuredStand>,
    /// Ways of the person from one stand to the next, entirely on the floor.
    pub crossings: Vec<Crossing>,
}

/// The mean output of one sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorVolts {
    /// The sensor.
    pub sensor: SensorId,
    /// Its output in volts.
    pub volts: f32,
}

/// A person who stands still on a mark.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredStand {
    /// The mark.
    pub mark: StandingMark,
    /// The sensors that carry a load: position in [`StandData::empty`], and mean output in volts.
    pub loaded: Vec<(usize, f32)>,
}

/// A way over the floor, from standing still to standing still: the mean of the force over its time is the weight,
/// because the body has no speed at either end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Crossing {
    /// For each sensor that carried a load, by position in [`StandData::empty`], its output over time.
    pub loaded: BTreeMap<usize, SensorMoments>,
    /// Number of moments in all.
    pub moments: u32,
}

/// How often a sensor had an output, in steps of [`SensorMoments::STEP_V`]: enough for the mean of any law over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorMoments(BTreeMap<i32, u32>);

impl SensorMoments {
    /// Width of a step (V). Within half of it, the force of the steepest usual part changes by 3 %, up and down alike.
    pub const STEP_V: f32 = 0.02;

    /// Adds a moment with this output in volts; ignores one that is not a number.
    pub fn add(&mut self, volts: f32) {
        if volts.is_finite() {
            // The cast saturates at outputs that no converter has.
            *self.0.entry((volts / Self::STEP_V).round() as i32).or_default() += 1;
        }
    }

    /// Returns the outputs in volts, with the number of moments of each.
    pub fn outputs(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.0.iter().map(|(step, count)| (f64::from(*step) * f64::from(Self::STEP_V), f64::from(*count)))
    }
}

impl Crossing {
    /// Adds a moment: the outputs of all sensors that carry a load.
    pub fn add(&mut self, loaded: impl IntoIterator<Item = (usize, f32)>) {
        self.moments = self.moments.saturating_add(1);
        for (sensor, volts) in loaded {
            self.loaded.entry(sensor).or_default().add(volts);
        }
    }
}

impl MeasuredStand {
    /// Returns the number of sensors at the end of their converter's range, where the output is a lower bound.
    #[must_use]
    pub fn saturated(&self) -> usize {
        self.loaded.iter().filter(|(_, volts)| is_saturated(*volts)).count()
    }
}

impl StandData {
    /// The same measurements with only those sensors that carried a load, or that lie under a tile with a stand.
    pub(super) fn compact(&self) -> Self {
        let stood = |tile: TileId| self.stands.iter().any(|stand| stand.mark.tile == tile);
        let mut wanted: Vec<bool> = self.empty.iter().map(|rest| stood(rest.sensor.tile)).collect();
        let in_stands = self.stands.iter().flat_map(|stand| stand.loaded.iter().map(|(sensor, _)| *sensor));
        let in_crossings = self.crossings.iter().flat_map(|crossing| crossing.loaded.keys().copied());
        for sensor in in_stands.chain(in_crossings) {
            if let Some(wanted) = wanted.get_mut(sensor) {
                *wanted = true;
            }
        }
        let mut count = 0;
        let places: Vec<Option<usize>> = wanted
            .iter()
            .map(|wanted| {
                count += usize::from(*wanted);
                wanted.then(|| count - 1)
            })
            .collect();
        let place = |sensor: usize| places.get(sensor).copied().flatten();
        let kept = self.empty.iter().zip(&wanted).filter(|(_, wanted)| **wanted);
        let stand = |stand: &MeasuredStand| MeasuredStand {
            mark: stand.mark,
            loaded: stand
                .loaded
                .iter()
                .filter_map(|(sensor, volts)| Some((place(*sensor)?, *volts)))
                .collect(),
        };
        let crossing = |crossing: &Crossing| Crossing {
            loaded: crossing
                .loaded
                .iter()
                .filter_map(|(sensor, moments)| Some((place(*sensor)?, moments.clone())))
                .collect(),
            moments: crossing.moments,
        };
        Self {
            empty: kept.map(|(rest, _)| *rest).collect(),
            stands: self.stands.iter().map(stand).collect(),
            crossings: self.crossings.iter().map(crossing).collect(),
        }
    }
}

impl StandData {
    /// For each sensor, whether it carried a load in none of the stands on its tile: it is broken, or the plate does
    /// not touch it, and its force is unknown.
    pub(super) fn silent(&self) -> Vec<bool> {
        let stood: BTreeSet<TileId> = self.stands.iter().map(|stand| stand.mark.tile).collect();
        let mut silent: Vec<bool> = self.empty.iter().map(|rest| stood.contains(&rest.sensor.tile)).collect();
        for (sensor, _) in self.stands.iter().flat_map(|stand| &stand.loaded) {
            if let Some(silent) = silent.get_mut(*sensor) {
                *silent = false;
            }
        }
        silent
    }
}

/// Whether an output in volts is at the end of the converter's range.
#[must_use]
pub(super) fn is_saturated(volts: f32) -> bool {
    volts >= Calibration::volts(Calibration::SATURATED)
}
