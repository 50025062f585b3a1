//! What an app does with one control.

use std::ops::RangeInclusive;

use super::session::Session;
use crate::engine::ControlState;
use crate::serve::Refusal;
use crate::widget::{Indicator, Value, WidgetId};
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

impl<'a> Control<'a> {
    pub(super) fn new(session: &'a Session, id: WidgetId) -> Self {
        Self { session, id }
    }

    /// Its name.
    #[must_use]
    pub fn id(&self) -> &str {
        self.id.as_str()
    }

    /// How it is, with the reason if no foot can press it ([`ControlState::off`]).
    ///
    /// # Errors
    /// [`Refusal::UnknownControl`] if a layout without it has come.
    pub fn state(&self) -> Result<ControlState, Refusal> {
        let snapshot = self.session.snapshot();
        let state = snapshot.control(self.id.as_str());
        state.ok_or_else(|| Refusal::unknown_control(self.id.as_str(), &snapshot.layout))
    }

    /// Gives it a value. A number beyond its range becomes the nearest end of the range, one between two steps the
    /// nearer step; [`Control::state`] has the value that it took. A number stands for on (not 0) where it is a switch,
    /// and for a choice, from 0, where it is a selector.
    ///
    /// # Errors
    /// [`Refusal::Control`] says why it stays as it was: NaN and infinities, a choice that a selector does not have, a
    /// value of another type, a control that is locked, in use, or only for feet.
    pub fn set(&self, value: impl Into<Value>) -> Result<(), Refusal> {
        let value = value.into();
        self.ask(|id| ControlMessage::Set { id, value })
    }

    /// Gives a slider, dial or stepper another range, also in layouts that come later; its value is brought into it.
    ///
    /// # Errors
    /// [`crate::widget::SetError::WrongType`] for other controls, [`crate::widget::SetError::NoRange`] for a range that is empty, not finite,
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
