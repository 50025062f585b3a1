//! The messages of all controls and regions of a layout, ready to run.

use std::collections::BTreeSet;

use glam::Vec2;

use super::content::{self, ControlMoment};
use super::discovery;
use super::feet_settings::{ContactPayload, ContactSending};
use super::midi::MidiNote;
use super::order::{Act, Holdable, MessageOrder};
use super::sending::{Payload, Sending, When};
use super::target::{Destination, SendTarget};
use crate::floor::Rect;
use crate::widget::{Behaviour, Value, WidgetId};

/// Targets and messages of one layout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MessagePlan {
    /// The targets, by their index.
    pub targets: Vec<SendTarget>,
    /// The messages of all controls.
    pub(super) lines: Vec<MessageLine>,
    /// The messages of the feet in regions.
    pub(super) areas: Vec<AreaLine>,
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

/// One message of the feet in one region.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AreaLine {
    pub(super) region: WidgetId,
    pub(super) target: usize,
    pub(super) area: Rect,
    /// The controls in it, where a foot operates these.
    pub(super) controls: Vec<Rect>,
    /// The force in newtons at which a foot arrives.
    pub(super) press_n: f32,
    pub(super) payload: ContactPayload,
}

impl MessagePlan {
    /// A plan for these targets, without messages.
    #[must_use]
    pub fn new(targets: Vec<SendTarget>) -> Self {
        Self { targets, ..Self::default() }
    }

    /// Adds the messages of the control `id`; those for a target that is not in the plan are left out, since the
    /// reader of layouts reports them.
    pub fn add(&mut self, id: &WidgetId, behaviour: &Behaviour, sendings: &[Sending]) {
        for Sending { when, target, payload } in sendings {
            let Some(target) = self.index_of(target) else { continue };
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

    /// Adds the messages of the feet on the free floor of the region `id`, which has the places `controls` in it; those
    /// for a target that is not in the plan are left out.
    pub fn add_region(&mut self, id: &WidgetId, area: Rect, controls: &[Rect], sendings: &[ContactSending]) {
        for ContactSending { target, payload, press_n } in sendings {
            let Some(target) = self.index_of(target) else { continue };
            let (region, controls, press_n, payload) =
                (id.clone(), controls.to_vec(), *press_n, payload.clone());
            self.areas.push(AreaLine { region, target, area, controls, press_n, payload });
        }
    }

    /// The states that last from the start on: the levels and retained texts of the controls' first values, and the
    /// descriptions for Home Assistant.
    #[must_use]
    pub fn standing(&self) -> Vec<(usize, Act)> {
        let mut all = Vec::new();
        for line in &self.lines {
            let first = line.initial.filter(|_| line.when == When::Value);
            let moment = ControlMoment { value: first, ..ControlMoment::default() };
            let act = first.and_then(|value| content::of_value(line, &moment, value, 0));
            let described = match self.targets.get(line.target).map(|target| &target.to) {
                Some(Destination::Mqtt(target)) if target.discovery => discovery::description(line, target),
                _ => None,
            };
            let acts = [act, described.map(Act::Mqtt)].into_iter().flatten();
            all.extend(acts.filter(|act| act.standing().is_some()).map(|act| (line.target, act)));
        }
        all
    }

    fn index_of(&self, target: &str) -> Option<usize> {
        self.targets.iter().position(|it| it.name == *target)
    }

    /// Whether neither controls nor feet send anything.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty() && self.areas.is_empty()
    }

    /// Everything that these messages can hold down or stroke at each target: released before the first message.
    #[must_use]
    pub fn holdables(&self) -> BTreeSet<(usize, Holdable)> {
        let of_controls = self.lines.iter().filter_map(|line| Some((line.target, line.holdable()?)));
        let of_feet = self.areas.iter().flat_map(|line| {
            let members = match &line.payload {
                ContactPayload::Mpe(mpe) => mpe.feet,
                ContactPayload::Osc(..) | ContactPayload::Pointer => 0,
            };
            (0..members).map(|member| (line.target, Holdable::Notes(member.saturating_add(2))))
        });
        of_controls.chain(of_feet).collect()
    }
}

impl MessageLine {
    /// Everything that it holds down, or that an event lets sound; `None` if there is no such thing.
    pub(super) fn holdable(&self) -> Option<Holdable> {
        match (&self.payload, self.when) {
            (_, When::Value) => None,
            (Payload::Key(key), _) => Some(Holdable::Key(key.clone())),
            (Payload::Button(button), _) => Some(Holdable::Button(*button)),
            (Payload::Osc(address, _), When::While) => Some(Holdable::Osc(address.clone())),
            (Payload::Note(key, settings), _) => {
                Some(Holdable::Note(MidiNote { channel: settings.channel, key: *key }))
            }
            (Payload::Controller(settings), When::While) => Some(Holdable::Controller(*settings)),
            (Payload::Dmx(settings), When::While) => Some(Holdable::Dmx(*settings)),
            (Payload::Mqtt(topic, settings), When::While) => Some(Holdable::Mqtt(settings.switch(topic))),
            _ => None,
        }
    }

    /// The order for `act`.
    pub(super) fn order(&self, act: Act) -> MessageOrder {
        MessageOrder { target: self.target, control: self.control.clone(), act }
    }
}

impl AreaLine {
    /// Whether a foot at `point` of the floor is in the region and on no control.
    pub(super) fn is_free(&self, point: Vec2) -> bool {
        self.area.contains(point) && !self.controls.iter().any(|control| control.contains(point))
    }

    /// The place of `point` in the region, 0 to 1 eastwards and northwards.
    pub(super) fn share(&self, point: Vec2) -> Vec2 {
        let size = self.area.size().max(Vec2::splat(f32::MIN_POSITIVE));
        ((point - self.area.min) / size).clamp(Vec2::ZERO, Vec2::ONE)
    }

    /// The order for `act`.
    pub(super) fn order(&self, act: Act) -> MessageOrder {
        MessageOrder { target: self.target, control: self.region.clone(), act }
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
