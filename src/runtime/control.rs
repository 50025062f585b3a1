//! What an app does with one control.

use std::ops::RangeInclusive;

use thiserror::Error;

use super::session::Session;
use crate::engine::ControlState;
use crate::widget::{Indicator, SetError, Value, WidgetId};
use crate::wire::ControlMessage;

/// One control of a session, by its id. Whatever changes it is told to all other outputs.
///
/// Each call waits for the sensing thread's answer: less than a millisecond while packets come, 5 ms without.
/// Called on the sensing thread itself (by a sink), it is refused after 200 ms.
#[derive(Clone, Debug)]
pub struct Control<'a> {
    session: &'a Session,
    id: WidgetId,
}

/// Why a floor does not do what an app asks; nothing has changed then.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The control does not take it: unknown, of another type, locked, in use, or guarded
    /// ([`SetError::Momentary`]: only a foot can hold it).
    #[error(transparent)]
    Control(#[from] SetError),
    /// The session is over.
    #[error("the session is over")]
    Ended,
    /// The sensing thread did not answer within 200 ms; it may still do what was asked.
    #[error("the floor does not answer")]
    NoAnswer,
}

impl<'a> Control<'a> {
    pub(super) fn new(session: &'a Session, id: &str) -> Self {
        Self { session, id: WidgetId::new(id) }
    }

    /// How it is.
    ///
    /// # Errors
    /// [`SetError::Unknown`] if a layout without it has come.
    pub fn state(&self) -> Result<ControlState, Refusal> {
        Ok(self.session.snapshot().control(self.id.as_str()).ok_or(SetError::Unknown)?)
    }

    /// Gives it a value, brought to its range and steps. A number stands for on (not 0) where it is a switch, and for a
    /// choice, from 0, where it is a selector.
    ///
    /// # Errors
    /// [`Refusal`] says why it stays as it was.
    pub fn set(&self, value: impl Into<Value>) -> Result<(), Refusal> {
        let value = value.into();
        self.ask(|id| ControlMessage::Set { id, value })
    }

    /// Gives a slider, dial or stepper another range, also in layouts that come later; its value is brought into it.
    ///
    /// # Errors
    /// [`SetError::WrongType`] for other controls, [`SetError::NoRange`] for a range that is empty, not finite,
    /// beyond a million or narrower than the control's step; otherwise as for [`Control::set`].
    pub fn set_range<T: Into<f64>>(&self, range: RangeInclusive<T>) -> Result<(), Refusal> {
        let (least, greatest) = range.into_inner();
        let (least, greatest) = (least.into() as f32, greatest.into() as f32);
        self.ask(|id| ControlMessage::SetRange { id, least, greatest })
    }

    /// Writes another label on it; its first 64 characters.
    ///
    /// # Errors
    /// [`Refusal`] if the session is over.
    pub fn set_label(&self, label: &str) -> Result<(), Refusal> {
        self.ask(|id| ControlMessage::Label { id, text: label.into() })
    }

    /// Switches its lamp.
    ///
    /// # Errors
    /// As for [`Control::set_label`].
    pub fn set_indicator(&self, indicator: Indicator) -> Result<(), Refusal> {
        self.ask(|id| ControlMessage::Indicate { id, indicator })
    }

    /// Lets it react to feet, or no more; a press under way is cancelled.
    ///
    /// # Errors
    /// As for [`Control::set_label`].
    pub fn set_enabled(&self, enabled: bool) -> Result<(), Refusal> {
        self.ask(|id| if enabled { ControlMessage::Enable { id } } else { ControlMessage::Disable { id } })
    }

    /// Keeps its value whatever feet and apps do, or no more; a press under way is cancelled.
    ///
    /// # Errors
    /// As for [`Control::set_label`].
    pub fn set_locked(&self, locked: bool) -> Result<(), Refusal> {
        self.ask(|id| if locked { ControlMessage::Lock { id } } else { ControlMessage::Unlock { id } })
    }

    fn ask(&self, message: impl FnOnce(WidgetId) -> ControlMessage) -> Result<(), Refusal> {
        self.session.ask(message(self.id.clone()))
    }
}
