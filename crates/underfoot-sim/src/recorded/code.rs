//! Recorded feet as bytes: whole numbers of variable length, each as its difference from the one before.
//!
//! ```text
//! version, length (ms), number of lines,
//! per line: first ms - that of the line before, 2 * length (mm) + left, number of points,
//!           the differences of their times, then those of each value, value by value
//! ```
//!
//! A number has 7 bits in each byte, the lowest first; the highest bit says that another byte follows. Differences that
//! may be negative are folded: 0, -1, 1, -2, 2 are 0, 1, 2, 3, 4.

use thiserror::Error;

use super::{FORCE, FootLine, FootPoint, MOST_FEET, MOST_LINES, MOST_MS, MOST_POINTS, RecordedFeet, VALUES};

/// The version of the code.
const VERSION: u64 = 1;

/// Greatest amount of each value: a kilometre, some thousand turns, more than any person weighs, the toes.
const MOST: [i64; VALUES] = [10_000_000, 10_000_000, 10_000_000, 100_000, 1000];

/// Lengths of bare feet, in millimetres, with room for those of children and giants.
const LENGTHS_MM: std::ops::RangeInclusive<u64> = 100..=400;

/// The reason why bytes are not recorded feet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BadFeet {
    /// A newer version of this program has written them.
    #[error("the feet were recorded by a newer underfoot (their form is {0}): this one is too old for them")]
    Newer(u64),
    /// Bytes are missing or wrong, or the numbers in them are those of no feet.
    #[error("the recorded feet are damaged")]
    Damaged,
    /// The feet are more than a floor can take.
    #[error("the recorded feet are too many: at most {MOST_FEET} at once, and ten minutes of them")]
    TooMany,
}

pub(super) fn encode(feet: &RecordedFeet) -> Vec<u8> {
    let mut out = Vec::new();
    for number in [VERSION, feet.length_ms.into(), feet.lines.len() as u64] {
        put(&mut out, number);
    }
    let mut begun = 0;
    for line in &feet.lines {
        let first = u64::from(line.first_ms());
        put(&mut out, first - begun);
        begun = first;
        put(&mut out, 2 * u64::from(line.length_mm) + u64::from(line.left));
        put(&mut out, line.points.len() as u64);
        for pair in line.points.windows(2) {
            let [from, to] = [0, 1].map(|index| pair.get(index).map_or(0, |point| point.ms));
            put(&mut out, u64::from(to - from));
        }
        for index in 0..VALUES {
            let mut before = 0;
            for point in &line.points {
                let value = i64::from(point.values[index]);
                put(&mut out, folded(value - before));
                before = value;
            }
        }
    }
    out
}

pub(super) fn decode(bytes: &[u8]) -> Result<RecordedFeet, BadFeet> {
    let mut input = Input { bytes };
    match input.number()? {
        VERSION => {}
        newer if newer > VERSION => return Err(BadFeet::Newer(newer)),
        _ => return Err(BadFeet::Damaged),
    }
    let length_ms = input.up_to(MOST_MS.into())? as u32;
    let count = input.up_to(MOST_LINES as u64)?;
    let (mut lines, mut begun, mut room) = (Vec::new(), 0, MOST_POINTS as u64);
    for _ in 0..count {
        begun += input.number()?.min(u64::from(MOST_MS) + 1);
        let kind = input.number()?;
        let (left, length) = (kind % 2 == 1, kind / 2);
        if !LENGTHS_MM.contains(&length) {
            return Err(BadFeet::Damaged);
        }
        let points = input.up_to(room)?;
        room -= points;
        let points = input.points(points as usize, begun, length_ms)?;
        lines.push(FootLine { left, length_mm: length as u16, points });
    }
    if !input.bytes.is_empty() {
        return Err(BadFeet::Damaged);
    }
    if most_at_once(&lines) > MOST_FEET {
        return Err(BadFeet::TooMany);
    }
    Ok(RecordedFeet { length_ms, lines })
}

/// The greatest number of feet at the same time.
fn most_at_once(lines: &[FootLine]) -> usize {
    let begins = lines.iter().map(|line| (line.first_ms(), 1));
    let ends = lines.iter().map(|line| (line.last_ms() + 1, -1));
    let mut changes: Vec<(u32, isize)> = begins.chain(ends).collect();
    changes.sort_unstable();
    let (mut now, mut most) = (0, 0);
    for (_, change) in changes {
        now += change;
        most = most.max(now);
    }
    most.unsigned_abs()
}

fn put(out: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        out.push(number as u8 | 0x80);
        number >>= 7;
    }
    out.push(number as u8);
}

const fn folded(number: i64) -> u64 {
    ((number << 1) ^ (number >> 63)).cast_unsigned()
}

const fn unfolded(number: u64) -> i64 {
    (number >> 1).cast_signed() ^ -((number & 1).cast_signed())
}

/// The bytes that are not read yet.
struct Input<'a> {
    bytes: &'a [u8],
}

impl Input<'_> {
    fn number(&mut self) -> Result<u64, BadFeet> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let (byte, rest) = self.bytes.split_first().ok_or(BadFeet::Damaged)?;
            self.bytes = rest;
            number |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(number);
            }
        }
        Err(BadFeet::Damaged)
    }

    fn up_to(&mut self, most: u64) -> Result<u64, BadFeet> {
        let number = self.number()?;
        if number > most { Err(BadFeet::TooMany) } else { Ok(number) }
    }

    /// The next `count` points of a line that begins at `first` and ends by `last` (ms).
    fn points(&mut self, count: usize, first: u64, last: u32) -> Result<Vec<FootPoint>, BadFeet> {
        // A point takes a byte for its time, except the first one, and one for each value.
        if count == 0 || self.bytes.len() + 1 < count.saturating_mul(VALUES + 1) {
            return Err(BadFeet::Damaged);
        }
        let mut points = Vec::with_capacity(count);
        let mut ms = first;
        for index in 0..count {
            if index > 0 {
                let step = self.number()?;
                ms = ms.checked_add(step).filter(|_| step > 0).ok_or(BadFeet::Damaged)?;
            }
            let ms = u32::try_from(ms).ok().filter(|ms| *ms <= last).ok_or(BadFeet::Damaged)?;
            points.push(FootPoint { ms, values: [0; VALUES] });
        }
        for (index, most) in MOST.into_iter().enumerate() {
            let least = if index >= FORCE { 0 } else { -most };
            let mut value = 0_i64;
            for point in &mut points {
                value = value.saturating_add(unfolded(self.number()?));
                if !(least..=most).contains(&value) {
                    return Err(BadFeet::Damaged);
                }
                point.values[index] = value as i32;
            }
        }
        Ok(points)
    }
}
