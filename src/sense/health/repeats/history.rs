//! The recent readings of one plate's sensors, and the detection of replayed buffers in them.

/// Number of readings kept per sensor: twice the longest repetition of interest.
const KEPT: usize = 256;

/// Number of readings a millisecond apart that must equal those a fixed time before; of a slow board, those of 100 ms,
/// and at least so many.
const REPEATED: usize = 100;
const FEWEST_REPEATED: usize = 16;

/// Maximum lag, in readings, after which a replayed buffer starts again.
pub(super) const MOST_LAG: usize = KEPT - REPEATED;

/// The last [`KEPT`] readings of each sensor of one plate.
#[derive(Clone, Debug)]
pub(super) struct ReadingHistory {
    readings: [[u16; KEPT]; 4],
    /// Number of readings of each sensor, counted on beyond [`KEPT`].
    read: [usize; 4],
}

impl ReadingHistory {
    pub(super) const EMPTY: Self = Self { readings: [[0; KEPT]; 4], read: [0; 4] };

    /// Stores a reading of the sensor at `corner`.
    pub(super) fn read(&mut self, corner: usize, raw: u16) {
        self.readings[corner][self.read[corner] % KEPT] = raw;
        self.read[corner] += 1;
    }

    /// Forgets the readings of the sensor at `corner`.
    pub(super) fn forget(&mut self, corner: usize) {
        self.read[corner] = 0;
    }

    /// Number of last readings of the sensor at `corner`, `interval_ms` apart, that equal those a fixed lag before:
    /// [`REPEATED`] or those of 100 ms, or 0 if there are fewer for every lag of 2 to [`MOST_LAG`] readings.
    pub(super) fn cycle(&self, corner: usize, interval_ms: f32) -> u32 {
        let (readings, read) = (&self.readings[corner], self.read[corner]);
        // The cast saturates.
        let repeated = ((REPEATED as f32 / interval_ms) as usize).clamp(FEWEST_REPEATED, REPEATED);
        let Some(most) = read.min(KEPT).checked_sub(repeated) else { return 0 };
        let most = most.min(MOST_LAG);
        let at = |back: usize| readings[(read - 1 - back) % KEPT];
        let repeats = |lag: usize| (0..repeated).all(|back| at(back) == at(back + lag));
        if (2..=most).any(repeats) { repeated as u32 } else { 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history(readings: impl Iterator<Item = u16>) -> ReadingHistory {
        let mut history = ReadingHistory::EMPTY;
        readings.for_each(|raw| history.read(2, raw));
        history
    }

    /// Readings without any order.
    fn noise(at: u32) -> u16 {
        (at.wrapping_mul(2_654_435_761) >> 16) as u16
    }

    #[test]
    fn a_buffer_that_is_replayed_is_found_whatever_its_length() {
        for length in [2, 3, 7, 64, 128, MOST_LAG as u32] {
            let played = history((0..300).map(noise).chain((0..400).map(|at| noise(at % length))));
            assert!(played.cycle(2, 1.0) > 0, "{length}");
            assert_eq!(played.cycle(0, 1.0), 0, "the sensor beside it");
        }
    }

    #[test]
    fn readings_that_come_once_are_no_cycle() {
        assert_eq!(history((0..1000).map(noise)).cycle(2, 1.0), 0);
    }
}
