//! Controls that act while they are held: `hold.rs`, `pedal.rs`, `lean.rs` in `src/widget/`.

use underfoot::glam::Vec2;
use underfoot::units::Newtons;
use underfoot::widget::{SetError, Value};

use super::bench::{Bench, Cancelled, Changed, Pressed, Released};

const ON: Value = Value::Switch(true);
const OFF: Value = Value::Switch(false);

#[test]
fn hold_lines_1_and_2_on_for_as_long_as_it_is_held() {
    let mut bench = Bench::with(r#"kind: "hold""#);
    bench.press();
    bench.wait(2000);
    assert_eq!(bench.events(), [Pressed, Changed(ON)]);
    assert_eq!(bench.value(), Some(ON));
    bench.lift();
    assert_eq!(bench.events(), [Changed(OFF), Released]);
}

#[test]
fn hold_line_3_off_however_it_ends() {
    let mut bench = Bench::with(r#"kind: "hold""#);
    bench.press();
    bench.slide_off();
    assert_eq!(bench.events(), [Pressed, Changed(ON), Changed(OFF), Cancelled]);
    bench.press();
    bench.walker.engine.set_enabled("it", false).unwrap();
    bench.wait(1);
    assert_eq!(bench.events(), [Pressed, Changed(ON), Changed(OFF), Cancelled]);
    bench.lift();
    bench.walker.engine.set_enabled("it", true).unwrap();
    bench.wait(100);
    bench.press();
    bench.lose_the_floor();
    assert_eq!(bench.events(), [Pressed, Changed(ON), Changed(OFF), Cancelled]);
}

#[test]
fn hold_line_4_pedal_line_8_lean_line_9_only_a_foot_can_hold() {
    for (kind, value) in
        [("hold", ON), ("pedal", Value::Number(0.5)), ("lean", Value::Pair(Vec2::new(0.5, 0.0)))]
    {
        let mut bench = Bench::with(&format!("kind: \"{kind}\""));
        let before = bench.value();
        assert_eq!(bench.walker.engine.set_value("it", value), Err(SetError::Momentary));
        assert_eq!(bench.value(), before);
    }
}

/// 45 N is 0, 245 N is 1, with a straight line between them.
const PEDAL: &str = r#"kind: "pedal", deadband_n: 45, full_n: 245, curve: 1"#;

#[test]
fn pedal_lines_1_to_5_force_is_the_value() {
    let mut bench = Bench::with(PEDAL);
    bench.press_with(0.5, 0.5, Newtons(145.0));
    bench.is_about(0.5, 0.08);
    bench.walker.press(Newtons(320.0));
    assert_eq!(bench.number(), 1.0);
    // Above the release threshold of 25 N, below the dead band.
    bench.walker.press(Newtons(35.0));
    assert_eq!(bench.number(), 0.0);
    assert!(bench.walker.engine.control("it").unwrap().is_engaged());
    bench.walker.press(Newtons(195.0));
    bench.lift();
    assert_eq!(bench.number(), 0.0);
    let events = bench.events();
    assert_eq!(events[0], Pressed);
    assert_eq!(events[events.len() - 2..], [Changed(Value::Number(0.0)), Released]);
}

#[test]
fn pedal_lines_6_and_7_nothing_is_left_of_a_lost_foot_and_an_untrusted_foot_moves_nothing() {
    let mut bench = Bench::with(PEDAL);
    bench.press_with(0.5, 0.5, Newtons(145.0));
    let before = bench.number();
    bench.walker.untrusted = true;
    bench.walker.press(Newtons(300.0));
    assert_eq!(bench.number(), before, "a force that can't be trusted");
    bench.walker.untrusted = false;
    bench.wait(5);
    assert_eq!(bench.number(), 1.0);
    bench.slide_off();
    let events = bench.events();
    assert_eq!(events[events.len() - 2..], [Changed(Value::Number(0.0)), Cancelled]);
}

#[test]
fn lean_lines_1_to_5_a_foot_that_settles_and_leans() {
    let mut bench = Bench::with(r#"kind: "lean""#);
    bench.press();
    bench.wait(300);
    // 5 mm is within the dead band of 8.
    let there = bench.at(0.5, 0.5);
    bench.walker.slide_to(there + Vec2::new(0.0, 0.005), 0.1);
    assert_eq!(bench.events(), [Pressed]);
    bench.walker.slide_to(there + Vec2::new(0.0, 0.05), 0.1);
    let north = bench.pair();
    assert!(north.y > 0.9 && north.x.abs() < 0.4, "{north}");
    bench.walker.slide_to(there + Vec2::new(-0.05, 0.0), 0.1);
    let west = bench.pair();
    assert!(west.x < -0.9 && west.y.abs() < 0.4, "{west}");
    bench.walker.slide_to(there, 0.1);
    bench.wait(50);
    assert!(bench.pair().length() < 0.3, "{}", bench.pair());
}

#[test]
fn lean_line_1_what_moves_while_the_foot_settles_is_no_lean() {
    let mut bench = Bench::with(r#"kind: "lean""#);
    let heel = bench.at(0.5, 0.35);
    bench.walker.step_at(heel, Newtons(150.0));
    // It rolls forward by 6 cm within a quarter of a second, as feet do.
    let ball = heel + Vec2::new(0.0, 0.06);
    bench.walker.slide_to(ball, 0.3);
    bench.wait(80);
    assert_eq!(bench.pair(), Vec2::ZERO);
}

#[test]
fn lean_lines_6_to_8_zero_however_it_ends() {
    let mut bench = Bench::with(r#"kind: "lean""#);
    let lean = |bench: &mut Bench| {
        bench.press();
        bench.wait(300);
        let to = bench.at(0.5, 0.5) + Vec2::new(0.05, 0.0);
        bench.walker.slide_to(to, 0.1);
        bench.events();
    };
    lean(&mut bench);
    let leaning = bench.pair();
    bench.walker.untrusted = true;
    let back = bench.at(0.5, 0.5);
    bench.walker.slide_to(back, 0.1);
    assert_eq!(bench.pair(), leaning, "a force that can't be trusted");
    bench.walker.untrusted = false;
    bench.wait(10);
    bench.lift();
    assert_eq!(bench.events().last(), Some(&Released));
    assert_eq!(bench.pair(), Vec2::ZERO);
    lean(&mut bench);
    bench.slide_off();
    let events = bench.events();
    assert_eq!(events[events.len() - 2..], [Changed(Value::Pair(Vec2::ZERO)), Cancelled]);
}
