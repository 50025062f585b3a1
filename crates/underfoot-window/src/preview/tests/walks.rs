//! People on walks drawn with the mouse.

use super::*;
use crate::preview::walks::Walks;
use underfoot_sim::{Arrivals, FootDriver, Scenario, arrivals, feet_by_hand};

/// A window, and the floor for the people.
fn room() -> (Room, Arrivals) {
    let (_, nobody) = feet_by_hand();
    let (handle, floor) = arrivals(Box::new(nobody));
    let mut room = Room::simulated();
    room.window.state_mut().walks = Some(Walks::new(handle));
    room.run(2);
    (room, floor)
}

/// Draws a line between two points of the screen.
fn draw(room: &mut Room, from: Pos2, to: Pos2) {
    room.hover(from);
    room.button(from, PointerButton::Primary, true);
    for step in 1..=10 {
        room.hover(from.lerp(to, step as f32 / 10.0));
    }
    room.button(to, PointerButton::Primary, false);
    room.run(2);
}

/// The maximum force on the control called `name` in the next twenty seconds, in newtons.
fn pressed(floor: &mut Arrivals, name: &str) -> f32 {
    let area = map().widgets.iter().find(|widget| widget.label == name).unwrap().area;
    let (mut feet, mut most) = (Vec::new(), 0.0_f32);
    for ms in 0..20_000 {
        floor.feet(Instant::from_millis(ms), &mut feet);
        let on_it = feet.iter().filter(|foot| area.contains(foot.centre_of_pressure()));
        most = on_it.fold(most, |most, foot| most.max(foot.force.0));
    }
    most
}

#[test]
fn somebody_walks_what_was_drawn_and_uses_the_control_at_its_end() {
    let (mut room, mut floor) = room();
    room.window.key_press(Key::W);
    room.run(2);
    assert!(room.says("be a foot again"));
    let home = room.place("Home");
    draw(&mut room, home + vec2(150.0, 200.0), home);
    assert!(room.feet().0.is_none(), "the mouse is no foot meanwhile");
    assert!(room.says("1 on the floor"));
    let most = pressed(&mut floor, "Home");
    // The force of a foot that works a control, not that of a step of a person walking over it.
    assert!((90.0..300.0).contains(&most), "{most} N");
    room.run(2);
    assert!(room.says("none on the floor"));
    room.window.get_by_label("Again").click_accesskit();
    room.run(2);
    assert!(room.says("1 on the floor"));
    room.window.key_press(Key::Escape);
    room.run(2);
    assert!(!room.says("be a foot again"));
}

#[test]
fn what_was_drawn_is_copied_as_a_scenario() {
    let (mut room, _floor) = room();
    room.window.get_by_label("Draw a walk").click_accesskit();
    room.run(2);
    let (home, zoom) = (room.place("Home"), room.place("Zoom in"));
    draw(&mut room, home + vec2(100.0, 180.0), home);
    draw(&mut room, zoom + vec2(0.0, 180.0), zoom);
    room.window.get_by_label("Copy").click_accesskit();
    room.window.step();
    let copied = room.window.output().platform_output.commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    let copied = copied.expect("a text is copied");
    assert!(copied.contains("\"home\"") && copied.contains("others:"), "{copied}");
    let geometry = Floor::default().geometry;
    assert!(Scenario::parse("walks.ron", &copied).unwrap().resolve(&map(), &geometry).is_ok(), "{copied}");
}
