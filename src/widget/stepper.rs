//! A stepper: one half counts up, the other down, repeating while held.
//!
//! ```text
//!  1  press on the east (north) half     -> Pressed, Changed (a step up)
//!  2  press on the west (south) half     -> Pressed, Changed (a step down)
//!  3  held for `repeat_after`            -> Changed, again and again, ever faster down to `fastest`
//!  4  on the other half, or lifting      -> no more repeats until it is back for `repeat_after`
//!  5  at either end                      -> nothing more
//!  6  release                            -> Released
//!  7  slide off, a step, loss            -> Changed (back to where it was), Cancelled
//!  8  a force that can't be trusted      -> as 4
//!  9  an app sets it                     -> no event; brought to range and steps
//! ```

use std::time::Duration;

use super::moment::{BehaviourInput, BehaviourMachine, FootOnControl};
use super::number::ControlNumber;
use super::press::PressOutcome;
use super::scale::INITIAL;
use super::{Axis, Emitted, Scale, SetError, Thresholds, Value};
use underfoot_format::{Flat, Name, Opt, num, record};

use crate::units::Instant;

record! {
    /// A stepper.
    pub struct StepperSpec = "Stepper", Copy => |it, faults| {
        it.scale.check_initial(&mut it.initial, faults);
        if it.scale.step <= 0.0 {
            faults.error(&["step"], "a stepper needs a `step`", "expected more than 0");
        }
    };
    /// The thresholds of its press.
    pub thresholds: Thresholds = "", Flat;
    /// The half that counts up: the eastern or the northern one.
    pub axis: Axis = "axis", Name => Axis::East;
    /// Its values; its step is not 0.
    pub scale: Scale = "", Flat;
    /// Initial value, within the range.
    pub initial: f32 = "initial", INITIAL;
    /// The repetition of a held stepper.
    pub repeat: Repeat = "", Flat;
}

record! {
    /// The repetition of a held stepper; by default slow enough to let go in time.
    pub struct Repeat = "Repeat", Copy, Eq => |it, faults| {
        if it.fastest > it.every || it.fastest < Duration::from_millis(10) {
            let (fastest, every) = (it.fastest.as_millis(), it.every.as_millis());
            faults.error(
                &["fastest_ms", "repeat_every_ms"],
                "`fastest_ms` must be 10 or more and at most `repeat_every_ms`",
                format!("fastest_ms is {fastest}, repeat_every_ms is {every}"),
            );
        }
    };
    /// Time from the first step to the second; `None` for no repetition.
    pub after: Option<Duration> = "repeat_after_ms", Opt(num(50.0..=5000.0).milli())
        => Some(Duration::from_millis(600));
    /// Time from the second step to the third.
    pub every: Duration = "repeat_every_ms", num(0.0..=5000.0).milli() => Duration::from_millis(250);
    /// Minimum time between two steps, at most `every`.
    pub fastest: Duration = "fastest_ms", num(0.0..=5000.0).milli() => Duration::from_millis(60);
}

/// Ratio of each pause to the one before.
const ACCELERATION: f32 = 0.85;

/// The state of a stepper.
#[derive(Clone, Debug)]
pub(super) struct Stepper {
    spec: StepperSpec,
    number: ControlNumber,
    held: Option<Held>,
}

/// A press under way.
#[derive(Clone, Copy, Debug)]
struct Held {
    up: bool,
    /// Time of the next step, and the pause after it.
    next: Option<(Instant, Duration)>,
}

impl Stepper {
    pub(super) fn new(spec: StepperSpec) -> Self {
        Self { number: ControlNumber::new(spec.scale, spec.initial), spec, held: None }
    }

    fn is_up(&self, foot: FootOnControl) -> bool {
        match self.spec.axis {
            Axis::East => foot.place.x >= 0.5,
            Axis::North => foot.place.y >= 0.5,
        }
    }

    fn first(&self, now: Instant) -> Option<(Instant, Duration)> {
        self.spec.repeat.after.map(|after| (now + after, self.spec.repeat.every))
    }

    fn step(&mut self, up: bool, emitted: &mut Emitted) {
        let step = self.spec.scale.step;
        let wanted = self.number.value() + if up { step } else { -step };
        self.number.follow(wanted, 0.0, emitted);
    }
}

impl BehaviourMachine for Stepper {
    fn act(&mut self, moment: &BehaviourInput, emitted: &mut Emitted) {
        self.number.follow_press(moment.outcome, emitted);
        if moment.outcome.is_some() {
            self.held = None;
        }
        if moment.is(PressOutcome::Pressed)
            && let Some(foot) = moment.foot
        {
            let up = self.is_up(foot);
            self.held = Some(Held { up, next: self.first(moment.now) });
            self.step(up, emitted);
            return;
        }
        let Some(held) = self.held else { return };
        let again = self.first(moment.now);
        let stays = moment.firm_foot().is_some_and(|foot| self.is_up(foot) == held.up);
        let next = match held.next {
            Some((due, pause)) if stays && moment.now >= due => {
                self.step(held.up, emitted);
                let fastest = self.spec.repeat.fastest;
                Some((moment.now + pause, pause.mul_f32(ACCELERATION).max(fastest)))
            }
            waiting if stays => waiting,
            _ => again,
        };
        self.held = Some(Held { next, ..held });
    }

    fn value(&self) -> Option<Value> {
        Some(Value::Number(self.number.value()))
    }

    fn set(&mut self, value: Value) -> Result<(), SetError> {
        self.number.set(value)
    }
}
