//! Every behaviour with every guard, under random actions of feet and apps.

use std::sync::Arc;
use std::time::Duration;

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::*;
use crate::units::{Instant, Newtons};

/// Operations for each of the controls below, so that there are more than 10^5 of them.
const OPERATIONS: u32 = 10_000;

const AT: Thresholds = Thresholds::new(Newtons(60.0), Newtons(40.0));
const SIZE: Vec2 = Vec2::new(0.4, 0.3);
const LIMIT: Duration = Duration::from_millis(700);

/// One of each, without extras.
pub(super) fn behaviours(at: Thresholds) -> Vec<Behaviour> {
    let scale = Scale { step: 0.5, ..Scale::new(-1.0, 3.0) };
    let hard = HardStage { press: Newtons(120.0), release: Newtons(90.0) };
    let hard = Gestures { hard: Some(hard), ..Gestures::default() };
    let gestures = Gestures {
        double_tap: Some(Duration::from_millis(150)),
        long_press: Some(Duration::from_millis(300)),
        swipe_m: Some(0.1),
        ..hard
    };
    let button = ButtonSpec::new(at);
    let slider = SliderSpec { initial: 1.0, ..SliderSpec::new(at, Scale::new(-1.0, 3.0)) };
    let arc = SliderTrack::Arc { from_degrees: 180.0, to_degrees: 0.0 };
    let repeat = Repeat {
        after: Some(Duration::from_millis(100)),
        every: Duration::from_millis(40),
        fastest: Duration::from_millis(10),
    };
    vec![
        Behaviour::Button(button),
        Behaviour::Button(ButtonSpec { acts_on: ActsOn::Press, ..button }),
        Behaviour::Button(ButtonSpec { gestures, ..button }),
        Behaviour::Hold(HoldSpec { thresholds: at }),
        Behaviour::Switch(SwitchSpec { thresholds: at, initial: true }),
        Behaviour::Selector(SelectorSpec {
            thresholds: at,
            axis: Axis::East,
            options: ["a", "b", "c"].map(Arc::from).into(),
            initial: 1,
        }),
        Behaviour::Slider(slider),
        Behaviour::Slider(SliderSpec { scale, track: SliderTrack::Line { degrees: 30.0 }, ..slider }),
        Behaviour::Slider(SliderSpec { scale: Scale { detent: 1.0, ..slider.scale }, track: arc, ..slider }),
        Behaviour::Slider(SliderSpec { mapping: Mapping::Relative(Relative { gain: 2.0 }), ..slider }),
        Behaviour::Slider(SliderSpec { mapping: Mapping::Rate(Rate { full_per_s: 8.0 }), scale, ..slider }),
        Behaviour::Pedal(PedalSpec {
            thresholds: at,
            scale: Scale::UNIT,
            deadband: Some(Newtons(60.0)),
            full: Newtons(150.0),
            curve: 2.0,
        }),
        Behaviour::Pad(PadSpec { initial: Vec2::ZERO, ..PadSpec::new(at, scale, Scale::UNIT) }),
        Behaviour::Dial(DialSpec { thresholds: at, scale, turn_degrees: 270.0, initial: 0.0 }),
        Behaviour::Stepper(StepperSpec { thresholds: at, axis: Axis::North, scale, initial: 0.0, repeat }),
        Behaviour::Lean(LeanSpec {
            thresholds: at,
            settle: Duration::from_millis(30),
            deadband_m: 0.01,
            full_m: 0.05,
        }),
    ]
}

fn all() -> Vec<Behaviour> {
    let confirm = Thresholds { guard: Guard::Confirm(Confirm { within: Duration::from_millis(900) }), ..AT };
    let run = Guard::HoldToRun(HoldToRun { max: LIMIT, warn: Some(Duration::from_millis(200)) });
    let run = Thresholds { guard: run, ..AT };
    let share = Thresholds { share: Some(WeightShare { press: 0.1, release: 0.06 }), ..AT };
    let momentary = |behaviour: &Behaviour| {
        matches!(behaviour, Behaviour::Hold(_) | Behaviour::Pedal(_) | Behaviour::Lean(_))
    };
    let mut all = behaviours(AT);
    all.extend(behaviours(confirm));
    all.extend(behaviours(share));
    all.extend(behaviours(run).into_iter().filter(momentary));
    all
}

#[derive(Clone, Copy, Debug)]
enum Op {
    Sense(Input, u32),
    Set(Value),
    Disable(bool),
    Lock(bool),
    Cancel,
}

/// A random action of a foot that presses, lifts and slides, mostly plausible.
fn op(random: &mut Pcg64Mcg, place: &mut Vec2) -> Op {
    let millis =
        if random.random_bool(0.1) { random.random_range(1..900) } else { random.random_range(1..60) };
    let force = Newtons(if random.random_bool(0.5) {
        random.random_range(0.0..45.0)
    } else {
        random.random_range(45.0..200.0)
    });
    match random.random_range(0..100) {
        0..=1 => return Op::Sense(Input::Lost, millis),
        2..=3 => return Op::Sense(Input::Stepping { force }, millis),
        4..=5 => return Op::Sense(Input::SlidOn { force }, 1),
        6..=7 => return Op::Sense(Input::SlidOff, 1),
        8..=15 => return Op::Sense(Input::Clear, millis),
        16 => return Op::Disable(random.random_bool(0.1)),
        17 => return Op::Lock(random.random_bool(0.1)),
        18 => return Op::Cancel,
        19 => return Op::Set(Value::Switch(random.random_bool(0.5))),
        20 => return Op::Set(Value::Number(random.random_range(-2.0..5.0))),
        21 => return Op::Set(Value::Number(f32::NAN)),
        22 => return Op::Set(Value::Choice(random.random_range(0..5))),
        23 => return Op::Set(Value::Pair(Vec2::new(random.random_range(-2.0..5.0), 0.3))),
        24..=44 => *place = Vec2::new(random.random_range(-0.3..1.3), random.random_range(-0.3..1.3)),
        45..=60 => *place += Vec2::new(random.random_range(-0.05..0.05), random.random_range(-0.05..0.05)),
        _ => {}
    }
    let at = if random.random_bool(0.01) { Vec2::NAN } else { *place };
    let weight = random.random_bool(0.3).then(|| Newtons(random.random_range(300.0..1200.0)));
    Op::Sense(Input::Foot { force, trusted: random.random_bool(0.97), place: at, weight }, millis)
}

/// The state of a control, derived from its events alone.
struct Watch<'a> {
    behaviour: &'a Behaviour,
    value: Option<Value>,
    before: Option<Value>,
    down: Option<Instant>,
    hard: bool,
    armed: bool,
    commits: u32,
}

impl Watch<'_> {
    fn guard(&self) -> Guard {
        self.behaviour.thresholds().guard
    }

    fn is_momentary(&self) -> bool {
        matches!(self.behaviour, Behaviour::Hold(_) | Behaviour::Pedal(_) | Behaviour::Lean(_))
    }

    /// Checks the events of one step; `clean` is whether the step may commit anything.
    fn take(&mut self, now: Instant, emitted: &[EventKind], clean: bool) {
        let confirm = matches!(self.guard(), Guard::Confirm { .. });
        let mut released = false;
        for event in emitted {
            match event {
                EventKind::Pressed => {
                    assert!(self.down.is_none());
                    self.down = Some(now);
                    self.before = self.value;
                }
                EventKind::Released | EventKind::Cancelled => {
                    assert!(self.down.take().is_some() && !(self.hard && *event == EventKind::Released));
                    released = *event == EventKind::Released;
                    self.hard = false;
                    assert!(clean || !released, "released while untrusted");
                    if !released && !self.is_momentary() {
                        assert_eq!(self.value, self.before, "a cancel takes everything back");
                    }
                }
                EventKind::HardPressed => {
                    assert!(self.down.is_some() && !self.hard);
                    self.hard = true;
                }
                EventKind::HardReleased => assert!(self.down.is_some() && std::mem::take(&mut self.hard)),
                EventKind::Clicked => {
                    let on_press = matches!(self.behaviour, Behaviour::Button(button)
                        if button.acts_on == ActsOn::Press);
                    let later = matches!(self.behaviour, Behaviour::Button(button)
                        if button.gestures.double_tap.is_some());
                    assert!(released || later || (on_press && self.down == Some(now)));
                    assert!(clean && (!confirm || self.armed || later));
                    self.commits += 1;
                }
                EventKind::DoubleTapped | EventKind::Swiped(_) => {
                    assert!(released && clean && (!confirm || self.armed));
                    self.commits += 1;
                }
                EventKind::LongPressed => assert!(self.down.is_some() && clean),
                EventKind::Ticked => assert!(self.down.is_some() && clean),
                EventKind::Changed(value) => {
                    assert_ne!(Some(*value), self.value, "a change is a change");
                    self.value = Some(*value);
                    assert!(!confirm || self.armed);
                    match value {
                        Value::Choice(choice) => assert!(*choice < 3 && released),
                        Value::Switch(_) if self.is_momentary() => {}
                        Value::Switch(_) => assert!(released),
                        Value::Number(_) | Value::Pair(_) => assert!(self.down.is_some()),
                    }
                    self.commits += 1;
                }
                EventKind::Armed => assert!(!std::mem::replace(&mut self.armed, true) && released),
                EventKind::Disarmed => assert!(std::mem::take(&mut self.armed)),
                EventKind::Warned => {
                    let Guard::HoldToRun(run) = self.guard() else { panic!("{event:?}") };
                    let held = now.since(self.down.unwrap());
                    assert!(held >= run.max - run.warns() && held < run.max);
                }
                EventKind::Refused => panic!("not locked"),
            }
        }
    }

    /// Checks the conditions that hold between any two operations.
    fn check(&self, now: Instant, control: &Control) {
        assert_eq!(control.is_engaged(), self.down.is_some());
        assert_eq!(control.is_armed(), self.armed);
        assert_eq!(control.value(), self.value);
        if let (Guard::HoldToRun(HoldToRun { max, .. }), Some(since)) = (self.guard(), self.down) {
            assert!(now.since(since) < max);
        }
        let on_steps = |scale: Scale, value: f32| {
            let steps = (value - scale.min) / scale.step;
            assert!((scale.min..=scale.max).contains(&value), "{value} out of range");
            assert!(scale.step == 0.0 || (steps - steps.round()).abs() < 1e-3, "{value} between steps");
        };
        match (self.behaviour, self.value) {
            (Behaviour::Slider(spec), Some(Value::Number(value))) => on_steps(spec.scale, value),
            (Behaviour::Dial(spec), Some(Value::Number(value))) => on_steps(spec.scale, value),
            (Behaviour::Stepper(spec), Some(Value::Number(value))) => on_steps(spec.scale, value),
            (Behaviour::Pad(spec), Some(Value::Pair(value))) => {
                on_steps(spec.x(), value.x);
                on_steps(spec.y(), value.y);
            }
            (Behaviour::Pedal(_), Some(Value::Number(value))) => {
                assert!((0.0..=1.0).contains(&value) && (value == 0.0 || self.down.is_some()));
            }
            (Behaviour::Lean(_), Some(Value::Pair(value))) => {
                assert!(value.length() < 1.001 && (value == Vec2::ZERO || self.down.is_some()));
            }
            (Behaviour::Hold(_), Some(Value::Switch(on))) => assert_eq!(on, self.down.is_some() && on),
            (Behaviour::Selector(_), Some(Value::Choice(choice))) => assert!(choice < 3),
            (Behaviour::Switch(_), Some(Value::Switch(_))) | (Behaviour::Button(_), None) => {}
            (behaviour, value) => panic!("a {} holds {value:?}", behaviour.name()),
        }
    }
}

/// Whether a step with `input` may commit something: live data, and no sign of a step or a slide.
fn is_clean(input: Input) -> bool {
    matches!(input, Input::Foot { trusted: true, .. } | Input::Clear)
}

fn work(behaviour: &Behaviour, seed: u64) -> u32 {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut control = Control::new(behaviour, SIZE);
    let value = control.value();
    let mut watch =
        Watch { behaviour, value, before: value, down: None, hard: false, armed: false, commits: 0 };
    let mut now = Instant::START;
    let mut place = Vec2::splat(0.5);
    for _ in 0..OPERATIONS {
        match op(&mut random, &mut place) {
            Op::Sense(input, millis) => {
                for _ in 0..millis {
                    now = now + Duration::from_millis(1);
                    let rested = control.is_at_rest() && input == Input::Clear;
                    let emitted = control.step(now, input);
                    assert!(!rested || emitted.is_empty(), "{emitted:?} from rest");
                    if control.is_locked() || control.is_disabled() {
                        let refused = emitted.iter().all(|event| *event == EventKind::Refused);
                        assert!(refused && (emitted.is_empty() || control.is_locked()), "{emitted:?}");
                    } else {
                        watch.take(now, &emitted, is_clean(input));
                    }
                    let running = matches!(watch.guard(), Guard::HoldToRun { .. });
                    assert!(!running || is_clean(input) || !control.is_engaged(), "off while untrusted");
                    watch.check(now, &control);
                }
            }
            Op::Set(value) => {
                let engaged = control.is_engaged();
                if control.set_value(value).is_ok() {
                    assert!(!engaged && !control.is_locked() && !watch.is_momentary());
                    watch.value = control.value();
                }
            }
            Op::Disable(disabled) => {
                let emitted = control.set_disabled(disabled);
                watch.take(now, &emitted, false);
            }
            Op::Lock(locked) => {
                let emitted = control.set_locked(locked);
                watch.take(now, &emitted, false);
            }
            Op::Cancel => {
                let emitted = control.cancel();
                watch.take(now, &emitted, false);
                assert!(control.needs_lift());
            }
        }
        watch.check(now, &control);
    }
    watch.commits
}

#[test]
fn whatever_feet_and_apps_do_each_press_ends_once_and_nothing_commits_while_untrusted() {
    let all = all();
    assert!(all.len() as u32 * OPERATIONS >= 100_000);
    for (seed, behaviour) in (0..).zip(&all) {
        let commits = work(behaviour, seed);
        // Enough presses counted for the checks to be meaningful.
        assert!(commits > 20, "only {commits} commits of {behaviour:?}");
    }
}
