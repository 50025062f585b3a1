//! A pad: the foot's place on it is a pair of numbers.
//!
//! ```text
//!  1  press                          -> Pressed, Changed if the foot is not where the mark was
//!  2  slide                          -> Changed
//!  3  off its area                   -> it keeps its foot: values stop at the edges
//!  4  lifting                        -> the values stay while the force falls
//!  5  release, anywhere              -> Released
//!  6  a step, loss, an app stops it  -> Changed (back to where it was), Cancelled
//!  7  a force that can't be trusted  -> the values stay
//!  8  an app sets it                 -> no event; brought to range and steps
//! ```

use glam::Vec2;

use super::moment::{Machine, Moment};
use super::press::Outcome;
use super::scale::QUANTUM;
use super::{Emitted, EventKind, Scale, SetError, Thresholds, Value};

/// A pad with two axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PadSpec {
    /// When it engages.
    pub thresholds: Thresholds,
    /// Values from west to east.
    pub x: Scale,
    /// Values from south to north.
    pub y: Scale,
    /// Values to begin with.
    pub initial: Vec2,
}

/// A pad at work.
#[derive(Clone, Debug)]
pub(super) struct Pad {
    spec: PadSpec,
    value: Vec2,
    before: Vec2,
}

impl Pad {
    pub(super) fn new(spec: PadSpec) -> Self {
        let value = Vec2::new(spec.x.settle(spec.initial.x), spec.y.settle(spec.initial.y));
        Self { spec, value, before: value }
    }

    fn change(&mut self, value: Vec2, emitted: &mut Emitted) {
        if value != self.value {
            self.value = value;
            emitted.push(EventKind::Changed(Value::Pair(value)));
        }
    }
}

impl Machine for Pad {
    fn act(&mut self, moment: &Moment, emitted: &mut Emitted) {
        match moment.outcome {
            Some(Outcome::Pressed) => {
                self.before = self.value;
                emitted.push(EventKind::Pressed);
            }
            Some(Outcome::Released) => emitted.push(EventKind::Released),
            Some(Outcome::Cancelled) => {
                self.change(self.before, emitted);
                emitted.push(EventKind::Cancelled);
            }
            None => {}
        }
        if let Some(foot) = moment.firm_foot() {
            let PadSpec { x, y, .. } = self.spec;
            let follow =
                |scale: Scale, now: f32, share| scale.follow(now, scale.at(share), QUANTUM).unwrap_or(now);
            let (east, north) = (foot.place.x, foot.place.y);
            self.change(Vec2::new(follow(x, self.value.x, east), follow(y, self.value.y, north)), emitted);
        }
    }

    fn value(&self) -> Option<Value> {
        Some(Value::Pair(self.value))
    }

    fn set(&mut self, value: Value) -> Result<(), SetError> {
        let Value::Pair(pair) = value else { return Err(SetError::WrongType) };
        if !pair.is_finite() {
            return Err(SetError::NotFinite);
        }
        self.value = Vec2::new(self.spec.x.settle(pair.x), self.spec.y.settle(pair.y));
        Ok(())
    }

    fn captures(&self) -> bool {
        true
    }
}
