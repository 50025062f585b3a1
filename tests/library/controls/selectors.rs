//! Switches and selectors; see `switch.rs` and `selector.rs` in `src/widget/`.

use underfoot::widget::EventKind::Ticked;
use underfoot::widget::{SetError, Value};

use super::bench::{Bench, Cancelled, Changed, Pressed, Released, clicks};

#[test]
fn switch_lines_1_to_4() {
    let mut bench = Bench::with(r#"kind: "switch""#);
    let on = Value::Switch(true);
    bench.press();
    assert_eq!(bench.events(), [Pressed]);
    assert_eq!(bench.walker.engine.control("it").unwrap().pending(), Some(on));
    bench.lift();
    assert_eq!(bench.events(), [Released, Changed(on)]);
    bench.press();
    bench.slide_off();
    assert_eq!(bench.events(), [Pressed, Cancelled]);
    assert_eq!(bench.value(), Some(on));
    bench.walker.engine.set_value("it", Value::Switch(false)).unwrap();
    bench.wait(5);
    assert_eq!((bench.value(), bench.events()), (Some(Value::Switch(false)), vec![]));
    bench.press();
    bench.lose_the_floor();
    assert_eq!(bench.events(), [Pressed, Cancelled]);
    assert_eq!(bench.value(), Some(Value::Switch(false)));
}

/// Three options of 12 cm each, the first one chosen.
const TOOLS: &str = r#"kind: "selector", options: ["Pan", "Zoom", "Turn"]"#;

#[test]
fn selector_lines_1_2_and_4_where_the_foot_lets_go_is_chosen() {
    let mut bench = Bench::with(TOOLS);
    bench.press_at(0.5, 0.5);
    assert_eq!(bench.events(), [Pressed]);
    assert_eq!(bench.value(), Some(Value::Choice(0)), "nothing is chosen yet");
    clicks(&mut bench);
    bench.slide_to(0.85, 0.5);
    assert_eq!(bench.events(), [Ticked]);
    assert_eq!(clicks(&mut bench), 1, "felt as a step");
    bench.lift();
    assert_eq!(bench.events(), [Released, Changed(Value::Choice(2))]);
    bench.press_at(0.85, 0.5);
    bench.lift();
    assert_eq!(bench.events(), [Pressed, Released], "the same again is no change");
}

#[test]
fn selector_line_3_between_two_options_the_one_in_question_stays() {
    let mut bench = Bench::with(TOOLS);
    bench.press_at(0.5, 0.5);
    // 1 cm beyond the border, 1 cm back, repeatedly: sway.
    for _ in 0..5 {
        bench.slide_to(0.69, 0.5);
        bench.slide_to(0.64, 0.5);
    }
    assert_eq!(bench.events(), [Pressed]);
}

#[test]
fn selector_line_5_a_lifting_foot_chooses_nothing_else() {
    let mut bench = Bench::with(TOOLS);
    bench.press_at(0.5, 0.5);
    // 36 N: above the release threshold, but the foot is lifting; it rolls on to the next option.
    bench.walker.press(underfoot::units::Newtons(36.0));
    bench.slide_to(0.9, 0.5);
    bench.lift();
    assert_eq!(bench.events(), [Pressed, Released, Changed(Value::Choice(1))]);
}

#[test]
fn selector_lines_6_and_7() {
    let mut bench = Bench::with(TOOLS);
    bench.press_at(0.8, 0.5);
    bench.slide_off();
    assert_eq!(bench.outline(), [Pressed, Cancelled]);
    bench.press_at(0.8, 0.5);
    bench.lose_the_floor();
    assert_eq!(bench.events(), [Pressed, Cancelled]);
    assert_eq!(bench.value(), Some(Value::Choice(0)));
    let engine = &mut bench.walker.engine;
    assert_eq!(engine.set_value("it", Value::Choice(3)), Err(SetError::NoSuchChoice));
    assert_eq!(engine.set_value("it", Value::Number(1.5)), Err(SetError::NoSuchChoice));
    assert_eq!(engine.set_value("it", Value::Number(2.0)), Ok(()), "for senders without whole numbers");
    assert_eq!(bench.value(), Some(Value::Choice(2)));
}

#[test]
fn options_one_below_the_other_begin_in_the_north() {
    let mut bench =
        Bench::with(r#"kind: "selector", axis: North, options: ["Hot", "Warm", "Cold"], initial: 1"#);
    bench.press_at(0.5, 0.9);
    bench.lift();
    assert_eq!(bench.value(), Some(Value::Choice(0)));
    bench.press_at(0.5, 0.1);
    bench.lift();
    assert_eq!(bench.value(), Some(Value::Choice(2)));
}
