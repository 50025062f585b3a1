//! Controls fed by hand, one input a millisecond.

use std::time::Duration;

use super::*;
use crate::units::{Instant, Newtons};
use glam::Vec2;

const AT: Thresholds =
    Thresholds { dwell: Duration::from_millis(5), ..Thresholds::new(Newtons(60.0), Newtons(40.0)) };

fn control(behaviour: &Behaviour) -> Control {
    Control::new(behaviour, Vec2::splat(0.3))
}

fn button() -> Control {
    control(&Behaviour::Button(ButtonSpec::new(AT)))
}

fn switch() -> Control {
    control(&Behaviour::Switch(SwitchSpec { thresholds: AT, initial: false }))
}

fn slider(step: f32) -> Control {
    let scale = Scale { step, ..Scale::new(0.0, 10.0) };
    let spec = SliderSpec { initial: 5.0, ..SliderSpec::new(AT, scale) };
    control(&Behaviour::Slider(spec))
}

fn foot(newtons: f32, share: f32) -> Input {
    Input::Foot { force: Newtons(newtons), trusted: true, place: Vec2::new(share, 0.5), weight: None }
}

/// Feeds each input for so many milliseconds, after a span without load.
fn play(control: &mut Control, inputs: &[(Input, u64)]) -> Vec<EventKind> {
    let mut now = Instant::START;
    for millis in 0..25 {
        now = Instant::from_millis(millis);
        control.step(now, Input::Clear);
    }
    let mut events = Vec::new();
    for &(input, millis) in inputs {
        for _ in 0..millis {
            now = now + Duration::from_millis(1);
            events.extend(control.step(now, input));
        }
    }
    events
}

#[test]
fn a_button_clicks_on_release_and_never_after_a_cancel() {
    use EventKind::{Cancelled, Clicked, Pressed, Released};
    let pressed = (foot(80.0, 0.5), 50);
    assert_eq!(play(&mut button(), &[pressed, (foot(0.0, 0.5), 10)]), [Pressed, Released, Clicked]);
    assert_eq!(play(&mut button(), &[pressed, (Input::SlidOff, 1)]), [Pressed, Cancelled]);
    assert_eq!(play(&mut button(), &[pressed, (Input::Lost, 200)]), [Pressed, Cancelled]);
}

#[test]
fn a_guard_that_confirms_waits_for_a_second_tap_and_leaves_nothing_of_it() {
    use EventKind::{Armed, Clicked, Disarmed, DoubleTapped, Pressed, Released};
    // No layout may set this, but an app can.
    let thresholds = Thresholds { guard: Guard::Confirm(Confirm { within: Duration::from_secs(3) }), ..AT };
    let mut spec = ButtonSpec::new(thresholds);
    spec.gestures.double_tap = Some(Duration::from_millis(350));
    let both = || control(&Behaviour::Button(spec));
    let tap = [(foot(80.0, 0.5), 50), (foot(0.0, 0.5), 10), (Input::Clear, 100)];
    let once = [tap, tap, [(Input::Clear, 400); 3]].concat();
    let armed = [Pressed, Released, Armed, Pressed, Released];
    assert_eq!(play(&mut both(), &once), [&armed[..], &[Clicked, Disarmed]].concat());
    let twice = [tap, tap, tap].concat();
    assert_eq!(
        play(&mut both(), &twice),
        [&armed[..], &[Pressed, Released, DoubleTapped, Disarmed]].concat()
    );
    let lost = [&tap[..], &tap[..], &[(Input::Lost, 1), (Input::Clear, 400)]].concat();
    assert_eq!(play(&mut both(), &lost), [&armed[..], &[Disarmed]].concat());
}

#[test]
fn a_switch_turns_over_on_release_only() {
    use EventKind::{Cancelled, Changed, Pressed, Released};
    let mut light = switch();
    let pressed = (foot(80.0, 0.5), 50);
    let on = Changed(Value::Switch(true));
    let pause = (Input::Clear, 100);
    let inputs = [pressed, (foot(0.0, 0.5), 10), pause, pressed, (Input::Lost, 1)];
    assert_eq!(play(&mut light, &inputs), [Pressed, Released, on, Pressed, Cancelled]);
    assert_eq!(light.value(), Some(Value::Switch(true)));
}

#[test]
fn a_slider_follows_its_foot_and_a_cancel_puts_it_back() {
    let mut zoom = slider(0.0);
    let events = play(&mut zoom, &[(foot(80.0, 0.5), 20), (foot(80.0, 0.7), 1), (foot(80.0, 1.4), 1)]);
    let changed = |value| EventKind::Changed(Value::Number(value));
    assert_eq!(events[0], EventKind::Pressed);
    assert!(matches!(events[1], EventKind::Changed(Value::Number(value)) if (value - 7.0).abs() < 1e-4));
    assert_eq!(events[2..], [changed(10.0)]);
    let mut now = Instant::from_millis(1000);
    assert_eq!(zoom.step(now, Input::Lost)[..], [changed(5.0), EventKind::Cancelled]);
    now = now + Duration::from_millis(1);
    zoom.step(now, Input::Clear);
    assert_eq!(zoom.value(), Some(Value::Number(5.0)));
}

#[test]
fn a_lifting_foot_does_not_drag_the_slider() {
    let mut zoom = slider(0.0);
    // 45 N is below the middle of press and release: the foot is on its way up and rolls to its toes.
    play(&mut zoom, &[(foot(80.0, 0.7), 20), (foot(45.0, 0.95), 10), (foot(0.0, 1.0), 10)]);
    assert!(matches!(zoom.value(), Some(Value::Number(value)) if (value - 7.0).abs() < 1e-4));
}

#[test]
fn steps_are_kept() {
    let mut level = slider(2.5);
    play(&mut level, &[(foot(80.0, 0.69), 20), (foot(0.0, 0.69), 10)]);
    assert_eq!(level.value(), Some(Value::Number(7.5)));
    assert_eq!(level.set_value(Value::Number(99.0)), Ok(()));
    assert_eq!(level.value(), Some(Value::Number(10.0)));
}

#[test]
fn an_app_sets_what_the_control_holds_and_only_that() {
    assert_eq!(button().set_value(Value::Switch(true)), Err(SetError::WrongType));
    assert_eq!(switch().set_value(Value::Number(1.0)), Err(SetError::WrongType));
    assert_eq!(slider(0.0).set_value(Value::Number(f32::NAN)), Err(SetError::NotFinite));
    let mut zoom = slider(0.0);
    play(&mut zoom, &[(foot(80.0, 0.5), 20)]);
    assert_eq!(zoom.set_value(Value::Number(1.0)), Err(SetError::InUse));
}

#[test]
fn switching_a_control_off_cancels_and_silences_it() {
    let mut home = button();
    play(&mut home, &[(foot(80.0, 0.5), 20)]);
    assert_eq!(home.set_disabled(true)[..], [EventKind::Cancelled]);
    assert!(home.step(Instant::from_millis(500), foot(80.0, 0.5)).is_empty());
    home.set_disabled(false);
    assert!(home.needs_lift());
}

#[test]
fn a_step_takes_back_whatever_a_press_did() {
    for behaviour in random::behaviours(AT) {
        let mut control = control(&behaviour);
        let before = control.value();
        let stepping = Input::Stepping { force: Newtons(500.0) };
        // Pressed, moved, and then recognised as a step that goes on for as long as a step does.
        let events = play(&mut control, &[(foot(130.0, 0.4), 60), (foot(130.0, 0.8), 60), (stepping, 400)]);
        assert_eq!(events.last(), Some(&EventKind::Cancelled), "{}", behaviour.name());
        assert_eq!(control.value(), before, "{}", behaviour.name());
        // The foot of a step that lands on it presses nothing at any force.
        let events = play(&mut control, &[(stepping, 400), (foot(500.0, 0.5), 200)]);
        assert_eq!(events, [], "{}", behaviour.name());
    }
}
