//! Sliders and pads; see `slider.rs` and `pad.rs` in `src/widget/`.

use underfoot::glam::Vec2;
use underfoot::units::Newtons;
use underfoot::widget::{SetError, SliderTrack, Value};

use super::bench::{Bench, Cancelled, Changed, Pressed, Released, clicks};

const PLAIN: &str = r#"kind: "slider", initial: 0.5"#;

#[test]
fn slider_lines_1_2_6_and_8_the_place_is_the_value() {
    let mut bench = Bench::with(PLAIN);
    bench.press_at(0.2, 0.5);
    let events = bench.events();
    assert!(matches!(events[..2], [Pressed, Changed(Value::Number(_))]), "{events:?}");
    bench.is_about(0.2, 0.06);
    bench.slide_to(0.7, 0.5);
    bench.is_about(0.7, 0.06);
    // 30 cm off it to the north and beyond its eastern end: it keeps its foot.
    bench.slide_to(1.3, 1.5);
    assert_eq!(bench.number(), 1.0);
    bench.lift();
    assert_eq!(bench.outline(), [Released]);
    assert_eq!(bench.number(), 1.0);
}

/// Along every kind of track, from a fifth to four fifths of the way.
#[test]
fn slider_line_2_along_any_track() {
    let tracks = [
        ("axis: North", SliderTrack::NORTH),
        ("angle_deg: 30", SliderTrack::Line { degrees: 30.0 }),
        ("angle_deg: 200", SliderTrack::Line { degrees: 200.0 }),
        ("arc_deg: (180, 0)", SliderTrack::Arc { from_degrees: 180.0, to_degrees: 0.0 }),
        ("arc_deg: (-45, 225)", SliderTrack::Arc { from_degrees: -45.0, to_degrees: 225.0 }),
    ];
    for (fields, track) in tracks {
        let mut bench = Bench::with(&format!("{PLAIN}, {fields}"));
        let size = bench.at(1.0, 1.0) - bench.at(0.0, 0.0);
        let place = |share| track.place_at(share, size);
        bench.press_at(place(0.2).x, place(0.2).y);
        bench.is_about(0.2, 0.1);
        for step in 1..=30 {
            let at = place(0.2 + 0.6 * step as f32 / 30.0);
            bench.slide_to(at.x, at.y);
        }
        bench.is_about(0.8, 0.1);
        bench.lift();
        bench.is_about(0.8, 0.1);
    }
}

#[test]
fn slider_lines_3_and_4_relative_sliders_move_and_can_be_lifted_back() {
    let mut bench = Bench::with(&format!("{PLAIN}, mapping: Relative(gain: 0.5)"));
    bench.press_at(0.9, 0.5);
    // A press changes the value only by the foot's tremor: the foot is at 0.9.
    bench.is_about(0.5, 0.01);
    bench.slide_to(0.5, 0.5);
    bench.is_about(0.3, 0.04);
    bench.lift();
    bench.press_at(0.9, 0.5);
    bench.is_about(0.3, 0.04);
    bench.slide_to(0.5, 0.5);
    bench.lift();
    bench.is_about(0.1, 0.06);
    // The value does not accumulate beyond the end: it comes back at once.
    bench.press_at(0.9, 0.5);
    bench.slide_to(0.1, 0.5);
    assert_eq!(bench.number(), 0.0);
    bench.slide_to(0.3, 0.5);
    bench.is_about(0.1, 0.04);
}

#[test]
fn slider_line_5_rate_sliders_run_as_fast_as_the_foot_is_away() {
    let mut bench = Bench::with(&format!("{PLAIN}, mapping: Rate(full_per_s: 0.2)"));
    bench.press_at(0.3, 0.5);
    bench.slide_to(0.33, 0.5);
    bench.wait(1000);
    assert_eq!(bench.number(), 0.5, "within a tenth it stands still");
    bench.slide_to(0.6, 0.5);
    let from = bench.number();
    bench.wait(1000);
    // Six tenths of full speed, less the dead band of a tenth.
    let moved = bench.number() - from;
    assert!((0.07..0.15).contains(&moved), "{moved} in a second");
    bench.lift();
    let stopped = bench.number();
    bench.wait(1000);
    assert_eq!(bench.number(), stopped);
}

#[test]
fn slider_line_7_a_lifting_foot_drags_nothing() {
    let mut bench = Bench::with(PLAIN);
    bench.press_at(0.3, 0.5);
    bench.walker.press(Newtons(28.0));
    bench.slide_to(0.8, 0.5);
    bench.lift();
    bench.is_about(0.3, 0.06);
}

#[test]
fn slider_lines_9_and_10_a_cancel_takes_it_back_and_an_untrusted_foot_moves_nothing() {
    let mut bench = Bench::with(PLAIN);
    bench.press_at(0.2, 0.5);
    let before = bench.number();
    bench.walker.untrusted = true;
    bench.slide_to(0.8, 0.5);
    assert_eq!(bench.number(), before, "forces that can't be trusted");
    bench.walker.untrusted = false;
    bench.wait(10);
    bench.is_about(0.8, 0.06);
    bench.events();
    clicks(&mut bench);
    bench.lose_the_floor();
    assert_eq!(bench.events(), [Changed(Value::Number(0.5)), Cancelled]);
    assert_eq!(clicks(&mut bench), 0, "a lost floor is not felt");
}

#[test]
fn slider_lines_11_and_12_steps_are_kept_and_felt() {
    let mut bench = Bench::with(r#"kind: "slider", max: 10, step: 2.5"#);
    bench.press_at(0.02, 0.5);
    clicks(&mut bench);
    bench.slide_to(0.98, 0.5);
    assert_eq!(bench.number(), 10.0);
    assert_eq!(clicks(&mut bench), 4, "one at each step");
    // A foot that sways by 1 cm around the border between 7.5 and 10.
    bench.slide_to(0.87, 0.5);
    bench.events();
    for _ in 0..5 {
        bench.slide_to(0.89, 0.5);
        bench.slide_to(0.86, 0.5);
    }
    assert_eq!(bench.events(), []);
    bench.lift();
    let engine = &mut bench.walker.engine;
    assert_eq!(engine.set_value("it", Value::Number(6.0)), Ok(()));
    assert_eq!(engine.value("it"), Some(Value::Number(5.0)), "brought to a step");
    assert_eq!(engine.set_value("it", Value::Number(f32::NAN)), Err(SetError::NotFinite));
    assert_eq!(engine.set_value("it", Value::Switch(true)), Err(SetError::WrongType));
}

#[test]
fn a_detent_holds_the_middle_and_is_felt() {
    let mut bench = Bench::with(r#"kind: "slider", min: -1, max: 1, detent: 1, initial: 0.6"#);
    bench.press_at(0.8, 0.5);
    clicks(&mut bench);
    bench.slide_to(0.5, 0.5);
    assert_eq!(bench.number(), 0.0, "exactly");
    assert_eq!(clicks(&mut bench), 1);
}

const PAD: &str = r#"kind: "pad", initial: (0.5, 0.5)"#;

#[test]
fn pad_lines_1_to_5_the_place_is_a_pair() {
    let mut bench = Bench::with(PAD);
    bench.press_at(0.25, 0.75);
    let near = |bench: &Bench, wanted: Vec2| {
        let pair = bench.pair();
        assert!(pair.distance(wanted) < 0.17, "{pair}, not {wanted}");
    };
    near(&bench, Vec2::new(-0.5, 0.5));
    bench.slide_to(0.75, 0.25);
    near(&bench, Vec2::new(0.5, -0.5));
    bench.slide_to(1.4, 0.25);
    assert_eq!(bench.pair().x, 1.0);
    bench.slide_to(0.6, 0.5);
    bench.walker.press(Newtons(28.0));
    let before = bench.pair();
    bench.slide_to(0.9, 0.5);
    bench.lift();
    assert_eq!(bench.pair(), before, "lifting moves nothing");
    assert_eq!(bench.outline(), [Pressed, Released]);
}

#[test]
fn pad_lines_6_to_8() {
    let mut bench = Bench::with(PAD);
    bench.press_at(0.25, 0.75);
    let before = bench.pair();
    bench.walker.untrusted = true;
    bench.slide_to(0.9, 0.1);
    assert_eq!(bench.pair(), before, "forces that can't be trusted");
    bench.events();
    bench.lose_the_floor();
    assert_eq!(bench.events(), [Changed(Value::Pair(Vec2::splat(0.5))), Cancelled]);
    let engine = &mut bench.walker.engine;
    assert_eq!(engine.set_value("it", Value::Pair(Vec2::new(9.0, -0.5))), Ok(()));
    assert_eq!(engine.value("it"), Some(Value::Pair(Vec2::new(1.0, -0.5))));
    assert_eq!(engine.set_value("it", Value::Pair(Vec2::NAN)), Err(SetError::NotFinite));
    assert_eq!(engine.set_value("it", Value::Number(0.1)), Err(SetError::WrongType));
}
