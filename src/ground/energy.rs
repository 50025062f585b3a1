//! A power law of energies.

use underfoot_format::{Num, num, record};

/// Range of the energies of single events.
const JOULES: Num = num(0.0001..=1000.0);

record! {
    /// The distribution of the energies of single events: a power law on a bounded range.
    ///
    /// # Source
    /// `p(E) ~ E^gamma` (paper, section 4.1.1), here between a least and a greatest energy: the energy of a footstep
    /// is limited, and events too weak to be felt are left out. Drawn by the inverse of the distribution function.
    pub struct EnergyLaw = "Energy", Copy => |it, faults| {
        faults.not_below(&["most_j", "least_j"], [it.most_j, it.least_j]);
    };
    /// The exponent; below zero, small events are more frequent than large ones.
    pub gamma: f32 = "gamma", num(-5.0..=5.0);
    /// The minimum energy, in joules; positive.
    pub least_j: f32 = "least_j", JOULES;
    /// The maximum energy, in joules; at least the minimum.
    pub most_j: f32 = "most_j", JOULES;
}

impl EnergyLaw {
    /// The energy below which a share `u` (0 to 1) of all events lies, in joules.
    #[must_use]
    pub fn quantile(&self, u: f64) -> f64 {
        let (least, most) = self.range();
        let u = u.clamp(0.0, 1.0);
        let power = f64::from(self.gamma) + 1.0;
        let energy = if power.abs() < 1e-6 {
            least * (most / least).powf(u)
        } else {
            // In units of the minimum energy, so that no power overflows.
            least * (1.0 + u * ((most / least).powf(power) - 1.0)).powf(power.recip())
        };
        energy.clamp(least, most)
    }

    /// The share of all events with at most `energy_j`, 0 to 1.
    #[must_use]
    pub fn share_below(&self, energy_j: f64) -> f64 {
        let (least, most) = self.range();
        let energy = energy_j.clamp(least, most) / least;
        let power = f64::from(self.gamma) + 1.0;
        let share = if power.abs() < 1e-6 {
            energy.ln() / (most / least).ln()
        } else {
            (energy.powf(power) - 1.0) / ((most / least).powf(power) - 1.0)
        };
        // An empty range.
        if share.is_nan() { 1.0 } else { share }
    }

    fn range(&self) -> (f64, f64) {
        let least = f64::from(self.least_j);
        (least, f64::from(self.most_j).max(least))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_and_shares_undo_each_other_for_any_exponent() {
        for gamma in [-4.0, -2.0, -1.5, -1.000_000_1, -1.0, -0.5, 0.0, 2.0] {
            let law = EnergyLaw { gamma, least_j: 0.1, most_j: 2.5 };
            for step in 0..=20 {
                let u = f64::from(step) / 20.0;
                let back = law.share_below(law.quantile(u));
                assert!((back - u).abs() < 1e-5, "gamma {gamma}: {u} came back as {back}");
            }
            let (ends, range) = ([law.quantile(0.0), law.quantile(1.0)], [0.1, 2.5]);
            assert!(ends.iter().zip(range).all(|(end, wanted)| (end - wanted).abs() < 1e-6), "{ends:?}");
        }
    }

    #[test]
    fn a_range_without_extent_has_one_energy() {
        let single = EnergyLaw { gamma: -1.5, least_j: 0.3, most_j: 0.3 };
        assert!((single.quantile(0.5) - 0.3).abs() < 1e-6 && single.share_below(0.3) == 1.0);
    }
}
