//! Events, states and holds of controls.

use serde::{Deserialize, Serialize};

use super::text::{Few, Sentence, Word};
use super::value::{self, JsonValue};
use crate::engine::{ControlState, IgnoredPress, ValueRange};
use crate::sense::ContactId;
use crate::widget::{OffReason, WidgetEvent, WidgetId};

/// Maximum number of held controls that a reader keeps: as many as a layout has.
const MOST_HELD: usize = 4096;

/// Maximum number of options of a control that a reader keeps.
const MOST_OPTIONS: usize = 1024;

/// An event of a control.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct EventRecord {
    /// The name of its kind: [`crate::widget::EventKind::name`].
    pub event: Word,
    /// The control.
    pub id: Word,
    /// The new value of the control, or the direction of a swipe.
    pub value: JsonValue,
    /// Force of the foot, in newtons.
    pub force_n: f32,
    /// Position of the foot in floor metres, eastwards.
    pub x_m: f32,
    /// Position of the foot in floor metres, northwards.
    pub y_m: f32,
    /// The contact that caused the event; null if no foot did.
    pub contact: Option<ContactId>,
}

impl From<&WidgetEvent> for EventRecord {
    fn from(event: &WidgetEvent) -> Self {
        Self {
            event: event.kind.name().into(),
            id: event.id.as_str().into(),
            value: event.kind.detail().map(JsonValue::from).unwrap_or_default(),
            force_n: event.force.0,
            x_m: event.position.x,
            y_m: event.position.y,
            contact: event.contact,
        }
    }
}

/// The state of a control: a line `state`. Reading ignores a property of the wrong type.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct StateRecord {
    /// The control.
    pub id: Word,
    /// Its value.
    pub value: JsonValue,
    /// Minimum and maximum of a number, or of both numbers of a pair.
    pub range: JsonValue,
    /// Step of a number with steps.
    #[serde(deserialize_with = "value::number")]
    pub step: Option<f32>,
    /// The names of a selector's options.
    pub options: Option<Few<Word, MOST_OPTIONS>>,
    /// False while an app or an error of the floor file keeps it off.
    #[serde(deserialize_with = "value::flag")]
    pub enabled: Option<bool>,
    /// The name of the reason why it is off.
    #[serde(deserialize_with = "value::word")]
    pub off: Option<Word>,
    /// That reason as a sentence.
    pub off_text: Option<Sentence>,
    /// Whether an app has locked its value.
    #[serde(deserialize_with = "value::flag")]
    pub locked: Option<bool>,
    /// Whether a foot presses it.
    #[serde(deserialize_with = "value::flag")]
    pub pressed: Option<bool>,
    /// Whether a first press has armed it.
    #[serde(deserialize_with = "value::flag")]
    pub armed: Option<bool>,
    /// The state of its lamp, by name.
    #[serde(deserialize_with = "value::word")]
    pub indicator: Option<Word>,
    /// The text on it.
    #[serde(deserialize_with = "value::word")]
    pub label: Option<Word>,
    /// Its page; null if it is on all.
    pub page: Option<Word>,
}

impl From<&ControlState> for StateRecord {
    fn from(state: &ControlState) -> Self {
        let ControlState { id, value, range, enabled, off, locked, pressed, armed, indicator, label, page } =
            state;
        let (step, options) = match range {
            Some(ValueRange::Number(scale)) => ((scale.step > 0.0).then_some(scale.step), None),
            Some(ValueRange::Choices(choices)) => {
                (None, Some(choices.iter().map(|choice| Word::from(choice.as_str())).collect()))
            }
            Some(ValueRange::Pair(..)) | None => (None, None),
        };
        Self {
            id: id.as_str().into(),
            value: value.map(JsonValue::from).unwrap_or_default(),
            range: range.as_ref().map(JsonValue::from).unwrap_or_default(),
            step,
            options,
            enabled: Some(*enabled),
            off: off.as_ref().map(|off| off.reason.name().into()),
            off_text: off.as_ref().map(|off| off.text.as_str().into()),
            locked: Some(*locked),
            pressed: Some(*pressed),
            armed: Some(*armed),
            indicator: Some(indicator.name().into()),
            label: Some(label.as_str().into()),
            page: page.as_ref().map(|page| page.as_str().into()),
        }
    }
}

impl StateRecord {
    /// Whether an app has switched the control off; `None` if the line does not say whether it is on.
    #[must_use]
    pub fn is_disabled(&self) -> Option<bool> {
        self.enabled.map(|_| self.off.as_ref().is_some_and(|off| *off == OffReason::Disabled.name()))
    }
}

/// The controls that feet hold, in a line without an event.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct HeldRecord {
    /// The controls.
    pub held: Few<Word, MOST_HELD>,
    /// Number of the report, wrapping at 2^32.
    pub sequence: u32,
}

impl HeldRecord {
    /// The record of these controls.
    #[must_use]
    pub fn new(held: &[WidgetId], sequence: u32) -> Self {
        Self { held: held.iter().map(|id| id.as_str().into()).collect(), sequence }
    }
}

/// A press that a control ignored.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct IgnoredRecord {
    /// The control.
    pub id: Word,
    /// The name of the reason: [`crate::engine::Ignored::name`].
    pub reason: Word,
    /// The reason in a sentence.
    pub why: Sentence,
    /// The greatest force, in newtons.
    pub force_n: f32,
    /// The contact.
    pub contact: ContactId,
}

impl From<&IgnoredPress> for IgnoredRecord {
    fn from(press: &IgnoredPress) -> Self {
        Self {
            id: press.id.as_str().into(),
            reason: press.why.name().into(),
            why: Sentence(press.why.to_string()),
            force_n: press.force.0,
            contact: press.contact,
        }
    }
}
