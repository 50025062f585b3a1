//! Push buttons and gestures; see `src/widget/button.rs`.

use underfoot::units::Newtons;
use underfoot::widget::Direction;
use underfoot::widget::EventKind::{DoubleTapped, HardPressed, HardReleased, LongPressed, Swiped};

use super::bench::{Bench, Cancelled, Clicked, Pressed, Released};

const PLAIN: &str = r#"kind: "button""#;

#[test]
fn lines_1_and_2_press_and_release() {
    let mut bench = Bench::with(PLAIN);
    bench.press();
    assert_eq!(bench.events(), [Pressed]);
    bench.lift();
    assert_eq!(bench.events(), [Released, Clicked]);
}

#[test]
fn line_1_a_button_that_acts_on_press_clicks_at_once_and_not_again() {
    let mut bench = Bench::with(r#"kind: "button", acts_on: Press"#);
    bench.press();
    assert_eq!(bench.events(), [Pressed, Clicked]);
    bench.lift();
    assert_eq!(bench.events(), [Released]);
}

#[test]
fn line_3_sliding_off_and_losing_the_floor_cancel() {
    let mut bench = Bench::with(PLAIN);
    bench.press();
    bench.slide_off();
    assert_eq!(bench.events(), [Pressed, Cancelled]);
    bench.press();
    bench.lose_the_floor();
    assert_eq!(bench.events(), [Pressed, Cancelled]);
}

#[test]
fn lines_4_and_5_a_long_press_is_no_click_and_a_click_waits_for_the_release() {
    let mut bench = Bench::with(r#"kind: "button", long_press_ms: 500"#);
    bench.press();
    bench.wait(200);
    assert_eq!(bench.events(), [Pressed], "not yet known which");
    bench.lift();
    assert_eq!(bench.events(), [Released, Clicked]);
    bench.press();
    bench.wait(600);
    assert_eq!(bench.events(), [Pressed, LongPressed]);
    bench.lift();
    assert_eq!(bench.events(), [Released]);
}

#[test]
fn line_5_buttons_without_a_long_press_never_wait_for_one() {
    let mut bench = Bench::with(PLAIN);
    bench.press();
    bench.wait(3000);
    bench.lift();
    assert_eq!(bench.events(), [Pressed, Released, Clicked]);
}

const TWICE: &str = r#"kind: "button", double_tap_ms: 400"#;

#[test]
fn lines_6_and_7_one_tap_and_two() {
    let mut bench = Bench::with(TWICE);
    bench.tap();
    bench.wait(200);
    assert_eq!(bench.events(), [Pressed, Released], "a second one may come");
    bench.wait(400);
    assert_eq!(bench.events(), [Clicked]);
    bench.tap();
    bench.tap();
    bench.wait(600);
    assert_eq!(bench.events(), [Pressed, Released, Pressed, Released, DoubleTapped]);
}

#[test]
fn line_8_a_second_press_that_is_no_tap_leaves_the_first_one_a_click() {
    let mut bench = Bench::with(r#"kind: "button", double_tap_ms: 400, long_press_ms: 500"#);
    bench.tap();
    bench.press();
    bench.wait(600);
    bench.lift();
    assert_eq!(bench.events(), [Pressed, Released, Pressed, Clicked, LongPressed, Released]);
    let mut bench = Bench::with(TWICE);
    bench.tap();
    bench.press();
    bench.slide_off();
    bench.wait(500);
    assert_eq!(bench.events(), [Pressed, Released, Pressed, Cancelled, Clicked]);
}

#[test]
fn line_9_a_tap_that_waits_is_forgotten_with_the_floor() {
    let mut bench = Bench::with(TWICE);
    bench.tap();
    bench.lose_the_floor();
    bench.walker.connected = true;
    bench.wait(1500);
    assert_eq!(bench.events(), [Pressed, Released]);
}

#[test]
fn lines_10_to_12_a_swipe_is_as_long_as_its_kind_says() {
    let mut bench = Bench::with(r#"kind: "button", swipe_m: 0.1"#);
    bench.press_at(0.3, 0.5);
    bench.slide_to(0.8, 0.5);
    bench.lift();
    assert_eq!(bench.events(), [Pressed, Released, Swiped(Direction::East)]);
    // 30 cm to the south, far off the button: it keeps its foot.
    bench.press_at(0.5, 0.9);
    bench.slide_to(0.5, -0.1);
    bench.lift();
    assert_eq!(bench.events(), [Pressed, Released, Swiped(Direction::South)]);
    bench.press();
    bench.slide_to(0.6, 0.5);
    bench.lift();
    assert_eq!(bench.events(), [Pressed, Released, Clicked]);
    // 8 cm: too short for a swipe, but 5 cm beyond the edge.
    bench.press_at(0.92, 0.5);
    bench.slide_to(1.14, 0.5);
    bench.lift();
    assert_eq!(bench.events(), [Pressed, Cancelled]);
}

const STAGES: &str = r#"kind: "two_stage_button""#;

#[test]
fn lines_13_to_15_the_second_stage_comes_and_goes_within_the_press() {
    let mut bench = Bench::with(STAGES);
    bench.press_with(0.5, 0.5, Newtons(90.0));
    assert_eq!(bench.events(), [Pressed]);
    bench.walker.press(Newtons(230.0));
    assert_eq!(bench.events(), [HardPressed]);
    bench.walker.press(Newtons(80.0));
    assert_eq!(bench.events(), [HardReleased]);
    bench.lift();
    assert_eq!(bench.events(), [Released], "no click: it was hard");
    bench.press_with(0.5, 0.5, Newtons(230.0));
    bench.lift();
    assert_eq!(bench.events(), [Pressed, HardPressed, HardReleased, Released]);
    bench.press_with(0.5, 0.5, Newtons(90.0));
    bench.lift();
    assert_eq!(bench.events(), [Pressed, Released, Clicked], "lightly it clicks");
}

#[test]
fn line_16_a_cancel_ends_both_stages() {
    let mut bench = Bench::with(STAGES);
    bench.press_with(0.5, 0.5, Newtons(230.0));
    bench.slide_off();
    assert_eq!(bench.events(), [Pressed, HardPressed, Cancelled]);
}
