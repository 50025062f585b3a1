//! The messages of all controls of a layout, ready to run.

use std::collections::BTreeSet;

use super::order::Holdable;
use super::sending::{Payload, Sending, When};
use super::target::SendTarget;
use crate::widget::{Behaviour, Value, WidgetId};

/// Targets and messages of one layout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MessagePlan {
    /// The targets, by their index.
    pub targets: Vec<SendTarget>,
    /// The messages of all controls.
    pub(super) lines: Vec<MessageLine>,
}

/// One message of one control.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MessageLine {
    pub(super) control: WidgetId,
    pub(super) target: usize,
    pub(super) when: When,
    pub(super) payload: Payload,
    /// Ends of the control's value, eastwards and northwards.
    pub(super) ends: [[f32; 2]; 2],
    pub(super) initial: Option<Value>,
}

impl MessagePlan {
    /// A plan for these targets, without messages.
    #[must_use]
    pub fn new(targets: Vec<SendTarget>) -> Self {
        Self { targets, lines: Vec::new() }
    }

    /// Adds the messages of the control `id`; those for a target that is not in the plan are left out, since the
    /// reader of layouts reports them.
    pub fn add(&mut self, id: &WidgetId, behaviour: &Behaviour, sendings: &[Sending]) {
        for Sending { when, target, payload } in sendings {
            let Some(target) = self.targets.iter().position(|it| it.name == *target) else { continue };
            self.lines.push(MessageLine {
                control: id.clone(),
                target,
                when: *when,
                payload: payload.clone(),
                ends: ends(behaviour),
                initial: behaviour.initial(),
            });
        }
    }

    /// Whether no control sends anything.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Everything that these messages can hold down or stroke at each target: released before the first message.
    #[must_use]
    pub fn holdables(&self) -> BTreeSet<(usize, Holdable)> {
        self.lines.iter().filter_map(|line| Some((line.target, line.holdable()?))).collect()
    }
}

impl MessageLine {
    /// The key, button or address that it holds down; `None` if it holds nothing.
    pub(super) fn holdable(&self) -> Option<Holdable> {
        match (&self.payload, self.when) {
            (_, When::Value) => None,
            (Payload::Key(key), _) => Some(Holdable::Key(key.clone())),
            (Payload::Button(button), _) => Some(Holdable::Button(*button)),
            (Payload::Osc(address, _), When::While) => Some(Holdable::Osc(address.clone())),
            _ => None,
        }
    }
}

/// The ends of the value of a control, eastwards and northwards.
fn ends(behaviour: &Behaviour) -> [[f32; 2]; 2] {
    match behaviour {
        Behaviour::Pad(pad) => [[pad.min.x, pad.max.x], [pad.min.y, pad.max.y]],
        Behaviour::Pedal(pedal) => [[pedal.scale.min, pedal.scale.max]; 2],
        Behaviour::Selector(selector) => [[0.0, selector.options.len().saturating_sub(1) as f32]; 2],
        Behaviour::Lean(_) => [[-1.0, 1.0]; 2],
        Behaviour::Button(_) | Behaviour::Hold(_) | Behaviour::Switch(_) => [[0.0, 1.0]; 2],
        Behaviour::Slider(_) | Behaviour::Dial(_) | Behaviour::Stepper(_) => {
            behaviour.scale().map_or([[0.0, 1.0]; 2], |scale| [[scale.min, scale.max]; 2])
        }
    }
}
