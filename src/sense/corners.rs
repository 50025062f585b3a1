//! What the sensors at a tile's four corners say of each other.
//!
//! Corners are in the order sw, se, nw, ne: the neighbours of a corner differ from it in one bit of its
//! number, its diagonal in both.

use super::Quality;

/// A corner that reads this little has lifted off, or is about to: what rests on it by weight is gone.
pub(super) const LIFTED_N: f32 = -2.0;

/// How far a lost sensor's force estimated from the other three is off, as a share of the tile's force (one
/// standard deviation; measured on simulated floors of parts and supports as the paper's).
const ESTIMATED: f32 = 0.15;

/// How far a sensor is off that nobody has calibrated, as a share of its reading (parts differ by a quarter).
const UNSURE: f32 = 0.2;

/// How far the force at a sensor that reads "at least" may be above its reading, as a share of it, where
/// no other tells (our choice).
const AT_LEAST: f32 = 0.5;

/// What it carries then for each newton that it reads: of loads just beyond the end there are more than of loads
/// far beyond (our choice: the worst error of points of 400 N is 1.9 instead of 2.4 cm, at the cost of up to 7 mm for
/// those just beyond).
const BEYOND: f32 = 1.1;

/// How far it is off where the others do tell, as a share of the tile's force and for each sensor that is at
/// its end (one standard deviation; a little more than is measured on simulated floors with position maps).
const TOLD: f32 = 0.03;

/// Whether a floor can produce such forces: no NaN, none above 1 MN.
pub(super) fn is_possible(forces: &[f32; 4]) -> bool {
    forces.iter().all(|force| force.abs() <= 1e6)
}

/// What the other three corners say this one carries, in newtons; below zero where it lifts off.
///
/// # Source
/// Four equal springs under a rigid plate: f_sw + f_ne = f_se + f_nw. Springs push but do not pull: with its
/// diagonal in the air, a corner carries that much or more, with a neighbour in the air that much or less.
pub(super) fn expected(forces: [f32; 4], corner: usize) -> f32 {
    forces[corner ^ 1] + forces[corner ^ 2] - forces[corner ^ 3]
}

/// The forces of a tile's sensors, one unknown filled in, and how far they can be trusted.
///
/// With one sensor out, its force is estimated from the other three: four equal
/// springs under a rigid plate carry f_sw + f_ne = f_se + f_nw. The tile is then
/// [`Quality::Degraded`]. With two out, or numbers no floor can produce (NaN,
/// above 1 MN), `None`: such a tile carries no contact.
#[must_use]
#[inline]
pub fn known_corners(forces: [f32; 4], quality: [Quality; 4]) -> Option<([f32; 4], Quality)> {
    if quality == [Quality::Live; 4] {
        return is_possible(&forces).then_some((forces, Quality::Live));
    }
    let mut forces = forces;
    let mut out = None;
    let mut worst = Quality::Live;
    for (corner, &quality) in quality.iter().enumerate() {
        match quality {
            Quality::Live | Quality::Degraded => worst = worst.max(quality),
            Quality::Stale | Quality::Faulty if out.is_none() => out = Some(corner),
            Quality::Stale | Quality::Faulty => return None,
        }
    }
    if let Some(corner) = out {
        forces[corner] = expected(forces, corner).max(0.0);
        worst = Quality::Degraded;
    }
    is_possible(&forces).then_some((forces, worst))
}

/// The forces of a tile some of whose sensors, the [`Quality::Degraded`] ones, read "at least": each no less than
/// the others say, or a little more than it reads where they can't.
pub(super) fn raised(forces: [f32; 4], quality: [Quality; 4]) -> [f32; 4] {
    let at_end = |corner: usize| quality[corner] == Quality::Degraded;
    let lifted = |corner: usize| forces[corner] < LIFTED_N;
    std::array::from_fn(|corner| {
        let reads = forces[corner];
        if !at_end(corner) {
            return reads;
        }
        if lifted(corner ^ 1) || lifted(corner ^ 2) {
            return BEYOND * reads;
        }
        if lifted(corner ^ 3) {
            return expected(forces, corner).max(BEYOND * reads);
        }
        let more = (expected(forces, corner) - reads).max(0.0);
        // Which of two on one diagonal carries it, nobody tells.
        reads + if at_end(corner ^ 3) { 0.5 * more } else { more }
    })
}

/// The standard deviation of each of `forces` beyond what is unknown of any sensor, in newtons, by the quality of
/// the sensors; `may_start` as in [`super::ForceFrame::may_start`].
pub(super) fn vague(forces: [f32; 4], quality: [Quality; 4], may_start: bool) -> [f32; 4] {
    let whole: f32 = forces.iter().sum();
    let at_end = quality.iter().filter(|&&quality| quality == Quality::Degraded).count() as f32;
    let one = |corner: usize| match quality[corner] {
        Quality::Live => 0.0,
        Quality::Degraded if may_start => UNSURE * forces[corner].abs(),
        Quality::Degraded => {
            let unseen = AT_LEAST * forces[corner].abs();
            let tips = (0..4).any(|other| other != corner && forces[other] < LIFTED_N);
            if tips { unseen } else { unseen.min(TOLD * at_end * whole) }
        }
        Quality::Stale | Quality::Faulty => {
            // Once the diagonal has lifted off, all that this corner bears beyond is unseen.
            ESTIMATED * whole + (-forces[corner ^ 3]).max(0.0)
        }
    };
    std::array::from_fn(one)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIVE: [Quality; 4] = [Quality::Live; 4];
    const END: Quality = Quality::Degraded;

    /// A foot of 720 N, west of the middle: on springs, sw + ne = se + nw.
    const FOOT: [f32; 4] = [250.0, 130.0, 230.0, 110.0];

    #[test]
    fn one_lost_sensor_is_told_by_the_others() {
        for corner in 0..4 {
            let (mut forces, mut quality) = (FOOT, LIVE);
            forces[corner] = 9999.0;
            quality[corner] = Quality::Faulty;
            assert_eq!(known_corners(forces, quality), Some((FOOT, Quality::Degraded)));
        }
    }

    #[test]
    fn two_sensors_are_too_few_and_nonsense_is_no_load() {
        let two_out = [Quality::Live, Quality::Stale, Quality::Live, Quality::Faulty];
        assert_eq!(known_corners([1.0; 4], two_out), None);
        assert_eq!(known_corners([f32::NAN; 4], LIVE), None);
        assert_eq!(known_corners([f32::INFINITY; 4], LIVE), None);
        assert_eq!(known_corners([3e38; 4], LIVE), None);
    }

    #[test]
    fn a_sensor_at_its_end_carries_what_the_others_say_and_never_less_than_it_reads() {
        let at_sw = [END, Quality::Live, Quality::Live, Quality::Live];
        assert_eq!(raised([200.0, 130.0, 230.0, 110.0], at_sw), FOOT);
        let more = [280.0, 130.0, 230.0, 110.0];
        assert_eq!(raised(more, at_sw), more);
    }

    #[test]
    fn of_two_neighbours_at_their_ends_one_is_told_and_of_a_diagonal_only_the_sum() {
        let west = [END, Quality::Live, END, Quality::Live];
        assert_eq!(raised([210.0, 130.0, 230.0, 110.0], west), FOOT);
        let diagonal = [END, Quality::Live, Quality::Live, END];
        assert_eq!(raised([230.0, 130.0, 230.0, 90.0], diagonal), FOOT);
    }

    #[test]
    fn beside_a_corner_in_the_air_nothing_is_told_but_that_it_is_more() {
        // A very heavy foot over sw, ne in the air: nw and se are its neighbours, and carry what they read.
        let over_sw = [685.0, 335.0, 245.0, -11.0];
        let south = [END, END, Quality::Live, Quality::Live];
        assert_eq!(raised(over_sw, south), [753.5, 368.5, 245.0, -11.0]);
        assert_eq!(vague(over_sw, south, false)[1], 0.5 * 335.0);
        // With all on their supports the plate tells it six times as well.
        let flat = vague(FOOT, [END, Quality::Live, Quality::Live, Quality::Live], false);
        assert_eq!(flat, [21.6, 0.0, 0.0, 0.0]);
    }
}
