//! The range of a converter's counts.

use underfoot_format::Named;

/// The sign of a converter's counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CountSign {
    /// From 0 at zero volts to the greatest count at full voltage.
    #[default]
    Unsigned,
    /// Two's complement: 0 at zero volts, the greatest count at full voltage, one below its negative at the other end.
    /// Words that are sent without their sign, as numbers above the greatest count, are read alike.
    Signed,
    /// From 0 at negative full voltage to the greatest count at full voltage; zero volts is in the middle.
    OffsetBinary,
}

impl Named for CountSign {
    const ALL: &'static [(&'static str, Self)] =
        &[("Unsigned", Self::Unsigned), ("Signed", Self::Signed), ("OffsetBinary", Self::OffsetBinary)];
}

impl CountSign {
    /// Returns `count` of a converter whose greatest count is `full` on the scale of 16 bits: 65535 at full voltage,
    /// negative below zero volts, and beyond these for a count beyond the range.
    #[must_use]
    pub fn scaled(self, count: f64, full: f64) -> f32 {
        let share = match self {
            Self::Unsigned => count / full,
            Self::Signed => {
                let is_unsigned_word = count > full && count <= 2.0 * full + 1.0;
                let count = if is_unsigned_word { count - 2.0 * (full + 1.0) } else { count };
                count / (full + 1.0)
            }
            Self::OffsetBinary => {
                let half = 0.5 * (full + 1.0);
                (count - half) / half
            }
        };
        (share * f64::from(u16::MAX)) as f32
    }
}

/// The range of the counts that a board sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CountRange {
    /// The greatest count, at full voltage: 1023 with 10 bits, 8388607 with 24 bits and a sign; 1 to 16777215.
    pub full_scale: u32,
    /// The sign of the counts.
    pub sign: CountSign,
}

impl Default for CountRange {
    fn default() -> Self {
        Self::WHOLE
    }
}

impl CountRange {
    /// The whole range of 16 bits without a sign.
    pub const WHOLE: Self = Self { full_scale: u16::MAX as u32, sign: CountSign::Unsigned };

    /// The greatest count of the finest converter, of 24 bits.
    pub const MOST: u32 = (1 << 24) - 1;

    /// The greatest count of 16 bits with this sign.
    #[must_use]
    pub const fn usual(sign: CountSign) -> u32 {
        match sign {
            CountSign::Signed => i16::MAX as u32,
            CountSign::Unsigned | CountSign::OffsetBinary => u16::MAX as u32,
        }
    }

    /// Whether zero volts is the middle of the range.
    #[must_use]
    pub const fn is_bipolar(&self) -> bool {
        !matches!(self.sign, CountSign::Unsigned)
    }

    /// Whether its counts need more than 16 bits without a sign.
    #[must_use]
    pub const fn needs_fractions(&self) -> bool {
        self.is_bipolar() || self.full_scale > u16::MAX as u32
    }

    /// Whether its words have more than 16 bits.
    #[must_use]
    pub const fn has_three_bytes(&self) -> bool {
        let most = match self.sign {
            CountSign::Signed => i16::MAX as u32,
            CountSign::Unsigned | CountSign::OffsetBinary => u16::MAX as u32,
        };
        self.full_scale > most
    }

    /// Returns `count` on the scale of 16 bits, 65535 at full voltage and negative below zero volts; beyond these for a
    /// count beyond the range.
    #[must_use]
    pub fn scaled(&self, count: f64) -> f32 {
        self.sign.scaled(count, f64::from(self.full_scale.max(1)))
    }

    /// Returns the count of a reading on the scale of 16 bits: the inverse of [`CountRange::scaled`], rounded.
    #[must_use]
    pub fn count(&self, scaled: f32) -> i64 {
        let (share, full) = (f64::from(scaled) / f64::from(u16::MAX), f64::from(self.full_scale.max(1)));
        let count = match self.sign {
            CountSign::Unsigned => share * full,
            CountSign::Signed => share * (full + 1.0),
            CountSign::OffsetBinary => (share + 1.0) * 0.5 * (full + 1.0),
        };
        // The cast saturates.
        count.round() as i64
    }

    /// Returns `count` on the scale of 16 bits, rounded; `None` beyond the range.
    #[must_use]
    pub fn rounded(&self, count: f64) -> Option<u16> {
        let scaled = self.scaled(count).round();
        (0.0..=f32::from(u16::MAX)).contains(&scaled).then_some(scaled as u16)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_and_the_zero_of_every_converter_are_those_of_16_bits() {
        use CountSign::{OffsetBinary, Signed, Unsigned};
        for bits in [8, 10, 12, 14, 16, 18, 20, 24] {
            let words = f64::from(1_u32 << bits);
            let near = |range: CountRange, count: f64, expected: f32| {
                let scaled = range.scaled(count);
                let step = 65_536.0 / words as f32 * 2.0;
                assert!((scaled - expected).abs() <= step + 0.01, "{bits} bits, {count}: {scaled}");
            };
            let unsigned = CountRange { full_scale: (1 << bits) - 1, sign: Unsigned };
            near(unsigned, 0.0, 0.0);
            near(unsigned, words - 1.0, 65_535.0);
            near(unsigned, words / 2.0, 32_767.5);
            let signed = CountRange { full_scale: (1 << (bits - 1)) - 1, sign: Signed };
            near(signed, 0.0, 0.0);
            near(signed, words / 2.0 - 1.0, 65_535.0);
            near(signed, -words / 2.0, -65_535.0);
            near(signed, words - 1.0, 0.0);
            near(signed, words / 2.0, -65_535.0);
            let offset = CountRange { full_scale: (1 << bits) - 1, sign: OffsetBinary };
            near(offset, words / 2.0, 0.0);
            near(offset, words - 1.0, 65_535.0);
            near(offset, 0.0, -65_535.0);
        }
    }

    #[test]
    fn a_count_beyond_the_range_is_none() {
        let ten_bits = CountRange { full_scale: 1023, sign: CountSign::Unsigned };
        assert_eq!(
            [-1.0, 0.0, 1023.0, 1024.0].map(|count| ten_bits.rounded(count)),
            [None, Some(0), Some(u16::MAX), None]
        );
    }

    #[test]
    fn a_reading_leads_back_to_its_count() {
        for sign in [CountSign::Unsigned, CountSign::Signed, CountSign::OffsetBinary] {
            for full_scale in [255, 1023, 65_535, 8_388_607] {
                let range = CountRange { full_scale, sign };
                assert!(
                    [3, 100, 250]
                        .iter()
                        .all(|count| range.count(range.scaled(f64::from(*count))) == i64::from(*count))
                );
            }
        }
    }

    #[test]
    fn sixteen_bits_stay_as_they_are() {
        assert!((0..=u16::MAX).all(|count| CountRange::WHOLE.rounded(count.into()) == Some(count)));
    }
}
