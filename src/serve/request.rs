//! What a floor does with what apps ask, and what it answers.

use crate::engine::Engine;
use crate::outgoing::{Readback, write_page, write_readback};
use crate::widget::{SetError, Value, WidgetId};
use crate::wire::{ControlMessage, Prefix, is_pattern, matches};

/// Does what `message` asks of `engine`; true if `answer` now holds what the asker is to be told.
///
/// # Errors
/// [`SetError`] if it can't be done; nothing has changed then.
pub(super) fn answer(
    engine: &mut Engine,
    prefix: &Prefix,
    message: &ControlMessage,
    answer: &mut Vec<u8>,
) -> Result<bool, SetError> {
    match message {
        ControlMessage::Set { id, value } => {
            let value = as_held(engine, id.as_str(), *value)?;
            engine.set_value(id.as_str(), value)?;
        }
        ControlMessage::Enable { id } => engine.set_enabled(id.as_str(), true)?,
        ControlMessage::Disable { id } => engine.set_enabled(id.as_str(), false)?,
        ControlMessage::Lock { id } => engine.set_locked(id.as_str(), true)?,
        ControlMessage::Unlock { id } => engine.set_locked(id.as_str(), false)?,
        ControlMessage::Label { id, text } => engine.set_label(id.as_str(), text)?,
        ControlMessage::Indicate { id, indicator } => engine.set_indicator(id.as_str(), *indicator)?,
        ControlMessage::ShowPage { page } => engine.set_page(page.as_str())?,
        ControlMessage::Get { id } => {
            let readback = readback(engine, id).ok_or(SetError::Unknown)?;
            write_readback(prefix, &readback, answer);
            return Ok(true);
        }
        ControlMessage::GetPage => {
            write_page(prefix, engine.page().unwrap_or_default(), answer);
            return Ok(true);
        }
        // Not for the engine: the server's own business.
        ControlMessage::Mute { .. } | ControlMessage::MuteTile { .. } | ControlMessage::GetMute => {}
    }
    Ok(false)
}

/// The controls that `id` means as a pattern; none if it is none, or the name of a control.
pub(super) fn meant(engine: &Engine, id: &WidgetId) -> Vec<WidgetId> {
    if !is_pattern(id.as_str()) || engine.control(id.as_str()).is_some() {
        return Vec::new();
    }
    let ids = engine.layout().widgets.iter().map(|widget| &widget.id);
    ids.filter(|other| matches(id.as_str(), other.as_str())).cloned().collect()
}

fn readback<'a>(engine: &'a Engine, id: &'a WidgetId) -> Option<Readback<'a>> {
    let control = engine.control(id.as_str())?;
    let widget = engine.layout().widgets.get(engine.layout().widget_index(id.as_str())?)?;
    Some(Readback {
        id,
        value: control.value(),
        enabled: !control.is_disabled() && !control.is_inhibited(),
        locked: control.is_locked(),
        pressed: control.is_engaged(),
        armed: control.is_armed(),
        indicator: control.indicator(),
        label: &widget.label,
    })
}

/// A number stands for on or off where the control is a switch, and for a choice where it is a
/// selector: OSC has no such types, or some apps can't send them.
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
