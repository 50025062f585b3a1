//! Numbers with a limited count of significant digits.

use std::fmt;

/// A number printed to some significant digits, without trailing zeros, so that small numbers are readable as well.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Significant {
    number: f32,
    digits: usize,
}

impl Significant {
    /// `number` to at least one and at most `digits` significant digits.
    pub(crate) const fn new(number: f32, digits: usize) -> Self {
        Self { number, digits }
    }
}

/// Exponents of ten printed in decimal notation, as 0.00123 and 123400; others get an `e`.
const WRITTEN_OUT: std::ops::RangeInclusive<i32> = -3..=5;

impl fmt::Display for Significant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Rounding comes first: 0.99996 to four digits is 1, with another exponent.
        let rounded = format!("{:.*e}", self.digits.saturating_sub(1), self.number);
        let Some((mantissa, exponent)) = rounded.split_once('e') else { return f.pad(&rounded) };
        let power = exponent.parse::<i32>().unwrap_or_default();
        let trimmed = |text: &str| match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text.to_owned(),
        };
        if !WRITTEN_OUT.contains(&power) {
            return f.pad(&format!("{}e{power}", trimmed(mantissa)));
        }
        let decimals = (self.digits as i32 - 1 - power).max(0) as usize;
        let value: f64 = rounded.parse().unwrap_or_default();
        f.pad(&trimmed(&format!("{value:.decimals$}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_size_keep_their_digits() {
        for (number, shown) in [
            (0.5, "0.5"),
            (4.4e-6, "4.4e-6"),
            (4.412_34e-6, "4.412e-6"),
            (0.001_234_56, "0.001235"),
            (0.999_96, "1"),
            (123.456, "123.5"),
            (123_456.0, "123500"),
            (9_999_999.0, "1e7"),
            (-2.0, "-2"),
            (0.0, "0"),
            (f32::INFINITY, "inf"),
            (f32::NAN, "NaN"),
        ] {
            assert_eq!(Significant::new(number, 4).to_string(), shown);
        }
        assert_eq!(format!("{:>8}", Significant::new(1.5, 4)), "     1.5");
    }
}
