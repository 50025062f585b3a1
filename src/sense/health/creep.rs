//! Corrects the creep of sensors: a reading goes on growing under a steady force, and a part of it remains
//! afterwards.
//!
//! Force-sensing resistors creep by some per cent for each decade of time. Under a foot that hardly matters; but
//! after it leaves, the remainder looks like a light foot that stays, for seconds. A sensor that creeps by the share
//! c of its load for each decade reads c m more than it should, where m is the sum of the load's exponential averages
//! over a tenth of a second, one, ten and a hundred seconds. Feet that leave tiles show the value of c: it is the
//! remaining reading over m, measured shortly afterwards and a second later. A foot's load that goes on resting there
//! does not decay like m, and feet that come and go cause jumps: both are excluded.

use multiversion::multiversion;

/// Time constants of the load averages (s): a decade apart.
const TIMES_S: [f32; 4] = [0.1, 1.0, 10.0, 100.0];

/// Minimum load average of a tile, its sensors together, that shows their creep (N).
const TELLS_N: f32 = 60.0;

/// Maximum remaining reading of a tile due to creep, as a share of its load average; more is load.
const MOST: f32 = 0.12;

/// Creep below which sensors count as free of it, and above which the cause is another one, as shares for each decade
/// (the maker's figure for the usual part is 0.05).
const LEAST: f32 = 0.02;
const WORST: f32 = 0.1;

/// Times after a foot has left a tile at which the remaining reading is examined (s), and maximum relative difference
/// between the two looks.
const LOOKS_S: [f32; 2] = [0.25, 1.0];
const ALIKE: f32 = 0.25;

/// Maximum ratio of the load average at the second look to that at the first: on a tile that was loaded for minutes
/// it decays so little that a resting load would look alike.
const FADED: f32 = 0.75;

/// Maximum change of the remaining reading from one block to the next (N, and as a share): creep decays, it never
/// jumps.
const JUMP_N: f32 = 1.0;
const JUMP: f32 = 0.2;

/// Step of the estimate for each foot, additional step for the first one, and the quantile of the feet that it
/// tracks. One foot alone proves nothing.
const STEP: f32 = 0.004;
const FIRST: f32 = 0.045;
const QUANTILE: f32 = 0.4;

/// Rate (1/s) at which the creep correction is applied: a standing person must not notice a step.
const EASE: f32 = 0.01;

/// Load whose remainder is negligible (N).
const NOTHING_N: f32 = 0.5;

/// Creep of a floor's sensors, as far as known.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Creep {
    /// Estimated share of a load for each decade.
    share: f32,
    /// Share in use for the correction.
    used: f32,
    /// Number of feet in the estimate.
    feet: f32,
}

/// Load averages of the sensors of one tile.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LoadAverages {
    loads: [[f32; 4]; TIMES_S.len()],
    /// Whether any average is above zero.
    was_loaded: bool,
    left: Left,
}

/// The remaining reading of a tile that a foot has left.
#[derive(Clone, Copy, Debug, Default)]
struct Left {
    /// Time since (s).
    seconds: f32,
    /// Present reading of the tile (N).
    reads: f32,
    /// Reading at the first look, and the load average then (N).
    first: (f32, f32),
}

impl Left {
    /// The remaining share of `memory`, once it is known: when the second look agrees with the first.
    fn look(&mut self, reads: f32, memory: f32, seconds: f32) -> Option<f32> {
        let jumps = (reads - self.reads).abs() > JUMP_N + JUMP * self.reads.abs();
        self.reads = reads;
        if jumps {
            self.seconds = 0.0;
            return None;
        }
        let before = self.seconds;
        self.seconds += seconds;
        let is_now = |look: f32| before < look && self.seconds >= look;
        if is_now(LOOKS_S[0]) {
            self.first = (reads, memory);
        }
        let (lingered, lingers) = (self.first.0 / self.first.1, reads / memory);
        let is_alike = (lingers - lingered).abs() < ALIKE * lingered.abs() || lingers.max(lingered) < LEAST;
        (is_now(LOOKS_S[1]) && memory < FADED * self.first.1 && is_alike).then_some(lingers)
    }
}

/// Gain of each load average over some time: 1 − exp(−dt/τ).
#[derive(Clone, Copy, Debug)]
pub(super) struct AverageGains([f32; TIMES_S.len()]);

impl AverageGains {
    /// The gains over `dt` seconds.
    pub(super) fn of(dt: f32) -> Self {
        Self(TIMES_S.map(|time_s| 1.0 - (-dt / time_s).exp()))
    }
}

impl Creep {
    /// Updates the estimate with the sum of a tile's readings, without creep correction, `seconds` after the last
    /// look.
    pub(super) fn learn(&mut self, memory: &mut LoadAverages, reads: f32, seconds: f32) {
        let whole: f32 = memory.sums().iter().sum();
        if whole < TELLS_N || reads.abs() > MOST * whole {
            memory.left = Left::default();
            return;
        }
        let Some(lingers) = memory.left.look(reads, whole, seconds) else { return };
        let less = lingers < self.share;
        self.feet += 1.0;
        let step = STEP + FIRST / self.feet;
        self.share += step * if less { QUANTILE - 1.0 } else { QUANTILE };
        self.share = self.share.clamp(0.0, WORST);
    }

    /// Moves the correction towards the estimate over `dt` seconds.
    pub(super) fn ease(&mut self, dt: f32) {
        let aim = if self.share < LEAST { 0.0 } else { self.share };
        self.used += (aim - self.used).clamp(-EASE * dt, EASE * dt);
    }

    /// Estimated share of a load for each decade.
    pub(super) const fn share(&self) -> f32 {
        self.share
    }

    /// Updates the load averages of some connected tiles with their `forces` over the time of these `parts`, and
    /// writes the creep of each sensor to `crept` (N).
    pub(super) fn follow(
        &self,
        parts: &AverageGains,
        forces: &[[f32; 4]],
        connected: &[bool],
        memories: &mut [LoadAverages],
        crept: &mut [[f32; 4]],
    ) {
        follow(self.used, parts, forces, connected, memories, crept);
    }
}

/// [`Creep::follow`] for sensors with a creep of `share`, compiled for each vector instruction set.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw+avx512dq", "x86_64+avx2", "aarch64+neon"))]
fn follow(
    share: f32,
    parts: &AverageGains,
    forces: &[[f32; 4]],
    connected: &[bool],
    memories: &mut [LoadAverages],
    crept: &mut [[f32; 4]],
) {
    let tiles = memories.iter_mut().zip(crept).zip(forces.iter().zip(connected));
    for ((memory, crept), (forces, connected)) in tiles {
        if *connected && memory.follow(*forces, parts) {
            *crept = memory.sums().map(|sum| share * sum);
        }
    }
}

impl LoadAverages {
    /// Updates the averages with these forces, m += gain (F − m); returns whether any may have changed.
    #[inline(always)]
    fn follow(&mut self, forces: [f32; 4], AverageGains(parts): &AverageGains) -> bool {
        if !self.was_loaded && forces.iter().fold(true, |none, &force| none & (force < NOTHING_N)) {
            return false;
        }
        let pressed = forces.map(|force| force.max(0.0));
        for (loads, part) in self.loads.iter_mut().zip(parts) {
            for (load, force) in loads.iter_mut().zip(pressed) {
                *load += part * (force - *load);
            }
        }
        self.was_loaded = self.loads.as_flattened().iter().fold(false, |any, &load| any | (load > NOTHING_N));
        if !self.was_loaded {
            self.loads = Default::default();
        }
        true
    }

    /// Sum of each sensor's load averages (N).
    #[inline(always)]
    fn sums(&self) -> [f32; 4] {
        std::array::from_fn(|corner| self.loads.iter().map(|loads| loads[corner]).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Feet of 150 N per sensor step on a tile for a second and leave it for two, `times`; returns the remaining
    /// apparent load of a sensor that creeps by `creep`, and the largest error under the last foot.
    fn walked_over(creep: f32, times: u32, left_n: f32) -> (f32, f32) {
        let (mut known, mut memory, mut truth) =
            (Creep::default(), LoadAverages::default(), LoadAverages::default());
        let parts = AverageGains::of(0.008);
        let (mut after, mut worst) = (0.0, 0.0_f32);
        for step in 0..times * 375 {
            let force = if step % 375 < 125 { 150.0 } else { left_n };
            truth.follow([force; 4], &parts);
            let reads = force + creep * truth.sums()[0];
            let off = known.used * memory.sums()[0];
            memory.follow([reads - off; 4], &parts);
            known.ease(0.008);
            if step % 8 == 0 {
                known.learn(&mut memory, 4.0 * reads, 0.064);
            }
            let error = reads - off - force;
            if step % 375 == 160 {
                after = error;
            }
            if step >= (times - 1) * 375 && step % 375 < 125 {
                worst = worst.max(error.abs());
            }
        }
        (after, worst)
    }

    #[test]
    fn what_lingers_after_a_foot_is_learnt_and_taken_off() {
        let (before, _) = walked_over(0.05, 1, 0.0);
        assert!(
            before > 4.0,
            "a quarter of a second later {before} N on each of four sensors look like a foot"
        );
        let (after, under) = walked_over(0.05, 40, 0.0);
        assert!(after.abs() < 1.0 && under < 5.0, "{after} N after and {under} N under the last foot");
    }

    #[test]
    fn nothing_is_taken_off_sensors_that_do_not_creep() {
        assert_eq!(walked_over(0.0, 40, 0.0), (0.0, 0.0));
        // A foot that presses and then rests there with a twentieth of that, repeatedly.
        assert_eq!(walked_over(0.0, 40, 7.5), (0.0, 0.0));
    }

    /// The estimate for a sensor that does not creep, on a tile that carries `load(seconds)` newtons.
    fn learnt_under(load: impl Fn(f32) -> f32, seconds: usize) -> f32 {
        let (mut known, mut memory) = (Creep::default(), LoadAverages::default());
        let parts = AverageGains::of(0.008);
        for step in 0..seconds * 125 {
            let force = load(step as f32 * 0.008);
            memory.follow([force; 4], &parts);
            if step % 8 == 0 {
                known.learn(&mut memory, 4.0 * force, 0.064);
            }
        }
        known.share()
    }

    #[test]
    fn a_busy_tile_on_which_light_feet_rest_or_come_and_go_teaches_nothing() {
        // On a tile that is loaded for minutes the average hardly decays within a second, and neither does a resting
        // load.
        let rests = |at: f32| if at % 60.0 < 57.0 { 150.0 } else { 20.0 };
        assert_eq!(learnt_under(rests, 600), 0.0);
        // After a heavy foot a light one taps twice, the second time lighter by the decay of creep.
        let steps = |at: f32| match at % 3.0 {
            ..1.0 => 150.0,
            1.15..1.35 => 6.0,
            1.85..2.15 => 3.0,
            _ => 0.0,
        };
        assert_eq!(learnt_under(steps, 600), 0.0);
    }
}
