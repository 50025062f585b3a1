//! The results of functions, by the numbers in `underfoot.h`.

use std::ffi::{CStr, c_int};

use underfoot::runtime::Refusal;
use underfoot::widget::{OffReason, SetError};

use crate::last_error;

pub(crate) const OK: c_int = 0;
pub(crate) const TIMEOUT: c_int = 1;
pub(crate) const OVER: c_int = 2;
pub(crate) const BAD_ARGUMENT: c_int = -1;
pub(crate) const UNKNOWN: c_int = -2;
pub(crate) const PANIC: c_int = -13;

/// `UF_BAD_ARGUMENT`; stores its text for `uf_last_error`.
pub(crate) fn bad_argument() -> c_int {
    last_error::keep(&text(BAD_ARGUMENT).to_string_lossy());
    BAD_ARGUMENT
}

/// The number of a refusal; stores its text for `uf_last_error`.
pub(crate) fn of_refusal(refusal: &Refusal) -> c_int {
    last_error::keep(&refusal.to_string());
    match refusal {
        Refusal::UnknownControl { .. } | Refusal::UnknownPage { .. } => UNKNOWN,
        Refusal::Control { why, .. } => match why {
            SetError::Unknown => UNKNOWN,
            SetError::WrongType => -3,
            SetError::NotFinite => -4,
            SetError::NoSuchChoice => -5,
            SetError::NoRange => -6,
            SetError::Momentary => -7,
            SetError::Locked => -8,
            SetError::InUse => -9,
        },
        Refusal::Ended => -10,
        Refusal::NoAnswer => -11,
        _ => -12,
    }
}

/// `UF_ON`.
pub(crate) const ON: c_int = 0;

/// The number of a reason, as in `underfoot.h`: its place in [`OffReason::ALL`], from 1; 100 for one without a number
/// in this library.
pub(crate) fn of_reason(reason: OffReason) -> c_int {
    let place = OffReason::ALL.iter().position(|other| *other == reason);
    place.and_then(|place| c_int::try_from(place + 1).ok()).unwrap_or(100)
}

/// The word for a reason, as in JSON lines; empty for `UF_ON` and for other numbers.
pub(crate) fn reason_name(number: c_int) -> &'static CStr {
    match number {
        1 => c"disabled",
        2 => c"waiting",
        3 => c"boards_swapped",
        4 => c"not_calibrated",
        5 => c"other_floor",
        6 => c"link_lost",
        7 => c"sensor_trouble",
        8 => c"repeated_readings",
        9 => c"coarse_readings",
        10 => c"other_held",
        11 => c"slow_readings",
        _ => c"",
    }
}

/// The text of a number.
pub(crate) fn text(status: c_int) -> &'static CStr {
    match status {
        OK => c"done",
        TIMEOUT => c"nothing happened in that time",
        OVER => c"the session has ended and all its events were taken",
        BAD_ARGUMENT => c"a null pointer, text that is not UTF-8, or a size that no version has",
        UNKNOWN => c"there is no such control or page",
        -3 => c"the control does not hold that type of value",
        -4 => c"the value is not a finite number",
        -5 => c"the selector has no such option",
        -6 => c"the control can't have such a range",
        -7 => c"only a foot can work this control, for as long as it holds it",
        -8 => c"the control is locked",
        -9 => c"a foot is using the control; try again when it has let go",
        -10 => c"the session is over",
        -11 => c"the floor does not answer",
        -12 => c"the floor refuses",
        PANIC => c"a fault of the library",
        _ => c"unknown status",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reason_has_the_number_of_the_header() {
        for reason in OffReason::ALL {
            let name = reason_name(of_reason(reason)).to_str().unwrap_or_default();
            assert_eq!(name, reason.name());
        }
        assert_eq!(reason_name(ON), c"");
    }
}
