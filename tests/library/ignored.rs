//! A press without an answer of a control has a reason.

use underfoot::engine::Ignored;
use underfoot::glam::Vec2;
use underfoot::units::Newtons;

use crate::support::{Walker, layout, page};

/// A walker on a floor that has been empty for long enough.
fn ready(name: &str) -> Walker {
    let mut walker = Walker::on(layout(name));
    walker.wait(100);
    walker
}

fn why(walker: &mut Walker) -> Vec<(String, Ignored)> {
    walker.lift();
    walker.wait(100);
    walker.ignored()
}

fn one(id: &str, why: Ignored) -> Vec<(String, Ignored)> {
    vec![(id.into(), why)]
}

#[test]
fn a_press_that_is_answered_is_not_ignored() {
    let mut walker = ready("map");
    walker.step_onto("home", Newtons(150.0));
    walker.wait(100);
    assert_eq!(why(&mut walker), []);
    assert!(!walker.take_events().is_empty());
}

#[test]
fn how_hard_a_control_was_pressed_is_told_press_by_press() {
    let mut walker = ready("map");
    // 150 N, reduced to 25 N (below the release threshold of 40 N) without leaving, then 100 N.
    walker.step_onto("home", Newtons(150.0));
    walker.wait(100);
    assert_eq!(walker.answered(), [], "it is still held");
    for force in [25.0, 100.0, 25.0] {
        walker.press(Newtons(force));
        walker.wait(200);
    }
    assert_eq!(why(&mut walker), [], "the rest on the way out is no press");
    let told = walker.answered();
    assert!(told.iter().all(|(id, _)| id == "home"), "{told:?}");
    let forces: Vec<f32> = told.iter().map(|(_, force)| force.0).collect();
    // Uncalibrated parts differ by a quarter; the ratio of the presses is right.
    assert!(
        matches!(forces[..], [first, second] if (first / 150.0 - 1.0).abs() < 0.25 && (first / second - 1.5).abs() < 0.1),
        "{forces:?}"
    );
}

#[test]
fn a_cancelled_press_tells_no_force() {
    let mut walker = ready("map");
    walker.step_onto("home", Newtons(150.0));
    walker.wait(100);
    // A tile away from it: the foot slid off, which cancels.
    walker.slide_to(Vec2::new(0.15, 1.2), 0.5);
    assert_eq!(why(&mut walker), []);
    assert_eq!(walker.answered(), []);
}

#[test]
fn too_light_and_a_graze() {
    let mut walker = ready("map");
    walker.step_onto("home", Newtons(40.0));
    walker.wait(100);
    assert_eq!(why(&mut walker), one("home", Ignored::TooLight));
    let mut walker = ready("map");
    walker.step_onto("home", Newtons(9.0));
    walker.wait(100);
    assert_eq!(why(&mut walker), []);
}

#[test]
fn a_foot_that_carries_a_body() {
    let mut walker = ready("map");
    walker.step_onto("home", Newtons(650.0));
    walker.wait(400);
    let told = why(&mut walker);
    assert!(told.is_empty() || told == one("home", Ignored::Step), "{told:?}");
    // It counted as a press for its first 30 ms, or as a step from the start; the next foot there steps as well.
    let mut walker = ready("map");
    walker.step_at(Vec2::new(0.15, 1.2), Newtons(650.0));
    walker.wait(400);
    walker.slide_to(Vec2::new(0.15, 0.76), 0.5);
    assert_eq!(why(&mut walker), one("home", Ignored::Step));
}

#[test]
fn a_foot_that_slides_on_from_beside() {
    let mut walker = ready("map");
    walker.step_at(Vec2::new(0.15, 1.2), Newtons(120.0));
    walker.wait(400);
    walker.slide_to(Vec2::new(0.15, 0.76), 0.5);
    walker.wait(100);
    assert_eq!(why(&mut walker), one("home", Ignored::SlidOn));
}

#[test]
fn a_control_that_was_not_seen_unloaded() {
    let mut walker = ready("map");
    walker.step_onto("home", Newtons(150.0));
    walker.wait(100);
    walker.connected = false;
    walker.wait(300);
    walker.connected = true;
    walker.wait(300);
    assert_eq!(why(&mut walker), one("home", Ignored::NotSeenUnloaded));
}

#[test]
fn a_guard_that_wants_a_settled_foot() {
    let mut walker = ready("all_controls");
    walker.step_onto("drive", Newtons(150.0));
    walker.wait(60);
    assert_eq!(why(&mut walker), one("drive", Ignored::Guard));
}

#[test]
fn a_foot_in_a_stance_zone_or_outside_of_the_region() {
    let text = |stances: &str, size: &str| {
        format!(
            r#"Layout(
    version: 1,
    regions: [(id: "all", at: (0, 2), size: {size})],
    stances: [{stances}],
    widgets: [(id: "home", kind: "button", at: (2, 2.6), size: (1, 0.9))],
)"#
        )
    };
    // The place of the press on the control lies in the stance zone.
    let mut walker = Walker::on(page(&text("(at: (1, 3.2), size: (3, 1))", "(6, 1.2)")));
    walker.wait(100);
    walker.step_at(Vec2::new(2.5, 3.35) * 0.304, Newtons(150.0));
    walker.wait(100);
    assert_eq!(why(&mut walker), one("home", Ignored::Stance));
    // The middle of the control is in the region, its north is not.
    let mut walker = Walker::on(page(&text("", "(6, 1.2)")));
    walker.wait(100);
    walker.step_at(Vec2::new(2.5, 3.4) * 0.304, Newtons(150.0));
    walker.wait(100);
    assert_eq!(why(&mut walker), one("home", Ignored::OutsideRegion));
}
