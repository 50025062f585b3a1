//! The readings that a plate on four supports allows.
//!
//! On a rigid plate the sum of one diagonal equals that of the other. A flexible one, such as 12 mm of plywood on
//! soft feet, twists: a load off both middle lines presses the corners of its own diagonal harder. The flexibility of
//! the floor's plates is learnt from the feet on them, starting with rigid plates: on a limp one a single corner may
//! carry all of the load, so that no reading of a single sensor could indicate a fault.
//!
//! Corners are numbered as in [`crate::sense::centroid::corners`].

use super::RangeEnd;
use crate::sense::centroid::corners::{self, KnownCorner, expected, told};

/// Minimum reading of a single sensor (N) for the others to respond (our choice).
const ALONE_N: f32 = 8.0;

/// Minimum response of the others, as a share of the lone load, with its lower and upper bounds (N).
///
/// A load right over a sensor puts a third of that sensor's reading on each of its neighbours, until the plate lifts
/// off diagonally, where its own weight (6 N per corner and more) then is missing.
const ANSWER: f32 = 0.1;
const LEAST_ANSWER_N: f32 = 1.0;
const MOST_ANSWER_N: f32 = 3.0;

/// Maximum error of the rigid-plate estimate of a corner, as a share of the tile's load: unequal supports (a tenth)
/// and gains (a twentieth), three deviations (our choice).
pub(super) const SLACK: f32 = 0.15;

/// The same for a verdict from a single frame, without confirmation by a later one.
const AT_ONCE_SLACK: f32 = 0.3;

/// Twist of the plate by a foot across a tile's diagonal beyond that of its centre of pressure, as a share of its
/// force: a print of 0.25 m at 45 degrees causes 0.14, and [`SLACK`] covers the rest (by geometry).
const ACROSS: f32 = 0.06;

/// Minimum load of a tile that shows the bending of its plate (N), and maximum weight of evidence: about two hundred
/// steps.
const BENDS_N: f32 = 80.0;
const MOST_WEIGHT: f32 = 300.0;

/// Maximum difference of a tile's diagonals beyond the range of plates, as a share of its load, that enters the
/// estimate: a dead sensor under the middle of a foot makes a third.
const FAULT: f32 = 0.2;

/// Standard deviation of the twist from one block of evidence of weight 1, where blocks of one step are alike: the
/// range covers twice that (by simulated walks on plates from rigid to limp).
const BLOCK_DEVIATION: f32 = 0.3;

/// Prior weight of evidence of rigid plates: high enough that no allowed plate (twist of 0.6 at most) puts a load on
/// one sensor alone, low enough that the first step or two outweigh it (our choice).
const RIGID_WEIGHT: f32 = 1.0;

/// Twist above which the neighbours may hardly measure a load over one sensor: they carry `(1 - twist) / 4` of it,
/// and of one on the plate's very corner `(1 - 1.3 twist) / 4` (on simulated floors of 0.45 one sensor was falsely
/// reported in an hour, of 0.2 none).
const LIMP: f32 = 0.3;

/// Flexibility of a floor's plates under twist: 0 for rigid ones, 1 for plates without stiffness of their own.
///
/// # Source
/// Plate on four equal springs: `f_sw - f_se - f_nw + f_ne = twist * sum(F x y) / reach^2`, by least squares.
#[derive(Clone, Copy, Debug)]
pub(super) struct Twist {
    seen: f32,
    weight: f32,
}

impl Default for Twist {
    fn default() -> Self {
        Self { seen: 0.0, weight: RIGID_WEIGHT }
    }
}

impl Twist {
    /// Lower and upper bound of the twist.
    pub(super) fn range(&self) -> (f32, f32) {
        let (middle, unsure) = (self.seen / self.weight, 2.0 * BLOCK_DEVIATION / self.weight.sqrt());
        ((middle - unsure).clamp(0.0, 1.0), (middle + unsure).clamp(0.0, 1.0))
    }

    /// Whether plates may be so limp that the other sensors do not respond to a load over one sensor.
    pub(super) fn may_be_limp(&self) -> bool {
        self.range().1 > LIMP
    }

    /// Updates the estimate with the mean readings of a loaded tile's sensors, none of them lifted or at the end of
    /// its range.
    ///
    /// A load on one sensor alone is either a limp plate or a sensor fault and does not enter.
    pub(super) fn learn(&mut self, forces: [f32; 4]) {
        if unanswered(forces, [false; 4]).is_some() {
            return;
        }
        let Some((diagonal, place, whole)) = diagonal(forces).filter(|&(_, _, whole)| whole > BENDS_N) else {
            return;
        };
        // A value beyond the range of all plates is a sensor fault.
        let wrong = diagonal - diagonal.clamp(place.min(0.0), place.max(0.0));
        if wrong.abs() > FAULT * whole {
            return;
        }
        let (diagonal, place) = (diagonal / whole, place / whole);
        self.seen += diagonal * place;
        self.weight += place * place;
        if self.weight > MOST_WEIGHT {
            self.seen *= MOST_WEIGHT / self.weight;
            self.weight = MOST_WEIGHT;
        }
    }
}

/// Difference between the two diagonals of a tile, the difference that its centre of pressure would cause on a limp
/// plate, and the whole load (N); `None` without load, or for readings so absurd that they add up to no number.
fn diagonal([sw, se, nw, ne]: [f32; 4]) -> Option<(f32, f32, f32)> {
    let whole = sw + se + nw + ne;
    let place = (se + ne - sw - nw) * (nw + ne - sw - se) / whole;
    let diagonal = sw - se - nw + ne;
    (whole > 1.0 && place.is_finite() && diagonal.is_finite()).then_some((diagonal, place, whole))
}

/// The allowed value nearest to `diagonal` for a plate with a twist between `low` and `high`; the heading of a foot
/// twists only plates that are known to bend.
fn lawful(diagonal: f32, place: f32, whole: f32, (low, high): (f32, f32)) -> f32 {
    let across = low * ACROSS * whole;
    let (one, other) = (low * place, high * place);
    diagonal.clamp(one.min(other) - across, one.max(other) + across)
}

/// Required reading of `corner`: of all readings that a plate with a twist in this range allows, the one nearest to
/// the actual reading.
pub(super) fn demanded(forces: [f32; 4], corner: usize, twist: (f32, f32)) -> f32 {
    let Some((difference, place, whole)) = diagonal(forces) else { return expected(forces, corner) };
    let lacks = lawful(difference, place, whole, twist) - difference;
    forces[corner] + if corner == 0 || corner == 3 { lacks } else { -lacks }
}

/// The sensor that alone reads a load (or the lack of one), if no foot could press like that.
///
/// Sensors that are `out` do not count; if one of its two neighbours is among them the result is open, since a load
/// on the edge between may have no other response.
pub(super) fn unanswered(forces: [f32; 4], out: [bool; 4]) -> Option<usize> {
    let known = || (0..4).filter(|&corner| !out[corner]);
    let loudest = known().max_by(|&a, &b| forces[a].abs().total_cmp(&forces[b].abs()))?;
    let force = forces[loudest].abs();
    let answer = (ANSWER * force).clamp(LEAST_ANSWER_N, MOST_ANSWER_N);
    let quiet = known().filter(|&corner| corner != loudest).all(|corner| forces[corner].abs() < answer);
    let answerable = !out[loudest ^ 1] && !out[loudest ^ 2];
    (force > ALONE_N && answerable && quiet).then_some(loudest)
}

/// Evidence of the other three sensors about `corner`; none if one of them is at the end of its range.
///
/// A part that misses its law at light loads may read as much in the air as at rest; a reading next to zero is
/// evidence all the same.
pub(super) fn evidence(forces: [f32; 4], ends: [RangeEnd; 4], corner: usize) -> KnownCorner {
    let is_beyond = (0..4).any(|other| other != corner && ends[other] == RangeEnd::High);
    let lifted = [0, 1, 2, 3].map(|corner| has_lifted(forces, ends, corner));
    if is_beyond { KnownCorner::Nothing } else { told(lifted, corner) }
}

fn has_lifted(forces: [f32; 4], ends: [RangeEnd; 4], corner: usize) -> bool {
    corners::has_lifted(forces[corner]) || ends[corner].reads_nothing()
}

/// Whether `corner`, which reads zero, should read more; `fell` means that it began to do so from one millisecond to
/// the next.
///
/// On an unloaded tile it should. On a loaded one, a foot on the far side may have lifted it off; so it must have
/// fallen faster than any foot lifts a corner, and the loads of the others must require half of its reading on the
/// empty floor, within all errors. (If the far side's own sensor is dead, and that is not known yet, the others seem
/// to require this of a lifted corner, too.)
pub(super) fn should_bear_more(
    forces: [f32; 4],
    ends: [RangeEnd; 4],
    out: [bool; 4],
    corner: usize,
    fell: bool,
    twist: (f32, f32),
) -> bool {
    let others = [corner ^ 1, corner ^ 2, corner ^ 3];
    let tells = |other: usize| !out[other] && !has_lifted(forces, ends, other);
    if others.iter().all(|&other| !tells(other) || forces[other].abs() < LEAST_ANSWER_N) {
        return true;
    }
    let load: f32 = others.iter().map(|&other| forces[other].abs()).sum();
    fell && !others.iter().any(|&other| out[other])
        && evidence(forces, ends, corner) == KnownCorner::Exactly
        && demanded(forces, corner, twist) > 0.5 * forces[corner] + AT_ONCE_SLACK * load
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE_OUT: [bool; 4] = [false; 4];
    const RIGID: (f32, f32) = (0.0, 0.0);

    #[test]
    fn a_foot_over_a_single_sensor_is_answered_by_the_others() {
        // 20 N and 100 N right over sw of a plate that rests on each corner with 11 N.
        assert_eq!(unanswered([15.0, 5.0, 5.0, -5.0], NONE_OUT), None);
        assert_eq!(unanswered([88.6, 11.4, 11.4, -11.4], NONE_OUT), None);
        // Three kilonewtons: the frame carries the load, ne hangs free.
        assert_eq!(unanswered([2900.0, -6.0, -6.0, -6.0], NONE_OUT), None);
    }

    #[test]
    fn fifty_newtons_on_one_sensor_alone_are_no_foot() {
        for corner in 0..4 {
            let mut forces = [0.4, -0.7, 0.1, 0.3];
            forces[corner] = 50.0;
            assert_eq!(unanswered(forces, NONE_OUT), Some(corner));
            forces[corner] = -11.0;
            assert_eq!(unanswered(forces, NONE_OUT), Some(corner));
        }
        assert_eq!(unanswered([4.0, 0.0, 0.0, 0.0], NONE_OUT), None, "too light to tell");
        assert_eq!(unanswered([50.0, 0.0, 0.0, 0.0], [true, false, false, false]), None, "known to be out");
        assert_eq!(
            unanswered([50.0, 0.0, 0.0, 0.0], [false, true, false, false]),
            None,
            "a foot on the south edge"
        );
        assert_eq!(unanswered([50.0, 0.0, 0.0, 0.0], [false, false, false, true]), Some(0));
        assert_eq!(unanswered([f32::NAN; 4], NONE_OUT), None);
    }

    #[test]
    fn a_lifted_corner_is_no_broken_one() {
        // sw reads zero, 11 N less than at rest.
        let sw_of = |forces, ends| should_bear_more(forces, ends, NONE_OUT, 0, true, RIGID);
        let alone = [RangeEnd::Low, RangeEnd::Within, RangeEnd::Within, RangeEnd::Within];
        assert!(sw_of([-11.0, 0.1, -0.2, 0.3], alone), "nobody there");
        assert!(sw_of([-11.0, 150.0, 160.0, 140.0], alone), "a foot in the middle");
        assert!(!should_bear_more([-11.0, 150.0, 160.0, 140.0], alone, NONE_OUT, 0, false, RIGID), "slowly");
        assert!(!sw_of([-11.0, 10.0, 10.0, 280.0], alone), "a foot on ne");
        assert!(!sw_of([-11.0, 300.0, -11.0, -10.0], alone), "tipped over se");
        assert!(sw_of([-11.0, -11.0, -11.0, -11.0], [RangeEnd::Low; 4]), "the whole tile unplugged");
        // The part at nw reads 1.5 N at rest under 11 N, and zero in the air.
        let east = [RangeEnd::Low, RangeEnd::Within, RangeEnd::Bare, RangeEnd::Within];
        assert!(!sw_of([-11.0, 190.0, -1.5, 90.0], east), "tipped over the east edge");
        // ne is at the end of its range: its load is unknown.
        let beyond = [RangeEnd::Low, RangeEnd::Within, RangeEnd::Within, RangeEnd::High];
        assert!(!sw_of([-11.0, 190.0, 180.0, 260.0], beyond), "a very heavy foot on ne");
    }

    #[test]
    fn beside_a_corner_at_the_end_of_its_range_nothing_is_told() {
        let forces = [0.0, 80.0, 90.0, 70.0];
        assert_eq!(evidence(forces, [RangeEnd::Within; 4], 0), KnownCorner::Exactly);
        let mut ends = [RangeEnd::Within; 4];
        ends[1] = RangeEnd::High;
        assert_eq!(evidence(forces, ends, 0), KnownCorner::Nothing);
        // A sensor is no evidence about itself.
        assert_eq!(evidence(forces, ends, 1), KnownCorner::Exactly);
    }

    /// Corner forces of points on a plate of this twist; places in units of the sensors' reach.
    fn plate(points: &[(f32, f32, f32)], twist: f32) -> [f32; 4] {
        let mut forces = [0.0; 4];
        for &(force, x, y) in points {
            for (corner, (east, north)) in
                [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].into_iter().enumerate()
            {
                forces[corner] += 0.25 * force * (1.0 + east * x + north * y + twist * east * north * x * y);
            }
        }
        forces
    }

    #[test]
    fn how_far_plates_bend_is_learnt_from_the_feet_on_them() {
        for truth in [0.0, 0.2, 0.4, 0.6, 0.9] {
            let mut twist = Twist::default();
            for step in 0..200_u16 {
                let (x, y) = ((0.7 * f32::from(step)).sin(), (1.3 * f32::from(step)).cos());
                // A foot is two loads: heel and ball.
                twist.learn(plate(&[(300.0, x, y), (300.0, 0.7 * x + 0.2, 0.7 * y - 0.1)], truth));
            }
            let (low, high) = twist.range();
            assert!(low <= truth && truth <= high && high - low < 0.4, "{truth}: {low} to {high}");
        }
    }

    #[test]
    fn a_sensor_that_is_dead_or_reads_a_load_alone_teaches_nothing_of_the_plate() {
        let mut twist = Twist::default();
        let mut forces = plate(&[(600.0, 0.1, 0.0)], 0.0);
        forces[0] = 0.0;
        let before = twist.range();
        for lone in [forces, [150.0, 0.3, -0.2, 0.1]] {
            (0..100).for_each(|_| twist.learn(lone));
            assert_eq!(twist.range(), before);
        }
    }

    #[test]
    fn what_a_bent_plate_reads_is_demanded_of_it_and_of_a_dead_sensor_what_it_lacks() {
        for truth in [0.0_f32, 0.5, 1.0] {
            let forces = plate(&[(400.0, 0.8, -0.6)], truth);
            for corner in 0..4 {
                let range = ((truth - 0.1).max(0.0), (truth + 0.1).min(1.0));
                for range in [range, (0.0, 1.0)] {
                    let demanded = demanded(forces, corner, range);
                    assert!((demanded - forces[corner]).abs() < 0.01, "{truth}, {corner}: {demanded} N");
                }
                // In the middle of the plate all stiffnesses agree.
                let mut dead = plate(&[(400.0, 0.1, 0.1)], truth);
                dead[corner] = 0.0;
                assert!(super::demanded(dead, corner, (0.0, 1.0)) > 30.0, "{truth}, {corner}");
            }
        }
    }
}
