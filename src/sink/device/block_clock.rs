//! Start times of blocks on the clock of the cues: a delay-locked loop.

#![deny(clippy::disallowed_macros, clippy::disallowed_methods, clippy::disallowed_types)]

use std::f64::consts::{SQRT_2, TAU};

use crate::units::Instant;

/// Bandwidth of the settled loop, in hertz: slow enough that a late wake-up hardly moves it, fast enough to follow
/// crystals as they warm up.
const BANDWIDTH_HZ: f64 = 0.2;

/// Bandwidth at the start, with which the loop settles within a second.
const FIRST_BANDWIDTH_HZ: f64 = 4.0;

/// Error in microseconds above which the loop restarts: the device dropped blocks, since no callback is this late.
const JUMP_US: f64 = 20_000.0;

/// Limit on an error in microseconds: a later callback contains no information on the period.
const LATEST_US: f64 = 1_000.0;

/// A shift: at least `SHIFT_BLOCKS` blocks in a row with an error above `SHIFT_US` microseconds on the same side. The
/// device has dropped samples; a late wake-up affects fewer blocks.
const SHIFT_US: f64 = 300.0;
const SHIFT_BLOCKS: u32 = 16;

/// Maximum relative difference in speed between the two clocks: crystals are within 200 ppm.
const MOST_DRIFT: f64 = 1e-3;

/// Estimates the start of each block of a device on another clock, from the times at which its callbacks ran.
///
/// Callbacks are late by a varying time, while blocks follow each other evenly. A delay-locked loop of second order
/// finds the even period in the uneven calls, and follows the slow drift between the two clocks without lag.
///
/// # Source
/// F. Adriaensen, "Using a DLL to filter time", Linux Audio Conference 2005: with `w = 2 pi B T`, the next time moves
/// by `sqrt(2) w e` and the period by `w^2 e` of each error `e`. This one begins with a wider band, takes blocks of
/// any length, and limits large errors.
#[derive(Debug, Default)]
pub(super) struct BlockClock {
    lock: Option<Lock>,
}

#[derive(Debug)]
struct Lock {
    /// Predicted start of the next block, in microseconds.
    next_us: f64,
    /// Microseconds of the other clock per microsecond of the device's.
    speed: f64,
    /// Time locked so far, in seconds.
    age_s: f64,
    /// Number of blocks in a row with an error on the same side, and the smallest of these errors in microseconds.
    off: u32,
    off_us: f64,
}

impl BlockClock {
    /// Returns the start of the block of `frames` frames with the measured start `measured`.
    pub(super) fn start_of_block(&mut self, measured: Instant, frames: usize, sample_rate: u32) -> Instant {
        let measured_us = measured.micros() as f64;
        let length_us = frames as f64 * 1e6 / f64::from(sample_rate.max(1));
        let Some(lock) = self.lock.as_mut().filter(|lock| (measured_us - lock.next_us).abs() < JUMP_US)
        else {
            self.lock =
                Some(Lock { next_us: measured_us + length_us, speed: 1.0, age_s: 0.0, off: 0, off_us: 0.0 });
            return measured;
        };
        lock.follow_shift(measured_us - lock.next_us);
        let error_us = (measured_us - lock.next_us).clamp(-LATEST_US, LATEST_US);
        let start_us = lock.next_us;
        let bandwidth_hz = BANDWIDTH_HZ.max(FIRST_BANDWIDTH_HZ / (1.0 + lock.age_s * FIRST_BANDWIDTH_HZ));
        let omega = TAU * bandwidth_hz * length_us * 1e-6;
        lock.next_us += SQRT_2 * omega * error_us + length_us * lock.speed;
        if length_us > 0.0 {
            let speed = lock.speed + omega * omega * error_us / length_us;
            lock.speed = speed.clamp(1.0 - MOST_DRIFT, 1.0 + MOST_DRIFT);
        }
        lock.age_s += length_us * 1e-6;
        Instant::from_micros(start_us.round() as u64)
    }

    /// Restarts with the next block.
    pub(super) fn forget(&mut self) {
        self.lock = None;
    }
}

impl Lock {
    /// Corrects a permanent error: an underrun has moved all later blocks.
    fn follow_shift(&mut self, error_us: f64) {
        if error_us.abs() < SHIFT_US {
            self.off = 0;
            return;
        }
        if self.off == 0 || error_us.signum() != self.off_us.signum() {
            (self.off, self.off_us) = (0, error_us);
        }
        self.off += 1;
        if error_us.abs() < self.off_us.abs() {
            self.off_us = error_us;
        }
        if self.off >= SHIFT_BLOCKS {
            self.next_us += self.off_us;
            self.off = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use rand_pcg::Pcg64Mcg;
    use rand_pcg::rand_core::{Rng, SeedableRng};

    use super::*;

    /// 64 frames at 96 kHz on a sound card 100 ppm fast: returns the error of each estimate in the last 20 of 30
    /// seconds; each call is late by the value of `late_us` for a number from 0 to 1.
    fn errors(mut late_us: impl FnMut(u32, f64) -> f64) -> Vec<f64> {
        let mut random = Pcg64Mcg::seed_from_u64(1);
        let mut clock = BlockClock::default();
        let block_us = 64.0 * 1e6 / 96_000.0 * (1.0 - 1e-4);
        let blocks = 45_000;
        let mut errors = Vec::new();
        for n in 0..blocks {
            let chance = f64::from(random.next_u32()) / f64::from(u32::MAX);
            let truth = 1e6 + f64::from(n) * block_us;
            let now = Instant::from_micros((truth + late_us(n, chance)).round() as u64);
            let start = clock.start_of_block(now, 64, 96_000).micros() as f64;
            if n > blocks / 3 {
                errors.push(start - truth);
            }
        }
        errors.sort_by(f64::total_cmp);
        errors
    }

    /// Distance from the 5th to the 95th percentile.
    fn spread(errors: &[f64]) -> f64 {
        errors[errors.len() * 95 / 100] - errors[errors.len() / 20]
    }

    #[test]
    fn uneven_calls_give_even_blocks_on_a_card_with_another_crystal() {
        // Up to 0.5 ms late, uniform: the mean, 0.25 ms, is part of the steady delay.
        let errors = errors(|_, chance| chance * 500.0);
        assert!((errors[errors.len() / 2] - 250.0).abs() < 15.0, "{}", errors[errors.len() / 2]);
        assert!(spread(&errors) < 30.0, "{} us", spread(&errors));
    }

    #[test]
    fn wake_ups_that_are_sometimes_very_late_hardly_move_the_period() {
        // 20 to 60 us late, and 5 ms in one of a hundred: a busy machine.
        let errors = errors(|_, chance| if chance < 0.01 { 5000.0 } else { 20.0 + 40.0 * chance });
        assert!(spread(&errors) < 15.0, "{} us", spread(&errors));
        assert!(errors[errors.len() - 1] < 120.0, "{}", errors[errors.len() - 1]);
    }

    #[test]
    fn an_underrun_moves_the_period_within_some_blocks() {
        // Every 3000 blocks (2 s) the device drops 2 ms.
        let errors = errors(|n, chance| f64::from(n / 3000) * 2000.0 + 20.0 * chance);
        let missed: Vec<f64> = errors.iter().map(|error| error.rem_euclid(2000.0)).collect();
        let far = missed.iter().filter(|error| **error > 100.0 && **error < 1900.0).count();
        assert!(far * 50 < missed.len(), "{far} of {} blocks are off", missed.len());
        // At the end the clock has followed all fourteen shifts.
        assert!((errors[errors.len() - 1] - 28_000.0).abs() < 100.0, "{}", errors[errors.len() - 1]);
    }

    #[test]
    fn punctual_calls_give_exact_blocks() {
        let errors = errors(|_, _| 0.0);
        assert!(spread(&errors) <= 2.0, "whole microseconds: {}", spread(&errors));
    }

    #[test]
    fn a_gap_is_taken_as_it_is() {
        let mut clock = BlockClock::default();
        clock.start_of_block(Instant::from_millis(100), 48, 48_000);
        let after = clock.start_of_block(Instant::from_millis(500), 48, 48_000);
        assert_eq!(after, Instant::from_millis(500));
        clock.forget();
        let anew = clock.start_of_block(Instant::from_micros(500_300), 48, 48_000);
        assert_eq!(anew, Instant::from_micros(500_300));
    }
}
