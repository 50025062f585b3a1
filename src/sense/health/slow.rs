//! The sensors of one tile, averaged over 64 ms: what changes too slowly for a single frame to show.

use super::averages::Readings;
use super::drift::Drift;
use super::trouble::{Sensor, Trouble};
use super::{End, plate};
use crate::sense::corners::{Told, has_lifted};
use crate::units::Instant;

/// Longest time between blocks that says something of change, in seconds; after a gap everything starts afresh.
pub(super) const GAP_S: f32 = 0.5;

/// For how long a sensor must stand still while its plate demands otherwise to be stuck, in seconds: half a step.
const STUCK_S: f32 = 0.3;

/// How long a load over one sensor goes unanswered, while nobody is near, until it is none on plates that may be
/// limp, in seconds: whoever stands sways, and stands on more than a point.
const LONE_S: f32 = 1.0;

/// A sensor is still if its averages stay within this much and this share of its reading:
/// its converter's noise (2 mV are 0.3 % of the force) with room to spare.
const STILL_N: f32 = 1.0;
const STILL_SHARE: f32 = 0.02;

/// How much farther than its averages the readings of a still sensor may reach, noise and hum included.
const STIRRED: f32 = 10.0;

/// How much a load must change at a corner, besides what the plate estimate may err, to expect it to move.
const CHANGE_N: f32 = 10.0;

/// How far a sensor in trouble may be from what its plate demands to be right again, in newtons.
const RIGHT_N: f32 = 3.0;

/// From which sum on a tile counts as loaded for its neighbours' sake, in newtons.
const LOADED_N: f32 = 6.0;

/// What follows from the blocks of one tile so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slow {
    ended: Option<Instant>,
    tracks: [Track; 4],
    /// For how long one sensor alone has read a load.
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
    pub(super) ends: [End; 4],
    /// Since the block before.
    pub(super) seconds: f32,
}

impl Block {
    /// Whether the tile counts as loaded for its neighbours' sake.
    pub(super) fn is_loaded(&self) -> bool {
        self.means.iter().sum::<f32>().abs() > LOADED_N
    }
}

/// A sensor's and its neighbours' extremes since the sensor last moved.
#[derive(Clone, Copy, Debug, Default)]
struct Track {
    begun: bool,
    own: (f32, f32),
    expected: (f32, f32),
    /// The largest load on the other corners.
    load: f32,
    /// Seconds since it should have moved.
    overdue: f32,
}

impl Slow {
    /// The block that is complete; `None` if it has gaps, after which nothing earlier counts either.
    pub(super) fn finish(&mut self, readings: Option<Readings>, at: Instant) -> Option<Block> {
        let seconds = self.ended.replace(at).map(|ended| at.since(ended).as_secs_f32());
        let seconds = seconds.filter(|&seconds| seconds <= GAP_S);
        let Some((seconds, Readings { means, lows, spreads, ends })) = seconds.zip(readings) else {
            self.tracks = Default::default();
            self.drift.interrupt();
            return None;
        };
        Some(Block { means, lows, spreads, ends, seconds })
    }

    /// Finds stuck sensors, on plates whose twist lies in this range, and gives those in trouble the chance to be found
    /// right again; `alone` says that no tile around carries anything.
    ///
    /// A plate that tipped or a sensor that was beyond its range at any time of a block leaves a mean that
    /// says nothing: after a stamp it is neither the load nor its absence.
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
                // No telling what it should read, but on an empty tile.
                let empty = others.iter().all(|&other| out[other] || means[other].abs() <= RIGHT_N);
                let is_right = empty && own.abs() <= RIGHT_N && !ends[corner].is_odd();
                sensor.review(own, is_right, alone, block.seconds);
                continue;
            }
            let lifted = has_lifted(block.lows[corner]) && sensor.trouble().is_none();
            let evidence = plate::evidence(block.lows, ends, corner);
            if lifted || evidence == Told::Nothing {
                // Neither evidence for it nor against it.
                continue;
            }
            let expected = plate::demanded(means, corner, twist).max(0.0);
            let slack = RIGHT_N + plate::SLACK * load;
            // A limp plate would leave it alone with its load, too: that is not proof that the load is there.
            let is_lone = plate::unanswered(means, [false; 4]) == Some(corner);
            let is_right =
                !is_lone && own >= expected - slack && (own <= expected + slack || evidence == Told::AtLeast);
            match sensor.trouble() {
                None | Some(Trouble::Drifted | Trouble::Noisy) => {}
                Some(_) if is_right && !sensor.shows(slack) => {}
                Some(_) => sensor.review(own, is_right && !ends[corner].is_odd(), alone, block.seconds),
            }
            // A reading at the end of the range stands still rightly under a heavy foot, and what a suspect load
            // demands of the others is not evidence.
            if ends[corner] == End::High || sensor.is_out() || others.iter().any(|&other| suspect[other]) {
                self.tracks[corner] = Track::default();
            } else {
                // With its diagonal in the air, it may rightly read more than is expected.
                let demands = (expected, if evidence == Told::AtLeast { f32::INFINITY } else { expected });
                if self.tracks[corner].follow(own, block.spreads[corner], demands, load, block.seconds) {
                    sensor.find(Trouble::Stuck, own);
                }
            }
        }
    }
}

impl Track {
    /// Adds a block, in which its plate demanded the least and the most that are given; true if the sensor is stuck.
    fn follow(&mut self, own: f32, spread: f32, (least, most): (f32, f32), load: f32, seconds: f32) -> bool {
        let widened = |range: (f32, f32), value: f32| (range.0.min(value), range.1.max(value));
        let reach = widened(self.own, own);
        let still = STILL_N + STILL_SHARE * own.abs();
        // Also what moved and came back within the block did not stand still.
        if !self.begun || reach.1 - reach.0 > still || spread > STIRRED * still {
            let here = |value: f32| (value, value);
            *self = Self { begun: true, own: here(own), expected: here(least), load, overdue: 0.0 };
            return false;
        }
        self.own = reach;
        self.expected = widened(self.expected, least);
        self.load = self.load.max(load);
        let slack = CHANGE_N + plate::SLACK * self.load;
        // It is not only that it should have moved some time: it reads wrongly now.
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
        // As of somebody who steps off a tile over its edge: in half a second the demand falls from 130 to 72 N.
        let is_stuck = |most: fn(f32) -> f32| {
            let mut track = Track::default();
            let mut demands = (0..8_u8).map(|block| (130.0 - 12.0 * f32::from(block)).max(72.0));
            demands.any(|least| track.follow(164.5, 1.0, (least, most(least)), 90.0, 0.064))
        };
        assert!(is_stuck(|least| least));
        assert!(!is_stuck(|_| f32::INFINITY));
    }
}
