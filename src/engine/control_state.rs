//! The state of one control, as reported to apps.

use super::{Engine, Snapshot};
use crate::floor::FloorFile;
use crate::layout::Layout;
use crate::widget::{Behaviour, Indicator, OffReason, Scale, Value, WidgetId};

/// The state of a control and its range of values.
#[derive(Clone, Debug, PartialEq)]
pub struct ControlState {
    /// The control's name.
    pub id: WidgetId,
    /// Its value; `None` for a control without one.
    pub value: Option<Value>,
    /// Its possible values; `None` for a switch and for a control without a value.
    pub range: Option<ValueRange>,
    /// Whether it reacts to feet: false while an app or a fault of the floor file keeps it off
    /// ([`OffReason::is_lasting`]). `off` also has the reasons that pass without a change of settings.
    pub enabled: bool,
    /// The reason why no foot can press it; `None` if a foot can.
    pub off: Option<Off>,
    /// Whether an app has locked its value.
    pub locked: bool,
    /// Whether a foot presses it now.
    pub pressed: bool,
    /// Whether a first press has armed it.
    pub armed: bool,
    /// The state of its lamp.
    pub indicator: Indicator,
    /// The text on it.
    pub label: String,
    /// Its page; `None` if it is on all of them.
    pub page: Option<WidgetId>,
}

/// A reason why a control is off.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Off {
    /// The reason.
    pub reason: OffReason,
    /// The reason as a sentence, with the name of the floor file where that matters.
    pub text: String,
}

impl Off {
    /// The reason for a floor that was read from `file`.
    #[must_use]
    pub fn new(reason: OffReason, file: &FloorFile) -> Self {
        Self { reason, text: reason.explain(file) }
    }
}

/// The possible values of a control.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueRange {
    /// A number on this scale.
    Number(Scale),
    /// Two numbers, eastwards and northwards.
    Pair(Scale, Scale),
    /// One of these options, counted from 0.
    Choices(Vec<String>),
}

impl ValueRange {
    /// The range of a control with this behaviour.
    fn of(behaviour: &Behaviour) -> Option<Self> {
        let unit = Scale::new(-1.0, 1.0);
        match behaviour {
            Behaviour::Button(_) | Behaviour::Hold(_) | Behaviour::Switch(_) => None,
            Behaviour::Slider(slider) => Some(Self::Number(slider.scale)),
            Behaviour::Pedal(pedal) => Some(Self::Number(pedal.scale)),
            Behaviour::Dial(dial) => Some(Self::Number(dial.scale)),
            Behaviour::Stepper(stepper) => Some(Self::Number(stepper.scale)),
            Behaviour::Pad(pad) => Some(Self::Pair(pad.x(), pad.y())),
            Behaviour::Lean(_) => Some(Self::Pair(unit, unit)),
            Behaviour::Selector(selector) => {
                Some(Self::Choices(selector.options.iter().map(|option| option.to_string()).collect()))
            }
        }
    }
}

impl ControlState {
    /// The state of control number `index` of `layout` in `snapshot`; `None` if there is no such control.
    pub fn of(layout: &Layout, index: usize, snapshot: &Snapshot) -> Option<Self> {
        let (widget, state) = (layout.widgets.get(index)?, snapshot.widgets.get(index)?);
        let range = snapshot.ranges.iter().find(|(of, _)| *of == index);
        let label = snapshot.labels.iter().find(|(of, _)| *of == index);
        Some(Self {
            id: widget.id.clone(),
            value: state.value,
            range: range
                .map(|(_, scale)| ValueRange::Number(*scale))
                .or_else(|| ValueRange::of(&widget.behaviour)),
            enabled: is_enabled(state.off),
            off: state.off.map(|reason| Off::new(reason, &snapshot.floor_file)),
            locked: state.locked,
            pressed: state.pressed,
            armed: state.armed,
            indicator: state.indicator,
            label: label.map_or(widget.label.as_str(), |(_, label)| label).to_owned(),
            page: widget.page_of(layout),
        })
    }
}

impl Engine {
    /// The state of the control named `id`; `None` for an unknown name.
    #[must_use]
    pub fn control_state(&self, id: &str) -> Option<ControlState> {
        let control = self.control(id)?;
        let layout = self.layout();
        let index = layout.widget_index(id)?;
        let (widget, off) = (layout.widgets.get(index)?, self.off(index));
        Some(ControlState {
            id: widget.id.clone(),
            value: control.value(),
            range: ValueRange::of(&widget.behaviour),
            enabled: is_enabled(off),
            off: off.map(|reason| Off::new(reason, self.floor_file())),
            locked: control.is_locked(),
            pressed: control.is_engaged(),
            armed: control.is_armed(),
            indicator: control.indicator(),
            label: widget.label.clone(),
            page: widget.page_of(layout),
        })
    }
}

fn is_enabled(off: Option<OffReason>) -> bool {
    !off.is_some_and(OffReason::is_lasting)
}
