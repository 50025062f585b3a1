use glam::Vec2;

use super::press::{Outcome, Press};
use super::{Axis, Emitted, EventKind, Input, SliderSpec, Value};
use crate::units::Instant;

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
    pub(super) press: Press,
    pub(super) value: f32,
    before: f32,
}

/// Smallest change worth an event where the slider has no steps, as a share of its range (our choice).
const QUANTUM: f32 = 1e-3;

impl Slider {
    pub(super) fn new(spec: SliderSpec) -> Self {
        Self { press: Press::new(spec.thresholds), value: spec.initial, before: spec.initial, spec }
    }

    pub(super) fn step(&mut self, now: Instant, input: Input) -> Emitted {
        let outcome = self.press.step(now, input);
        let mut emitted = self.emit(outcome);
        if let Input::Foot { place, .. } = input
            && self.press.is_firm()
        {
            self.follow(place, &mut emitted);
        }
        emitted
    }

    pub(super) fn cancel(&mut self) -> Emitted {
        let outcome = self.press.cancel();
        self.emit(outcome)
    }

    /// The nearest value the slider may take; NaN leaves it where it is.
    pub(super) fn settle(&self, value: f32) -> f32 {
        let SliderSpec { min, max, step, .. } = self.spec;
        if value.is_nan() {
            return self.value;
        }
        let value = value.clamp(min, max);
        if step > 0.0 { (min + ((value - min) / step).round() * step).min(max) } else { value }
    }

    fn emit(&mut self, outcome: Option<Outcome>) -> Emitted {
        match outcome {
            Some(Outcome::Pressed) => {
                self.before = self.value;
                Emitted::from_iter([EventKind::Pressed])
            }
            Some(Outcome::Released) => Emitted::from_iter([EventKind::Released]),
            Some(Outcome::Cancelled) => {
                let mut emitted = Emitted::new();
                if self.value != self.before {
                    self.value = self.before;
                    emitted.push(EventKind::Changed(Value::Number(self.value)));
                }
                emitted.push(EventKind::Cancelled);
                emitted
            }
            None => Emitted::new(),
        }
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
