//! Steppers; see `src/widget/stepper.rs`.

use underfoot::units::Newtons;
use underfoot::widget::Value;

use super::bench::{Bench, Cancelled, Changed, Pressed, Released, clicks};

const STEPPER: &str =
    r#"kind: "stepper", initial: 5, max: 30, repeat_after_ms: 500, repeat_every_ms: 200, fastest_ms: 50"#;

fn to(number: f32) -> underfoot::widget::EventKind {
    Changed(Value::Number(number))
}

#[test]
fn lines_1_2_and_6_a_tap_is_a_step() {
    let mut bench = Bench::with(STEPPER);
    bench.press_at(0.8, 0.5);
    assert_eq!(clicks(&mut bench), 2, "the press and the step");
    bench.lift();
    assert_eq!(bench.events(), [Pressed, to(6.0), Released]);
    bench.press_at(0.2, 0.5);
    bench.lift();
    assert_eq!(bench.events(), [Pressed, to(5.0), Released]);
    let mut upright = Bench::with(&format!("{STEPPER}, axis: North"));
    upright.press_at(0.5, 0.85);
    upright.lift();
    assert_eq!(upright.number(), 6.0);
}

#[test]
fn line_3_held_it_repeats_ever_faster() {
    let mut bench = Bench::with(STEPPER);
    bench.press_at(0.8, 0.5);
    bench.wait(400);
    assert_eq!(bench.number(), 6.0, "not yet");
    bench.wait(100);
    assert_eq!(bench.number(), 7.0);
    bench.wait(1000);
    let slow = bench.number();
    bench.wait(1000);
    let fast = bench.number();
    assert!(fast - slow > slow - 7.0 + 2.0, "{slow} after a second, {fast} after another");
    bench.wait(2000);
    assert_eq!(bench.number(), 30.0, "line 5: no farther than its end");
}

#[test]
fn lines_4_and_8_off_its_half_lifting_or_untrusted_it_waits() {
    let mut bench = Bench::with(STEPPER);
    bench.press_at(0.7, 0.5);
    bench.slide_to(0.3, 0.5);
    bench.wait(1000);
    assert_eq!(bench.number(), 6.0, "on the other half");
    // 4 cm beyond the middle, which takes a seventh of a second.
    bench.slide_to(0.62, 0.5);
    bench.wait(250);
    assert_eq!(bench.number(), 6.0, "back, but not for long");
    bench.wait(250);
    assert_eq!(bench.number(), 7.0);
    bench.walker.untrusted = true;
    bench.wait(1000);
    assert_eq!(bench.number(), 7.0, "forces that can't be trusted");
    bench.walker.untrusted = false;
    // 44 N: above the release threshold, but below the force of a foot that stays.
    bench.walker.press(Newtons(44.0));
    bench.wait(1000);
    assert_eq!(bench.number(), 7.0, "lifting");
}

#[test]
fn lines_7_and_9_a_cancel_takes_every_step_back() {
    let mut bench = Bench::with(STEPPER);
    bench.press_at(0.8, 0.5);
    bench.wait(1000);
    assert!(bench.number() > 7.0);
    bench.slide_off();
    let events = bench.events();
    assert_eq!(events[events.len() - 2..], [to(5.0), Cancelled]);
    assert_eq!(bench.walker.engine.set_value("it", Value::Number(7.4)), Ok(()));
    assert_eq!(bench.number(), 7.0);
}
