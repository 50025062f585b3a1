//! What functions answer, by the numbers in `underfoot.h`.

use std::ffi::{CStr, c_int};

use underfoot::runtime::Refusal;
use underfoot::widget::SetError;

pub(crate) const OK: c_int = 0;
pub(crate) const TIMEOUT: c_int = 1;
pub(crate) const OVER: c_int = 2;
pub(crate) const BAD_ARGUMENT: c_int = -1;
pub(crate) const UNKNOWN: c_int = -2;
pub(crate) const PANIC: c_int = -13;

/// The number of a refusal.
pub(crate) fn of_refusal(refusal: Refusal) -> c_int {
    match refusal {
        Refusal::Control(error) => match error {
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

/// A number in words.
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
