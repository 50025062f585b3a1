//! R7 a slip from one control to another, R8 walking over controls, R9 a control held too long, S10 an object left on
//! the floor, S12 a person who jumps or falls.

use std::time::Duration;

use underfoot::engine::{FootRole, Snapshot};
use underfoot::glam::Vec2;
use underfoot::layout::Layout;
use underfoot::units::Newtons;
use underfoot::widget::{Behaviour, Confirm, EventKind, Guard, HoldToRun};
use underfoot_lab::experiment::{Guarded, IntentEffort, IntentTable};

use super::desk::{FIRM, at_the_map, clicks, middle};
use crate::support::{Walker, layout};

/// The map with this guard on every button.
fn guarded(guard: Guard) -> Layout {
    let mut page = layout("map");
    for widget in &mut page.widgets {
        if let Behaviour::Button(button) = &mut widget.behaviour {
            button.thresholds.guard = guard;
        }
    }
    page
}

fn in_front_of(page: Layout) -> Walker {
    let mut walker = Walker::on(page);
    walker.stand(Newtons(690.0));
    walker.wait(3000);
    walker
}

fn role(walker: &Walker, place: Vec2) -> Option<FootRole> {
    let contact = walker.contact_at(place)?.id;
    let mut snapshot = Snapshot::default();
    walker.engine.snapshot(&mut snapshot);
    snapshot.feet.iter().find(|foot| foot.contact == contact).map(|foot| foot.role)
}

const CONFIRM: Guard = Guard::Confirm(Confirm { within: Duration::from_secs(3) });
const HOLD: Guard =
    Guard::HoldToRun(HoldToRun { max: Duration::from_secs(4), warn: Some(Duration::from_secs(2)) });

#[test]
fn r7_a_foot_that_slides_from_one_control_to_the_next_cancels_the_first_and_needs_a_lift_for_the_second() {
    let mut walker = at_the_map();
    let (west, south) = (middle(&walker, "pan_west"), middle(&walker, "pan_south"));
    walker.step_at(west, FIRM);
    walker.wait(100);
    walker.slide_to(south, 0.3);
    walker.wait(500);
    let kinds = [EventKind::Pressed, EventKind::Cancelled];
    assert_eq!(walker.take_events(), kinds.map(|kind| ("pan_west".to_string(), kind)));
    walker.lift();
    walker.wait(100);
    assert_eq!(walker.take_events(), [], "nothing is committed on the way off either");
    assert!(clicks(&mut walker, "pan_south"));
}

#[test]
fn r7_leaving_a_control_by_three_centimetres_cancels_it() {
    let mut walker = at_the_map();
    let home = middle(&walker, "home");
    walker.step_at(home, FIRM);
    walker.wait(100);
    // The button is 18 cm wide and deep: 11 cm from its middle is 2 cm off, 14 cm is 5 cm off.
    walker.slide_to(home + Vec2::new(0.0, 0.11), 0.2);
    walker.wait(100);
    assert_eq!(walker.take_events().len(), 1, "still pressed");
    walker.slide_to(home + Vec2::new(0.0, 0.14), 0.2);
    assert_eq!(walker.take_events(), [("home".to_string(), EventKind::Cancelled)]);
}

#[test]
fn r8_people_who_walk_over_guarded_controls_start_none_of_them() {
    let mut table = IntentTable::default();
    for number in 0..3 {
        table.add_person(40 + number, number, IntentEffort { steps: 60, presses: 0 }).unwrap();
    }
    println!("{table}");
    for guard in [Guarded::Confirm, Guarded::HoldToRun] {
        assert!(table.steps(guard) >= 180);
        assert_eq!(table.whole(guard).false_activations, 0, "{guard:?}");
    }
}

#[test]
fn r8_a_foot_that_is_down_for_less_than_a_quarter_of_a_second_never_runs_anything() {
    let mut walker = in_front_of(guarded(HOLD));
    walker.step_onto("home", FIRM);
    walker.wait(150);
    walker.lift();
    walker.wait(100);
    assert_eq!(walker.take_events(), []);
    walker.step_onto("home", FIRM);
    walker.wait(400);
    assert_eq!(walker.take_events(), [("home".to_string(), EventKind::Pressed)], "meant, it runs");
}

#[test]
fn r9_a_control_held_too_long_warns_stops_and_needs_a_lift() {
    let mut walker = in_front_of(guarded(HOLD));
    walker.step_onto("home", FIRM);
    walker.wait(2500);
    let home = |kind| ("home".to_string(), kind);
    assert_eq!(walker.take_events(), [home(EventKind::Pressed), home(EventKind::Warned)]);
    walker.wait(2500);
    assert_eq!(walker.take_events(), [home(EventKind::Cancelled)]);
    walker.wait(1000);
    assert_eq!(walker.take_events(), [], "still held");
    walker.lift();
    walker.wait(100);
    walker.step_onto("home", FIRM);
    walker.wait(500);
    assert_eq!(walker.take_events(), [home(EventKind::Pressed)]);
}

#[test]
fn rule_7_only_one_control_runs_at_a_time() {
    let mut page = guarded(HOLD);
    page.regions[0].cursor = underfoot::layout::CursorRule::Each;
    // A seated person with both feet free, which together would run two.
    let mut walker = Walker::on(page);
    walker.step_onto("home", FIRM);
    walker.wait(500);
    let east = middle(&walker, "pan_east");
    walker.also_at(east, FIRM);
    walker.wait(800);
    assert_eq!(walker.take_events(), [("home".to_string(), EventKind::Pressed)]);
}

#[test]
fn s10_an_object_left_on_a_control_is_shown_after_a_minute_and_presses_nothing() {
    let mut walker = Walker::on(layout("map"));
    let home = middle(&walker, "home");
    // A bag of 5 kg, put down gently: below the threshold of 60 N.
    walker.step_at(home, Newtons(50.0));
    walker.wait(59_000);
    assert_eq!(role(&walker, home), Some(FootRole::Free));
    walker.wait(4000);
    assert_eq!(role(&walker, home), Some(FootRole::Object));
    let mut snapshot = Snapshot::default();
    walker.engine.snapshot(&mut snapshot);
    assert_eq!(snapshot.cursors, [None], "it is no cursor, so feet elsewhere in the region may be");
    // Another heavy thing on top, within a fifth of its load, changes nothing.
    walker.press(Newtons(58.0));
    walker.wait(1000);
    assert_eq!(role(&walker, home), Some(FootRole::Object));
    assert_eq!(walker.take_events(), []);
    // After its removal, the control works again.
    walker.lift();
    walker.wait(100);
    walker.stand(Newtons(690.0));
    walker.wait(800);
    assert!(clicks(&mut walker, "home"));
}

#[test]
fn s10_a_heavy_object_that_pressed_a_control_lets_go_of_it_without_a_click() {
    let mut walker = Walker::on(layout("map"));
    walker.step_onto("home", Newtons(100.0));
    walker.wait(63_000);
    let home = |kind| ("home".to_string(), kind);
    assert_eq!(walker.take_events(), [home(EventKind::Pressed), home(EventKind::Cancelled)]);
    walker.lift();
    walker.wait(100);
    assert_eq!(walker.take_events(), []);
}

/// Both feet leave the floor within a tenth of a second.
fn jump(walker: &mut Walker) {
    walker.leave_floor(100);
    walker.wait(100);
}

#[test]
fn s12_who_jumps_releases_what_is_free_and_confirms_nothing() {
    let mut walker = at_the_map();
    walker.step_onto("home", FIRM);
    walker.wait(200);
    jump(&mut walker);
    let kinds = [EventKind::Pressed, EventKind::Released, EventKind::Clicked];
    assert_eq!(walker.take_events(), kinds.map(|kind| ("home".to_string(), kind)), "released normally");

    let mut walker = in_front_of(guarded(CONFIRM));
    walker.step_onto("home", FIRM);
    walker.wait(200);
    walker.lift();
    walker.wait(300);
    walker.take_events();
    walker.step_onto("home", FIRM);
    walker.wait(200);
    jump(&mut walker);
    let events = walker.take_events();
    let clicked = events.iter().any(|(_, kind)| *kind == EventKind::Clicked);
    assert!(!clicked && events.iter().any(|(_, kind)| *kind == EventKind::Cancelled), "{events:?}");
}
