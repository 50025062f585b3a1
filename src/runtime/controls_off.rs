//! A floor whose controls are off for a while.

use super::session::Session;
use crate::serve::FloorCommand;
use crate::widget::WidgetId;
use crate::wire::ControlMessage;

/// Keeps the controls of a floor off as long as this value exists, so that people can walk over the floor to check
/// it. Cancels presses under way. On drop, switches on the controls that were on before.
#[derive(Debug)]
pub struct ControlsOff {
    session: Session,
    ids: Vec<WidgetId>,
}

impl Session {
    /// Switches off all controls that are on.
    #[must_use]
    pub fn controls_off(&self) -> ControlsOff {
        let seen = self.snapshot();
        let on = seen.layout.widgets.iter().zip(&seen.floor.widgets).filter(|(_, state)| !state.disabled);
        let ids: Vec<WidgetId> = on.map(|(widget, _)| widget.id.clone()).collect();
        for id in &ids {
            self.insist(FloorCommand::Control(ControlMessage::Disable { id: id.clone() }));
        }
        ControlsOff { session: self.clone(), ids }
    }
}

impl Drop for ControlsOff {
    fn drop(&mut self) {
        for id in self.ids.drain(..) {
            self.session.insist(FloorCommand::Control(ControlMessage::Enable { id }));
        }
    }
}
