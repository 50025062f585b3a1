use glam::Vec2;

use super::moment::{Acts, Moment};
use super::press::Outcome;
use super::{Axis, Emitted, EventKind, SetError, Thresholds, Value};

/// A slider: the foot's place along its axis is its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderSpec {
    /// When it engages.
    pub thresholds: Thresholds,
    /// Which way the value grows.
    pub axis: Axis,
    /// Value at the low end.
    pub min: f32,
    /// Value at the high end; greater than `min`.
    pub max: f32,
    /// Distance between the values it may take; 0 for any value.
    pub step: f32,
    /// Value to begin with, within the range.
    pub initial: f32,
}

/// A slider at work: it keeps its foot until the foot lets go, wherever that slides.
///
/// ```text
/// press               -> Pressed, Changed if the foot is not where the handle was
/// slide               -> Changed, at least a quantum apart
/// lifting             -> the value stays while the force falls (a lifting foot rolls)
/// release, anywhere   -> Released
/// loss                -> Changed (back to where it was), Cancelled
/// ```
#[derive(Clone, Debug)]
pub(super) struct Slider {
    spec: SliderSpec,
    value: f32,
    before: f32,
}

/// Smallest change worth an event where the slider has no steps, as a share of its range (our choice).
const QUANTUM: f32 = 1e-3;

impl Slider {
    pub(super) fn new(spec: SliderSpec) -> Self {
        Self { value: spec.initial, before: spec.initial, spec }
    }

    /// The nearest value the slider may take; NaN leaves it where it is.
    fn settle(&self, value: f32) -> f32 {
        let SliderSpec { min, max, step, .. } = self.spec;
        if value.is_nan() {
            return self.value;
        }
        let value = value.clamp(min, max);
        if step > 0.0 { (min + ((value - min) / step).round() * step).min(max) } else { value }
    }

    fn follow(&mut self, place: Vec2, emitted: &mut Emitted) {
        let SliderSpec { axis, min, max, .. } = self.spec;
        let share = match axis {
            Axis::East => place.x,
            Axis::North => place.y,
        };
        let value = self.settle(min + (max - min) * share);
        let at_an_end = value == min || value == max;
        let moved = (value - self.value).abs();
        if moved >= QUANTUM * (max - min) || (at_an_end && moved > 0.0) {
            self.value = value;
            emitted.push(EventKind::Changed(Value::Number(value)));
        }
    }
}

impl Acts for Slider {
    fn act(&mut self, moment: &Moment, emitted: &mut Emitted) {
        match moment.outcome {
            Some(Outcome::Pressed) => {
                self.before = self.value;
                emitted.push(EventKind::Pressed);
            }
            Some(Outcome::Released) => emitted.push(EventKind::Released),
            Some(Outcome::Cancelled) => {
                if self.value != self.before {
                    self.value = self.before;
                    emitted.push(EventKind::Changed(Value::Number(self.value)));
                }
                emitted.push(EventKind::Cancelled);
            }
            None => {}
        }
        if let Some(foot) = moment.firm {
            self.follow(foot.place, emitted);
        }
    }

    fn value(&self) -> Option<Value> {
        Some(Value::Number(self.value))
    }

    fn set(&mut self, value: Value) -> Result<(), SetError> {
        let Value::Number(number) = value else { return Err(SetError::WrongType) };
        if !number.is_finite() {
            return Err(SetError::NotFinite);
        }
        self.value = self.settle(number);
        Ok(())
    }

    fn captures(&self) -> bool {
        true
    }
}
