//! Day and quality of a floor's calibration.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use underfoot_format::codec::Spelled;

/// A day of the calendar, in UTC; written `2026-11-20`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Day {
    year: u16,
    month: u8,
    day: u8,
}

/// A day in files.
pub(crate) const DAY: Spelled<Day> = Spelled {
    about: "a day in quotes, \"2026-11-20\"",
    parse: |text| text.parse().ok(),
    wrong: |name, _| format!("`{name}` is no day"),
    expected: "expected year-month-day",
    help: |_| Some("write \"2026-11-20\"".to_owned()),
    stand_in: Day { year: 1970, month: 1, day: 1 },
};

/// A text is not a day.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("expected a day such as 2026-11-20")]
pub struct NotADay;

impl Day {
    /// The day of this date, years 1 to 9999; `None` if the calendar has no such day.
    #[must_use]
    pub fn new(year: u16, month: u8, day: u8) -> Option<Self> {
        let exists = (1..=9999).contains(&year) && day >= 1 && day <= days_of_month(year, month);
        exists.then_some(Self { year, month, day })
    }

    /// Returns the day in UTC, `seconds` after the beginning of 1970; the last day of 9999 for all later ones.
    ///
    /// # Source
    /// Years are counted from March, so that the leap day comes last; 400 years have 146,097 days.
    #[must_use]
    pub fn of_unix_seconds(seconds: u64) -> Self {
        let days = (seconds / 86_400).min(LAST) + DAYS_FROM_MARCH_OF_YEAR_0;
        let (era, of_era) = (days / 146_097, days % 146_097);
        let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
        let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
        // Months from March on have 31, 30, 31, 30, 31 days, five months 153.
        let from_march = (5 * of_year + 2) / 153;
        let day = of_year - (153 * from_march + 2) / 5 + 1;
        let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
        let year = era * 400 + year_of_era + u64::from(month <= 2);
        Self { year: year as u16, month: month as u8, day: day as u8 }
    }
}

/// Days from the first of March of the year 0 to the beginning of 1970.
const DAYS_FROM_MARCH_OF_YEAR_0: u64 = 719_468;

/// The last day of 9999, counted from the beginning of 1970.
const LAST: u64 = 2_932_896;

const fn days_of_month(year: u16, month: u8) -> u8 {
    match month {
        1 | 3 | 5 | 7 | 8 | 10 | 12 => 31,
        4 | 6 | 9 | 11 => 30,
        2 if year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400)) => 29,
        2 => 28,
        _ => 0,
    }
}

impl fmt::Display for Day {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04}-{:02}-{:02}", self.year, self.month, self.day)
    }
}

impl FromStr for Day {
    type Err = NotADay;

    fn from_str(text: &str) -> Result<Self, NotADay> {
        let digits = |part: Option<&str>, length: usize| {
            let part = part.filter(|part| part.len() == length && part.bytes().all(|b| b.is_ascii_digit()));
            part.and_then(|part| part.parse::<u16>().ok()).ok_or(NotADay)
        };
        let mut parts = text.split('-');
        let (year, month, day) =
            (digits(parts.next(), 4)?, digits(parts.next(), 2)?, digits(parts.next(), 2)?);
        let day = Self::new(year, month as u8, day as u8);
        day.filter(|_| parts.next().is_none()).ok_or(NotADay)
    }
}

/// Day of the measurement of a sensor's law, and the residual of the fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibrationRecord {
    /// The day of the fit.
    pub day: Day,
    /// Root mean square of the force error, as a share of the greatest force measured.
    pub residual: f32,
}

impl CalibrationRecord {
    /// A record whose residual is rounded to four decimals, as a floor file shows it; NaN stays NaN.
    #[must_use]
    pub fn rounded(day: Day, residual: f32) -> Self {
        Self { day, residual: four_decimals(residual) }
    }
}

/// Day of the measurement of a tile's position map, and the residual with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapRecord {
    /// The day of the fit.
    pub day: Day,
    /// Position error with the map that 95 % of the points do not exceed, in metres.
    pub residual_m: f32,
}

impl MapRecord {
    /// A record whose residual is rounded to a tenth of a millimetre, as a floor file shows it; NaN stays NaN.
    #[must_use]
    pub fn rounded(day: Day, residual_m: f32) -> Self {
        Self { day, residual_m: four_decimals(residual_m) }
    }
}

fn four_decimals(residual: f32) -> f32 {
    (f64::from(residual * 1e4).round() / 1e4) as f32
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        for (seconds, day) in [
            (0, "1970-01-01"),
            (951_782_400, "2000-02-29"),
            (951_868_800, "2000-03-01"),
            (1_795_132_799, "2026-11-19"),
            (1_795_132_800, "2026-11-20"),
            (4_107_542_399, "2100-02-28"),
            (4_107_542_400, "2100-03-01"),
            (u64::MAX, "9999-12-31"),
        ] {
            assert_eq!(Day::of_unix_seconds(seconds).to_string(), day);
            assert_eq!(day.parse(), Ok(Day::of_unix_seconds(seconds)));
        }
    }

    #[test]
    fn what_no_calendar_has_is_no_day() {
        for text in [
            "",
            "2026",
            "2026-13-01",
            "2025-02-29",
            "2100-02-29",
            "0000-01-01",
            "2026-1-1",
            "2026-11-20-1",
            "2026-11-2O",
        ] {
            assert_eq!(text.parse::<Day>(), Err(NotADay), "{text}");
        }
    }

    proptest! {
        #[test]
        fn one_day_follows_the_other(days in 0..LAST) {
            let (today, tomorrow) = (Day::of_unix_seconds(days * 86_400), Day::of_unix_seconds((days + 1) * 86_400));
            prop_assert!(today < tomorrow);
            prop_assert_eq!(Day::new(today.year, today.month, today.day), Some(today));
            let same_month = (today.year, today.month) == (tomorrow.year, tomorrow.month);
            prop_assert_eq!(tomorrow.day, if same_month { today.day + 1 } else { 1 });
            prop_assert!(same_month || today.day == days_of_month(today.year, today.month));
        }
    }
}
