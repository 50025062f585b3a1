//! Lines of text with numbers in columns, as boards without OSC send them.

use arrayvec::ArrayVec;
use thiserror::Error;

use super::{MAX_CHANNELS, Readings};
use crate::floor::{CountSign, TextLines, TextNumbers};

/// Maximum length of a line in bytes: twice that of 128 columns of seven digits.
const LONGEST: usize = 2048;

/// Maximum length of a number in bytes; more digits than an f32 holds are of no use.
const DIGITS: usize = 24;

/// Good lines in a row after a rejected one, of which none is used: the rest of a broken line may pass for a whole one.
const TRUSTED_AFTER: u8 = 1;

/// Reason for which a line of a board is not used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum LineFault {
    /// It holds bytes that are not visible ASCII.
    #[error("it is not text: is its baud rate the one of the board?")]
    NotText,
    /// No line end within 2048 bytes.
    #[error("a line does not end within {LONGEST} bytes: is its baud rate the one of the board?")]
    TooLong,
    /// It has another number of columns.
    #[error("a line has {found} columns, not {expected}")]
    Columns {
        /// The columns of the line.
        found: usize,
        /// The expected columns.
        expected: usize,
    },
    /// A column of a sensor does not hold a number.
    #[error("column {column} is not a number")]
    NotANumber {
        /// The column, from 1.
        column: u8,
    },
    /// It is well-formed and follows a rejected line.
    #[error("a line follows a broken one, and the next line has to confirm it")]
    Unconfirmed,
}

/// Reads the lines of one board from a stream of bytes.
///
/// A line ends with a line feed or a carriage return; empty lines are skipped, and so are the bytes before the first
/// end, which are the rest of a line that began before the stream. A line is used as a whole or not at all, and after
/// a rejected line only from the second good one on.
///
/// ```
/// use underfoot::floor::{CountSign, TextLines, TextNumbers};
/// use underfoot::wire::{LineDecoder, Readings};
///
/// let lines = TextLines {
///     board: 0,
///     request: Vec::new(),
///     separators: " ,".into(),
///     columns: vec![1, 2],
///     width: 2,
///     numbers: TextNumbers::Counts { full_scale: 1023.0, sign: CountSign::Unsigned },
/// };
/// let mut decoder = LineDecoder::new(lines);
/// let mut read = |text: &[u8]| text.iter().filter_map(|byte| decoder.push(*byte)).last();
/// read(b"23\r\n512, 0\n");
/// let Some(Ok(Readings::Counts(counts))) = read(b"1023, 0\n") else { panic!() };
/// assert_eq!(counts[..], [Some(65_535), Some(0)]);
/// ```
#[derive(Clone, Debug)]
pub struct LineDecoder {
    format: TextLines,
    line: Vec<u8>,
    /// Number of bytes skipped so far on the way to the next end of a line; `None` within lines.
    skipped: Option<usize>,
    /// Good lines in a row, at most [`TRUSTED_AFTER`].
    good: u8,
}

impl LineDecoder {
    /// A decoder for lines of this format.
    #[must_use]
    pub const fn new(format: TextLines) -> Self {
        Self { format, line: Vec::new(), skipped: Some(0), good: TRUSTED_AFTER }
    }

    /// The format of the lines.
    #[must_use]
    pub const fn format(&self) -> &TextLines {
        &self.format
    }

    /// Takes the next byte; returns the readings of the line that it ends, or the reason for which that line is not
    /// used. A count beyond the range becomes `None` in its place.
    pub fn push(&mut self, byte: u8) -> Option<Result<Readings, LineFault>> {
        if !matches!(byte, b'\n' | b'\r') {
            match &mut self.skipped {
                Some(skipped) if *skipped < LONGEST => {
                    *skipped += 1;
                    return None;
                }
                None if self.line.len() < LONGEST => {
                    self.line.push(byte);
                    return None;
                }
                _ => {}
            }
            self.reset();
            self.good = 0;
            return Some(Err(LineFault::TooLong));
        }
        if self.skipped.take().is_some() || self.line.is_empty() {
            return None;
        }
        let read = read(&self.line, &self.format);
        self.line.clear();
        let read = read.and_then(|readings| {
            let is_trusted = self.good >= TRUSTED_AFTER;
            self.good = self.good.saturating_add(1).min(TRUSTED_AFTER);
            is_trusted.then_some(readings).ok_or(LineFault::Unconfirmed)
        });
        if read.as_ref().is_err_and(|fault| *fault != LineFault::Unconfirmed) {
            self.good = 0;
        }
        Some(read)
    }

    /// Starts anew, as for another stream: skips bytes up to the next end of a line.
    pub fn reset(&mut self) {
        self.line.clear();
        self.skipped = Some(0);
        self.good = TRUSTED_AFTER;
    }
}

fn read(line: &[u8], format: &TextLines) -> Result<Readings, LineFault> {
    if !line.iter().all(|byte| byte.is_ascii_graphic() || is_blank(*byte)) {
        return Err(LineFault::NotText);
    }
    let (columns, expected) = (columns(line, format.separators.as_bytes()), usize::from(format.width));
    let found = columns.clone().count();
    if found != expected {
        return Err(LineFault::Columns { found, expected });
    }
    let numbers = format.columns.iter().take(MAX_CHANNELS).map(|&column| {
        let written = columns.clone().nth(usize::from(column).wrapping_sub(1));
        written.and_then(number).ok_or(LineFault::NotANumber { column })
    });
    match format.numbers {
        TextNumbers::Newtons => Ok(Readings::Newtons(numbers.collect::<Result<_, _>>()?)),
        TextNumbers::Counts { full_scale, sign } if sign != CountSign::Unsigned || full_scale > GREATEST => {
            let scaled = |number: f32| sign.scaled(number.into(), full_scale.into());
            Ok(Readings::Scaled(numbers.map(|number| number.map(scaled)).collect::<Result<_, _>>()?))
        }
        TextNumbers::Counts { full_scale, .. } => {
            let counts: Result<ArrayVec<_, MAX_CHANNELS>, _> =
                numbers.map(|number| number.map(|number| count(number, full_scale))).collect();
            Ok(Readings::Counts(counts?))
        }
    }
}

/// The greatest count of 16 bits.
const GREATEST: f32 = u16::MAX as f32;

/// A count of 0 to 65535 for a number of 0 to `full_scale`; `None` beyond.
fn count(number: f32, full_scale: f32) -> Option<u16> {
    (0.0..=full_scale).contains(&number).then(|| (number / full_scale * GREATEST).round() as u16)
}

const fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t')
}

/// The texts between `separators`, without blanks around them.
fn columns<'l>(line: &'l [u8], separators: &'l [u8]) -> impl Iterator<Item = &'l [u8]> + Clone {
    let mut rest = Some(line.trim_ascii());
    std::iter::from_fn(move || {
        let line = rest?;
        let splits = |byte: &u8| separators.contains(if is_blank(*byte) { &b' ' } else { byte });
        let Some(end) = line.iter().position(splits) else { return rest.take() };
        let (column, behind) = line.split_at(end);
        let behind = behind.trim_ascii_start();
        // Blanks around a separator belong to it.
        let is_visible = |byte: &u8| separators.contains(byte) && !is_blank(*byte);
        let behind = match behind.split_first() {
            Some((first, after)) if is_visible(first) => after.trim_ascii_start(),
            _ => behind,
        };
        rest = Some(behind);
        Some(column.trim_ascii_end())
    })
}

/// A decimal number; `None` for other texts, also those that Rust would read as infinite or NaN.
fn number(text: &[u8]) -> Option<f32> {
    let is_digit = |byte: &u8| matches!(byte, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E');
    if text.len() > DIGITS || !text.iter().all(is_digit) {
        return None;
    }
    std::str::from_utf8(text).ok()?.parse().ok().filter(|number: &f32| number.is_finite())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn format(separators: &str, columns: &[u8], width: u8) -> TextLines {
        TextLines {
            board: 0,
            request: Vec::new(),
            separators: separators.into(),
            columns: columns.into(),
            width,
            numbers: TextNumbers::Counts { full_scale: 1000.0, sign: CountSign::Unsigned },
        }
    }

    /// A decoder that has seen a good line.
    fn trusting(format: &TextLines, good: &[u8]) -> LineDecoder {
        let mut decoder = LineDecoder::new(format.clone());
        let results = read_all(&mut decoder, &[b"9 9\n", good].concat());
        assert!(matches!(results[..], [Ok(_)]), "{results:?}");
        decoder
    }

    fn read_all(decoder: &mut LineDecoder, bytes: &[u8]) -> Vec<Result<Readings, LineFault>> {
        bytes.iter().filter_map(|byte| decoder.push(*byte)).collect()
    }

    fn counts(counts: [u16; 4]) -> Result<Readings, LineFault> {
        Ok(Readings::Counts(counts.map(Some).into_iter().collect()))
    }

    const FOUR: [u16; 4] = [0, 65_535, 32_768, 655];

    #[test]
    fn numbers_stand_between_spaces_commas_and_words() {
        for (separators, columns, width, line) in [
            (" ,", &[1, 2, 3, 4][..], 4, "0 1000 500 10\n"),
            (" ,", &[1, 2, 3, 4], 4, "  0,1000 ,  500\t10 \r\n"),
            (",", &[1, 2, 3, 4], 4, "0, 1000, 500, 10\n"),
            (";", &[1, 2, 3, 4], 4, "0;1e3;500.0;+10\n"),
            (" ", &[2, 3, 4, 5], 5, "v 0 1000 500 10\n"),
            (" ", &[5, 4, 2, 1], 6, "10 500 ms: 1000 0 left\n"),
            (",", &[4, 3, 2, 1], 5, "10,500,1000,0,\n"),
        ] {
            let mut decoder = trusting(&format(separators, columns, width), line.as_bytes());
            assert_eq!(read_all(&mut decoder, line.as_bytes()), [counts(FOUR)], "{line:?}");
        }
    }

    #[test]
    fn broken_lines_are_named_and_the_one_after_them_needs_another() {
        let format = format(" ,", &[1, 2, 3, 4], 4);
        let good = b"0 1000 500 10\n";
        for (bad, fault) in [
            ("0 1000 500\n", LineFault::Columns { found: 3, expected: 4 }),
            ("0 1000 500 0 1000 500 10\n", LineFault::Columns { found: 7, expected: 4 }),
            ("0,,500,10\n", LineFault::NotANumber { column: 2 }),
            ("0 1000 inf 10\n", LineFault::NotANumber { column: 3 }),
            ("0 1000 500 NaN\n", LineFault::NotANumber { column: 4 }),
            ("0 1e99 500 10\n", LineFault::NotANumber { column: 2 }),
            ("x 1000 500 10\n", LineFault::NotANumber { column: 1 }),
            ("0 1000 \u{fc} 10\n", LineFault::NotText),
            ("\0 1000 500 10\n", LineFault::NotText),
        ] {
            let mut decoder = trusting(&format, good);
            let read = read_all(&mut decoder, &[bad.as_bytes(), good, good].concat());
            assert_eq!(read, [Err(fault), Err(LineFault::Unconfirmed), counts(FOUR)], "{bad:?}");
        }
        let mut decoder = trusting(&format, good);
        let endless = [&[b'1'; LONGEST + 1], &b"1 1\n"[..], good, good].concat();
        let too_long = Err(LineFault::TooLong);
        assert_eq!(read_all(&mut decoder, &endless), [too_long, Err(LineFault::Unconfirmed), counts(FOUR)]);
    }

    #[test]
    fn a_count_beyond_its_range_costs_its_sensor_alone() {
        let mut decoder = trusting(&format(" ", &[1, 2, 3], 3), b"1 2 3\n");
        let beyond = Readings::Counts([None, Some(0), None].into_iter().collect());
        assert_eq!(read_all(&mut decoder, b"-1 0 1000.5\n"), [Ok(beyond)]);
    }

    #[test]
    fn an_amplifier_of_24_bits_keeps_its_last_bit_and_its_sign() {
        for (sign, full_scale, line, expected) in [
            (CountSign::Unsigned, 16_777_215.0, "8388608 8388609\n", 32_767.5),
            (CountSign::Signed, 8_388_607.0, "-1 0\n", -0.0078),
            (CountSign::OffsetBinary, 16_777_215.0, "8388608 8388609\n", 0.0),
        ] {
            let numbers = TextNumbers::Counts { full_scale, sign };
            let format = TextLines { numbers, ..format(" ", &[1, 2], 2) };
            let mut decoder = trusting(&format, b"7 7\n");
            let read = read_all(&mut decoder, line.as_bytes());
            let [Ok(Readings::Scaled(values))] = &read[..] else { panic!("{sign:?}: {read:?}") };
            assert!((values[0] - expected).abs() < 0.01 && values[1] > values[0], "{sign:?}: {values:?}");
        }
    }

    proptest! {
        /// As a line at another baud rate.
        #[test]
        fn noise_is_never_a_reading(noise in proptest::collection::vec(any::<u8>(), 0..4096)) {
            let mut decoder = LineDecoder::new(format(" ,", &[1, 2, 3, 4], 4));
            prop_assert!(read_all(&mut decoder, &noise).iter().all(Result::is_err));
        }

        #[test]
        fn half_a_line_is_never_a_reading(at in 0_usize..14, from in 0_usize..14) {
            let line = b"100 200 300 40\n";
            let mut decoder = trusting(&format(" ,", &[1, 2, 3, 4], 4), line);
            // The end of one line and the start of another are lost between them.
            let bytes = [&line[..at], &line[at + from.min(14 - at)..]].concat();
            let read = read_all(&mut decoder, &bytes);
            let smaller = |readings: &Readings| {
                let Readings::Counts(counts) = readings else { return false };
                counts.iter().flatten().all(|count| *count <= 300 * 66)
            };
            prop_assert!(read.iter().flatten().all(smaller), "{:?}", read);
        }
    }
}
