//! The readings of one board in one millisecond, kept until its frame is made.

use arrayvec::ArrayVec;
use multiversion::multiversion;

use crate::floor::Calibration;
use crate::wire::{MAX_CHANNELS, Readings};

/// The readings of one board, channel by channel, laid out for vector operations.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum BoardSample {
    Counts(Counts),
    /// Counts with fractions on the scale of 16 bits, of other converters and as means; may hold NaN.
    Scaled(ArrayVec<f32, MAX_CHANNELS>),
    /// May hold NaN and infinities.
    Newtons(ArrayVec<f32, MAX_CHANNELS>),
}

/// Counts, apart from the bits of missing ones: half the size of [`Readings`].
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Counts {
    length: u8,
    /// Bit n is set if channel n has no reading or does not exist.
    missing: u64,
    /// Zero without a reading.
    values: [u16; MAX_CHANNELS],
}

impl BoardSample {
    /// A sample without channels.
    pub(super) const EMPTY: Self =
        Self::Counts(Counts { length: 0, missing: u64::MAX, values: [0; MAX_CHANNELS] });

    pub(super) fn new(readings: &Readings) -> Self {
        let mut sample = Self::EMPTY;
        sample.replace(readings);
        sample
    }

    /// Number of channels read.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Counts(counts) => counts.length.into(),
            Self::Scaled(values) | Self::Newtons(values) => values.len(),
        }
    }

    /// Stores `readings`; returns true if they equal the previous ones, count for count.
    pub(super) fn replace(&mut self, readings: &Readings) -> bool {
        match (&mut *self, readings) {
            (Self::Counts(kept), Readings::Counts(counts)) => kept.replace(counts),
            (Self::Newtons(kept), Readings::Newtons(new)) | (Self::Scaled(kept), Readings::Scaled(new))
                if kept == new =>
            {
                true
            }
            (_, Readings::Counts(_)) => {
                *self = Self::new(readings);
                false
            }
            (_, Readings::Scaled(values)) => {
                *self = Self::Scaled(values.clone());
                false
            }
            (_, Readings::Newtons(forces)) => {
                *self = Self::Newtons(forces.clone());
                false
            }
        }
    }

    /// Whether `readings` equal these, bit for bit.
    pub(super) fn holds(&self, readings: &Readings) -> bool {
        match (self, readings) {
            (Self::Counts(_), Readings::Counts(_)) => *self == Self::new(readings),
            (Self::Scaled(kept), Readings::Scaled(new)) | (Self::Newtons(kept), Readings::Newtons(new)) => {
                kept == new
            }
            _ => false,
        }
    }

    /// Takes the readings of one more of `packets` packets into the mean: x += (y - x) / n. Counts become
    /// [`BoardSample::Scaled`]; readings of another kind or number replace the mean.
    pub(super) fn average(&mut self, readings: &Readings, packets: u32) {
        let share = 1.0 / packets.max(1) as f32;
        let mean = |kept: &mut [f32], new: &mut dyn Iterator<Item = f32>| {
            kept.iter_mut().zip(new).for_each(|(kept, new)| *kept += (new - *kept) * share);
        };
        if let Self::Counts(counts) = self {
            *self = Self::Scaled(counts.scaled().collect());
        }
        match (&mut *self, readings) {
            (Self::Scaled(kept), Readings::Counts(new)) if kept.len() == new.len() => {
                mean(kept, &mut new.iter().map(|count| count.map_or(f32::NAN, f32::from)));
            }
            (Self::Scaled(kept), Readings::Scaled(new)) | (Self::Newtons(kept), Readings::Newtons(new))
                if kept.len() == new.len() =>
            {
                mean(kept, &mut new.iter().copied());
            }
            _ => *self = Self::new(readings),
        }
    }

    /// The reading of a channel with this `law` in newtons, before subtraction of the tare; NaN without a reading.
    pub(super) fn force(&self, channel: usize, law: &Calibration) -> f32 {
        match self {
            Self::Counts(counts) if counts.is_missing(channel) => f32::NAN,
            Self::Counts(counts) => law.force(counts.values[channel % MAX_CHANNELS]).0,
            Self::Scaled(values) => {
                let value = values.get(channel).copied().unwrap_or(f32::NAN);
                law.force_at(Calibration::volts_of(value)).0
            }
            Self::Newtons(forces) => forces.get(channel).copied().unwrap_or(f32::NAN),
        }
    }
}

impl Counts {
    /// The readings of the `LANES` channels from `first` on, zero without one; `None` if there are fewer channels.
    #[inline(always)]
    pub(super) fn run<const LANES: usize>(&self, first: usize) -> Option<&[u16; LANES]> {
        self.values.get(first..)?.first_chunk()
    }

    /// The readings of these channels, zero without one.
    #[inline(always)]
    pub(super) fn pick<const LANES: usize>(&self, channels: &[u8; LANES]) -> [u16; LANES] {
        channels.map(|channel| self.values[usize::from(channel) % MAX_CHANNELS])
    }

    /// Whether any existing channel has no reading.
    #[inline(always)]
    pub(super) const fn is_any_missing(&self) -> bool {
        self.missing != not_there(self.length)
    }

    /// Whether a channel has no reading.
    #[inline(always)]
    pub(super) const fn is_missing(&self, channel: usize) -> bool {
        channel >= MAX_CHANNELS || self.missing >> channel & 1 != 0
    }

    /// The readings with room for fractions; NaN without one.
    fn scaled(&self) -> impl Iterator<Item = f32> + '_ {
        let values = self.values.iter().take(self.length.into()).enumerate();
        values.map(|(channel, value)| if self.is_missing(channel) { f32::NAN } else { f32::from(*value) })
    }

    /// Adds the reading of each channel to its sum, which becomes NaN without a reading.
    pub(super) fn add_to(&self, sums: &mut [f32]) {
        for (sum, value) in sums.iter_mut().zip(&self.values) {
            *sum += f32::from(*value);
        }
        if self.is_any_missing() {
            let missing = sums.iter_mut().enumerate().filter(|(channel, _)| self.is_missing(*channel));
            missing.for_each(|(_, sum)| *sum = f32::NAN);
        }
    }

    fn replace(&mut self, counts: &[Option<u16>]) -> bool {
        let length = counts.len().min(MAX_CHANNELS) as u8;
        let (is_any_new, is_any_missing) = take_in(&mut self.values, counts);
        let mut missing = not_there(length);
        if is_any_missing {
            let nothing = (0..MAX_CHANNELS).zip(counts).filter(|(_, count)| count.is_none());
            missing |= nothing.fold(0, |bits, (channel, _)| bits | 1 << channel);
        }
        let is_same = !is_any_new && (length, missing) == (self.length, self.missing);
        (self.length, self.missing) = (length, missing);
        is_same
    }
}

/// Copies `counts` to `values`; returns whether any differed before, and whether any is missing.
///
/// Without branches, over plain numbers, compiled for each vector instruction set.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw+avx512dq", "x86_64+avx2", "aarch64+neon"))]
fn take_in(values: &mut [u16; MAX_CHANNELS], counts: &[Option<u16>]) -> (bool, bool) {
    let (mut changed, mut is_any_missing) = (0, false);
    for (value, count) in values.iter_mut().zip(counts) {
        // `unwrap_or` checks for a count before reading it; this reads it in any case.
        let given = count.map_or(0, u32::from);
        changed |= given ^ u32::from(*value);
        is_any_missing |= count.is_none();
        *value = given as u16;
    }
    (changed != 0, is_any_missing)
}

/// The bits of the channels that a board with `length` channels does not have.
const fn not_there(length: u8) -> u64 {
    match u64::MAX.checked_shl(length as u32) {
        Some(bits) => bits,
        None => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(counts: &[Option<u16>]) -> Readings {
        Readings::Counts(counts.iter().copied().collect())
    }

    #[test]
    fn the_same_readings_again_are_no_news() {
        let mut sample = BoardSample::EMPTY;
        let newtons = Readings::Newtons([1.0, 2.0].into_iter().collect());
        let all = [
            counts(&[Some(7), Some(0)]),
            counts(&[Some(7), None]),
            counts(&[Some(7), Some(0), Some(0)]),
            counts(&[None; MAX_CHANNELS]),
            newtons,
        ];
        for readings in all {
            assert!(!sample.replace(&readings), "{readings:?}");
            assert!(sample.replace(&readings), "{readings:?}");
            assert_eq!(sample, BoardSample::new(&readings));
            assert_eq!(sample.len(), readings.len());
        }
        let nothing = Readings::Newtons([f32::NAN].into_iter().collect());
        assert!(
            !sample.replace(&nothing) && !sample.replace(&nothing),
            "what is not a number is never the same"
        );
    }

    #[test]
    fn the_mean_of_several_packets_keeps_fractions() {
        let mut mean = BoardSample::new(&counts(&[Some(10), Some(65_535), None]));
        for (packets, low) in [(2, 11), (3, 13), (4, 12)] {
            mean.average(&counts(&[Some(low), Some(65_535), Some(3)]), packets);
        }
        let BoardSample::Scaled(values) = mean else { panic!("no fractions: {mean:?}") };
        assert!((values[0] - 11.5).abs() < 1e-5 && values[1] == 65_535.0 && values[2].is_nan(), "{values:?}");
    }

    #[test]
    fn what_a_channel_did_not_give_is_not_a_force() {
        let sample = BoardSample::new(&counts(&[Some(20_000), None]));
        assert_eq!(sample.force(0, &Calibration::NOMINAL), Calibration::NOMINAL.force(20_000).0);
        assert!([1, 2, 64].into_iter().all(|channel| sample.force(channel, &Calibration::NOMINAL).is_nan()));
    }
}
