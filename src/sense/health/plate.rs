//! What a rigid plate on four supports allows its sensors to read.
//!
//! Corners are numbered as in [`crate::sense::corners`].

use super::End;
use crate::sense::corners::{self, Told, expected, told};

/// A single sensor must read this much, in newtons, for an answer to be expected of the others (our choice).
const ALONE_N: f32 = 8.0;

/// An answer must be larger than this share of the lone load, from the least to the most one expects.
///
/// A load right over a sensor puts a third of what that one reads on each of its
/// neighbours, until the plate lifts off diagonally, where its own weight (6 N per
/// corner and more) then is missing.
const ANSWER: f32 = 0.1;
const LEAST_ANSWER_N: f32 = 1.0;
const MOST_ANSWER_N: f32 = 3.0;

/// How much of a tile's load the rigid-plate estimate of a corner may be off: unequal
/// supports (a tenth) and gains (a twentieth), three deviations (our choice).
pub(super) const SLACK: f32 = 0.15;

/// The same for a verdict from a single frame, which no later one confirms.
const AT_ONCE_SLACK: f32 = 0.3;

/// The sensor that alone reads a load (or the lack of one), if no foot could press like that.
///
/// Sensors that are `out` say nothing; with one of its two neighbours among them there is no telling,
/// for a load on the edge between may have no other answer.
pub(super) fn unanswered(forces: [f32; 4], out: [bool; 4]) -> Option<usize> {
    let known = || (0..4).filter(|&corner| !out[corner]);
    let loudest = known().max_by(|&a, &b| forces[a].abs().total_cmp(&forces[b].abs()))?;
    let force = forces[loudest].abs();
    let answer = (ANSWER * force).clamp(LEAST_ANSWER_N, MOST_ANSWER_N);
    let quiet = known().filter(|&corner| corner != loudest).all(|corner| forces[corner].abs() < answer);
    let answerable = !out[loudest ^ 1] && !out[loudest ^ 2];
    (force > ALONE_N && answerable && quiet).then_some(loudest)
}

/// What the other three say about `corner`: nothing either if one of them bears more than it can read.
///
/// A part that misses its law where it is light may read no less in the air than at rest; that it reads next to
/// nothing tells all the same.
pub(super) fn evidence(forces: [f32; 4], ends: [End; 4], corner: usize) -> Told {
    let is_beyond = (0..4).any(|other| other != corner && ends[other] == End::High);
    let lifted = [0, 1, 2, 3].map(|corner| has_lifted(forces, ends, corner));
    if is_beyond { Told::Nothing } else { told(lifted, corner) }
}

fn has_lifted(forces: [f32; 4], ends: [End; 4], corner: usize) -> bool {
    corners::has_lifted(forces[corner]) || ends[corner].reads_nothing()
}

/// Whether `corner`, which reads nothing at all, should read more; `fell` says that it came to do so
/// from one millisecond to the next.
///
/// On a tile that carries nothing it should. On one that does, a foot on the far side may have lifted it
/// off, rightly; so it must have fallen faster than any foot lifts a corner, and half of what it reads on
/// the empty floor must be there by what the others carry, all errors allowed for. (If the far side's own
/// sensor is dead, and that is not known yet, the others seem to say so of a lifted corner, too.)
pub(super) fn should_bear_more(
    forces: [f32; 4],
    ends: [End; 4],
    out: [bool; 4],
    corner: usize,
    fell: bool,
) -> bool {
    let others = [corner ^ 1, corner ^ 2, corner ^ 3];
    let tells = |other: usize| !out[other] && !has_lifted(forces, ends, other);
    if others.iter().all(|&other| !tells(other) || forces[other].abs() < LEAST_ANSWER_N) {
        return true;
    }
    let load: f32 = others.iter().map(|&other| forces[other].abs()).sum();
    fell && !others.iter().any(|&other| out[other])
        && evidence(forces, ends, corner) == Told::Exactly
        && expected(forces, corner) > 0.5 * forces[corner] + AT_ONCE_SLACK * load
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE_OUT: [bool; 4] = [false; 4];

    #[test]
    fn a_foot_over_a_single_sensor_is_answered_by_the_others() {
        // 20 N and 100 N right over sw of a plate that rests on each corner with 11 N.
        assert_eq!(unanswered([15.0, 5.0, 5.0, -5.0], NONE_OUT), None);
        assert_eq!(unanswered([88.6, 11.4, 11.4, -11.4], NONE_OUT), None);
        // Three kilonewtons: the frame takes over, ne hangs free.
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
        // sw reads nothing, 11 N less than at rest.
        let sw_of = |forces, ends| should_bear_more(forces, ends, NONE_OUT, 0, true);
        let alone = [End::Low, End::Within, End::Within, End::Within];
        assert!(sw_of([-11.0, 0.1, -0.2, 0.3], alone), "nobody there");
        assert!(sw_of([-11.0, 150.0, 160.0, 140.0], alone), "a foot in the middle");
        assert!(!should_bear_more([-11.0, 150.0, 160.0, 140.0], alone, NONE_OUT, 0, false), "slowly");
        assert!(!sw_of([-11.0, 10.0, 10.0, 280.0], alone), "a foot on ne");
        assert!(!sw_of([-11.0, 300.0, -11.0, -10.0], alone), "tipped over se");
        assert!(sw_of([-11.0, -11.0, -11.0, -11.0], [End::Low; 4]), "the whole tile unplugged");
        // The part at nw reads 1.5 N at rest where 11 N press it, and nothing in the air.
        let east = [End::Low, End::Within, End::Bare, End::Within];
        assert!(!sw_of([-11.0, 190.0, -1.5, 90.0], east), "tipped over the east edge");
        // ne is at the end of its range: nobody knows how much it bears.
        let beyond = [End::Low, End::Within, End::Within, End::High];
        assert!(!sw_of([-11.0, 190.0, 180.0, 260.0], beyond), "a very heavy foot on ne");
    }

    #[test]
    fn beside_a_corner_at_the_end_of_its_range_nothing_is_told() {
        let forces = [0.0, 80.0, 90.0, 70.0];
        assert_eq!(evidence(forces, [End::Within; 4], 0), Told::Exactly);
        let mut ends = [End::Within; 4];
        ends[1] = End::High;
        assert_eq!(evidence(forces, ends, 0), Told::Nothing);
        // It does not speak of itself.
        assert_eq!(evidence(forces, ends, 1), Told::Exactly);
    }
}
