//! Dials; see `src/widget/dial.rs`.

use underfoot::glam::Vec2;
use underfoot::units::Newtons;
use underfoot::widget::{SetError, Value};

use super::bench::{Bench, Cancelled, Changed, FIRM, Pressed, Released, clicks};

/// A turn of 270 degrees from 0 to 27: ten degrees a step.
const DIAL: &str = r#"kind: "dial", max: 27, initial: 10"#;

/// Distance of the foot from the middle, in metres.
const REACH: f32 = 0.12;

/// Moves the foot around the middle from one angle to another, in degrees from east counter-clockwise.
fn turn(bench: &mut Bench, from: f32, to: f32) {
    let middle = bench.at(0.5, 0.5);
    for step in 1..=40 {
        let angle = from + (to - from) * step as f32 / 40.0;
        bench.walker.slide_to(middle + REACH * Vec2::from_angle(angle.to_radians()), 0.3);
    }
}

fn press_at(bench: &mut Bench, degrees: f32) {
    let at = bench.at(0.5, 0.5) + REACH * Vec2::from_angle(degrees.to_radians());
    bench.walker.step_at(at, FIRM);
    bench.wait(60);
}

#[test]
fn lines_1_to_4_clockwise_is_more() {
    let mut bench = Bench::with(DIAL);
    press_at(&mut bench, 180.0);
    assert_eq!((bench.events(), bench.number()), (vec![Pressed], 10.0));
    clicks(&mut bench);
    turn(&mut bench, 180.0, 90.0);
    bench.is_about(19.0, 1.5);
    assert!((7..=12).contains(&clicks(&mut bench)), "a click at each step");
    turn(&mut bench, 90.0, 180.0);
    bench.is_about(10.0, 1.5);
    bench.lift();
    let before = bench.number();
    press_at(&mut bench, 0.0);
    assert_eq!(bench.number(), before, "it goes on from where it was");
    turn(&mut bench, 0.0, -45.0);
    bench.is_about(before + 4.5, 1.6);
}

#[test]
fn line_5_near_the_middle_it_stands_still() {
    let mut bench = Bench::with(DIAL);
    press_at(&mut bench, 180.0);
    // Straight through the middle and out on the other side: not a turn.
    let west = bench.at(0.5, 0.5) + REACH * Vec2::new(1.0, 0.0);
    bench.walker.slide_to(west, 0.3);
    bench.is_about(10.0, 3.0);
}

#[test]
fn lines_6_to_8_it_stops_at_its_ends_and_comes_back_at_once() {
    let mut bench = Bench::with(DIAL);
    press_at(&mut bench, 180.0);
    turn(&mut bench, 180.0, -90.0);
    assert_eq!(bench.number(), 27.0);
    turn(&mut bench, -90.0, -45.0);
    bench.is_about(22.5, 1.6);
    let before = bench.number();
    bench.walker.press(Newtons(28.0));
    turn(&mut bench, -45.0, 45.0);
    bench.lift();
    assert_eq!(bench.number(), before, "lifting turns nothing");
    assert_eq!(bench.outline(), [Pressed, Released]);
}

#[test]
fn lines_9_to_11() {
    let mut bench = Bench::with(DIAL);
    press_at(&mut bench, 180.0);
    turn(&mut bench, 180.0, 90.0);
    let before = bench.number();
    bench.walker.untrusted = true;
    turn(&mut bench, 90.0, 0.0);
    assert_eq!(bench.number(), before, "forces that can't be trusted");
    bench.events();
    bench.lose_the_floor();
    assert_eq!(bench.events(), [Changed(Value::Number(10.0)), Cancelled]);
    let engine = &mut bench.walker.engine;
    assert_eq!(engine.set_value("it", Value::Number(99.4)), Ok(()));
    assert_eq!(engine.value("it"), Some(Value::Number(27.0)));
    assert_eq!(engine.set_value("it", Value::Choice(1)), Err(SetError::WrongType));
}
