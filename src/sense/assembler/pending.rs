//! The samples of a board with a rate of its own, until they enter a frame.

use arrayvec::ArrayVec;

use super::sample::BoardSample;
use crate::wire::Readings;

/// Maximum number of waiting samples: frames come each millisecond, or 20 ms late at most while they wait for other
/// boards.
const MOST: usize = 24;

/// A sample that waits for its frame.
#[derive(Clone, Debug)]
pub(super) struct PendingSample {
    /// The first frame that it may enter.
    pub(super) slot: i64,
    /// Its instant on the receive clock; of a mean, the last one's.
    pub(super) sampled_ns: i64,
    /// Arrival of its last packet.
    pub(super) arrived_ns: i64,
    pub(super) sample: BoardSample,
    /// Number of packets in its mean.
    packets: u32,
}

/// The samples that wait for their frames, earliest first.
#[derive(Clone, Debug, Default)]
pub(super) struct PendingSamples {
    waiting: ArrayVec<PendingSample, MOST>,
}

impl PendingSamples {
    /// Whether none waits.
    pub(super) fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Adds the readings of a packet for the frame of `slot` or a later one. Several packets for one frame become their
    /// mean if `averages`; otherwise the last one counts. Returns whether it replaces another.
    pub(super) fn add(
        &mut self,
        slot: i64,
        sampled_ns: i64,
        arrived_ns: i64,
        readings: &Readings,
        averages: bool,
    ) -> bool {
        let is_full = self.waiting.is_full();
        if let Some(last) = self.waiting.last_mut().filter(|last| last.slot >= slot || is_full) {
            (last.sampled_ns, last.arrived_ns) = (sampled_ns, arrived_ns);
            if averages {
                last.packets = last.packets.saturating_add(1);
                last.sample.average(readings, last.packets);
            } else {
                last.sample.replace(readings);
            }
            return !averages;
        }
        let sample = BoardSample::new(readings);
        self.waiting.push(PendingSample { slot, sampled_ns, arrived_ns, sample, packets: 1 });
        false
    }

    /// Removes and returns the last sample that may enter the frame of `slot`, and the number of earlier ones, which
    /// are dropped.
    pub(super) fn take(&mut self, slot: i64) -> Option<(PendingSample, u64)> {
        let count = self.waiting.iter().take_while(|pending| pending.slot <= slot).count();
        let last = self.waiting.drain(..count).last()?;
        Some((last, count as u64 - 1))
    }

    /// Removes all samples.
    pub(super) fn clear(&mut self) {
        self.waiting.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readings(newtons: f32) -> Readings {
        Readings::Newtons([newtons; 4].into_iter().collect())
    }

    #[test]
    fn packets_of_one_frame_are_averaged_for_fast_boards_and_replaced_for_slow_ones() {
        for (averages, expected) in [(true, 2.5), (false, 4.0)] {
            let mut pending = PendingSamples::default();
            for newtons in [1.0, 2.0, 3.0, 4.0] {
                pending.add(7, 0, 0, &readings(newtons), averages);
            }
            assert!(pending.take(6).is_none());
            let (taken, dropped) = pending.take(7).unwrap();
            assert_eq!((taken.sample, dropped), (BoardSample::new(&readings(expected)), 0));
            assert!(pending.is_empty());
        }
    }

    #[test]
    fn without_frames_the_samples_are_bounded() {
        let mut pending = PendingSamples::default();
        for slot in 0..1000 {
            pending.add(slot, slot, slot, &readings(slot as f32), false);
        }
        let (taken, _) = pending.take(1000).unwrap();
        assert_eq!(taken.sampled_ns, 999);
    }
}
