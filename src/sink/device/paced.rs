//! A clock in place of a sound card.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{Builder, JoinHandle, sleep};
use std::time::{Duration, Instant};

use cpal::{BufferSize, Error, ErrorKind, SampleFormat, SupportedBufferSize, SupportedStreamConfigRange};

use super::callback::Callback;
use super::choice::DeviceConfig;

/// The device name that selects it.
pub(super) const PACED: &str = "paced";

/// Default frames in a block and samples per second: those of a fast interface.
pub(super) const BLOCK: u32 = 64;
pub(super) const SAMPLE_RATE: u32 = 96_000;

/// Maximum number of channels: a floor of 32 x 32 tiles.
const MOST_CHANNELS: u16 = 1024;

/// All configurations that a paced clock accepts.
pub(super) fn ranges() -> Vec<SupportedStreamConfigRange> {
    let buffer = SupportedBufferSize::Range { min: 16, max: 8192 };
    (1..=MOST_CHANNELS)
        .map(|channels| SupportedStreamConfigRange::new(channels, 8_000, 192_000, buffer, SampleFormat::F32))
        .collect()
}

/// How much faster its crystal is than the machine's, in ppm: no two crystals agree, so the blocks of a real card
/// drift relative to the sensor packets. With this drift the block clock is tested too.
const CRYSTAL_PPM: u64 = 100;

/// A substitute for a sound card: a thread that requests blocks at the times of a card.
///
/// Blocks are due on an absolute schedule, however late the thread wakes up. Each block sounds from the moment when
/// the next one is due, as on a card with two buffers. A block not filled by then is an underrun.
pub(super) struct PacedStream {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl PacedStream {
    pub(super) fn start(
        choice: DeviceConfig,
        mut callback: Callback,
        mut trouble: impl FnMut(Error) + Send + 'static,
    ) -> Result<Self, Error> {
        let frames = match choice.buffer_size {
            BufferSize::Fixed(frames) => frames.max(1),
            BufferSize::Default => BLOCK,
        };
        let mut block = vec![0.0_f32; frames as usize * usize::from(choice.channels)];
        let period = Period { frames, sample_rate: choice.sample_rate };
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let work = move || {
            let begun = Instant::now();
            let mut number = 0;
            while !stopped.load(Ordering::Acquire) {
                let due = begun + period.times(number);
                sleep(due.saturating_duration_since(Instant::now()));
                let sounds = begun + period.times(number + 1);
                callback.run(&mut block, sounds.saturating_duration_since(Instant::now()));
                number += 1;
                if Instant::now() > sounds {
                    trouble(ErrorKind::Xrun.into());
                    // Like a card, it skips missed blocks and continues with the one due now.
                    number = number.max(period.passed(begun.elapsed()));
                }
            }
        };
        let thread = Builder::new().name("paced".into()).spawn(work);
        let thread = thread.map_err(|error| {
            Error::with_message(ErrorKind::ResourceExhausted, format!("no thread: {error}"))
        })?;
        Ok(Self { stop, thread: Some(thread) })
    }
}

impl Drop for PacedStream {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Release);
        if let Some(thread) = self.thread.take() {
            // The result is ignored, even after a panic.
            let _ = thread.join();
        }
    }
}

/// Nanoseconds on the machine's clock per second of the crystal.
const NANOS_OF_A_SECOND: u128 = 1_000_000_000 - (CRYSTAL_PPM * 1000) as u128;

/// The time between two blocks.
#[derive(Clone, Copy)]
struct Period {
    frames: u32,
    sample_rate: u32,
}

impl Period {
    /// Returns `number` periods, without accumulated rounding errors.
    fn times(self, number: u64) -> Duration {
        let frames = u128::from(number) * u128::from(self.frames);
        let nanos = frames * NANOS_OF_A_SECOND / u128::from(self.sample_rate.max(1));
        Duration::from_nanos(u64::try_from(nanos).unwrap_or(u64::MAX))
    }

    /// Returns the number of whole periods in `span`.
    fn passed(self, span: Duration) -> u64 {
        let frames = span.as_nanos() * u128::from(self.sample_rate) / NANOS_OF_A_SECOND;
        let blocks = frames / u128::from(self.frames.max(1));
        u64::try_from(blocks).unwrap_or(u64::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periods_do_not_drift() {
        let period = Period { frames: 64, sample_rate: 96_000 };
        assert_eq!(period.times(1), Duration::from_nanos(666_600));
        // An hour, 100 ppm fast.
        let hour = Duration::from_secs(3600) - Duration::from_millis(360);
        assert_eq!((period.times(1500 * 3600), period.passed(hour)), (hour, 1500 * 3600));
    }
}
