//! The reasons why a control rejects a value.

use thiserror::Error;

/// The reason why a control rejects a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum SetError {
    /// The layout has no control with that name.
    #[error("there is no such control")]
    Unknown,
    /// The type does not fit: a button has no value, a switch no number, a slider no switch value.
    #[error("the control does not hold that type of value")]
    WrongType,
    /// The number is NaN or infinite.
    #[error("the value is not a finite number")]
    NotFinite,
    /// The selector has no option with that number.
    #[error("the selector has no such option")]
    NoSuchChoice,
    /// The range is empty, not finite, beyond a million, or narrower than the control's step.
    #[error("the control can't have such a range")]
    NoRange,
    /// The control acts only while a foot holds it.
    #[error("only a foot can work this control, for as long as it holds it")]
    Momentary,
    /// The control is locked; the app that locked it can unlock it.
    #[error("the control is locked")]
    Locked,
    /// A foot is on the control; it has precedence until it lets go.
    #[error("a foot is using the control; try again when it has let go")]
    InUse,
}
