//! How a control is, for those who ask.

use super::{Engine, Snapshot};
use crate::layout::Layout;
use crate::widget::{Behaviour, Indicator, Scale, Value, WidgetId};

/// How a control is, and what it can be.
#[derive(Clone, Debug, PartialEq)]
pub struct ControlState {
    /// Which control.
    pub id: WidgetId,
    /// What it holds; `None` for what holds nothing.
    pub value: Option<Value>,
    /// What it can hold; `None` for what holds nothing, or on and off.
    pub range: Option<ValueRange>,
    /// Whether it reacts to feet.
    pub enabled: bool,
    /// Whether it keeps its value.
    pub locked: bool,
    /// Whether a foot has it pressed.
    pub pressed: bool,
    /// Whether a first press has armed it.
    pub armed: bool,
    /// What its lamp shows.
    pub indicator: Indicator,
    /// What is written on it.
    pub label: String,
    /// The page it is on; `None` if it is on all of them.
    pub page: Option<WidgetId>,
}

/// What a control can hold.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueRange {
    /// Numbers.
    Number(Scale),
    /// Two numbers, eastwards and northwards.
    Pair(Scale, Scale),
    /// One of these, from 0.
    Choices(Vec<String>),
}

impl ValueRange {
    /// What a control of this behaviour can hold.
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
    /// How control number `index` of `layout` is in `snapshot`; `None` if there is none.
    pub(crate) fn of(layout: &Layout, index: usize, snapshot: &Snapshot) -> Option<Self> {
        let (widget, state) = (layout.widgets.get(index)?, snapshot.widgets.get(index)?);
        let range = snapshot.ranges.iter().find(|(of, _)| *of == index);
        let label = snapshot.labels.iter().find(|(of, _)| *of == index);
        Some(Self {
            id: widget.id.clone(),
            value: state.value,
            range: range
                .map(|(_, scale)| ValueRange::Number(*scale))
                .or_else(|| ValueRange::of(&widget.behaviour)),
            enabled: !state.disabled && !state.uncalibrated && state.hold_doubt.is_none(),
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
    /// How the control named `id` is; `None` for an unknown name.
    #[must_use]
    pub fn control_state(&self, id: &str) -> Option<ControlState> {
        let control = self.control(id)?;
        let layout = self.layout();
        let widget = layout.widgets.get(layout.widget_index(id)?)?;
        Some(ControlState {
            id: widget.id.clone(),
            value: control.value(),
            range: ValueRange::of(&widget.behaviour),
            enabled: !control.is_disabled() && !control.is_inhibited(),
            locked: control.is_locked(),
            pressed: control.is_engaged(),
            armed: control.is_armed(),
            indicator: control.indicator(),
            label: widget.label.clone(),
            page: widget.page_of(layout),
        })
    }
}
