use crate::units::Instant;

/// How fast the estimate follows what is measured: a thirtieth per block, so that a late wake-up hardly moves it.
const PULL: f64 = 0.03;

/// A measured time that is further off than this means that blocks were left out, not that one came late.
const JUMP_US: f64 = 20_000.0;

/// Estimates when each block of a device starts, on another clock, from when its callback happened to run.
///
/// Callbacks come late by a varying time; blocks follow each other evenly. A
/// delay-locked loop finds the even beat in the uneven calls, and follows the
/// slow drift between the two clocks.
#[derive(Debug, Default)]
pub(super) struct BlockClock {
    next_us: Option<f64>,
}

impl BlockClock {
    /// The start of the block of `frames` frames whose callback runs at `now`.
    pub(super) fn start_of_block(&mut self, now: Instant, frames: usize, sample_rate: u32) -> Instant {
        let measured = now.micros() as f64;
        let start = match self.next_us {
            Some(expected) if (measured - expected).abs() < JUMP_US => {
                expected + PULL * (measured - expected)
            }
            _ => measured,
        };
        self.next_us = Some(start + frames as f64 * 1e6 / f64::from(sample_rate));
        Instant::from_micros(start.round() as u64)
    }
}

#[cfg(test)]
mod tests {
    use rand_pcg::Pcg64Mcg;
    use rand_pcg::rand_core::{Rng, SeedableRng};

    use super::*;

    /// 64 frames at 96 kHz, calls up to 0.5 ms late, a sound card 100 ppm fast.
    #[test]
    fn uneven_calls_give_even_blocks() {
        let mut random = Pcg64Mcg::seed_from_u64(1);
        let mut clock = BlockClock::default();
        let block_us = 64.0 * 1e6 / 96_000.0 * (1.0 - 1e-4);
        let mut last: Option<f64> = None;
        for n in 0..5000 {
            let late = f64::from(random.next_u32()) / f64::from(u32::MAX) * 500.0;
            let now = Instant::from_micros((1e6 + f64::from(n) * block_us + late) as u64);
            let start = clock.start_of_block(now, 64, 96_000).micros() as f64;
            if n > 300 {
                let truth = 1e6 + f64::from(n) * block_us + 250.0;
                assert!((start - truth).abs() < 100.0, "block {n}: {} us off", start - truth);
                if let Some(last) = last {
                    assert!((start - last - block_us).abs() < 12.0, "block {n}: {} us", start - last);
                }
            }
            last = Some(start);
        }
    }

    #[test]
    fn a_gap_is_taken_as_it_is() {
        let mut clock = BlockClock::default();
        clock.start_of_block(Instant::from_millis(100), 48, 48_000);
        let after = clock.start_of_block(Instant::from_millis(500), 48, 48_000);
        assert_eq!(after, Instant::from_millis(500));
    }
}
