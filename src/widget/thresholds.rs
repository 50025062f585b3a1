use std::time::Duration;

use super::Guard;
use crate::units::Newtons;

/// When a foot's force counts as a press.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// Force from which on the control engages.
    pub press: Newtons,
    /// Force below which it lets go; less than `press`.
    pub release: Newtons,
    /// How long the force must hold before the press counts.
    pub dwell: Duration,
    /// How long after a release no new press counts.
    pub lockout: Duration,
    /// What takes the place of `press` and `release` once the person's weight is known.
    pub share: Option<WeightShare>,
    /// What it takes besides force.
    pub guard: Guard,
}

/// Thresholds as parts of a person's weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeightShare {
    /// Part of the weight from which on the control engages.
    pub press: f32,
    /// Part of the weight below which it lets go; less than `press`.
    pub release: f32,
}

/// Force below which no press can be told from a foot that rests beside the control.
const LEAST_PRESS: Newtons = Newtons(10.0);

impl Thresholds {
    /// Absolute thresholds with a dwell and a lockout of 20 ms, unguarded.
    #[must_use]
    pub const fn new(press: Newtons, release: Newtons) -> Self {
        let brief = Duration::from_millis(20);
        Self { press, release, dwell: brief, lockout: brief, share: None, guard: Guard::Free }
    }

    /// The same for a person of this weight: shares turned into newtons.
    ///
    /// `press` and `release` stay as they are where there are no shares, or
    /// while the weight is not known (`None`, or no positive number). A press
    /// never takes less than 10 N.
    #[must_use]
    pub fn for_weight(self, weight: Option<Newtons>) -> Self {
        match (self.share, weight) {
            (Some(share), Some(weight)) if weight.is_finite() && weight > Newtons::ZERO => {
                let press = (weight * share.press).max(LEAST_PRESS);
                Self { press, release: press * (share.release / share.press), ..self }
            }
            _ => self,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_follow_the_weight_and_fall_back_on_newtons() {
        let shared = Thresholds {
            share: Some(WeightShare { press: 0.1, release: 0.06 }),
            ..Thresholds::new(Newtons(60.0), Newtons(40.0))
        };
        let at = |weight| {
            let at = shared.for_weight(weight);
            (at.press.0.round(), at.release.0.round())
        };
        assert_eq!(at(None), (60.0, 40.0));
        assert_eq!(at(Some(Newtons(900.0))), (90.0, 54.0));
        // A child of 5 kg: 10 N is as light as a press may be.
        assert_eq!(at(Some(Newtons(50.0))), (10.0, 6.0));
        for nonsense in [0.0, -700.0, f32::NAN, f32::INFINITY] {
            assert_eq!(at(Some(Newtons(nonsense))), (60.0, 40.0));
        }
        let absolute = Thresholds::new(Newtons(60.0), Newtons(40.0));
        assert_eq!(absolute.for_weight(Some(Newtons(900.0))), absolute);
    }
}
