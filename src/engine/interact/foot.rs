//! The input of a control from a foot, and how a foot operates each kind of control.

use glam::Vec2;

use super::belief::is_sensed;
use crate::engine::feet::PressMode;
use crate::layout::Widget;
use crate::sense::{Contact, ForceFrame};
use crate::units::Newtons;
use crate::widget::{Behaviour, Guard, Input};

/// The input of `widget` from a foot of a person of this `weight`; `may` is whether that foot may act on it.
pub(super) fn foot_input(
    contact: &Contact,
    widget: &Widget,
    frame: &ForceFrame,
    weight: Option<Newtons>,
    may: bool,
) -> Input {
    let trusted =
        may && contact.tiles.iter().all(|load| frame.quality.get(load.index).is_some_and(is_sensed));
    Input::Foot { force: contact.force, trusted, place: place(contact.centroid, widget), weight }
}

pub(super) fn place(position: Vec2, widget: &Widget) -> Vec2 {
    (position - widget.area.min) / widget.area.size()
}

impl PressMode {
    pub(super) fn of(widget: &Widget) -> Self {
        let held = matches!(widget.behaviour.thresholds().guard, Guard::HoldToRun { .. });
        match &widget.behaviour {
            Behaviour::Lean(_) => Self::Stand,
            Behaviour::Button(button) if !button.gestures.lasts() && !held => Self::Tap,
            Behaviour::Switch(_) | Behaviour::Selector(_) if !held => Self::Tap,
            Behaviour::Button(_) | Behaviour::Switch(_) | Behaviour::Selector(_) | Behaviour::Stepper(_) => {
                Self::Hold
            }
            Behaviour::Hold(_)
            | Behaviour::Slider(_)
            | Behaviour::Pedal(_)
            | Behaviour::Pad(_)
            | Behaviour::Dial(_) => Self::Follow,
        }
    }
}
