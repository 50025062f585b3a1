//! A dial: a foot that moves round its middle turns it.
//!
//! ```text
//!  1  press                          -> Pressed; the value stays, wherever the dial is touched
//!  2  clockwise round the middle     -> Changed, growing
//!  3  counter-clockwise              -> Changed, falling
//!  4  lift, press again              -> it goes on from where it was
//!  5  too near the middle            -> the value stays, and the turn goes on from where the foot comes out
//!  6  beyond either end              -> the value stops there, and comes back at once
//!  7  lifting                        -> the value stays while the force falls
//!  8  release, anywhere              -> Released
//!  9  a step, loss, an app stops it  -> Changed (back to where it was), Cancelled
//! 10  a force that can't be trusted  -> the value stays
//! 11  an app sets it                 -> no event; brought to range and steps
//! ```

use super::moment::{BehaviourInput, BehaviourMachine};
use super::number::ControlNumber;
use super::press::PressOutcome;
use super::rest::RestingPlace;
use super::scale::INITIAL;
use super::track::wrapped;
use super::{Emitted, Scale, SetError, Thresholds, Value};
use underfoot_format::{Flat, num, record};

record! {
    /// A dial.
    pub struct DialSpec = "Dial", Copy => |it, faults| it.scale.check_initial(&mut it.initial, faults);
    /// The thresholds of its press.
    pub thresholds: Thresholds = "", Flat;
    /// Its values; they grow clockwise.
    pub scale: Scale = "", Flat;
    /// Angle from the least to the greatest value, in degrees; may be several turns.
    pub turn_degrees: f32 = "turn_deg", num(45.0..=3600.0) => 270.0;
    /// Initial value, within the range.
    pub initial: f32 = "initial", INITIAL;
}

/// Share of the way from middle to edge within which the angle of a foot is undefined (our choice: a centimetre of
/// error there turns the dial by 20 degrees).
const HUB: f32 = 0.2;

/// The state of a dial.
#[derive(Clone, Debug)]
pub(super) struct Dial {
    spec: DialSpec,
    number: ControlNumber,
    /// Last angle of the foot, in radians.
    angle: Option<f32>,
    rest: RestingPlace,
}

impl Dial {
    pub(super) fn new(spec: DialSpec) -> Self {
        Self {
            number: ControlNumber::new(spec.scale, spec.initial),
            spec,
            angle: None,
            rest: RestingPlace::default(),
        }
    }
}

impl BehaviourMachine for Dial {
    fn act(&mut self, moment: &BehaviourInput, emitted: &mut Emitted) {
        if moment.is(PressOutcome::Pressed) {
            self.angle = None;
        }
        self.number.follow_press(moment.outcome, emitted);
        let hub = HUB * 0.5 * moment.size.min_element();
        let offset = moment.settled(&mut self.rest).map(|place| (place - 0.5) * moment.size);
        let angle = offset.filter(|offset| offset.length() >= hub).map(|offset| offset.to_angle());
        if let (Some(before), Some(now)) = (self.angle, angle) {
            let turned = -wrapped(now - before).to_degrees();
            self.number.move_by(turned / self.spec.turn_degrees * self.spec.scale.range(), emitted);
        }
        self.angle = angle;
    }

    fn value(&self) -> Option<Value> {
        Some(Value::Number(self.number.value()))
    }

    fn set(&mut self, value: Value) -> Result<(), SetError> {
        self.number.set(value)
    }

    fn captures(&self) -> bool {
        true
    }
}
