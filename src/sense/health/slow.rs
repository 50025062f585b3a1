//! The sensors of one tile, averaged over 64 ms: changes too slow to show in a single frame.

use super::averages::BlockReadings;
use super::drift::Drift;
use super::trouble::{Sensor, Trouble};
use super::{RangeEnd, plate};
use crate::sense::centroid::corners::{KnownCorner, has_lifted};
use crate::units::Instant;

/// Maximum time between blocks for a comparison (s); after a longer gap everything restarts.
pub(super) const GAP_S: f32 = 0.5;

/// Time for which a sensor must be still although its plate requires otherwise to be stuck (s): half a step.
const STUCK_S: f32 = 0.3;

/// Time for which a load over one sensor may have no response, with no other load near, on plates that may be limp
/// (s): a standing person sways, and stands on more than a point.
const LONE_S: f32 = 1.0;

/// A sensor is still if its averages stay within this force and this share of its reading: its converter's noise (2
/// mV are 0.3 % of the force) with ample margin.
const STILL_N: f32 = 1.0;
const STILL_SHARE: f32 = 0.02;

/// Ratio of the maximum range of a still sensor's readings to that of its averages, including noise and hum.
const STIRRED: f32 = 10.0;

/// Change of the required load of a corner, besides the plate estimate's error, that a working sensor must follow
/// (N).
const CHANGE_N: f32 = 10.0;

/// Maximum distance of a faulty sensor from the plate's requirement to count as right again (N).
const RIGHT_N: f32 = 3.0;

/// Sum above which a tile counts as loaded for its neighbours' sake (N).
const LOADED_N: f32 = 6.0;

/// The state of one tile from its blocks so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slow {
    ended: Option<Instant>,
    tracks: [Track; 4],
    /// Time for which one sensor alone has read a load (s).
    lone_s: f32,
    pub(super) drift: Drift,
}

/// The averages of one block.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Block {
    pub(super) means: [f32; 4],
    /// Lowest reading.
    pub(super) lows: [f32; 4],
    /// Highest less lowest reading.
    pub(super) spreads: [f32; 4],
    pub(super) ends: [RangeEnd; 4],
    /// Time since the block before (s).
    pub(super) seconds: f32,
}

impl Block {
    /// Whether the tile counts as loaded for its neighbours' sake.
    pub(super) fn is_loaded(&self) -> bool {
        self.means.iter().sum::<f32>().abs() > LOADED_N
    }
}

/// Extremes of a sensor and of its neighbours since the sensor last moved.
#[derive(Clone, Copy, Debug, Default)]
struct Track {
    begun: bool,
    own: (f32, f32),
    expected: (f32, f32),
    /// Largest load on the other corners.
    load: f32,
    /// Time since it should have moved (s).
    overdue: f32,
}

impl Slow {
    /// The complete block; `None` if it has gaps, after which earlier blocks do not count either.
    pub(super) fn finish(&mut self, readings: Option<BlockReadings>, at: Instant) -> Option<Block> {
        let seconds = self.ended.replace(at).map(|ended| at.since(ended).as_secs_f32());
        let seconds = seconds.filter(|&seconds| seconds <= GAP_S);
        let Some((seconds, BlockReadings { means, lows, spreads, ends })) = seconds.zip(readings) else {
            self.tracks = Default::default();
            self.drift.interrupt();
            return None;
        };
        Some(Block { means, lows, spreads, ends, seconds })
    }

    /// Finds stuck sensors, on plates with a twist in this range, and reviews faulty ones; `alone` means that no tile
    /// around carries a load.
    ///
    /// If a plate tipped or a sensor was beyond its range at any time of a block, the mean is meaningless: after a
    /// stamp it is neither the load nor its absence.
    pub(super) fn judge(&mut self, block: &Block, alone: bool, twist: (f32, f32), sensors: &mut [Sensor; 4]) {
        let out = sensors.map(|sensor| sensor.is_out());
        let (means, ends) = (block.means, block.ends);
        match plate::unanswered(means, out).filter(|_| alone) {
            None => self.lone_s = 0.0,
            Some(corner) => {
                self.lone_s += block.seconds;
                if self.lone_s > LONE_S {
                    sensors[corner].find(Trouble::Offset, means[corner]);
                }
            }
        }
        let suspect = sensors.map(|sensor| sensor.trouble() == Some(Trouble::Offset));
        for corner in 0..4 {
            let others = [corner ^ 1, corner ^ 2, corner ^ 3];
            let load: f32 = others.iter().map(|&other| means[other].abs()).sum();
            let (sensor, own) = (&mut sensors[corner], means[corner]);
            if others.iter().any(|&other| out[other]) {
                self.tracks[corner] = Track::default();
                // The required reading is unknown, except on an empty tile.
                let empty = others.iter().all(|&other| out[other] || means[other].abs() <= RIGHT_N);
                let is_right = empty && own.abs() <= RIGHT_N && !ends[corner].is_odd();
                sensor.review(own, is_right, alone, block.seconds);
                continue;
            }
            let lifted = has_lifted(block.lows[corner]) && sensor.trouble().is_none();
            let evidence = plate::evidence(block.lows, ends, corner);
            if lifted || evidence == KnownCorner::Nothing {
                // No evidence in either direction.
                continue;
            }
            let expected = plate::demanded(means, corner, twist).max(0.0);
            let slack = RIGHT_N + plate::SLACK * load;
            // A limp plate would also leave the load on this sensor alone: that does not prove the load.
            let is_lone = plate::unanswered(means, [false; 4]) == Some(corner);
            let is_right = !is_lone
                && own >= expected - slack
                && (own <= expected + slack || evidence == KnownCorner::AtLeast);
            match sensor.trouble() {
                None | Some(Trouble::Drifted | Trouble::Noisy) => {}
                Some(_) if is_right && !sensor.shows(slack) => {}
                Some(_) => sensor.review(own, is_right && !ends[corner].is_odd(), alone, block.seconds),
            }
            // A reading at the end of the range is rightly constant under a heavy foot, and a suspect load is no
            // basis for the requirement of the others.
            if ends[corner] == RangeEnd::High || sensor.is_out() || others.iter().any(|&other| suspect[other])
            {
                self.tracks[corner] = Track::default();
            } else {
                // With its diagonal in the air, it may rightly read more than the expected value.
                let demands =
                    (expected, if evidence == KnownCorner::AtLeast { f32::INFINITY } else { expected });
                if self.tracks[corner].follow(own, block.spreads[corner], demands, load, block.seconds) {
                    sensor.find(Trouble::Stuck, own);
                }
            }
        }
    }
}

impl Track {
    /// Adds a block with the least and the greatest reading that its plate allows; returns true if the sensor is
    /// stuck.
    fn follow(&mut self, own: f32, spread: f32, (least, most): (f32, f32), load: f32, seconds: f32) -> bool {
        let widened = |range: (f32, f32), value: f32| (range.0.min(value), range.1.max(value));
        let reach = widened(self.own, own);
        let still = STILL_N + STILL_SHARE * own.abs();
        // A reading that moved and returned within the block was not still.
        if !self.begun || reach.1 - reach.0 > still || spread > STIRRED * still {
            let here = |value: f32| (value, value);
            *self = Self { begun: true, own: here(own), expected: here(least), load, overdue: 0.0 };
            return false;
        }
        self.own = reach;
        self.expected = widened(self.expected, least);
        self.load = self.load.max(load);
        let slack = CHANGE_N + plate::SLACK * self.load;
        // The sensor has not only failed to move before: its present reading is wrong.
        let amiss = (least - own).max(own - most);
        if self.expected.1 - self.expected.0 > slack && amiss > 0.5 * slack {
            self.overdue += seconds;
        }
        self.overdue >= STUCK_S
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_that_bears_more_with_its_diagonal_in_the_air_is_not_stuck() {
        // As for a person who steps off a tile over its edge: in half a second the requirement falls from 130 to 72
        // N.
        let is_stuck = |most: fn(f32) -> f32| {
            let mut track = Track::default();
            let mut demands = (0..8_u8).map(|block| (130.0 - 12.0 * f32::from(block)).max(72.0));
            demands.any(|least| track.follow(164.5, 1.0, (least, most(least)), 90.0, 0.064))
        };
        assert!(is_stuck(|least| least));
        assert!(!is_stuck(|_| f32::INFINITY));
    }
}
