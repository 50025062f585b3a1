//! An app's request on its way to a node, and its answer.

use serde::{Deserialize, Serialize};
use serde_json::Value as Argument;
use underfoot::engine::{ControlState, Off, ValueRange};
use underfoot::label::MAX_LABEL;
use underfoot::widget::{Indicator, OffReason, Scale, WidgetId};
use underfoot::wire::{ControlMessage, read_json, write_json};

use super::NodeValue;
use super::text::shown;

/// Greatest number of choices of a control.
const MOST_CHOICES: usize = 1024;

/// A request to one node, in the form in which an app sends it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NodeRequest {
    /// The request's number; a gateway gives each only once.
    pub number: u64,
    /// The area of the node to which it is addressed.
    pub area: String,
    /// The address without its prefix.
    pub path: String,
    /// The arguments.
    pub args: Vec<Argument>,
}

impl NodeRequest {
    /// The request number `number` to the node of `area`.
    #[must_use]
    pub fn of(number: u64, area: &str, message: &ControlMessage) -> Self {
        let (path, args) = write_json(message);
        Self { number, area: area.to_owned(), path, args }
    }

    /// The request as a control message.
    ///
    /// # Errors
    /// The reason why the path or the arguments are invalid.
    pub fn message(&self) -> Result<ControlMessage, String> {
        read_json(&self.path, &self.args)
    }
}

/// The answer to a request.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NodeAnswer {
    /// The gateway that sent the request.
    pub gateway: u64,
    /// The request's number.
    pub number: u64,
    /// The reason for a refusal; `None` if the node has done it.
    pub refused: Option<String>,
    /// The states of the controls that it concerns, afterwards.
    pub states: Vec<NodeState>,
}

/// The state of a control: [`ControlState`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NodeState {
    id: String,
    value: Option<NodeValue>,
    range: Option<NodeRange>,
    enabled: bool,
    /// The reason why it is off, by name and in a sentence.
    #[serde(default)]
    off: Option<(String, String)>,
    locked: bool,
    pressed: bool,
    armed: bool,
    indicator: String,
    label: String,
    page: Option<String>,
}

/// The range of a control: minimum, maximum, step and detent, of two numbers one after the other; or the choices.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum NodeRange {
    Number([f32; 4]),
    Pair([f32; 4], [f32; 4]),
    Choices(Vec<String>),
}

impl From<&ControlState> for NodeState {
    fn from(state: &ControlState) -> Self {
        let ControlState { id, value, range, enabled, off, locked, pressed, armed, indicator, label, page } =
            state;
        let numbers = |scale: &Scale| [scale.min, scale.max, scale.step, scale.detent];
        let range = range.as_ref().map(|range| match range {
            ValueRange::Number(scale) => NodeRange::Number(numbers(scale)),
            ValueRange::Pair(x, y) => NodeRange::Pair(numbers(x), numbers(y)),
            ValueRange::Choices(choices) => NodeRange::Choices(choices.clone()),
        });
        Self {
            id: id.as_str().to_owned(),
            value: value.map(NodeValue::from),
            range,
            enabled: *enabled,
            off: off.as_ref().map(|off| (off.reason.name().to_owned(), off.text.clone())),
            locked: *locked,
            pressed: *pressed,
            armed: *armed,
            indicator: indicator.name().to_owned(),
            label: label.clone(),
            page: page.as_ref().map(|page| page.as_str().to_owned()),
        }
    }
}

impl NodeState {
    /// All its ids: of the control and, if it has one, of the page.
    pub(super) fn ids(&self) -> impl Iterator<Item = &String> {
        std::iter::once(&self.id).chain(self.page.iter().filter(|page| !page.is_empty()))
    }

    /// Cleans and shortens its texts, which apps may show.
    pub(super) fn tidy(&mut self) {
        self.label = shown(&self.label, MAX_LABEL);
        if let Some(NodeRange::Choices(choices)) = &mut self.range {
            choices.truncate(MOST_CHOICES);
            choices.iter_mut().for_each(|choice| *choice = shown(choice, MAX_LABEL));
        }
    }

    /// The state as outputs take it.
    #[must_use]
    pub fn state(&self) -> ControlState {
        let scale = |[min, max, step, detent]: [f32; 4]| Scale { min, max, step, detent };
        let range = self.range.as_ref().map(|range| match range {
            NodeRange::Number(numbers) => ValueRange::Number(scale(*numbers)),
            NodeRange::Pair(x, y) => ValueRange::Pair(scale(*x), scale(*y)),
            NodeRange::Choices(choices) => ValueRange::Choices(choices.clone()),
        });
        let indicator = Indicator::ALL.into_iter().find(|one| one.name() == self.indicator);
        ControlState {
            id: WidgetId::new(&self.id),
            value: self.value.and_then(NodeValue::value),
            range,
            enabled: self.enabled,
            off: self.off.as_ref().and_then(|(name, text)| {
                Some(Off { reason: OffReason::from_name(name)?, text: text.clone() })
            }),
            locked: self.locked,
            pressed: self.pressed,
            armed: self.armed,
            indicator: indicator.unwrap_or_default(),
            label: self.label.clone(),
            page: self.page.as_deref().map(WidgetId::new),
        }
    }
}

#[cfg(test)]
mod tests {
    use underfoot::widget::Value;

    use super::*;

    #[test]
    fn requests_and_states_arrive_as_they_were() {
        let message = ControlMessage::Set { id: WidgetId::new("zoom"), value: Value::Number(0.1) };
        let bytes = serde_json::to_vec(&NodeRequest::of(7, "west", &message)).unwrap();
        let request: NodeRequest = serde_json::from_slice(&bytes).unwrap();
        assert_eq!((request.number, request.message()), (7, Ok(message)));
        let scale = Scale { step: 0.25, ..Scale::new(-1.0, 3.0) };
        let ranges = [
            None,
            Some(ValueRange::Number(scale)),
            Some(ValueRange::Pair(scale, Scale::new(0.0, 1.0))),
            Some(ValueRange::Choices(vec!["one".into(), "two".into()])),
        ];
        for range in ranges {
            let state = ControlState {
                id: WidgetId::new("zoom"),
                value: Some(Value::Number(0.5)),
                range,
                enabled: false,
                off: Some(Off { reason: OffReason::NotCalibrated, text: "not calibrated".into() }),
                locked: false,
                pressed: true,
                armed: false,
                indicator: Indicator::Busy,
                label: "Zoom".into(),
                page: Some(WidgetId::new("map")),
            };
            let bytes = serde_json::to_vec(&NodeState::from(&state)).unwrap();
            let read: NodeState = serde_json::from_slice(&bytes).unwrap();
            assert_eq!(read.state(), state);
        }
    }
}
