//! The sensors of one tile, averaged over 64 ms: changes too slow to show in a single frame.

use super::averages::BlockReadings;
use super::drift::Drift;
use super::stuck::{Demands, Extremes, STILL_N};
use super::trouble::{Sensor, Trouble};
use super::{RangeEnd, plate};
use crate::sense::centroid::corners::{KnownCorner, has_lifted};
use crate::units::Instant;

/// Maximum time between blocks for a comparison (s); after a longer gap everything restarts.
pub(super) const GAP_S: f32 = 0.5;

/// Time for which a load over one sensor may have no response, with no other load near, on plates that may be limp
/// (s): a standing person sways, and stands on more than a point.
const LONE_S: f32 = 1.0;

/// Share of the load that a corner has lost to which the other corners of its plate respond at least if it has lifted:
/// its diagonal then bears as much (our choice, with a margin for creep).
const OF_LIFTED: f32 = 0.5;

/// Maximum distance of a faulty sensor from the plate's requirement to count as right again (N).
const RIGHT_N: f32 = 3.0;

/// Sum above which a tile counts as loaded for its neighbours' sake (N).
const LOADED_N: f32 = 6.0;

/// The state of one tile from its blocks so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slow {
    ended: Option<Instant>,
    extremes: [Extremes; 4],
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

    /// Whether this sensor has carried no current throughout, and less than on the empty floor, although no other
    /// corner bears what a lifted one would have lost.
    fn is_open_at(&self, corner: usize) -> bool {
        let lost = -self.means[corner];
        let responds = |other: usize| self.means[other].abs() > OF_LIFTED * lost;
        self.ends[corner] == RangeEnd::Low
            && has_lifted(-lost)
            && self.spreads[corner] < STILL_N
            && ![corner ^ 1, corner ^ 2, corner ^ 3].into_iter().any(responds)
    }
}

impl Slow {
    /// The complete block; `None` if it has gaps, after which earlier blocks do not count either.
    pub(super) fn finish(&mut self, readings: Option<BlockReadings>, at: Instant) -> Option<Block> {
        let seconds = self.ended.replace(at).map(|ended| at.since(ended).as_secs_f32());
        let seconds = seconds.filter(|&seconds| seconds <= GAP_S);
        let Some((seconds, BlockReadings { means, lows, spreads, ends })) = seconds.zip(readings) else {
            self.extremes = Default::default();
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
        let mut overdue = [false; 4];
        for corner in 0..4 {
            let others = [corner ^ 1, corner ^ 2, corner ^ 3];
            let load: f32 = others.iter().map(|&other| means[other].abs()).sum();
            let (sensor, own) = (&mut sensors[corner], means[corner]);
            if block.is_open_at(corner) {
                sensor.find(Trouble::Open, own);
            }
            if others.iter().any(|&other| out[other]) {
                self.extremes[corner] = Extremes::default();
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
                self.extremes[corner] = Extremes::default();
            } else {
                // With its diagonal in the air, it may rightly read more than the expected value.
                let most = if evidence == KnownCorner::AtLeast { f32::INFINITY } else { expected };
                let neighbours = [means[corner ^ 1], means[corner ^ 2]];
                let demands = Demands { least: expected, most, neighbours, load };
                overdue[corner] =
                    self.extremes[corner].follow(own, block.spreads[corner], demands, block.seconds);
            }
        }
        // One stuck sensor makes the readings of the others wrong too. Those that have not moved either, since they
        // bear little, look alike until they move.
        let mut late = (0..4).filter(|&corner| overdue[corner]);
        if let (Some(corner), None) = (late.next(), late.next()) {
            sensors[corner].find(Trouble::Stuck, means[corner]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIGID: (f32, f32) = (0.0, 0.1);

    /// The troubles of four sensors that read `rest`, and then for a second `fallen`, at these ends of their ranges.
    fn found(
        rest: [f32; 4],
        fallen: [f32; 4],
        ends: [RangeEnd; 4],
        twist: (f32, f32),
    ) -> [Option<Trouble>; 4] {
        let (mut slow, mut sensors) = (Slow::default(), [Sensor::default(); 4]);
        let block = |means, ends| Block { means, lows: means, spreads: [0.5; 4], ends, seconds: 0.064 };
        let mut judge = |block: &Block| slow.judge(block, true, twist, &mut sensors);
        (0..5).for_each(|_| judge(&block(rest, [RangeEnd::Within; 4])));
        (0..16).for_each(|_| judge(&block(fallen, ends)));
        sensors.map(|sensor| sensor.trouble())
    }

    #[test]
    fn a_sensor_that_goes_dead_on_an_empty_tile_is_found_and_its_diagonal_is_not_accused() {
        // Each corner bears 14 N of the plate; creep has left a newton or two on the others.
        let rest = [0.0, 1.5, -1.0, 2.0];
        let fallen = [-14.0, 1.5, -1.0, 2.0];
        let low = [RangeEnd::Low, RangeEnd::Within, RangeEnd::Within, RangeEnd::Within];
        assert_eq!(found(rest, fallen, low, RIGID), [Some(Trouble::Open), None, None, None]);
        // The same fall within the range: a plug with a bad contact. Which of the diagonal is wrong is open.
        let [own, .., across] = found(rest, fallen, [RangeEnd::Within; 4], RIGID);
        assert_eq!(across, None, "it has not moved, and neither have its neighbours");
        assert_ne!(own, Some(Trouble::Stuck));
    }

    #[test]
    fn a_corner_that_a_foot_on_the_opposite_one_lifts_is_not_open() {
        let low = [RangeEnd::Low, RangeEnd::Within, RangeEnd::Within, RangeEnd::Within];
        assert_eq!(found([0.0; 4], [-14.0, 3.0, 3.0, 60.0], low, RIGID), [None; 4]);
    }

    #[test]
    fn a_sensor_that_does_not_follow_a_load_that_moves_its_neighbours_is_stuck() {
        let within = [RangeEnd::Within; 4];
        let [own, others @ ..] = found([0.0; 4], [0.0, 60.0, 70.0, 65.0], within, RIGID);
        assert_eq!((own, others), (Some(Trouble::Stuck), [None; 3]));
    }

    #[test]
    fn of_two_sensors_that_have_not_moved_neither_is_accused() {
        // A foot over sw of a plate that bends. On a less limp one se and nw would bear 40 N each, and both have stayed
        // where they were.
        let within = [RangeEnd::Within; 4];
        assert_eq!(found([0.0, 1.4, 0.7, 0.0], [114.0, 1.7, 0.7, 5.6], within, (0.4, 0.7)), [None; 4]);
    }
}
