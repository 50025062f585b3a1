//! N3 a silent link, N7 a burst after a delay, F10 another layout under a foot, R5 a window without a viewer, R6 a
//! floor that is lost while a slider is dragged.

use underfoot::glam::Vec2;
use underfoot::units::Newtons;
use underfoot::widget::{EventKind, Value};

use super::desk::{FIRM, at_the_map, clicks, middle};
use crate::support::layout;

fn home(kind: EventKind) -> (String, EventKind) {
    ("home".to_string(), kind)
}

#[test]
fn n3_a_silent_floor_is_safe_within_120_ms_and_starts_nothing_when_it_is_back() {
    let mut walker = at_the_map();
    walker.step_onto("home", FIRM);
    walker.wait(100);
    assert_eq!(walker.take_events(), [home(EventKind::Pressed)]);
    walker.connected = false;
    walker.wait(90);
    assert_eq!(walker.take_events(), [], "less than 100 ms is no loss");
    walker.wait(30);
    assert_eq!(walker.take_events(), [home(EventKind::Cancelled)]);
    walker.connected = true;
    walker.wait(2000);
    assert_eq!(walker.take_events(), [], "the foot that was there must lift first");
    walker.lift();
    walker.wait(100);
    assert!(clicks(&mut walker, "home"));
}

#[test]
fn n7_what_was_pressed_while_packets_were_delayed_is_not_replayed() {
    let mut walker = at_the_map();
    let place = middle(&walker, "home");
    walker.hold_back = true;
    // Pressed and lifted while no packet comes through; then all packets at once.
    walker.step_at(place, FIRM);
    walker.wait(120);
    walker.lift();
    walker.wait(40);
    walker.release_packets();
    walker.wait(1500);
    assert_eq!(walker.take_events(), [], "an old press");
    assert!(clicks(&mut walker, "home"), "and the next one counts");
}

#[test]
fn f10_a_layout_that_is_read_again_under_a_foot_waits_for_it() {
    let mut walker = at_the_map();
    walker.step_onto("home", FIRM);
    walker.wait(100);
    let mut moved = layout("map");
    let index = moved.widget_index("home").unwrap();
    moved.widgets[index].label = "Elsewhere".into();
    walker.engine.set_layout(moved.clone());
    walker.wait(200);
    assert_ne!(walker.engine.layout(), &moved, "deferred");
    walker.lift();
    walker.wait(50);
    assert_eq!(walker.engine.layout(), &moved);
    let kinds = [EventKind::Pressed, EventKind::Released, EventKind::Clicked];
    assert_eq!(walker.take_events(), kinds.map(home), "and the press counted");
}

#[test]
fn f10_a_control_that_vanished_from_the_layout_is_cancelled() {
    let mut walker = at_the_map();
    walker.step_onto("home", FIRM);
    walker.wait(100);
    let mut without = layout("map");
    without.widgets.retain(|widget| widget.id != "home");
    walker.engine.set_layout(without.clone());
    walker.wait(10);
    assert_eq!(walker.take_events(), [home(EventKind::Pressed), home(EventKind::Cancelled)]);
    assert_eq!(walker.engine.layout(), &without);
    walker.lift();
    walker.wait(100);
    assert_eq!(walker.take_events(), []);
}

#[test]
fn r5_feet_do_not_need_a_window() {
    // An engine without snapshots reports the same as one that is examined every millisecond.
    let events = |looked_at: bool| {
        let mut walker = at_the_map();
        walker.watched = looked_at;
        assert!(clicks(&mut walker, "pan_north"));
        walker.step_onto("zoom", Newtons(80.0));
        walker.wait(100);
        walker.lift();
        walker.wait(50);
        walker.take_events()
    };
    assert_eq!(events(true), events(false));
}

#[test]
fn r6_a_slider_whose_floor_is_lost_goes_back_to_where_it_was() {
    let mut walker = at_the_map();
    let before = walker.engine.value("zoom");
    let zoom = middle(&walker, "zoom");
    walker.step_at(zoom, Newtons(80.0));
    walker.wait(100);
    walker.slide_to(zoom + Vec2::new(0.1, 0.0), 0.3);
    assert_ne!(walker.engine.value("zoom"), before);
    walker.take_events();
    walker.connected = false;
    walker.wait(120);
    let events = walker.take_events();
    assert_eq!(walker.engine.value("zoom"), before);
    let zoom = |kind| ("zoom".to_string(), kind);
    let Some(Value::Number(number)) = before else { panic!("a slider holds a number") };
    assert_eq!(events, [zoom(EventKind::Changed(Value::Number(number))), zoom(EventKind::Cancelled)]);
}
