//! Numbers as files hold them.

/// A number as a file holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// Its value; finite.
    pub value: f64,
    /// The nearest single-precision value; finite.
    pub single: f32,
    /// Whether it was written without point and exponent.
    pub whole: bool,
}

/// Reasons why a text that looks like a number cannot be used as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotANumber {
    /// `NaN` or `inf`, which no quantity of a floor can be.
    NotFinite,
    /// The value is too large to represent.
    TooLarge,
    /// The text is not a number.
    Malformed,
}

/// Parses a RON number: underscores, `0x`, `0o`, `0b`, exponents and type suffixes are allowed.
///
/// # Errors
/// [`NotANumber`] has the reason.
pub fn parse_number(written: &str) -> Result<Number, NotANumber> {
    let text = written.replace('_', "");
    let (sign, digits) = match text.strip_prefix('-') {
        Some(digits) => (-1.0, digits),
        None => (1.0, text.strip_prefix('+').unwrap_or(&text)),
    };
    if digits.starts_with("inf") || digits.starts_with("NaN") {
        return Err(NotANumber::NotFinite);
    }
    let bases = [("0x", 16), ("0X", 16), ("0o", 8), ("0O", 8), ("0b", 2), ("0B", 2)];
    if let Some((digits, base)) = bases.iter().find_map(|(p, base)| Some((digits.strip_prefix(p)?, *base))) {
        let value =
            u64::from_str_radix(without_suffix(digits, base), base).map_err(|_| NotANumber::Malformed)?;
        return Ok(Number { value: sign * value as f64, single: sign as f32 * value as f32, whole: true });
    }
    let digits = without_suffix(digits, 10);
    // Rust also accepts words such as "infinity" here; a number begins with a digit.
    if !digits.starts_with(|c: char| c.is_ascii_digit()) {
        return Err(NotANumber::Malformed);
    }
    let value: f64 = digits.parse().map_err(|_| NotANumber::Malformed)?;
    let single: f32 = digits.parse().map_err(|_| NotANumber::Malformed)?;
    if !single.is_finite() {
        return Err(NotANumber::TooLarge);
    }
    let whole = digits.bytes().all(|byte| byte.is_ascii_digit());
    Ok(Number { value: sign * value, single: sign as f32 * single, whole })
}

/// Removes a type such as `u8` or `f32` from the end of `digits`.
fn without_suffix(digits: &str, base: u32) -> &str {
    let suffixes = ["i8", "i16", "i32", "i64", "i128", "u8", "u16", "u32", "u64", "u128"];
    let floats = if base == 10 { ["f32", "f64"].as_slice() } else { &[] };
    suffixes.iter().chain(floats).find_map(|suffix| digits.strip_suffix(suffix)).unwrap_or(digits)
}

/// Formats `value` for people: at most four decimals, without trailing zeros.
pub fn plain(value: f64) -> String {
    let rounded = format!("{value:.4}");
    let text = rounded.trim_end_matches('0').trim_end_matches('.');
    if value != 0.0 && value.abs() < 1e-6 {
        format!("{value:e}")
    } else if text == "-0" || (text == "0" && value != 0.0) {
        value.to_string()
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_to_write_a_number_in_ron_is_read() {
        let cases = [
            ("60", 60.0),
            ("+60", 60.0),
            ("-0.25", -0.25),
            ("1_000", 1000.0),
            ("6e1", 60.0),
            ("1.5E-3", 0.0015),
            ("0x3C", 60.0),
            ("0b11_1100", 60.0),
            ("0o74", 60.0),
            ("-0x10", -16.0),
            ("60u8", 60.0),
            ("2.5f32", 2.5),
        ];
        for (written, value) in cases {
            assert_eq!(parse_number(written).map(|number| number.value), Ok(value), "{written}");
        }
        assert!(parse_number("60").unwrap().whole && !parse_number("60.0").unwrap().whole);
    }

    #[test]
    fn what_no_force_or_place_can_be_is_refused() {
        for written in ["NaN", "inf", "-inf", "+NaN", "inff32"] {
            assert_eq!(parse_number(written), Err(NotANumber::NotFinite), "{written}");
        }
        for written in ["1e400", "-1e400", "3.5e38"] {
            assert_eq!(parse_number(written), Err(NotANumber::TooLarge), "{written}");
        }
        for written in ["1e", "0x", "1e+", "", "infinity", "0xfffffffffffffffff"] {
            assert!(parse_number(written).is_err(), "{written}");
        }
    }

    #[test]
    fn numbers_are_shown_as_people_write_them() {
        assert_eq!(plain(60.0), "60");
        assert_eq!(plain(0.304), "0.304");
        assert_eq!(plain(0.1 + 0.2), "0.3");
        assert_eq!(plain(-2.5), "-2.5");
        assert_eq!(plain(0.00001), "0.00001");
    }
}
