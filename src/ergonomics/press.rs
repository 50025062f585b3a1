//! Press thresholds from presses that people have just made.

use super::force::RESTING;
use crate::units::Newtons;

/// Share of the lightest press at which the threshold is put.
const SHARE: f32 = 0.5;

/// Greatest threshold that a control may have.
const MOST: Newtons = Newtons(1000.0);

/// How hard presses were.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressSpread {
    /// How many there were, at least 1.
    pub count: usize,
    /// The lightest.
    pub lowest: Newtons,
    /// A quarter was lighter than this.
    pub lower_quartile: Newtons,
    /// Half were lighter than this.
    pub median: Newtons,
    /// A quarter was harder than this.
    pub upper_quartile: Newtons,
    /// The hardest.
    pub highest: Newtons,
}

impl PressSpread {
    /// Of the peak `forces` of presses, in any order; quartiles between two of them are interpolated. `None` for none;
    /// forces that are not finite are left out.
    #[must_use]
    pub fn of(forces: &[Newtons]) -> Option<Self> {
        let mut sorted: Vec<f32> =
            forces.iter().map(|force| force.0).filter(|force| force.is_finite()).collect();
        sorted.sort_by(f32::total_cmp);
        let last = sorted.len().checked_sub(1)?;
        let at = |share: f32| {
            let place = share * last as f32;
            let below = sorted.get(place.floor() as usize).copied().unwrap_or_default();
            let above = sorted.get(place.ceil() as usize).copied().unwrap_or(below);
            Newtons(below + (above - below) * place.fract())
        };
        Some(Self {
            count: sorted.len(),
            lowest: at(0.0),
            lower_quartile: at(0.25),
            median: at(0.5),
            upper_quartile: at(0.75),
            highest: at(1.0),
        })
    }
}

/// A threshold for presses such as some that were made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressProposal {
    /// The threshold, in whole newtons.
    pub press: Newtons,
    /// Whether half of the lightest press would be less than a foot at rest bears, so that this counts instead.
    pub is_resting_force: bool,
    /// How many of the presses would be lighter than the threshold.
    pub missed: usize,
}

/// The threshold for the peak `forces` of presses that people meant: half of the lightest one, but no less than the
/// 35 N that a foot bears which only rests there (rule U202). `None` without a press.
///
/// ```
/// use underfoot::ergonomics::propose_press;
/// use underfoot::units::Newtons;
///
/// let proposal = propose_press(&[Newtons(140.0), Newtons(92.0), Newtons(110.0)]);
/// assert_eq!(proposal.map(|proposal| proposal.press), Some(Newtons(46.0)));
/// ```
///
/// # Source
/// Half is this project's choice, not a measured figure. The next press of the same people may be lighter than the
/// lightest of a few: half leaves as much below it as it is above the threshold. The lightest counts and not the
/// median, because a control that lets one person in ten press in vain is a broken one. The paper uses thresholds of
/// normal force and names none.
#[must_use]
pub fn propose_press(forces: &[Newtons]) -> Option<PressProposal> {
    let lowest = PressSpread::of(forces)?.lowest;
    let half = Newtons((SHARE * lowest.0).round());
    let press = Newtons(half.0.clamp(RESTING.0, MOST.0));
    let missed = forces.iter().filter(|force| force.is_finite() && **force < press).count();
    Some(PressProposal { press, is_resting_force: half < RESTING, missed })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn newtons<const N: usize>(forces: [f32; N]) -> [Newtons; N] {
        forces.map(Newtons)
    }

    #[test]
    fn quartiles_are_those_of_a_table() {
        // 1 to 9 in disorder, by linear interpolation: 3, 5 and 7.
        let spread = PressSpread::of(&newtons([9.0, 1.0, 8.0, 2.0, 7.0, 3.0, 6.0, 4.0, 5.0])).unwrap();
        let of = [spread.lowest, spread.lower_quartile, spread.median, spread.upper_quartile, spread.highest];
        assert_eq!((spread.count, of), (9, newtons([1.0, 3.0, 5.0, 7.0, 9.0])));
        let spread = PressSpread::of(&newtons([10.0, 20.0])).unwrap();
        assert_eq!((spread.lower_quartile, spread.median), (Newtons(12.5), Newtons(15.0)));
        assert_eq!(PressSpread::of(&newtons([f32::NAN])), None);
        assert_eq!(PressSpread::of(&[]), None);
    }

    #[test]
    fn half_of_the_lightest_but_more_than_a_foot_at_rest() {
        let press =
            |forces: &[Newtons]| propose_press(forces).map(|it| (it.press.0, it.is_resting_force, it.missed));
        assert_eq!(press(&newtons([140.0, 92.0, 110.0])), Some((46.0, false, 0)));
        // A child's 50 N: half is what a resting foot bears.
        assert_eq!(press(&newtons([50.0, 90.0])), Some((35.0, true, 0)));
        // Lighter than a resting foot: such a press can't be told from one.
        assert_eq!(press(&newtons([20.0, 90.0])), Some((35.0, true, 1)));
        assert_eq!(press(&newtons([f32::NAN, 5000.0])), Some((1000.0, false, 0)));
        assert_eq!(press(&[]), None);
    }
}
