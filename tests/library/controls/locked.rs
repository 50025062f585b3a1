//! Requests of apps to controls: disable, lock, light a lamp; and the shared press, see `src/widget/press.rs`.

use underfoot::engine::Snapshot;
use underfoot::glam::Vec2;
use underfoot::units::Newtons;
use underfoot::widget::EventKind::Refused;
use underfoot::widget::{Indicator, SetError, Value};

use super::bench::{Bench, Cancelled, Changed, Clicked, Pressed, Released, clicks};

const KINDS: [&str; 10] =
    ["button", "hold", "switch", "selector", "slider", "pedal", "pad", "dial", "stepper", "lean"];

#[test]
fn a_locked_control_says_so_and_stays_as_it_is() {
    for kind in KINDS {
        let mut bench = Bench::with(&format!("kind: \"{kind}\""));
        let before = bench.value();
        bench.walker.engine.set_locked("it", true).unwrap();
        bench.wait(100);
        bench.press_at(0.8, 0.6);
        bench.slide_to(0.3, 0.4);
        bench.wait(500);
        bench.lift();
        assert_eq!(bench.events(), [Refused], "{kind}");
        assert_eq!(bench.value(), before, "{kind}");
        assert_eq!(bench.walker.engine.set_value("it", Value::Number(1.0)), Err(SetError::Locked), "{kind}");
        assert!(bench.walker.engine.control("it").unwrap().is_locked());
    }
}

#[test]
fn a_disabled_control_says_nothing() {
    for kind in KINDS {
        let mut bench = Bench::with(&format!("kind: \"{kind}\""));
        let before = bench.value();
        bench.walker.engine.set_enabled("it", false).unwrap();
        bench.press_at(0.8, 0.6);
        bench.wait(500);
        bench.lift();
        assert_eq!((bench.events(), bench.value()), (vec![], before), "{kind}");
        assert_eq!(clicks(&mut bench), 0, "{kind}");
    }
}

#[test]
fn locking_cancels_and_unlocking_wants_a_lift() {
    let mut bench = Bench::with(r#"kind: "slider", initial: 0.5"#);
    bench.press_at(0.8, 0.5);
    bench.events();
    bench.walker.engine.set_locked("it", true).unwrap();
    bench.wait(1);
    assert_eq!(bench.events(), [Changed(Value::Number(0.5)), Cancelled]);
    bench.walker.engine.set_locked("it", false).unwrap();
    bench.wait(500);
    assert_eq!(bench.events(), [], "the foot is still on it");
    bench.lift();
    bench.press_at(0.8, 0.5);
    assert_eq!(bench.outline(), [Pressed]);
}

#[test]
fn a_locked_control_is_felt_where_its_kind_warns() {
    let mut bench = Bench::with(r#"kind: "confirm_button""#);
    bench.walker.engine.set_locked("it", true).unwrap();
    bench.wait(100);
    bench.tap();
    assert_eq!(bench.events(), [Refused]);
    assert!(clicks(&mut bench) > 0);
}

#[test]
fn lamps_and_states_are_read_back() {
    let mut bench = Bench::with(r#"kind: "confirm_button""#);
    for indicator in Indicator::ALL {
        bench.walker.engine.set_indicator("it", indicator).unwrap();
        assert_eq!(bench.walker.engine.control("it").unwrap().indicator(), indicator);
    }
    bench.tap();
    let mut snapshot = Snapshot::default();
    bench.walker.engine.snapshot(&mut snapshot);
    assert!(snapshot.widgets[0].armed && !snapshot.widgets[0].locked);
    assert_eq!(snapshot.widgets[0].indicator, Indicator::Attention);
    assert_eq!(bench.walker.engine.set_locked("nothing", true), Err(SetError::Unknown));
    assert_eq!(bench.walker.engine.set_indicator("nothing", Indicator::On), Err(SetError::Unknown));
    assert!(bench.walker.engine.control("nothing").is_none());
}

#[test]
fn press_lines_1_to_4_and_8_thresholds_dwell_and_lockout() {
    let mut bench =
        Bench::with(r#"kind: "button", press_n: 100, release_n: 60, dwell_ms: 100, lockout_ms: 300"#);
    bench.press_with(0.5, 0.5, Newtons(80.0));
    bench.wait(300);
    assert_eq!(bench.events(), [], "too light");
    bench.walker.press(Newtons(150.0));
    bench.walker.press(Newtons(40.0));
    bench.wait(50);
    assert_eq!(bench.events(), [], "a graze, shorter than the dwell");
    bench.walker.press(Newtons(150.0));
    bench.wait(150);
    assert_eq!(bench.events(), [Pressed]);
    bench.walker.press(Newtons(75.0));
    bench.wait(300);
    assert_eq!(bench.events(), [], "between the thresholds it stays");
    bench.lift();
    assert_eq!(bench.events(), [Released, Clicked]);
    // The release was 60 ms ago; 240 ms of the lockout are left, then the dwell.
    bench.press();
    assert_eq!(bench.events(), []);
    bench.wait(400);
    assert_eq!(bench.events(), [Pressed]);
}

/// Row R7 of the fault table.
#[test]
fn press_line_9_a_foot_that_slid_on_must_lift_first() {
    let mut bench = Bench::with(r#"kind: "button""#);
    let beside = bench.at(-0.6, 0.5);
    bench.walker.step_at(beside, Newtons(150.0));
    bench.wait(500);
    bench.slide_to(0.5, 0.5);
    bench.wait(500);
    assert_eq!(bench.events(), []);
    bench.lift();
    bench.press();
    assert_eq!(bench.events(), [Pressed]);
}

/// Row S12 of the fault table: a person falls and lands on the floor with several parts of the body.
#[test]
fn a_fall_confirms_nothing() {
    let mut bench = Bench::with(r#"kind: "confirm_button""#);
    let at = bench.at(0.5, 0.5);
    // A knee, a hip, a hand: heavy, moving, in several places within a second.
    for (way, force) in [(Vec2::ZERO, 900.0), (Vec2::new(0.06, 0.03), 500.0), (Vec2::new(-0.05, 0.1), 700.0)]
    {
        bench.walker.step_at(at + way, Newtons(force));
        bench.walker.slide_to(at + way + Vec2::new(0.0, 0.25), 1.5);
        bench.lift();
    }
    let events = bench.events();
    assert!(!events.contains(&Clicked), "{events:?}");
}
