//! A slider: a foot's place along its track is its value, or moves it.
//!
//! ```text
//!  1  press                         -> Pressed
//!  2  absolute: the foot's place    -> Changed, also where it is pressed
//!  3  relative: pressing            -> the value stays (clutch); the foot's way moves it by `gain`
//!  4  relative: lift, press again   -> it goes on from where it was
//!  5  rate: the way from where it was pressed
//!                                   -> Changed at a speed that grows with it; none within a tenth of it
//!  6  off its area                  -> it keeps its foot: nothing ends, values stop at the ends
//!  7  lifting                       -> the value stays while the force falls (a lifting foot rolls)
//!  8  release, anywhere             -> Released
//!  9  a step, loss, an app stops it -> Changed (back to where it was), Cancelled
//! 10  a force that can't be trusted, a foot that rests
//!                                   -> the value stays
//! 11  steps                         -> only whole steps, with hysteresis between them
//! 12  an app sets it                -> no event; brought to range and steps
//! ```

use std::time::Duration;

use super::moment::{BehaviourInput, BehaviourMachine};
use super::number::ControlNumber;
use super::press::PressOutcome;
use super::rest::RestingPlace;
use super::scale::INITIAL;
use super::scale::QUANTUM;
use super::track::TrackFields;
use super::{Emitted, Scale, SetError, SliderTrack, Thresholds, Value};
use underfoot_format::{Flat, OneOf, choices, num, record};

record! {
    /// A slider: the foot's place along its track is its value, or moves it.
    pub struct SliderSpec = "Slider", Copy => |it, faults| it.scale.check_initial(&mut it.initial, faults);
    /// The thresholds of its press.
    pub thresholds: Thresholds = "", Flat;
    /// The direction in which its value grows.
    pub track: SliderTrack = "axis", TrackFields => SliderTrack::EAST;
    /// The effect of the foot's place on its value.
    pub mapping: Mapping = "mapping", OneOf => Mapping::Absolute;
    /// Its values.
    pub scale: Scale = "", Flat;
    /// Initial value, within the range.
    pub initial: f32 = "initial", INITIAL;
}

impl SliderSpec {
    /// An absolute slider that grows eastwards and begins at its low end.
    #[must_use]
    pub const fn new(thresholds: Thresholds, scale: Scale) -> Self {
        let (track, mapping) = (SliderTrack::EAST, Mapping::Absolute);
        Self { thresholds, track, mapping, scale, initial: scale.min }
    }
}

choices! {
    /// The effect of a foot's place on a slider's value.
    pub enum Mapping: Copy = Absolute;
    /// The place is the value.
    Absolute,
    /// The distance from the place of the press moves the value: a lift and another press extend the reach.
    Relative(Relative),
    /// The distance from the place of the press is the speed at which the value moves.
    Rate(Rate),
}

record! {
    /// The distance from the place of the press moves the value: a lift and another press extend the reach.
    pub struct Relative = "Relative", Copy;
    /// Ranges per length of the track.
    pub gain: f32 = "gain", num(0.01..=10.0) => 1.0;
}

record! {
    /// The distance from the place of the press is the speed at which the value moves.
    pub struct Rate = "Rate", Copy;
    /// Change of the value per second at full deflection, half the track.
    pub full_per_s: f32 = "full_per_s", num(1e-6..=1e6);
}

/// Share of the full deflection within which a rate slider stands still (our choice).
const DEAD: f32 = 0.1;

/// Maximum time by which one frame moves a rate slider.
const LONGEST: Duration = Duration::from_millis(20);

/// The state of a slider: it keeps its foot until the foot lets go, wherever that slides.
#[derive(Clone, Debug)]
pub(super) struct Slider {
    spec: SliderSpec,
    number: ControlNumber,
    /// Place of the press (rate) or last place of the foot (relative) along the track.
    anchor: Option<f32>,
    rest: RestingPlace,
}

impl Slider {
    pub(super) fn new(spec: SliderSpec) -> Self {
        Self {
            number: ControlNumber::new(spec.scale, spec.initial),
            spec,
            anchor: None,
            rest: RestingPlace::default(),
        }
    }

    fn slide(&mut self, share: f32, elapsed: Duration, emitted: &mut Emitted) {
        let range = self.spec.scale.range();
        match self.spec.mapping {
            Mapping::Absolute => self.number.follow(self.spec.scale.at(share), QUANTUM, emitted),
            Mapping::Relative(Relative { gain }) => {
                let way = share - self.anchor.replace(share).unwrap_or(share);
                self.number.move_by(way * gain * range, emitted);
            }
            Mapping::Rate(Rate { full_per_s }) => {
                let way = 2.0 * (share - *self.anchor.get_or_insert(share)).clamp(-0.5, 0.5);
                let speed = (way.abs() - DEAD).max(0.0) / (1.0 - DEAD) * way.signum();
                self.number.move_by(speed * full_per_s * elapsed.min(LONGEST).as_secs_f32(), emitted);
            }
        }
    }
}

impl BehaviourMachine for Slider {
    fn act(&mut self, moment: &BehaviourInput, emitted: &mut Emitted) {
        if moment.is(PressOutcome::Pressed) {
            self.anchor = None;
        }
        self.number.follow_press(moment.outcome, emitted);
        let place = moment.settled(&mut self.rest);
        let share = place.and_then(|place| self.spec.track.share_at(place, moment.size));
        match share {
            Some(share) => self.slide(share, moment.elapsed, emitted),
            // Motion in the meantime does not count as travel.
            None if matches!(self.spec.mapping, Mapping::Relative { .. }) => self.anchor = None,
            None => {}
        }
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
