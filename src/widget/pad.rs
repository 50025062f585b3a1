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

use super::moment::{BehaviourInput, BehaviourMachine};
use super::press::PressOutcome;
use super::rest::RestingPlace;
use super::scale::QUANTUM;
use super::scale::{VALUES, WIDTHS};
use super::{Emitted, EventKind, Scale, SetError, Thresholds, Value};
use underfoot_format::number::plain;
use underfoot_format::{Faults, Flat, Follow, Num, Pair, record};

/// A pair of numbers, eastwards and northwards.
const fn pair(each: Num) -> Pair {
    Pair { each, pattern: "(east, north)", parts: ["eastwards", "northwards"] }
}

record! {
    /// A pad with two axes; every setting is written eastwards and northwards.
    pub struct PadSpec = "Pad", Copy => PadSpec::rules;
    /// The thresholds of its press.
    pub thresholds: Thresholds = "", Flat;
    /// The least values.
    pub min: Vec2 = "min", pair(VALUES);
    /// The greatest values; more than `min`.
    pub max: Vec2 = "max", pair(VALUES);
    /// Distances between allowed values, counted from `min`; 0 for any value.
    pub step: Vec2 = "step", pair(WIDTHS) => Vec2::ZERO;
    /// Distances between values that attract the numbers, counted from `min`; 0 for none.
    pub detent: Vec2 = "detent", pair(WIDTHS) => Vec2::ZERO;
    /// Initial values.
    pub initial: Vec2 = "initial", Follow { explicit: pair(VALUES), otherwise: "the least" };
}

impl PadSpec {
    /// A pad with these values from west to east and from south to north; it begins at the least of both.
    #[must_use]
    pub const fn new(thresholds: Thresholds, x: Scale, y: Scale) -> Self {
        Self {
            thresholds,
            min: Vec2::new(x.min, y.min),
            max: Vec2::new(x.max, y.max),
            step: Vec2::new(x.step, y.step),
            detent: Vec2::new(x.detent, y.detent),
            initial: Vec2::new(x.min, y.min),
        }
    }

    /// The values from west to east.
    #[must_use]
    pub const fn x(&self) -> Scale {
        Scale { min: self.min.x, max: self.max.x, step: self.step.x, detent: self.detent.x }
    }

    /// The values from south to north.
    #[must_use]
    pub const fn y(&self) -> Scale {
        Scale { min: self.min.y, max: self.max.y, step: self.step.y, detent: self.detent.y }
    }

    fn rules(&mut self, faults: &mut Faults) {
        self.x().check(faults, "eastwards ");
        self.y().check(faults, "northwards ");
        let nearest = self.initial.min(self.max).max(self.min);
        if nearest != self.initial {
            let range = |scale: Scale| format!("{} to {}", plain(scale.min.into()), plain(scale.max.into()));
            let expected = format!("expected ({}, {})", range(self.x()), range(self.y()));
            faults.error(&["initial", "min", "max"], "`initial` lies outside of the range", expected);
        }
        self.initial = nearest;
    }
}

/// The state of a pad.
#[derive(Clone, Debug)]
pub(super) struct Pad {
    spec: PadSpec,
    value: Vec2,
    before: Vec2,
    rest: RestingPlace,
}

impl Pad {
    pub(super) fn new(spec: PadSpec) -> Self {
        let value = Vec2::new(spec.x().settle(spec.initial.x), spec.y().settle(spec.initial.y));
        Self { spec, value, before: value, rest: RestingPlace::default() }
    }

    fn change(&mut self, value: Vec2, emitted: &mut Emitted) {
        if value != self.value {
            self.value = value;
            emitted.push(EventKind::Changed(Value::Pair(value)));
        }
    }
}

impl BehaviourMachine for Pad {
    fn act(&mut self, moment: &BehaviourInput, emitted: &mut Emitted) {
        match moment.outcome {
            Some(PressOutcome::Pressed) => {
                self.before = self.value;
                emitted.push(EventKind::Pressed);
            }
            Some(PressOutcome::Released) => emitted.push(EventKind::Released),
            Some(PressOutcome::Cancelled) => {
                self.change(self.before, emitted);
                emitted.push(EventKind::Cancelled);
            }
            None => {}
        }
        if let Some(place) = moment.settled(&mut self.rest) {
            let (x, y) = (self.spec.x(), self.spec.y());
            let follow =
                |scale: Scale, now: f32, share| scale.follow(now, scale.at(share), QUANTUM).unwrap_or(now);
            self.change(
                Vec2::new(follow(x, self.value.x, place.x), follow(y, self.value.y, place.y)),
                emitted,
            );
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
        self.value = Vec2::new(self.spec.x().settle(pair.x), self.spec.y().settle(pair.y));
        Ok(())
    }

    fn captures(&self) -> bool {
        true
    }
}
