//! The force thresholds of a press.

use std::time::Duration;

use super::Guard;
use super::stage::Stage;
use crate::units::Newtons;
use underfoot_format::number::plain;
use underfoot_format::{Faults, Num, OneOf, num, record};

/// Range of a dwell or lockout.
const BRIEF: Num = num(0.0..=2000.0).milli();

record! {
    /// The force thresholds of a press.
    pub struct Thresholds = "Thresholds", Copy => Thresholds::rules;
    /// Force above which the control engages: a press below 10 N looks the same as a foot resting beside the control,
    /// one above 1000 N is a jump.
    pub press: Newtons = "press_n", num(10.0..=1000.0);
    /// Force below which it releases; less than `press`.
    pub release: Newtons = "release_n", num(1.0..=1000.0);
    /// Time for which the force must hold before the press counts.
    pub dwell: Duration = "dwell_ms", BRIEF => Duration::from_millis(20);
    /// Time after a release in which no new press counts.
    pub lockout: Duration = "lockout_ms", BRIEF => Duration::from_millis(20);
    /// Shares of the person's weight that replace `press` and `release` once the weight is known.
    pub share: Option<WeightShare> = "press_share", SHARE => None;
    /// The condition besides force.
    pub guard: Guard = "guard", OneOf => Guard::Free;
}

/// Shares of a person's weight; twice the weight is a jump.
const SHARE: Stage = Stage {
    press: num(0.01..=2.0),
    release: num(0.005..=2.0),
    names: ["press_share", "release_share"],
    about: "Part of the weight below which it lets go; less than `press_share`.",
    follows: TWO_THIRDS,
    lonely: "parts of the person's weight come in pairs",
};

/// Thresholds as shares of a person's weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeightShare {
    /// Share of the weight above which the control engages.
    pub press: f32,
    /// Share of the weight below which it releases; less than `press`.
    pub release: f32,
}

impl From<[f32; 2]> for WeightShare {
    fn from([press, release]: [f32; 2]) -> Self {
        Self { press, release }
    }
}

impl From<WeightShare> for [f32; 2] {
    fn from(share: WeightShare) -> Self {
        [share.press, share.release]
    }
}

/// Ratio of release to press force above which sway alone causes a release.
const RELEASE_SHARE: f32 = 0.8;

/// Default release threshold, as a share of the press threshold.
const TWO_THIRDS: f32 = 0.67;

/// Force below which a press looks the same as a foot that rests beside the control.
const LEAST_PRESS: Newtons = Newtons(10.0);

impl Thresholds {
    fn rules(&mut self, faults: &mut Faults) {
        check_hysteresis(faults, &["release_n", "press_n"], [self.release.0, self.press.0], " N");
        if let Some(WeightShare { press, release }) = self.share {
            check_hysteresis(faults, &["release_share", "press_share"], [release, press], "");
        }
    }

    /// Absolute thresholds with a dwell and a lockout of 20 ms, unguarded.
    #[must_use]
    pub const fn new(press: Newtons, release: Newtons) -> Self {
        let brief = Duration::from_millis(20);
        Self { press, release, dwell: brief, lockout: brief, share: None, guard: Guard::Free }
    }

    /// The thresholds for a person of this weight: shares converted to newtons.
    ///
    /// `press` and `release` stay without shares, or while the weight is unknown (`None`, or not positive). A press
    /// threshold is at least 10 N.
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

fn check_hysteresis(
    faults: &mut Faults,
    names: &'static [&'static str; 2],
    [release, press]: [f32; 2],
    unit: &str,
) {
    let [release_name, press_name] = names;
    let shown = |force: f32| plain(force.into());
    let found = format!("{press_name} is {}{unit}, {release_name} is {}{unit}", shown(press), shown(release));
    let digits = if unit.is_empty() { 1000.0 } else { 1.0 };
    let good = shown((TWO_THIRDS * press * digits).round() / digits);
    if release >= press {
        faults.error(names, format!("`{release_name}` must be below `{press_name}`"), found);
    } else if release > RELEASE_SHARE * press {
        let message = format!("`{release_name}` is so close to `{press_name}` that a swaying foot chatters");
        faults.warning(names, message, found);
    } else {
        return;
    }
    faults.help(format!("two thirds of {press_name} are a good start: {release_name}: {good}"));
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
        // A child of 5 kg: 10 N is the minimum of a press.
        assert_eq!(at(Some(Newtons(50.0))), (10.0, 6.0));
        for nonsense in [0.0, -700.0, f32::NAN, f32::INFINITY] {
            assert_eq!(at(Some(Newtons(nonsense))), (60.0, 40.0));
        }
        let absolute = Thresholds::new(Newtons(60.0), Newtons(40.0));
        assert_eq!(absolute.for_weight(Some(Newtons(900.0))), absolute);
    }
}
