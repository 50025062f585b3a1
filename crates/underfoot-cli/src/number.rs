//! Parsers for numbers and tiles on the command line: finite and within their range, with a message otherwise.

use std::num::NonZeroUsize;
use std::ops::RangeInclusive;
use std::thread;
use std::time::Duration;

use underfoot::floor::TileId;

/// Maximum running time of a program: a year.
const LONGEST_S: f64 = 365.0 * 86_400.0;

/// Parses a finite number within `range`; `unit` follows the range in the message, such as `newtons`.
pub(crate) fn number(text: &str, range: &RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    // NaN is in no range.
    let read = text.parse::<f64>().ok().filter(|number| range.contains(number));
    read.ok_or_else(|| format!("expected {} to {} {unit}", range.start(), range.end()))
}

/// Parses a time in seconds within `range`.
fn span(text: &str, range: &RangeInclusive<f64>) -> Result<Duration, String> {
    number(text, range, "seconds").map(Duration::from_secs_f64)
}

/// Parses the running time of a program: 0 to a year.
pub(crate) fn lifetime(text: &str) -> Result<Duration, String> {
    span(text, &(0.0..=LONGEST_S))
}

/// Parses the duration of a measurement: 0.1 s to a day.
pub(crate) fn patience(text: &str) -> Result<Duration, String> {
    span(text, &(0.1..=86_400.0))
}

/// Parses the duration of a simulated slide or press: 0.01 s to a minute.
#[cfg(feature = "lab")]
pub(crate) fn gesture(text: &str) -> Result<Duration, String> {
    span(text, &(0.01..=60.0))
}

/// Parses a delay in milliseconds: 0 to a second.
pub(crate) fn delay_ms(text: &str) -> Result<Duration, String> {
    number(text, &(0.0..=1000.0), "milliseconds").map(|ms| Duration::from_secs_f64(ms * 1e-3))
}

/// Parses a tile by column and row: `2,3` or `(2, 3)`.
pub(crate) fn tile(text: &str) -> Result<TileId, String> {
    let bare = text.trim_matches(['(', ')']);
    let (column, row) = bare.split_once(',').ok_or("write it like 2,3: column, row")?;
    let number = |digits: &str| digits.trim().parse::<u16>().map_err(|error| format!("{digits:?}: {error}"));
    Ok(TileId::new(number(column)?, number(row)?))
}

/// Maximum number of threads.
const MOST_THREADS: usize = 1024;

/// Parses a number of threads, or `all`.
pub(crate) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    if text == "all" {
        return Ok(thread::available_parallelism().unwrap_or(NonZeroUsize::MIN));
    }
    let number = text.parse().ok().filter(|number: &NonZeroUsize| number.get() <= MOST_THREADS);
    number.ok_or_else(|| format!("expected a number of threads from 1 to {MOST_THREADS}, or `all`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_finite_number_in_range_is_refused() {
        for text in ["nan", "NaN", "inf", "-inf", "1e999", "-1", "1e30", "", "ten", "1s"] {
            let message = lifetime(text).unwrap_err();
            assert_eq!(message, "expected 0 to 31536000 seconds", "{text}");
        }
        for read in [patience, delay_ms] {
            assert!(["nan", "inf", "-0.1", "1e9"].iter().all(|text| read(text).is_err()));
        }
        assert_eq!(lifetime("2.5"), Ok(Duration::from_millis(2500)));
        assert_eq!(lifetime("0"), Ok(Duration::ZERO));
        assert_eq!(delay_ms("12"), Ok(Duration::from_millis(12)));
    }

    #[test]
    fn threads_are_a_number_or_all() {
        assert_eq!(threads("3").unwrap().get(), 3);
        assert!(threads("all").unwrap().get() >= 1);
        for wrong in ["0", "-1", "many", "1025", ""] {
            assert!(threads(wrong).is_err(), "{wrong}");
        }
    }
}
