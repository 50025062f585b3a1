//! Impulses with a width, struck as series of short ones.

use std::f64::consts::TAU;

use arrayvec::ArrayVec;

use super::{Impulse, MAX_MODES, ModalBank, Mode};

/// Maximum time between two impulses of a push, in seconds: a quarter of the fastest mode's period.
const SPACING_S: f32 = 0.000_25;

/// Minimum number of impulses of a push that has a width.
const FEWEST: usize = 6;

/// Maximum number of pushes under way on one channel; a further one is struck as an ideal impulse.
const MAX_PUSHES: usize = 8;

/// Maximum gain of a push that keeps the level of its strongest mode; a push much wider than that mode's period could
/// not do it at any gain.
const STRONGEST: f32 = 4.0;

/// The pushes that strike one modal bank: an impulse with a width is a row of small ones.
///
/// # Real-time
/// No allocation.
#[derive(Clone, Debug)]
pub(super) struct Pushes {
    sample_rate: f32,
    under_way: ArrayVec<Push, MAX_PUSHES>,
}

/// A push under way.
#[derive(Clone, Debug)]
struct Push {
    /// With the amplitudes of an ideal impulse.
    modes: ArrayVec<Mode, MAX_MODES>,
    round: f32,
    gain: f32,
    count: usize,
    done: usize,
    /// Samples between two impulses; the place of an impulse is this times the number of impulses before it.
    spacing: f32,
    /// Samples since the first impulse.
    age: usize,
}

impl Pushes {
    pub(super) fn new(sample_rate: f32) -> Self {
        Self { sample_rate, under_way: ArrayVec::new() }
    }

    /// Whether no push is under way.
    pub(super) fn is_empty(&self) -> bool {
        self.under_way.is_empty()
    }

    /// Ends all pushes at once.
    pub(super) fn clear(&mut self) {
        self.under_way.clear();
    }

    /// Strikes playable modes; the very next sample is the first to move. Returns the number of modes stolen.
    pub(super) fn strike(
        &mut self,
        bank: &mut ModalBank,
        modes: &ArrayVec<Mode, MAX_MODES>,
        impulse: Impulse,
    ) -> u32 {
        let width_s = if impulse.width_s > 0.0 { impulse.width_s.min(Impulse::WIDEST_S) } else { 0.0 };
        if width_s * self.sample_rate < 2.0 || self.under_way.is_full() {
            return strike_all(bank, modes, 1.0);
        }
        let count = ((width_s / SPACING_S).ceil() as usize).max(FEWEST);
        let round = if impulse.round > 0.0 { impulse.round.min(1.0) } else { 0.0 };
        let spacing = width_s * self.sample_rate / count as f32;
        let gain = evened(modes, round, count, f64::from(width_s));
        let mut push = Push { modes: modes.clone(), round, gain, count, done: 0, spacing, age: 0 };
        let stolen = push.strike(bank);
        self.under_way.push(push);
        stolen
    }

    /// Adds the bank's next `out.len()` samples to `out`; returns the number of modes stolen meanwhile.
    pub(super) fn render(&mut self, bank: &mut ModalBank, out: &mut [f32]) -> u32 {
        let (mut rest, mut stolen) = (out, 0);
        while !self.under_way.is_empty() && !rest.is_empty() {
            let next = self.under_way.iter().map(Push::wait).min().unwrap_or(0);
            let now = next.min(rest.len());
            let (part, later) = std::mem::take(&mut rest).split_at_mut(now);
            bank.render(part);
            rest = later;
            let passed = part.len();
            self.under_way.retain(|push| {
                push.age += passed;
                while push.done < push.count && push.wait() == 0 {
                    stolen += push.strike(bank);
                }
                push.done < push.count
            });
        }
        bank.render(rest);
        stolen
    }
}

impl Push {
    /// Samples until the next impulse.
    fn wait(&self) -> usize {
        ((self.spacing * self.done as f32).round() as usize).saturating_sub(self.age)
    }

    fn strike(&mut self, bank: &mut ModalBank) -> u32 {
        let weight = self.gain * weight(self.done, self.count, self.round);
        self.done += 1;
        strike_all(bank, &self.modes, weight)
    }
}

/// Share of impulse number `n` of `count` in a push, `(1 - round + round * 30 u^2 (1 - u)^2) / count` with `u = (n +
/// 0.5) / count`; the shares add up to 1 (except for rounding).
fn weight(n: usize, count: usize, round: f32) -> f32 {
    let u = (n as f32 + 0.5) / count as f32;
    let bell = 30.0 * u * u * (1.0 - u) * (1.0 - u);
    (1.0 - round + round * bell) / count as f32
}

/// Gain at which the strongest mode of a push is struck as by an ideal impulse.
fn evened(modes: &ArrayVec<Mode, MAX_MODES>, round: f32, count: usize, width_s: f64) -> f32 {
    let strongest = modes.iter().max_by(|a, b| a.amplitude.abs().total_cmp(&b.amplitude.abs()));
    let hz = strongest.map_or(0.0, |mode| f64::from(mode.frequency_hz));
    let (s, c) = (TAU * hz * width_s / count as f64).sin_cos();
    let (mut turned, mut sum) = ((1.0, 0.0), (0.0, 0.0));
    for n in 0..count {
        let weight = f64::from(weight(n, count, round));
        sum = (sum.0 + weight * turned.0, sum.1 + weight * turned.1);
        turned = (turned.0 * c - turned.1 * s, turned.0 * s + turned.1 * c);
    }
    (sum.0.hypot(sum.1).recip() as f32).min(STRONGEST)
}

fn strike_all(bank: &mut ModalBank, modes: &ArrayVec<Mode, MAX_MODES>, weight: f32) -> u32 {
    let mut stolen = 0;
    for mode in modes {
        stolen += u32::from(bank.strike(mode.frequency_hz, mode.decay_s, mode.amplitude * weight));
    }
    stolen
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 96_000.0;

    fn mode(frequency_hz: f32, amplitude: f32) -> Mode {
        Mode { frequency_hz, decay_s: 0.05, amplitude }
    }

    fn struck(modes: &[Mode], impulse: Impulse, block: usize) -> Vec<f32> {
        let (mut bank, mut pushes) = (ModalBank::new(RATE, 8), Pushes::new(RATE as f32));
        pushes.strike(&mut bank, &modes.iter().copied().collect(), impulse);
        let mut out = vec![0.0; 9600];
        out.chunks_mut(block).for_each(|part| {
            pushes.render(&mut bank, part);
        });
        out
    }

    fn peak(samples: &[f32]) -> f32 {
        samples.iter().fold(0.0, |peak, x| peak.max(x.abs()))
    }

    #[test]
    fn a_push_of_no_time_is_an_impulse() {
        let modes = [mode(200.0, 1.0), mode(500.0, 0.5)];
        let mut bank = ModalBank::new(RATE, 8);
        for mode in &modes {
            bank.strike(mode.frequency_hz, mode.decay_s, mode.amplitude);
        }
        let mut out = vec![0.0; 9600];
        bank.render(&mut out);
        assert_eq!(struck(&modes, Impulse::default(), 9600), out);
    }

    /// The bell's transform at 1/width is known: 30 u^2 (1-u)^2 turned once is -0.3.
    #[test]
    fn a_soft_push_keeps_the_strongest_mode_and_hardly_strikes_the_fast_ones() {
        let bell = Impulse { width_s: 0.002, round: 1.0 };
        let (slow, fast) = (mode(100.0, 1.0), mode(900.0, 0.5));
        let ideal = struck(&[slow], Impulse::default(), 9600);
        let soft = struck(&[slow], bell, 9600);
        let difference = (peak(&soft[480..]) / peak(&ideal[480..]) - 1.0).abs();
        assert!(difference < 0.03, "the strongest mode is as strong as ever: {difference}");
        let alone = struck(&[fast], Impulse::default(), 9600);
        let with = struck(&[slow, fast], bell, 9600);
        let rest: Vec<f32> = with.iter().zip(&soft).map(|(a, b)| a - b).collect();
        assert!(peak(&rest[480..]) < 0.35 * peak(&alone[480..]), "the fast one is not");
    }

    #[test]
    fn it_begins_at_once_and_does_not_depend_on_the_block() {
        let modes = [mode(150.0, 1.0), mode(420.0, -0.5)];
        for round in [0.0, 0.5, 1.0] {
            let impulse = Impulse { width_s: 0.003, round };
            let whole = struck(&modes, impulse, 9600);
            assert_ne!(whole[0], 0.0);
            for block in [1, 7, 64] {
                let cut = struck(&modes, impulse, block);
                let worst = whole.iter().zip(&cut).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(worst < 1e-5, "{worst} in blocks of {block}");
            }
        }
    }

    #[test]
    fn many_pushes_at_once_are_all_felt_and_end() {
        let (mut bank, mut pushes) = (ModalBank::new(RATE, 8), Pushes::new(RATE as f32));
        let modes = [mode(200.0, 0.1)].into_iter().collect();
        for _ in 0..20 {
            pushes.strike(&mut bank, &modes, Impulse { width_s: 0.01, round: 1.0 });
        }
        let mut out = vec![0.0; 96_000];
        out.chunks_mut(64).for_each(|part| {
            pushes.render(&mut bank, part);
        });
        assert!(peak(&out) > 1.0);
        assert!(bank.is_silent() && pushes.is_empty());
    }
}
