//! An event on its way to the gateway.

use glam::Vec2;
use serde::{Deserialize, Serialize};
use underfoot::sense::ContactId;
use underfoot::units::{Instant, Newtons};
use underfoot::widget::{Detail, Direction, EventKind, Value, WidgetEvent, WidgetId};

/// A control's value in messages.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum NodeValue {
    /// On or off.
    Switch(bool),
    /// A number in the control's range.
    Number(f32),
    /// The index of the chosen option, from 0.
    Choice(u16),
    /// Two numbers, eastwards and northwards.
    Pair([f32; 2]),
    /// The direction of a foot: `north`, `east`, `south` or `west` as 0 to 3.
    Direction(u8),
}

/// One event of one control, as a node reports it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NodeEvent {
    /// The time of the event, on the node's clock.
    pub at: u64,
    /// The control.
    pub id: String,
    /// The kind of event: [`EventKind::name`].
    pub kind: String,
    /// The control's new value, or the direction of the foot.
    pub value: Option<NodeValue>,
    /// The node's number for the contact that caused it; `None` if no foot did.
    pub contact: Option<u32>,
    /// The force of that contact.
    pub force: f32,
    /// Its position, in floor metres.
    pub position: [f32; 2],
}

impl From<Value> for NodeValue {
    fn from(value: Value) -> Self {
        match value {
            Value::Switch(on) => Self::Switch(on),
            Value::Number(number) => Self::Number(number),
            Value::Choice(choice) => Self::Choice(choice),
            Value::Pair(pair) => Self::Pair(pair.into()),
        }
    }
}

impl NodeValue {
    /// The value; `None` for a direction and for numbers that a control cannot hold.
    #[must_use]
    pub fn value(self) -> Option<Value> {
        match self {
            Self::Switch(on) => Some(Value::Switch(on)),
            Self::Number(number) => number.is_finite().then_some(Value::Number(number)),
            Self::Choice(choice) => Some(Value::Choice(choice)),
            Self::Pair(pair) => Some(Vec2::from(pair)).filter(|pair| pair.is_finite()).map(Value::Pair),
            Self::Direction(_) => None,
        }
    }

    fn of(detail: Detail) -> Self {
        match detail {
            Detail::Value(value) => value.into(),
            Detail::Direction(direction) => {
                let number = (0_u8..).zip(Direction::ALL).find(|(_, one)| *one == direction);
                Self::Direction(number.map_or(0, |(number, _)| number))
            }
        }
    }

    fn direction(self) -> Option<Direction> {
        match self {
            Self::Direction(number) => Direction::ALL.get(usize::from(number)).copied(),
            _ => None,
        }
    }
}

impl NodeEvent {
    /// The message form of `event`.
    #[must_use]
    pub fn of(event: &WidgetEvent) -> Self {
        Self {
            at: event.at.micros(),
            id: event.id.as_str().to_owned(),
            kind: event.kind.name().to_owned(),
            value: event.kind.detail().map(NodeValue::of),
            contact: event.contact.map(|id| id.0),
            force: event.force.0,
            position: event.position.into(),
        }
    }

    /// The kind of event; `None` if no control reports that.
    #[must_use]
    pub fn event_kind(&self) -> Option<EventKind> {
        let detail = |value: NodeValue| {
            value.value().map(Detail::Value).or_else(|| value.direction().map(Detail::Direction))
        };
        EventKind::of(&self.kind, self.value.and_then(detail))
    }

    /// The event as outputs take it, with the time and the contact's number from the gateway; `None` if a control
    /// cannot report it.
    #[must_use]
    pub fn event(&self, at: Instant, contact: Option<u32>) -> Option<WidgetEvent> {
        let position = Vec2::from(self.position);
        (position.is_finite() && self.force.is_finite()).then_some(())?;
        Some(WidgetEvent {
            at,
            id: WidgetId::new(&self.id),
            kind: self.event_kind()?,
            contact: contact.map(ContactId),
            force: Newtons(self.force),
            position,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(kind: EventKind) -> WidgetEvent {
        let (at, id) = (Instant::from_micros(7), WidgetId::new("zoom"));
        WidgetEvent { at, id, kind, contact: Some(ContactId(3)), force: Newtons(1.5), position: Vec2::ONE }
    }

    #[test]
    fn every_kind_of_event_arrives_as_it_was() {
        let values =
            [Value::Switch(true), Value::Number(0.1), Value::Choice(3), Value::Pair(Vec2::new(0.5, -1.0))];
        let all = EventKind::PLAIN
            .into_iter()
            .chain(values.map(EventKind::Changed))
            .chain(Direction::ALL.map(EventKind::Swiped));
        for kind in all {
            let told = event(kind);
            let bytes = serde_json::to_vec(&NodeEvent::of(&told)).unwrap();
            let read: NodeEvent = serde_json::from_slice(&bytes).unwrap();
            assert_eq!(read.event(told.at, Some(3)), Some(told));
        }
    }

    #[test]
    fn what_no_control_does_is_no_event() {
        let mut odd = NodeEvent::of(&event(EventKind::Pressed));
        odd.kind = "jumped".into();
        assert_eq!(odd.event_kind(), None);
        odd.kind = "changed".into();
        assert_eq!(odd.event_kind(), None, "without a value");
        odd.value = Some(NodeValue::Number(f32::NAN));
        assert_eq!(odd.event_kind(), None);
        odd.kind = "pressed".into();
        odd.position[0] = f32::INFINITY;
        assert_eq!(odd.event(Instant::START, None), None);
    }
}
