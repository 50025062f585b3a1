//! What a control does, as its kind and its widget write it: one file per behaviour.

mod button;
mod dial;
mod guard;
mod lean;
mod pad;
mod pedal;
mod scale;
mod selector;
mod slider;
mod stepper;
mod switch;
mod thresholds;
pub(super) mod variant;

use std::time::Duration;

use super::fields::Fields;
use super::node::Node;
use crate::widget::{Behaviour, HoldSpec, Thresholds};

/// The behaviours by the names they have in kind files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Button,
    Hold,
    Switch,
    Selector,
    Slider,
    Pedal,
    Pad,
    Dial,
    Stepper,
    Lean,
}

impl Form {
    const ALL: [(&'static str, Self); 10] = [
        ("Button", Self::Button),
        ("Hold", Self::Hold),
        ("Switch", Self::Switch),
        ("Selector", Self::Selector),
        ("Slider", Self::Slider),
        ("Pedal", Self::Pedal),
        ("Pad", Self::Pad),
        ("Dial", Self::Dial),
        ("Stepper", Self::Stepper),
        ("Lean", Self::Lean),
    ];

    /// The behaviour named by `node`.
    pub(super) fn read(node: Node<'_>) -> Option<Self> {
        node.choice(&Self::ALL)
    }

    fn of(behaviour: &Behaviour) -> Self {
        match behaviour {
            Behaviour::Button(_) => Self::Button,
            Behaviour::Hold(_) => Self::Hold,
            Behaviour::Switch(_) => Self::Switch,
            Behaviour::Selector(_) => Self::Selector,
            Behaviour::Slider(_) => Self::Slider,
            Behaviour::Pedal(_) => Self::Pedal,
            Behaviour::Pad(_) => Self::Pad,
            Behaviour::Dial(_) => Self::Dial,
            Behaviour::Stepper(_) => Self::Stepper,
            Behaviour::Lean(_) => Self::Lean,
        }
    }

    /// Whether it does nothing beyond the press: nothing it did outlasts it.
    const fn is_momentary(self) -> bool {
        matches!(self, Self::Hold | Self::Pedal | Self::Lean)
    }
}

/// A behaviour of this form; its settings must all be written.
pub(super) fn read(fields: &mut Fields<'_>, form: Form) -> Option<Behaviour> {
    merge(fields, form, None)
}

/// `base` with the settings that are written.
pub(super) fn read_over(fields: &mut Fields<'_>, base: &Behaviour) -> Option<Behaviour> {
    merge(fields, Form::of(base), Some(base))
}

/// What `$base` holds if it is of this variant.
macro_rules! spec {
    ($base:expr, $variant:ident) => {
        match $base {
            Some(Behaviour::$variant(spec)) => Some(spec),
            _ => None,
        }
    };
}

fn merge(fields: &mut Fields<'_>, form: Form, base: Option<&Behaviour>) -> Option<Behaviour> {
    let at: Option<Thresholds> = thresholds::read(fields, form, base.map(Behaviour::thresholds));
    // All settings are read before what is missing ends it, so that each is reported.
    Some(match form {
        Form::Button => Behaviour::Button(button::read(fields, at, spec!(base, Button))?),
        Form::Hold => Behaviour::Hold(HoldSpec { thresholds: at? }),
        Form::Switch => Behaviour::Switch(switch::read(fields, at, spec!(base, Switch))?),
        Form::Selector => Behaviour::Selector(selector::read(fields, at, spec!(base, Selector))?),
        Form::Slider => Behaviour::Slider(slider::read(fields, at, spec!(base, Slider))?),
        Form::Pedal => Behaviour::Pedal(pedal::read(fields, at, spec!(base, Pedal))?),
        Form::Pad => Behaviour::Pad(pad::read(fields, at, spec!(base, Pad))?),
        Form::Dial => Behaviour::Dial(dial::read(fields, at, spec!(base, Dial))?),
        Form::Stepper => Behaviour::Stepper(stepper::read(fields, at, spec!(base, Stepper))?),
        Form::Lean => Behaviour::Lean(lean::read(fields, at, spec!(base, Lean))?),
    })
}

/// A number of single precision within `range`.
pub(super) fn single(node: Node<'_>, range: std::ops::RangeInclusive<f64>) -> Option<f32> {
    node.number(range).map(|number| number.single)
}

/// A field in milliseconds, of at most `most`.
fn millis(fields: &mut Fields<'_>, name: &'static str, base: Duration, most: f64) -> Option<Duration> {
    let base = base.as_secs_f32() * 1000.0;
    let millis = fields.read(name, Some(base), |node| single(node, 0.0..=most))?;
    Some(Duration::from_micros((f64::from(millis) * 1000.0).round() as u64))
}

/// A field in seconds within `range`.
fn seconds(node: Node<'_>, range: std::ops::RangeInclusive<f64>) -> Option<Duration> {
    node.number(range).map(|number| Duration::from_micros((number.value * 1e6).round() as u64))
}

/// What `read` makes of a field that may be written `None`, for what is not there at all.
pub(super) fn optional<T>(
    fields: &mut Fields<'_>,
    name: &'static str,
    base: Option<T>,
    read: impl FnOnce(Node<'_>) -> Option<T>,
) -> Option<Option<T>> {
    fields.read(name, Some(base), |node| if node.is_none() { Some(None) } else { read(node).map(Some) })
}
