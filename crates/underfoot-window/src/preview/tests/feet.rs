//! The effect of mouse and keys on the feet and on the view of the floor.

use super::*;

#[test]
fn a_press_on_the_floor_puts_force_where_the_mouse_is() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    room.hover(home);
    assert_eq!(room.feet().0.unwrap().force, Newtons::ZERO, "in the air above it");
    room.press(home);
    let foot = room.feet().0.unwrap();
    assert!((foot.force.0 - 150.0).abs() < 1.0, "{foot:?}");
    // A pixel is about 3 mm of floor in this window.
    let off = acts_at(&foot).distance(middle_of("Home"));
    assert!(off < 0.004, "{off} m beside the control");
    let west = room.place("West");
    room.hover(west);
    let off = acts_at(&room.feet().0.unwrap()).distance(middle_of("West"));
    assert!(off < 0.004, "dragging slides: {off}");
    room.release(west);
    assert_eq!(room.feet().0.unwrap().force, Newtons::ZERO);
}

#[test]
fn the_wheel_presses_harder_and_softer() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    room.press(home);
    room.wheel(3.0);
    let harder = room.feet().0.unwrap().force.0;
    assert!((harder - 150.0 * 1.12_f32.powi(3)).abs() < 2.0, "{harder}");
    room.wheel(-6.0);
    assert!(room.feet().0.unwrap().force.0 < 120.0);
}

#[test]
fn q_e_and_the_right_button_turn_the_foot_about_its_pressure() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    room.press(home);
    room.hold_key(Key::Q, 12);
    let left = room.feet().0.unwrap();
    assert!((0.2..0.6).contains(&left.heading_rad), "Q turns to the left: {}", left.heading_rad);
    assert!(acts_at(&left).distance(middle_of("Home")) < 0.004);
    room.hold_key(Key::E, 24);
    assert!(room.feet().0.unwrap().heading_rad < -0.1, "E turns to the right");
    room.release(home);
    let before = room.feet().0.unwrap().heading_rad;
    room.button(home, PointerButton::Secondary, true);
    room.hover(home + vec2(-50.0, 0.0));
    room.button(home + vec2(-50.0, 0.0), PointerButton::Secondary, false);
    let turned = room.feet().0.unwrap().heading_rad - before;
    assert!((turned - 0.6).abs() < 0.05, "50 points to the left: {turned}");
    assert_eq!(room.feet().0.unwrap().force, Newtons::ZERO, "the right button does not press");
}

#[test]
fn the_standing_foot_stays_where_space_left_it() {
    let mut room = Room::simulated();
    let stance = room.place("South");
    room.hover(stance);
    room.window.key_press(Key::Space);
    room.run(20);
    let standing = room.feet().1.unwrap();
    assert!(standing.position.distance(middle_of("South")) < 0.004);
    assert!((standing.force.0 - 600.0).abs() < 2.0);
    let home = room.place("Home");
    room.press(home);
    assert_eq!(room.feet().1.unwrap().position, standing.position);
    assert!(room.feet().0.unwrap().force.0 > 100.0, "both feet are down");
    room.release(home);
    // A drag of its handle moves it, and the working foot does not press.
    let handle = room.place("Standing foot");
    room.hover(handle);
    room.button(handle, PointerButton::Primary, true);
    room.hover(handle + vec2(80.0, 0.0));
    let moved = room.feet();
    assert!(moved.1.unwrap().position.x > standing.position.x + 0.1);
    assert_eq!(moved.0.unwrap().force, Newtons::ZERO, "the hand holds the standing foot");
    room.button(handle + vec2(80.0, 0.0), PointerButton::Primary, false);
    // Space on the standing foot lifts it.
    room.window.key_press(Key::Space);
    room.run(2);
    assert!(room.feet().1.is_none());
}

#[test]
fn a_button_stands_the_foot_in_the_layouts_own_place() {
    let mut room = Room::simulated();
    room.window.get_by_label("Stance foot").click();
    room.run(3);
    assert_eq!(room.feet().1.unwrap().position, map().stances[0].area.centre());
    room.window.get_by_label("Stance foot").click();
    room.run(3);
    assert!(room.feet().1.is_none());
}

#[test]
fn shift_chooses_a_tile_and_presses_nothing() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    room.hover(home);
    let modifiers = Modifiers::SHIFT;
    for pressed in [true, false] {
        room.window.event(Event::ModifiersChanged(modifiers));
        room.window.event(Event::PointerButton {
            pos: home,
            button: PointerButton::Primary,
            pressed,
            modifiers,
        });
        room.run(5);
        assert_eq!(room.feet().0.unwrap().force, Newtons::ZERO);
    }
    let tile = Floor::default().geometry.tile_under(middle_of("Home")).unwrap();
    assert!(room.says(&format!("Tile {}, {}", tile.column, tile.row)) && room.says("Follow the foot"));
}

// R5
#[test]
fn a_window_that_loses_the_keyboard_lifts_the_foot() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    room.press(home);
    room.window.event(Event::WindowFocused(false));
    room.run(20);
    assert_eq!(room.feet().0.unwrap().force, Newtons::ZERO, "its button may come up elsewhere, unseen");
}

#[test]
fn a_real_floor_has_no_mouse_feet_and_a_click_chooses_a_tile() {
    let mut room = Room::of(false, 1280.0, 800.0);
    assert!(!room.says("Stance foot"));
    let zoom = room.place("Zoom in");
    room.press(zoom);
    assert!(room.feet.lock().unwrap().is_empty());
    let tile = Floor::default().geometry.tile_under(middle_of("Zoom in")).unwrap();
    assert!(room.says(&format!("Tile {}, {}", tile.column, tile.row)));
    room.window.key_press(Key::ArrowRight);
    room.run(2);
    assert!(room.says(&format!("Tile {}, {}", tile.column + 1, tile.row)));
    room.window.get_by_label("Follow the foot").click();
    room.run(2);
    assert!(room.says("underfoot"));
}

#[test]
fn a_control_with_the_focus_is_pressed_and_slid_by_keys() {
    let mut room = Room::simulated();
    room.window.get_by_label("Home").focus();
    room.run(2);
    room.window.key_down(Key::Enter);
    room.run(3);
    let foot = room.feet().0.unwrap();
    assert!((foot.force.0 - 150.0).abs() < 1.0 && acts_at(&foot).distance(middle_of("Home")) < 0.001);
    room.window.key_up(Key::Enter);
    room.run(3);
    assert!(room.feet().0.is_none_or(|foot| foot.force == Newtons::ZERO));
    room.window.get_by_label("Time of day").focus();
    room.run(2);
    room.window.key_down(Key::Space);
    room.run(2);
    room.window.key_down(Key::ArrowRight);
    room.run(20);
    let foot = room.feet().0.unwrap();
    let way = acts_at(&foot) - middle_of("Time of day");
    assert!(foot.force.0 > 100.0 && way.x > 0.05 && way.y.abs() < 0.001, "{way}");
    assert!(room.feet().1.is_none(), "Space is the control's while it has the focus");
}

#[test]
fn ctrl_with_the_wheel_zooms_and_leaves_the_force() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    let before = room.window.get_by_label("Home").rect();
    room.hover(home);
    room.window.event(Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta: vec2(0.0, 4.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::CTRL | Modifiers::COMMAND,
    });
    room.run(30);
    let after = room.window.get_by_label("Home").rect();
    assert!(after.width() > 1.05 * before.width(), "{before} {after}");
    assert!((after.center() - home).length() < 2.0, "what is under the mouse stays there");
    room.press(home);
    assert!((room.feet().0.unwrap().force.0 - 150.0).abs() < 1.0);
}

#[test]
fn a_button_shows_the_whole_floor_again() {
    let mut room = Room::simulated();
    let (home, before) = (room.place("Home"), room.window.get_by_label("Home").rect());
    room.hover(home);
    room.window.event(Event::Zoom(1.5));
    room.run(10);
    assert!(room.window.get_by_label("Home").rect().width() > 1.3 * before.width());
    room.window.get_by_label_contains("· fit").click();
    room.run(3);
    assert_eq!(room.window.get_by_label("Home").rect(), before);
    assert!(!room.says("· fit"));
}

#[test]
fn two_fingers_are_two_feet_and_the_mouse_that_the_system_makes_of_the_first_is_none() {
    let mut room = Room::simulated();
    let (home, zoom) = (room.place("Home"), room.place("Zoom in"));
    let touch = |id, phase, pos| Event::Touch {
        device_id: egui::TouchDeviceId(1),
        id: egui::TouchId(id),
        phase,
        pos,
        force: None,
    };
    room.window.event(touch(1, egui::TouchPhase::Start, home));
    // The system reports the first finger on a screen as a mouse too.
    room.window.event(Event::PointerMoved(home));
    let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
    room.window.event(Event::PointerButton { pos: home, button, pressed: true, modifiers });
    room.window.event(touch(2, egui::TouchPhase::Start, zoom));
    room.run(2);
    let pressing = |room: &Room| {
        let feet = room.feet.lock().unwrap();
        feet.iter().filter(|foot| foot.force.0 > 0.0).map(acts_at).collect::<Vec<Vec2>>()
    };
    let feet = pressing(&room);
    assert_eq!(feet.len(), 2, "{feet:?}");
    for name in ["Home", "Zoom in"] {
        assert!(feet.iter().any(|foot| foot.distance(middle_of(name)) < 0.02), "{name}: {feet:?}");
    }
    room.window.event(touch(1, egui::TouchPhase::End, home));
    room.run(2);
    assert_eq!(pressing(&room).len(), 1, "the other finger is still down");
    room.window.event(touch(2, egui::TouchPhase::Cancel, zoom));
    room.run(2);
    assert!(pressing(&room).is_empty());
}
