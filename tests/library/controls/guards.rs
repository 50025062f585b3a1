//! Guards; see `src/widget/guard.rs`.

use underfoot::units::Newtons;
use underfoot::widget::EventKind::{Armed, Disarmed, Warned};
use underfoot::widget::Value;

use super::bench::{Bench, Cancelled, Changed, Clicked, Pressed, Released, clicks};

const CONFIRM: &str = r#"kind: "confirm_button""#;

#[test]
fn confirm_lines_1_and_3_arm_then_press() {
    let mut bench = Bench::with(CONFIRM);
    bench.press();
    clicks(&mut bench);
    bench.lift();
    assert_eq!(bench.events(), [Pressed, Released, Armed]);
    assert!(bench.walker.engine.control("it").unwrap().is_armed());
    assert_eq!(clicks(&mut bench), 2, "the release, and that it is armed");
    bench.tap();
    assert_eq!(bench.events(), [Pressed, Released, Clicked, Disarmed]);
    assert!(!bench.walker.engine.control("it").unwrap().is_armed());
}

#[test]
fn confirm_line_2_a_first_press_that_slides_off_arms_nothing() {
    let mut bench = Bench::with(CONFIRM);
    bench.press();
    bench.slide_off();
    assert_eq!(bench.events(), [Pressed, Cancelled]);
}

#[test]
fn confirm_line_4_a_second_press_that_slides_off_does_nothing() {
    let mut bench = Bench::with(CONFIRM);
    bench.tap();
    bench.press();
    bench.slide_off();
    assert_eq!(bench.events(), [Pressed, Released, Armed, Pressed, Cancelled, Disarmed]);
}

#[test]
fn confirm_line_5_three_seconds_and_no_longer() {
    let mut bench = Bench::with(CONFIRM);
    bench.tap();
    bench.wait(2700);
    assert_eq!(bench.events(), [Pressed, Released, Armed]);
    bench.wait(300);
    assert_eq!(bench.events(), [Disarmed]);
    bench.tap();
    assert_eq!(bench.events(), [Pressed, Released, Armed], "too late, it is a first one");
}

#[test]
fn confirm_line_6_disarmed_with_the_floor_or_by_an_app() {
    let mut bench = Bench::with(CONFIRM);
    bench.tap();
    bench.walker.engine.set_enabled("it", false).unwrap();
    bench.walker.engine.set_enabled("it", true).unwrap();
    bench.wait(1);
    assert_eq!(bench.events(), [Pressed, Released, Armed, Disarmed]);
    bench.wait(100);
    bench.tap();
    bench.lose_the_floor();
    assert_eq!(bench.events(), [Pressed, Released, Armed, Disarmed]);
}

#[test]
fn confirm_guards_what_changes_at_once_as_well() {
    let mut bench = Bench::with(r#"kind: "stepper", guard: Confirm"#);
    bench.press_at(0.8, 0.5);
    bench.wait(2000);
    bench.lift();
    assert_eq!(bench.number(), 0.0, "armed only");
    bench.press_at(0.8, 0.5);
    bench.lift();
    assert_eq!(bench.number(), 1.0);
}

const ON: Value = Value::Switch(true);
const OFF: Value = Value::Switch(false);

/// Runs for 2 s at most, warns half a second before.
const RUN: &str = r#"kind: "dead_man", guard: HoldToRun(max_s: 2, warn_s: 0.5)"#;

/// Time for a deliberate foot to settle, plus the dwell.
const SETTLED: u64 = 600;

fn run(bench: &mut Bench) {
    bench.press();
    bench.wait(SETTLED);
    assert_eq!(bench.events(), [Pressed, Changed(ON)]);
}

#[test]
fn hold_to_run_lines_7_and_8_for_as_long_as_it_is_held() {
    let mut bench = Bench::with(RUN);
    run(&mut bench);
    bench.wait(800);
    assert_eq!(bench.value(), Some(ON));
    bench.lift();
    assert_eq!(bench.events(), [Changed(OFF), Released]);
}

#[test]
fn hold_to_run_line_9_off_while_untrusted() {
    let mut bench = Bench::with(RUN);
    run(&mut bench);
    bench.walker.untrusted = true;
    bench.wait(1);
    assert_eq!(bench.events(), [Changed(OFF), Cancelled], "one frame is enough");
    bench.walker.untrusted = false;
    bench.wait(1000);
    assert_eq!(bench.events(), [], "the foot must lift first");
    bench.lift();
    run(&mut bench);
    bench.slide_off();
    assert_eq!(bench.events(), [Changed(OFF), Cancelled]);
    run(&mut bench);
    bench.lose_the_floor();
    assert_eq!(bench.events(), [Changed(OFF), Cancelled]);
}

#[test]
fn hold_to_run_lines_10_and_11_warned_then_stopped_then_lifted() {
    let mut bench = Bench::with(RUN);
    run(&mut bench);
    clicks(&mut bench);
    bench.wait(1500);
    assert_eq!(bench.events(), [Warned]);
    assert_eq!(clicks(&mut bench), 1, "felt");
    bench.wait(500);
    assert_eq!(bench.events(), [Changed(OFF), Cancelled]);
    bench.wait(3000);
    assert_eq!(bench.events(), [], "still held");
    bench.lift();
    run(&mut bench);
}

#[test]
fn hold_to_run_a_foot_that_crosses_runs_nothing() {
    let mut bench = Bench::with(RUN);
    // A step's landing on the control, which lasts less than a quarter of a second.
    let at = bench.at(0.5, 0.5);
    bench.walker.step_at(at, Newtons(300.0));
    bench.wait(120);
    bench.lift();
    assert_eq!(bench.events(), []);
}

#[test]
fn a_pedal_can_run_on_a_hold_too() {
    let mut bench = Bench::with(r#"kind: "pedal", dwell_ms: 250, guard: HoldToRun(max_s: 2)"#);
    bench.press();
    bench.wait(SETTLED);
    assert!(bench.number() > 0.0);
    bench.walker.untrusted = true;
    bench.wait(1);
    assert_eq!(bench.number(), 0.0);
}
