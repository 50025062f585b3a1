//! Processing of requests from apps.

use super::Refusal;
use crate::engine::Engine;
use crate::widget::{SetError, Value, WidgetId};
use crate::wire::{ControlMessage, is_pattern, matches};

/// Carries out the request `message` on `engine`.
///
/// # Errors
/// [`Refusal`] if the engine rejects it; nothing has changed then.
pub(super) fn apply(engine: &mut Engine, message: &ControlMessage) -> Result<(), Refusal> {
    set(engine, message).map_err(|why| refusal(engine, message, why))
}

/// Returns the refusal of `message` for reason `why`, with the most similar names.
pub(super) fn refusal(engine: &Engine, message: &ControlMessage, why: SetError) -> Refusal {
    match (message.id(), message, why) {
        (_, ControlMessage::ShowPage { page }, _) => Refusal::unknown_page(page.as_str(), engine.layout()),
        (Some(id), _, SetError::Unknown) => Refusal::unknown_control(id.as_str(), engine.layout()),
        (Some(id), _, why) => Refusal::Control { id: id.clone(), why },
        // No other request can fail.
        (None, _, _) => Refusal::unknown_control("", engine.layout()),
    }
}

fn set(engine: &mut Engine, message: &ControlMessage) -> Result<(), SetError> {
    match message {
        ControlMessage::Set { id, value } => {
            let value = as_held(engine, id.as_str(), *value)?;
            engine.set_value(id.as_str(), value)
        }
        ControlMessage::Enable { id } => engine.set_enabled(id.as_str(), true),
        ControlMessage::Disable { id } => engine.set_enabled(id.as_str(), false),
        ControlMessage::Lock { id } => engine.set_locked(id.as_str(), true),
        ControlMessage::Unlock { id } => engine.set_locked(id.as_str(), false),
        ControlMessage::Indicate { id, indicator } => engine.set_indicator(id.as_str(), *indicator),
        ControlMessage::SetRange { id, least, greatest } => engine.set_range(id.as_str(), *least, *greatest),
        ControlMessage::ShowPage { page } => engine.set_page(page.as_str()),
        ControlMessage::Get { id } => engine.control(id.as_str()).map(drop).ok_or(SetError::Unknown),
        // The server processes these itself.
        ControlMessage::GetPage
        | ControlMessage::GetAll
        | ControlMessage::CancelAll
        | ControlMessage::Label { .. }
        | ControlMessage::Mute { .. }
        | ControlMessage::MuteTile { .. }
        | ControlMessage::UseSensors { .. }
        | ControlMessage::GetMute => Ok(()),
    }
}

/// Returns the controls that match the pattern `id`; empty if `id` is not a pattern, or is the name of a control.
pub(super) fn meant(engine: &Engine, id: &WidgetId) -> Vec<WidgetId> {
    if !is_pattern(id.as_str()) || engine.control(id.as_str()).is_some() {
        return Vec::new();
    }
    let ids = engine.layout().widgets.iter().map(|widget| &widget.id);
    ids.filter(|other| matches(id.as_str(), other.as_str())).cloned().collect()
}

/// Converts a number to on or off for a switch, and to a choice for a selector: OSC has no such types, or some apps
/// cannot send them.
fn as_held(engine: &Engine, id: &str, value: Value) -> Result<Value, SetError> {
    Ok(match (engine.value(id), value) {
        (Some(Value::Switch(_)), Value::Number(number)) => Value::Switch(number != 0.0),
        (Some(Value::Choice(_)), Value::Number(number)) => {
            let is_choice = number.fract() == 0.0 && (0.0..=f32::from(u16::MAX)).contains(&number);
            Value::Choice(if is_choice { number as u16 } else { return Err(SetError::NoSuchChoice) })
        }
        _ => value,
    })
}
