//! Random combinations of faults.

use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::{Bursts, LinkFaults, Outage, Stall};
use crate::units::Instant;

/// Average time between two events.
const EVERY: Duration = Duration::from_secs(4);

/// Maximum duration of an event: a floor counts as lost after 0.1 s and as back after 1 s, so events fall on both
/// sides of these limits.
const LONGEST: Duration = Duration::from_secs(2);

impl LinkFaults {
    /// Losses, duplicates, delays and damage with random shares all the time, and every few seconds of `length` an
    /// outage, a frozen board or a stall, on a floor of `boards` boards (with 0, no event affects a single board).
    /// The same seed gives the same faults.
    #[must_use]
    pub fn nemesis(seed: u64, length: Duration, boards: u16) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let mut share = |most: f64| if rng.random::<bool>() { most * rng.random::<f64>() } else { 0.0 };
        let mut faults = Self {
            loss: share(0.2),
            duplicate: share(0.3),
            delay: share(0.3),
            delay_up_to: Duration::from_millis(30),
            damage: share(0.02),
            ..Self::default()
        };
        if rng.random::<bool>() {
            let length = Duration::from_millis(rng.random_range(5..95));
            faults.bursts =
                Some(Bursts { every: length + Duration::from_millis(rng.random_range(200..2000)), length });
        }
        let mut at = Instant::START;
        loop {
            at = at + EVERY.mul_f64(2.0 * rng.random::<f64>());
            if at >= Instant::START + length {
                return faults;
            }
            // Short ones are as likely as long ones.
            let lasting = LONGEST.mul_f64(rng.random::<f64>().powi(3)).max(Duration::from_millis(1));
            let until = at + lasting;
            let board = (boards > 0 && rng.random::<bool>()).then(|| rng.random_range(0..boards));
            match rng.random_range(0..3) {
                0 => faults.outages.push(Outage { board, from: at, until }),
                1 => faults.frozen.push(Outage { board, from: at, until }),
                _ => faults.stalls.push(Stall { from: at, until }),
            }
            at = until;
        }
    }
}
