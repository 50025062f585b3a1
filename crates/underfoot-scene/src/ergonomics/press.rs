//! Press thresholds from recorded presses.

use super::force::RESTING;
use underfoot::units::Newtons;

/// Proposed threshold as a share of the lightest press.
const SHARE: f32 = 0.5;

/// Maximum threshold of a control.
const MOST: Newtons = Newtons(1000.0);

/// Distribution of the forces of presses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressSpread {
    /// Number of presses, at least 1.
    pub count: usize,
    /// Lightest press.
    pub lowest: Newtons,
    /// Lower quartile: a quarter of the presses was lighter.
    pub lower_quartile: Newtons,
    /// Median: half of the presses were lighter.
    pub median: Newtons,
    /// Upper quartile: a quarter of the presses was harder.
    pub upper_quartile: Newtons,
    /// Hardest press.
    pub highest: Newtons,
}

impl PressSpread {
    /// Computes the distribution of the peak `forces` of presses, in any order, with interpolated quartiles. Ignores
    /// forces that are not finite; returns `None` if no force is left.
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

/// A proposed threshold for presses like the recorded ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressProposal {
    /// The threshold, in whole newtons.
    pub press: Newtons,
    /// True if half of the lightest press is less than the force of a resting foot, so that the latter is the
    /// threshold.
    pub is_resting_force: bool,
    /// Number of recorded presses lighter than the threshold.
    pub missed: usize,
}

/// Proposes a threshold from the peak `forces` of intended presses: half of the lightest one, but at least the 35 N
/// of a foot that only rests on the control (rule U202). Returns `None` without a press.
///
/// ```
/// use underfoot_scene::ergonomics::propose_press;
/// use underfoot::units::Newtons;
///
/// let proposal = propose_press(&[Newtons(140.0), Newtons(92.0), Newtons(110.0)]);
/// assert_eq!(proposal.map(|proposal| proposal.press), Some(Newtons(46.0)));
/// ```
///
/// # Source
/// Half is this project's choice, not a measured figure. The next press of the same people may be lighter than the
/// lightest of a few: half leaves as much margin below the lightest press as the threshold is above zero. The
/// lightest press counts and not the median, because a control on which one person in ten presses without effect is
/// broken. The paper uses thresholds of normal force but gives no numbers.
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
        // A child's 50 N: half of it is less than the force of a resting foot.
        assert_eq!(press(&newtons([50.0, 90.0])), Some((35.0, true, 0)));
        // Lighter than a resting foot: the threshold can't detect such a press.
        assert_eq!(press(&newtons([20.0, 90.0])), Some((35.0, true, 1)));
        assert_eq!(press(&newtons([f32::NAN, 5000.0])), Some((1000.0, false, 0)));
        assert_eq!(press(&[]), None);
    }
}
