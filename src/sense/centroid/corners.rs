//! Relations between the readings of a tile's four sensors.
//!
//! Sensors are in the order sw, se, nw, ne, or of the floor file: the neighbours of a sensor differ from it in one bit
//! of its number, its diagonal in both. The forces of a plate on three supports do not depend on each other.

use crate::floor::SensorPlaces;
use crate::sense::Quality;

/// Reading below which a corner has lifted off, or is about to: the plate's weight on it is gone.
const LIFTED_N: f32 = -2.0;

/// Error of a lost sensor's force estimated from the other three, as a share of the tile's force (one standard
/// deviation; measured on simulated floors with parts and supports like the paper's).
const ESTIMATED: f32 = 0.15;

/// Error of an uncalibrated sensor, as a share of its reading (parts differ by a quarter).
const UNSURE: f32 = 0.2;

/// Possible excess of the force at a sensor at the end of its range over its reading, as a share of the reading,
/// without evidence from the others (our choice).
const AT_LEAST: f32 = 0.5;

/// Estimated load per newton of its reading in that case: loads just beyond the end are more frequent than loads far
/// beyond (our choice: the worst error of points of 400 N is 1.9 instead of 2.4 cm, at the cost of up to 7 mm for
/// those just beyond).
const BEYOND: f32 = 1.1;

/// Possible error of a sensor at the end of its range with evidence from the others, as shares of its reading: below
/// the load, and above it if its part deviates from its law (our choice: of seven pairs tried, those with three to
/// five times as much below as above separated people's feet best).
const BELOW: f32 = 0.3;
const ABOVE: f32 = 0.1;

/// Error of its force with evidence from the others, as a share of the tile's force and for each sensor at its end
/// (one standard deviation; a little more than measured on simulated floors with position maps).
const TOLD: f32 = 0.03;

/// Whether a floor can produce these forces: no NaN, none above 1 MN.
pub(in crate::sense) fn is_possible(forces: &[f32; 4]) -> bool {
    // All four are checked: that takes less time than a branch after each.
    forces.iter().fold(true, |all, force| all & (force.abs() <= 1e6))
}

/// Load of this corner of a parallelogram as estimated from the other three (N); below zero where it lifts off.
///
/// [`told`] gives the meaning of the estimate.
///
/// # Source
/// Four equal springs under a rigid plate: f_sw + f_ne = f_se + f_nw.
pub(in crate::sense) fn expected(forces: [f32; 4], corner: usize) -> f32 {
    forces[corner ^ 1] + forces[corner ^ 2] - forces[corner ^ 3]
}

/// Meaning of the [`expected`] value of a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sense) enum KnownCorner {
    /// The exact load, except for unequal supports and gains.
    Exactly,
    /// A lower bound of the load.
    AtLeast,
    /// No information.
    Nothing,
}

/// Evidence of the other three about `corner`, some of which have `lifted` off their supports.
///
/// # Source
/// Springs push but do not pull: with its diagonal in the air, a corner carries the [`expected`] load or more; with a
/// neighbour in the air, that load or less, since the plate tips over it.
pub(in crate::sense) fn told(lifted: [bool; 4], corner: usize) -> KnownCorner {
    if lifted[corner ^ 1] || lifted[corner ^ 2] {
        KnownCorner::Nothing
    } else if lifted[corner ^ 3] {
        KnownCorner::AtLeast
    } else {
        KnownCorner::Exactly
    }
}

/// [`told`] on a plate with sensors at these places: no information without the balance of a parallelogram.
fn told_of(places: &SensorPlaces, lifted: [bool; 4], corner: usize) -> KnownCorner {
    if places.is_parallelogram() { told(lifted, corner) } else { KnownCorner::Nothing }
}

/// Whether a corner that reads `force` newtons has lifted off, or is about to.
pub(in crate::sense) fn has_lifted(force: f32) -> bool {
    force < LIFTED_N
}

/// The forces of a tile's sensors, with one unknown estimated, and their quality.
///
/// If one of four sensors is out, its force is estimated from the other three: four equal springs under a rigid plate
/// carry f_sw + f_ne = f_se + f_nw ([`SensorPlaces::balanced`]). The tile is then [`Quality::Degraded`]. With two out,
/// with one of three out, or numbers that no floor can produce (NaN, above 1 MN), returns `None`: such a tile carries
/// no contact.
#[must_use]
#[inline]
pub fn known_corners(
    places: &SensorPlaces,
    forces: [f32; 4],
    quality: [Quality; 4],
) -> Option<([f32; 4], Quality)> {
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
        forces[corner] = places.balanced(forces, corner)?.max(0.0);
        worst = Quality::Degraded;
    }
    is_possible(&forces).then_some((forces, worst))
}

/// The forces of a tile with sensors at the ends of their ranges, the [`Quality::Degraded`] ones: as estimated from
/// the plate's other corners, or a little more than the reading without evidence from these.
///
/// Near its end a part may also read too much: then the force is lowered. On a plate that is no parallelogram the
/// others are no evidence.
pub(in crate::sense) fn mended(places: &SensorPlaces, forces: [f32; 4], quality: [Quality; 4]) -> [f32; 4] {
    let at_end = quality.map(|quality| quality == Quality::Degraded);
    let lifted = forces.map(has_lifted);
    std::array::from_fn(|corner| {
        let reads = forces[corner];
        match told_of(places, lifted, corner) {
            _ if !at_end[corner] => reads,
            KnownCorner::Nothing => BEYOND * reads,
            KnownCorner::AtLeast => expected(forces, corner).max(BEYOND * reads),
            KnownCorner::Exactly => reads + lacking(forces, at_end, corner),
        }
    })
}

/// Correction of the reading of `corner` on a plate that rests on all its supports: the imbalance is divided among
/// the sensors `at_end` by the errors that each may have in the direction that reduces it.
///
/// # Source
/// The most likely forces given f_sw + f_ne = f_se + f_nw ([`expected`]), known to [`TOLD`], and readings known to
/// [`BELOW`] and [`ABOVE`]: each sensor receives a part of the imbalance in proportion to its variance.
fn lacking(forces: [f32; 4], at_end: [bool; 4], corner: usize) -> f32 {
    let missing = expected(forces, corner) - forces[corner];
    let variance = |other: usize| {
        // To reduce the imbalance, the diagonal must change in the same direction as this corner, the neighbours in
        // the opposite one.
        let rises = (missing > 0.0) == (other == corner || other == corner ^ 3);
        let wrong = if rises { BELOW } else { ABOVE } * forces[other];
        if at_end[other] { wrong * wrong } else { 0.0 }
    };
    let whole: f32 = forces.iter().sum();
    let all = (0..4).map(variance).sum::<f32>() + (TOLD * whole).powi(2).max(f32::MIN_POSITIVE);
    missing * variance(corner) / all
}

/// The standard deviation of each of `forces` beyond the general uncertainty of sensors (N), by the quality of the
/// sensors; `may_start` as in [`crate::sense::ForceFrame::may_start`].
pub(in crate::sense) fn extra_sigma(
    places: &SensorPlaces,
    forces: [f32; 4],
    quality: [Quality; 4],
    may_start: bool,
) -> [f32; 4] {
    let whole: f32 = forces.iter().sum();
    let at_end = quality.iter().filter(|&&quality| quality == Quality::Degraded).count() as f32;
    let lifted = forces.map(has_lifted);
    let one = |corner: usize| match quality[corner] {
        Quality::Live => 0.0,
        Quality::Degraded if may_start => UNSURE * forces[corner].abs(),
        Quality::Degraded => {
            let unseen = AT_LEAST * forces[corner].abs();
            let is_told = told_of(places, lifted, corner) == KnownCorner::Exactly;
            if is_told { unseen.min(TOLD * at_end * whole) } else { unseen }
        }
        Quality::Stale | Quality::Faulty => {
            // Once the diagonal has lifted off, any further load on this corner is not visible.
            ESTIMATED * whole + (-forces[corner ^ 3]).max(0.0)
        }
    };
    std::array::from_fn(one)
}

/// Minimum load at which corners can contradict each other (N).
const CONTRADICTS_N: f32 = 30.0;

/// Maximum difference between the sums of a tile's diagonals, as a share of its load, due to unequal supports and
/// gains (two to three standard deviations), and due to a foot across a plate that bends.
const UNEQUAL: f32 = 0.15;
const ACROSS: f32 = 0.15;

/// Share of a tile's load below which a corner may be in the air.
const IN_THE_AIR: f32 = 0.03;

/// The standard deviation of each of `forces` due to a combination that no plate, rigid or bent, allows (N): it shows
/// a sensor that is dead under its load, or at its end, in the same frame.
///
/// A diagonal that carries too little lacks the excess of the other, unless the other has a corner in the air.
///
/// # Source
/// Plate on four springs: f_sw - f_se - f_nw + f_ne lies between zero (rigid) and that of the load's place (limp).
#[inline]
pub(in crate::sense) fn contradicted([sw, se, nw, ne]: [f32; 4]) -> [f32; 4] {
    let whole = (sw + se) + (nw + ne);
    let diagonal = (sw - se) + (ne - nw);
    let place = ((se - sw) + (ne - nw)) * ((nw - sw) + (ne - se)) / whole;
    let low = (place - ACROSS * whole).min(0.0);
    let high = (place + ACROSS * whole).max(0.0);
    let slack = UNEQUAL * whole;
    if whole.is_nan() || whole <= CONTRADICTS_N || (diagonal >= low - slack && diagonal <= high + slack) {
        return [0.0; 4];
    }
    let air = IN_THE_AIR * whole;
    if diagonal > high {
        let lacks = if sw.min(ne) < air { 0.0 } else { diagonal - high };
        [0.0, lacks, lacks, 0.0]
    } else {
        let lacks = if se.min(nw) < air { 0.0 } else { low - diagonal };
        [lacks, 0.0, 0.0, lacks]
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::floor::{Geometry, TileId};

    const LIVE: [Quality; 4] = [Quality::Live; 4];

    fn corners() -> SensorPlaces {
        *Geometry::default().sensor_places(TileId::new(0, 0))
    }

    const END: Quality = Quality::Degraded;

    /// A foot of 720 N, west of the middle: on springs, sw + ne = se + nw.
    const FOOT: [f32; 4] = [250.0, 130.0, 230.0, 110.0];

    #[test]
    fn one_lost_sensor_is_told_by_the_others() {
        for corner in 0..4 {
            let (mut forces, mut quality) = (FOOT, LIVE);
            forces[corner] = 9999.0;
            quality[corner] = Quality::Faulty;
            assert_eq!(known_corners(&corners(), forces, quality), Some((FOOT, Quality::Degraded)));
        }
    }

    #[test]
    fn two_sensors_are_too_few_and_nonsense_is_no_load() {
        let two_out = [Quality::Live, Quality::Stale, Quality::Live, Quality::Faulty];
        assert_eq!(known_corners(&corners(), [1.0; 4], two_out), None);
        assert_eq!(known_corners(&corners(), [f32::NAN; 4], LIVE), None);
        assert_eq!(known_corners(&corners(), [f32::INFINITY; 4], LIVE), None);
        assert_eq!(known_corners(&corners(), [3e38; 4], LIVE), None);
    }

    #[test]
    fn a_plate_on_three_legs_needs_all_of_them_and_a_trapezium_three_of_four() {
        let places = |places: &[(f32, f32)]| {
            SensorPlaces::at(&places.iter().copied().map(Vec2::from).collect::<Vec<_>>()).unwrap()
        };
        let three = places(&[(-0.2, -0.15), (0.2, -0.15), (0.0, 0.18)]);
        let lost = [Quality::Live, Quality::Faulty, Quality::Live, Quality::Live];
        let forces = [200.0, 150.0, 300.0, 0.0];
        assert_eq!(known_corners(&three, forces, LIVE), Some((forces, Quality::Live)));
        assert_eq!(known_corners(&three, forces, lost), None);
        let trapezium = places(&[(-0.2, -0.1), (0.2, -0.1), (-0.1, 0.12), (0.1, 0.12)]);
        let forces = trapezium.shares(Vec2::new(0.03, 0.01)).map(|share| 700.0 * share);
        let mut read = forces;
        read[1] = 0.0;
        let (known, quality) = known_corners(&trapezium, read, lost).unwrap();
        assert!((known[1] - forces[1]).abs() < 1e-2 && quality == Quality::Degraded, "{known:?}");
    }

    #[test]
    fn of_a_corner_nothing_is_told_while_the_plate_tips_over_its_neighbour() {
        let air = |corner| [0, 1, 2, 3].map(|other| other == corner);
        let of_sw = [0, 1, 2, 3].map(|corner| told(air(corner), 0));
        assert_eq!(
            of_sw,
            [KnownCorner::Exactly, KnownCorner::Nothing, KnownCorner::Nothing, KnownCorner::AtLeast]
        );
        assert_eq!(told([false; 4], 0), KnownCorner::Exactly);
    }

    #[track_caller]
    fn nearly(found: [f32; 4], expected: [f32; 4]) {
        // A fortieth of the tile's load: slightly above the accuracy of the plate estimate.
        assert!(
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 18.0),
            "{found:?}"
        );
    }

    #[test]
    fn a_sensor_at_its_end_carries_about_what_the_others_say() {
        let at_sw = [END, Quality::Live, Quality::Live, Quality::Live];
        nearly(mended(&corners(), [200.0, 130.0, 230.0, 110.0], at_sw), FOOT);
        // A part that deviates from its law near its end reads too much there.
        nearly(mended(&corners(), [290.0, 130.0, 230.0, 110.0], at_sw), FOOT);
        assert_eq!(mended(&corners(), [0.0; 4], at_sw), [0.0; 4]);
    }

    #[test]
    fn of_two_neighbours_at_their_ends_the_one_that_lacks_is_told_and_of_a_diagonal_only_the_sum() {
        let west = [END, Quality::Live, END, Quality::Live];
        nearly(mended(&corners(), [210.0, 130.0, 230.0, 110.0], west), FOOT);
        let diagonal = [END, Quality::Live, Quality::Live, END];
        let [sw, _, _, ne] = mended(&corners(), [220.0, 130.0, 230.0, 100.0], diagonal);
        assert!((sw + ne - 360.0).abs() < 18.0, "{sw} and {ne} N");
    }

    #[test]
    fn of_two_neighbours_that_disagree_the_one_that_reads_too_much_comes_down_as_the_other_goes_up() {
        // A foot of 1150 N. Its south-east sensor ends at 306 N; the north-east one reads 565 N under about 460 N:
        // unchanged, it would put 490 N on the south-east one, and 1360 N on the tile.
        let east = [Quality::Live, END, Quality::Live, END];
        let [sw, se, nw, ne] = mended(&corners(), [115.0, 306.0, 193.0, 565.0], east);
        assert_eq!((sw, nw), (115.0, 193.0));
        assert!((400.0..460.0).contains(&se) && (490.0..540.0).contains(&ne), "{se} and {ne} N");
        assert!((se + nw - sw - ne).abs() < 30.0, "all four make a plate");
    }

    #[test]
    fn beside_a_corner_in_the_air_nothing_is_told_but_that_it_is_more() {
        // A very heavy foot over sw, ne in the air: nw and se are its neighbours, and their readings are their loads.
        let over_sw = [685.0, 335.0, 245.0, -11.0];
        let south = [END, END, Quality::Live, Quality::Live];
        assert_eq!(mended(&corners(), over_sw, south), [753.5, 368.5, 245.0, -11.0]);
        assert_eq!(extra_sigma(&corners(), over_sw, south, false)[1], 0.5 * 335.0);
        // With all on their supports the plate estimate is six times as accurate.
        let flat = extra_sigma(&corners(), FOOT, [END, Quality::Live, Quality::Live, Quality::Live], false);
        assert_eq!(flat, [21.6, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn a_dead_sensor_under_load_contradicts_the_others_and_a_lifted_or_bent_corner_does_not() {
        assert_eq!(contradicted(FOOT), [0.0; 4]);
        for dead in 0..4 {
            let mut forces = [190.0, 170.0, 180.0, 160.0];
            let carries = std::mem::take(&mut forces[dead]);
            let sigma = contradicted(forces);
            assert!(sigma[dead] > 0.5 * carries, "{dead}: {sigma:?}");
            assert_eq!(sigma[dead ^ 1] + sigma[dead ^ 2], 0.0);
        }
        // A foot over sw, ne in the air; the same on a plate that is limp; one in the middle of the south edge.
        for forces in
            [[350.0, 120.0, 130.0, -5.0], [450.0, 80.0, 70.0, 10.0], [300.0, 310.0, 15.0, 12.0], [0.0; 4]]
        {
            assert_eq!(contradicted(forces), [0.0; 4], "{forces:?}");
        }
    }
}
