//! One foot, or two that are seen as one?
//!
//! What the tiles of a single track carry is explained by one foot or by two. Both explanations are kept: their log
//! odds are the prior, given how the track began, plus the evidence of what has been seen since:
//!
//! - **Spread.** The loads of the tiles lie about their common centroid with a covariance that is a lower bound of
//!   that of the pressure. One foot is long and narrow; two are neither.
//! - **Standing.** A walking step never rests; who stands for longer on one contact that bears a body's weight, with
//!   no other foot near, stands on both feet.
//! - **Shift.** While one stands, the centre of pressure of a single foot sways by a centimetre or so. It moves farther
//!   when a second foot takes over weight.
//! - **Roll.** From heel to toes within a stance, a centre of pressure travels farther than that of two feet side by side.
//!
//! From even odds on the contact is ambiguous, and its ellipse is always as wide as the possibility. A second track
//! begins once the odds pay for the risk, and the data say where it is.

use glam::DVec2;

use super::state::{BODY_N, Track};
use super::stillness::STANDS_S;
use super::strips::Whole;
use crate::sense::tile::LoadedTile;

/// Prior log odds of two feet: of a track that began far from all others, and of one that began near another foot.
const LONE: f64 = -1.1;
const ACCOMPANIED: f64 = -4.6;

/// Log odds that are paid before a second track begins: a false one can press something (cost 400 : 1).
pub(super) const BIRTH: f64 = 6.0;

/// The largest spread of tile loads under one foot along and across it, in metres, and by how much it varies. In 294
/// recorded steps and their turned, rocked and pressed kin at most 0.095 and 0.024.
const ALONG_M: f64 = 0.088;
const ACROSS_M: f64 = 0.021;
const ALONG_SPREAD_M: f64 = 0.0055;
const ACROSS_SPREAD_M: f64 = 0.0035;

/// Force below which spread says nothing, in newtons.
const SPREAD_N: f64 = 60.0;

/// Log odds that standing alone adds, in all, and after how long beyond the longest rest of a step, in seconds.
const STANDING: f64 = 4.0;
const STANDING_S: f64 = 0.2;

/// Sway of somebody who stands on one leg, as a standard deviation in metres.
const SWAY_M: f64 = 0.010;

/// Travel of a centre of pressure that two feet do not show together, in metres, and what it takes off.
const ROLL_M: f64 = 0.08;
const ROLL: f64 = 4.0;

/// Half the distance between two feet that stand, from and to, in metres.
const HALF_STANCE_M: (f64, f64) = (0.06, 0.15);

/// The largest sum of evidence of each kind.
const MOST: f64 = 12.0;

/// Over which time evidence is averaged, in seconds.
const WINDOW_S: f64 = 0.03;

/// How the loads of some tiles lie about their centroid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spread {
    /// Standard deviation along the widest direction, and across it, in metres.
    pub along: f64,
    pub across: f64,
    /// The widest direction.
    pub axis: DVec2,
}

impl Spread {
    /// Of `tiles` about `middle`.
    pub(super) fn of<'a>(tiles: impl Iterator<Item = &'a LoadedTile>, middle: DVec2) -> Self {
        let (mut xx, mut xy, mut yy, mut force) = (0.0, 0.0, 0.0, 0.0);
        for tile in tiles {
            let load = f64::from(tile.wrench.force);
            let arm = tile.centroid.as_dvec2() - middle;
            xx += load * arm.x * arm.x;
            xy += load * arm.x * arm.y;
            yy += load * arm.y * arm.y;
            force += load;
        }
        let (mean, difference, mixed) = (0.5 * (xx + yy) / force, 0.5 * (xx - yy) / force, xy / force);
        let swing = difference.hypot(mixed);
        let angle = 0.5 * mixed.atan2(difference);
        Self {
            along: (mean + swing).max(0.0).sqrt(),
            across: (mean - swing).max(0.0).sqrt(),
            axis: DVec2::from_angle(angle),
        }
    }

    /// Log odds for two feet.
    pub(super) fn evidence(&self) -> f64 {
        self.evidence_along() + excess(self.across, ACROSS_M, ACROSS_SPREAD_M)
    }

    fn evidence_along(&self) -> f64 {
        excess(self.along, ALONG_M, ALONG_SPREAD_M)
    }
}

/// Half the square of by how many deviations `value` is above `limit`.
fn excess(value: f64, limit: f64, deviation: f64) -> f64 {
    (0.5 * ((value - limit).max(0.0) / deviation).powi(2)).min(MOST)
}

/// The odds of the two explanations of one track.
#[derive(Clone, Copy, Debug)]
pub(super) struct Explanation {
    /// Log odds of two feet against one, averaged.
    pub log_odds: f64,
}

/// What speaks for a second foot, and where it would be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Second {
    /// It takes over weight: seen by the shift from the anchor.
    Shift(DVec2),
    /// The tiles' loads lie too far apart along an axis.
    Apart(Spread),
}

impl Explanation {
    pub(super) fn new() -> Self {
        Self { log_odds: LONE }
    }

    /// Takes in what the track's tiles carry now; `alone`: no other foot is within a stride.
    ///
    /// Gives where the second foot is once it is worth a track.
    pub(super) fn update(
        &mut self,
        foot: &Track,
        seen: &Whole,
        list: &[LoadedTile],
        alone: bool,
        dt: f64,
    ) -> Option<Second> {
        let prior = if foot.accompanied { ACCOMPANIED } else { LONE };
        let mut spread = Spread::default();
        if seen.force > SPREAD_N && foot.tiles.len() > 1 {
            spread = Spread::of(foot.tiles.iter().map(|&position| &list[position as usize]), seen.middle);
        }
        let mut evidence = prior + spread.evidence();
        let mut shift = DVec2::ZERO;
        if alone && foot.anchored_s > 0.0 && seen.force > BODY_N {
            if foot.anchored_s > STANDS_S {
                if !foot.accompanied {
                    evidence += STANDING * ((foot.anchored_s - STANDS_S) / STANDING_S).min(1.0);
                }
                shift = seen.middle - foot.anchor;
                let deviation = SWAY_M.hypot(0.5 * seen.doubt);
                evidence += (0.5 * (shift.length() / deviation).powi(2)).min(MOST);
            } else {
                evidence -= (ROLL * (foot.travel / ROLL_M).powi(2)).min(ROLL);
            }
        }
        let weight = 1.0 - (-dt / WINDOW_S).exp();
        self.log_odds += weight * (evidence - self.log_odds);
        if self.log_odds < BIRTH || evidence < BIRTH {
            return None;
        }
        if spread.evidence_along() > -prior + BIRTH.min(4.0) {
            Some(Second::Apart(spread))
        } else if shift.length() > 3.0 * SWAY_M {
            Some(Second::Shift(shift))
        } else {
            None
        }
    }

    /// Probability of two feet.
    pub(super) fn probability(&self) -> f64 {
        1.0 / (1.0 + (-self.log_odds).exp())
    }

    /// Whether two feet are as likely as one.
    pub(super) fn is_open(&self) -> bool {
        self.log_odds > 0.0
    }

    /// Standard deviation of what a second foot may add to the place of the contact, in metres: its 95 % circle
    /// holds 95 % of both explanations together.
    pub(super) fn hidden_m(&self) -> f64 {
        let two = self.probability();
        if two < 0.05 {
            return 0.0;
        }
        let (least, most) = HALF_STANCE_M;
        (least + (most - least) * (1.0 - 0.05 / two)) / 2.4477
    }
}
