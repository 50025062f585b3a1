//! One control of a session, for apps.

use std::ops::RangeInclusive;

use super::session::Session;
use crate::engine::ControlState;
use crate::serve::Refusal;
use crate::widget::{Indicator, Value, WidgetId};
use crate::wire::ControlMessage;

/// One control of a session, by its id. Every change made here is also reported to all other outputs.
///
/// Each call waits for the sensing thread's answer: less than a millisecond while packets arrive, 5 ms without. A
/// call from the sensing thread itself (in a sink) fails after 200 ms.
#[derive(Clone, Debug)]
pub struct ControlHandle<'a> {
    session: &'a Session,
    id: WidgetId,
}

impl<'a> ControlHandle<'a> {
    pub(super) fn new(session: &'a Session, id: WidgetId) -> Self {
        Self { session, id }
    }

    /// The name of the control.
    #[must_use]
    pub fn id(&self) -> &str {
        self.id.as_str()
    }

    /// Its state, with the reason if no foot can press it ([`ControlState::off`]).
    ///
    /// # Errors
    /// [`Refusal::UnknownControl`] if the current layout has no such control.
    pub fn state(&self) -> Result<ControlState, Refusal> {
        let snapshot = self.session.snapshot();
        let state = snapshot.control(self.id.as_str());
        state.ok_or_else(|| Refusal::unknown_control(self.id.as_str(), &snapshot.layout))
    }

    /// Sets its value. Clamps a number to the range and rounds it to the nearest step; [`ControlHandle::state`] has the
    /// resulting value. For a switch, a number other than 0 means on; for a selector, a number is the index of a
    /// choice, from 0.
    ///
    /// # Errors
    /// [`Refusal::Control`] has the reason why the value is unchanged: NaN and infinities, a choice that a selector
    /// does not have, a value of another type, a control that is locked, in use, or only for feet.
    pub fn set(&self, value: impl Into<Value>) -> Result<(), Refusal> {
        let value = value.into();
        self.ask(|id| ControlMessage::Set { id, value })
    }

    /// Sets the range of a slider, dial or stepper, also in later layouts, and clamps its value to the range.
    ///
    /// # Errors
    /// [`crate::widget::SetError::WrongType`] for other controls, [`crate::widget::SetError::NoRange`] for a range
    /// that is empty, not finite, beyond a million or narrower than the control's step; otherwise as for
    /// [`ControlHandle::set`].
    pub fn set_range<T: Into<f64>>(&self, range: RangeInclusive<T>) -> Result<(), Refusal> {
        let (least, greatest) = range.into_inner();
        let (least, greatest) = (least.into() as f32, greatest.into() as f32);
        self.ask(|id| ControlMessage::SetRange { id, least, greatest })
    }

    /// Sets its label, of which the first 64 characters count.
    ///
    /// # Errors
    /// [`Refusal`] if the session has ended.
    pub fn set_label(&self, label: &str) -> Result<(), Refusal> {
        self.ask(|id| ControlMessage::Label { id, text: label.into() })
    }

    /// Sets its indicator lamp.
    ///
    /// # Errors
    /// As for [`ControlHandle::set_label`].
    pub fn set_indicator(&self, indicator: Indicator) -> Result<(), Refusal> {
        self.ask(|id| ControlMessage::Indicate { id, indicator })
    }

    /// Enables or disables it for feet; cancels a press under way.
    ///
    /// # Errors
    /// As for [`ControlHandle::set_label`].
    pub fn set_enabled(&self, enabled: bool) -> Result<(), Refusal> {
        self.ask(|id| if enabled { ControlMessage::Enable { id } } else { ControlMessage::Disable { id } })
    }

    /// Locks or unlocks its value against feet and apps; cancels a press under way.
    ///
    /// # Errors
    /// As for [`ControlHandle::set_label`].
    pub fn set_locked(&self, locked: bool) -> Result<(), Refusal> {
        self.ask(|id| if locked { ControlMessage::Lock { id } } else { ControlMessage::Unlock { id } })
    }

    fn ask(&self, message: impl FnOnce(WidgetId) -> ControlMessage) -> Result<(), Refusal> {
        self.session.ask(message(self.id.clone()))
    }
}
