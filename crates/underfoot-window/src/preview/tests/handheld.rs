//! Windows in a hand: buttons for fingers, all of them on the screen, and a floor that panels leave free.

use eframe::egui::{Rect, Vec2 as Size};
use egui_kittest::kittest::By;

use super::*;
use crate::preview::handheld::{TARGET, fit_targets};
use underfoot_scene::scene::Theme;

/// Screens of a phone, upright and across, in points.
const PHONES: [(f32, f32); 2] = [(390.0, 844.0), (844.0, 390.0)];

/// A tablet, which a finger has to touch first.
const TABLET: (f32, f32) = (820.0, 1180.0);

/// A window of this size that a finger has touched.
fn touched(width: f32, height: f32) -> Room {
    let mut room = Room::of(true, width, height);
    // With the letters of the program.
    crate::preview::style::apply(&room.window.ctx, &Theme::LIGHT);
    fit_targets(&room.window.ctx, true);
    // At a corner, where nothing is.
    for phase in [egui::TouchPhase::Start, egui::TouchPhase::End] {
        let (device_id, id, pos) = (egui::TouchDeviceId(1), egui::TouchId(1), Pos2::ZERO);
        room.window.event(Event::Touch { device_id, id, phase, pos, force: None });
        room.run(1);
    }
    room.run(6);
    room
}

/// The buttons on the screen, with their names.
fn buttons(room: &Room) -> Vec<(String, Rect)> {
    use eframe::egui::accesskit::Role;
    let roles = [Role::Button, Role::RadioButton, Role::ComboBox];
    let all = room.window.query_all(By::new().predicate(move |node| roles.contains(&node.role())));
    all.map(|node| (node.accesskit_node().label().unwrap_or_default(), node.rect())).collect()
}

fn assert_for_fingers(room: &Room, screen: Size, at: &str) {
    let found = buttons(room);
    assert!(found.len() > 8, "{at}: {found:?}");
    // The floor's own controls are no buttons of the window.
    for (name, rect) in found.iter().filter(|(name, _)| !map().widgets.iter().any(|one| one.label == *name)) {
        assert!(rect.height() >= TARGET && rect.width() >= TARGET, "{at}: {name} is {}", rect.size());
        let inside = Rect::from_min_size(Pos2::ZERO, screen + Size::splat(16.0));
        assert!(inside.contains_rect(*rect), "{at}: {name} is at {rect}");
    }
}

fn share_of(room: &Room, label: &str, screen: Size) -> f32 {
    let rect = room.window.get_by_label(label).rect();
    rect.width() * rect.height() / (screen.x * screen.y)
}

#[test]
fn every_button_of_a_phone_and_a_tablet_is_for_fingers_and_the_floor_keeps_half_of_the_screen() {
    for (width, height) in [PHONES[0], PHONES[1], TABLET] {
        let (mut room, screen) = (touched(width, height), Size::new(width, height));
        let at = format!("{width} x {height}");
        assert_for_fingers(&room, screen, &at);
        let share = share_of(&room, "Floor", screen);
        assert!(share >= 0.5, "{at}: the floor has {share}");
        for name in ["Appearance", "Help", "Layout", "Design", "Panel"] {
            room.window.get_by_label(name);
        }
        room.window.get_by_label("Design").click();
        room.run(8);
        assert_for_fingers(&room, screen, &format!("{at}, Design"));
        let share = share_of(&room, "Drawing board", screen);
        assert!(share >= 0.5, "{at}: the drawing board has {share}");
        assert!(!room.says("Search the things"), "{at}: panels are folded");
    }
}

#[test]
fn the_lists_of_design_are_for_fingers_and_two_numbers_of_a_field_stand_side_by_side() {
    let mut room = touched(1280.0, 2000.0);
    room.window.get_by_label("Design").click();
    room.run(8);
    room.window.get_by_label("Control home").click();
    room.run(8);
    let found = buttons(&room);
    for name in ["Hide: home", "Lock: home", "Reset Text on it"] {
        let Some((_, rect)) = found.iter().find(|(label, _)| label == name) else {
            panic!("{name} is not there: {found:?}")
        };
        assert!(rect.height() >= TARGET && rect.width() >= TARGET, "{name}: {rect:?}");
    }
    for [first, second] in [["Place: east", "Place: north"], ["Size: width", "Size: depth"]] {
        let [first, second] = [first, second].map(|name| room.window.get_by_label(name).rect());
        assert_eq!(first.center().y, second.center().y);
    }
}

#[test]
fn one_panel_is_open_at_a_time_and_another_mode_folds_it() {
    for (width, height) in PHONES {
        let (mut room, screen) = (touched(width, height), Size::new(width, height));
        let at = format!("{width} x {height}");
        for name in ["Panel", "Effects", "Plots"] {
            room.window.get_by_label(name).click();
            room.run(20);
            assert!(share_of(&room, "Floor", screen) > 0.25, "{at}: {name} leaves a floor");
        }
        let state = room.window.state();
        assert!(state.plots.is_open && !state.tuner.as_ref().unwrap().is_open, "{at}");
        assert_eq!(state.panel.wanted, Some(false), "{at}");
        room.window.get_by_label("Design").click();
        room.run(8);
        room.window.get_by_label("Add").click();
        room.run(8);
        let button = room.window.get_by_label("Put down: button").rect();
        assert!(button.height() >= TARGET, "{at}: {button}");
        assert!(share_of(&room, "Drawing board", screen) > 0.25, "{at}");
        // A thing in hand folds the list: its place is on the floor.
        room.window.get_by_label("Put down: button").click();
        room.run(8);
        assert!(room.window.query_by_label("Put down: button").is_none(), "{at}");
        assert!(share_of(&room, "Drawing board", screen) >= 0.5, "{at}");
    }
}

#[test]
fn a_finger_moves_nothing_while_it_is_down_and_a_mouse_alone_changes_nothing() {
    let mut room = Room::simulated();
    let (home, before) = (room.place("Home"), room.window.get_by_label("Help").rect());
    room.press(home);
    room.release(home);
    assert_eq!(room.window.get_by_label("Help").rect(), before);
    let touch = |phase| Event::Touch {
        device_id: egui::TouchDeviceId(1),
        id: egui::TouchId(1),
        phase,
        pos: home,
        force: None,
    };
    room.window.event(touch(egui::TouchPhase::Start));
    room.run(20);
    assert_eq!(room.window.get_by_label("Help").rect(), before, "under the finger");
    room.window.event(touch(egui::TouchPhase::End));
    room.run(20);
    assert!(room.window.get_by_label("Help").rect().height() >= TARGET);
}
