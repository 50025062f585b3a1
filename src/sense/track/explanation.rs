//! Does a track consist of one foot or of two?
//!
//! One foot or two explain the loads of a single track's tiles. The tracker keeps both explanations; their log odds
//! are the prior, which depends on how the track began, plus the evidence since:
//!
//! - **Spread.** The covariance of the tile loads about their common centroid is a lower bound of that of the
//!   pressure. One foot is long and narrow; two feet are not.
//! - **Soles.** While a contact lands or stands, with no other foot near, one sole or two are fitted to its loads
//!   ([`pair`](super::pair)): the only evidence of a child's second foot, since a child weighs no more than a foot that
//!   operates a control.
//! - **Standing.** A walking step never rests. A single contact that carries a person for longer, with no other foot
//!   near, is both feet.
//! - **Shift.** In standing, the centre of pressure of a single foot sways by about a centimetre. It moves farther
//!   when a second foot takes over weight.
//! - **Roll.** From heel to toes within a stance, a centre of pressure travels farther than that of two feet side by
//!   side.
//!
//! Above even odds the contact is ambiguous, and its ellipse always covers both possibilities. A second track begins
//! when the odds justify the risk and the data show its place.

use super::params::explanation::{
    ACCOMPANIED, ACROSS_M, ACROSS_SPREAD_M, ALONG_M, ALONG_SPREAD_M, BIRTH, HALF_STANCE_M, LONE, MOST, ROLL,
    ROLL_M, SPREAD_N, STANDING, STANDING_S, STOPPED, STOPPED_S, SWAY_M,
};
use super::params::stillness::STANDS_S;
use glam::DVec2;

use super::elapsed::Elapsed;
use super::pair::Pair;
use super::params::pair::{LIGHT, ONE_SOLE, ONE_STEP};
use super::state::Track;
use super::strips::{Whole, centroid_sigma};
use crate::sense::centroid::tile::LoadedTile;

/// The covariance of the places of some tile loads about their centroid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spread {
    /// Mean of the variances eastwards and northwards (m²).
    mean: f64,
    /// Half the difference between the two, and the covariance: both give the widest direction.
    difference: f64,
    mixed: f64,
}

impl Spread {
    /// The spread of `tiles` about `middle`.
    pub(super) fn of<'a>(tiles: impl Iterator<Item = &'a LoadedTile>, middle: DVec2) -> Self {
        Self::of_arms(tiles.map(|tile| (f64::from(tile.wrench.force), tile.centroid.as_dvec2() - middle)))
    }

    /// The spread of loads (N), each with its arm from their centroid.
    #[inline]
    fn of_arms(loads: impl Iterator<Item = (f64, DVec2)>) -> Self {
        let (mut xx, mut xy, mut yy, mut force) = (0.0, 0.0, 0.0, 0.0);
        for (load, arm) in loads {
            xx += load * arm.x * arm.x;
            xy += load * arm.x * arm.y;
            yy += load * arm.y * arm.y;
            force += load;
        }
        Self { mean: 0.5 * (xx + yy) / force, difference: 0.5 * (xx - yy) / force, mixed: xy / force }
    }

    /// Difference between the variance along the widest direction, or across it, and their mean.
    fn swing(&self) -> f64 {
        self.difference.hypot(self.mixed)
    }

    /// Standard deviation along the widest direction (m).
    fn along(&self) -> f64 {
        (self.mean + self.swing()).max(0.0).sqrt()
    }

    /// Standard deviation across it (m).
    fn across(&self) -> f64 {
        (self.mean - self.swing()).max(0.0).sqrt()
    }

    /// The widest direction.
    pub(super) fn axis(&self) -> DVec2 {
        DVec2::from_angle(0.5 * self.mixed.atan2(self.difference))
    }

    /// Log odds of two feet.
    #[inline]
    pub(super) fn evidence(&self) -> f64 {
        if self.is_narrow() {
            return 0.0;
        }
        self.evidence_along() + excess(self.across(), ACROSS_M, ACROSS_SPREAD_M)
    }

    /// Whether it is narrower than one foot by more than rounding errors, compared by squares without a root.
    #[inline]
    fn is_narrow(&self) -> bool {
        const SURELY: f64 = 1.0 - 1e-9;
        let room_along = SURELY * ALONG_M * ALONG_M - self.mean;
        let beyond_across = self.mean - SURELY * ACROSS_M * ACROSS_M;
        let swing = self.difference * self.difference + self.mixed * self.mixed;
        room_along > 0.0
            && swing < SURELY * room_along * room_along
            && (beyond_across < 0.0 || SURELY * swing > beyond_across * beyond_across)
    }

    fn evidence_along(&self) -> f64 {
        excess(self.along(), ALONG_M, ALONG_SPREAD_M)
    }
}

/// ½ ((`value` − `limit`) / `deviation`)² above the limit, at most [`MOST`].
fn excess(value: f64, limit: f64, deviation: f64) -> f64 {
    (0.5 * ((value - limit).max(0.0) / deviation).powi(2)).min(MOST)
}

/// Log odds of the two explanations of one track.
#[derive(Clone, Copy, Debug)]
pub(super) struct Explanation {
    /// Smoothed log odds of two feet against one.
    pub log_odds: f64,
}

/// Evidence of a second foot, and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Second {
    /// It takes over weight: the shift from the anchor shows it.
    Shift(DVec2),
    /// The tiles' loads lie too far apart along an axis.
    Apart(Spread),
    /// Two soles explain the loads.
    Pair(Pair),
}

impl Default for Explanation {
    fn default() -> Self {
        Self { log_odds: ACCOMPANIED }
    }
}

impl Explanation {
    /// Updates the odds with the present loads of the track's tiles, at the usual distance `side` from each other.
    /// `alone`: whether it carries a person, with no other foot within a stride.
    ///
    /// log odds += w (evidence − log odds). Returns the place of the second foot once it justifies a track.
    pub(super) fn update(
        &mut self,
        foot: &Track,
        seen: &Whole,
        list: &[LoadedTile],
        side: f64,
        alone: bool,
        elapsed: &Elapsed,
    ) -> Option<Second> {
        // A light contact far from all others is a tapping foot; a person stands on one foot or on two.
        let lone = !foot.company.accompanied && (foot.bears() || seen.force > foot.step.body_n);
        let prior = if lone { LONE } else { ACCOMPANIED };
        let tiles = foot.tiles.as_slice().iter().map(|&position| &list[position as usize]);
        let (mut evidence, mut spread, mut spread_evidence) = (prior, Spread::default(), 0.0);
        if seen.force > SPREAD_N && foot.tiles.len() > 1 {
            spread = Spread::of(tiles.clone(), seen.middle);
            spread_evidence = spread.evidence();
            evidence += spread_evidence;
        }
        let pair = foot.arrivals.fitted.pair;
        if let Some(pair) = &pair {
            let least = match (alone, foot.stillness.anchored_s > STANDS_S) {
                (false, _) => LIGHT,
                (true, true) => ONE_SOLE,
                (true, false) => ONE_STEP,
            };
            let soles = (pair.log_odds - least).clamp(-MOST, MOST);
            evidence += soles.max(spread_evidence) - spread_evidence;
        }
        let mut shift = DVec2::ZERO;
        if foot.stillness.anchored_s > 0.0 && alone {
            if foot.stillness.anchored_s > STANDS_S {
                let (standing, after_s) =
                    if foot.company.accompanied { (STOPPED, STOPPED_S) } else { (STANDING, STANDING_S) };
                evidence += standing * ((foot.stillness.anchored_s - STANDS_S) / after_s).min(1.0);
                shift = seen.middle - foot.stillness.anchor;
                let deviation = SWAY_M.hypot(0.5 * centroid_sigma(tiles, seen.force, side));
                evidence += (0.5 * (shift.length() / deviation).powi(2)).min(MOST);
            } else {
                evidence -= (ROLL * (foot.step.travel / ROLL_M).powi(2)).min(ROLL);
            }
        }
        let weight = 1.0 - elapsed.explanation;
        self.log_odds += weight * (evidence - self.log_odds);
        if self.log_odds < BIRTH || evidence < BIRTH {
            return None;
        }
        let shifted = shift.length() > 3.0 * SWAY_M;
        if let Some(pair) = pair.filter(|pair| pair.is_placed() && !shifted) {
            Some(Second::Pair(pair))
        } else if spread.evidence_along() > -prior + BIRTH.min(4.0) {
            Some(Second::Apart(spread))
        } else if shifted {
            Some(Second::Shift(shift))
        } else {
            None
        }
    }

    /// Probability of two feet.
    fn probability(&self) -> f64 {
        1.0 / (1.0 + (-self.log_odds).exp())
    }

    /// Whether two feet are more likely than one.
    pub(super) fn is_open(&self) -> bool {
        self.log_odds > 0.0
    }

    /// Standard deviation that a possible second foot adds to the place of the contact (m): its 95 % circle covers 95
    /// % of both explanations together.
    pub(super) fn hidden_m(&self) -> f64 {
        // The probability is far below one in twenty for nearly every foot, so skip the exponential.
        if self.log_odds < -3.0 {
            return 0.0;
        }
        let two = self.probability();
        if two < 0.05 {
            return 0.0;
        }
        let (least, most) = HALF_STANCE_M;
        (least + (most - least) * (1.0 - 0.05 / two)) / 2.4477
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Spread of `loads` (newtons, and places along and across in metres) about their centroid.
    fn spread(loads: &[(f64, f64, f64)]) -> Spread {
        let force: f64 = loads.iter().map(|load| load.0).sum();
        let sum: DVec2 = loads.iter().map(|&(force, x, y)| DVec2::new(x, y) * force).sum();
        let middle = sum / force;
        let arms = loads.iter().map(|&(force, x, y)| (force, DVec2::new(x, y) - middle));
        Spread::of_arms(arms)
    }

    #[test]
    fn the_spread_of_two_equal_loads_is_half_their_distance() {
        let apart = spread(&[(100.0, 0.0, 0.0), (100.0, 0.3, 0.0)]);
        assert!((apart.along() - 0.15).abs() < 1e-12 && apart.across() < 1e-9);
        assert!(apart.axis().y.abs() < 1e-12);
    }

    #[test]
    fn a_heel_and_a_ball_are_one_foot_and_feet_side_by_side_two() {
        // One foot spreads at most as widely as half of the load on each end of a sole.
        assert!(spread(&[(350.0, 0.0, 0.0), (350.0, 0.17, 0.02)]).evidence() < 0.1);
        // 30 cm apart over a seam.
        assert!(spread(&[(350.0, 0.0, 0.0), (350.0, 0.0, 0.3)]).evidence() > BIRTH);
        // 16 cm apart over four tiles: neither long nor narrow.
        let four = [(175.0, 0.0, 0.0), (175.0, 0.13, 0.0), (175.0, 0.0, 0.14), (175.0, 0.13, 0.14)];
        assert!(spread(&four).evidence() > BIRTH);
    }

    #[test]
    fn the_ellipse_is_as_wide_as_the_possibility() {
        let at = |log_odds| Explanation { log_odds }.hidden_m();
        assert_eq!(at(-4.6), 0.0, "one in a hundred lies outside of every 95 % ellipse");
        assert!(at(-1.1) > 0.03 && at(3.0) > at(-1.1));
        assert!(2.4477 * at(9.0) < HALF_STANCE_M.1, "no wider than two feet stand");
    }
}
