//! The place of the floor on the screen: modes, panels, bars and messages do not move it, at any width.

use super::*;

/// The area of a control in Try mode, or of its record in Design mode.
fn home(room: &Room) -> egui::Rect {
    let label = if room.says("Drawing board") { "On the floor: home" } else { "Home" };
    room.window.get_by_label(label).rect()
}

/// A window of this size, whose floor shows the layout of the editor.
fn room(width: f32, height: f32) -> Room {
    let mut room = Room::of(true, width, height);
    let designed = room.window.state().designer.as_ref().map(|designer| designer.layout().clone());
    room.layouts.send(loaded(Arc::new(designed.unwrap()), "map".into())).unwrap();
    room.run(3);
    room
}

const SIZES: [(f32, f32); 5] =
    [(640.0, 800.0), (900.0, 700.0), (1100.0, 700.0), (1280.0, 800.0), (1600.0, 1000.0)];

#[test]
fn the_floor_stays_where_it_is_whatever_mode_panel_or_bar_is_opened_or_closed() {
    for (width, height) in SIZES {
        let mut room = room(width, height);
        let before = home(&room);
        let is_still = |room: &Room, what: &str| {
            let now = home(room);
            let moved = (now.min - before.min).length().max((now.max - before.max).length());
            assert!(moved < 0.5, "{what} moves the floor by {moved} at {width}: {before}, {now}");
        };
        for bar in ["Plots", "Effects", "Panel"] {
            for does in ["opening or closing", "closing or opening"] {
                room.window.get_by_label(bar).click();
                room.run(20);
                is_still(&room, &format!("{does} {bar}"));
            }
        }
        for _ in 0..2 {
            room.window.key_press(Key::F2);
            room.run(6);
            is_still(&room, "Design");
            room.window.key_press_modifiers(Modifiers::COMMAND, Key::A);
            room.run(6);
            is_still(&room, "a selection");
            for bar in ["Text", "Text", "Panel", "Panel"] {
                room.window.get_by_label(bar).click();
                room.run(20);
                is_still(&room, &format!("{bar} of Design"));
            }
            room.window.key_press(Key::F2);
            room.run(6);
            is_still(&room, "Try");
        }
    }
}

#[test]
fn messages_cover_the_floor_and_do_not_move_it() {
    for (width, height) in SIZES {
        let mut room = room(width, height);
        let before = home(&room);
        room.notices.send("Something happened.".into()).unwrap();
        room.run(3);
        assert_eq!(home(&room), before, "a notice at {width}");
        let (name, diagnostics) = ("map.ron".into(), "map.ron:3:5: unknown field".into());
        room.layouts.send(LayoutNews::Refused { name, diagnostics }).unwrap();
        room.run(3);
        assert_eq!(home(&room), before, "a file with problems at {width}");
    }
}

#[test]
fn the_floor_keeps_at_least_half_of_a_narrow_window_whatever_is_open() {
    let mut room = room(640.0, 800.0);
    let area = |room: &Room, label: &str| room.window.get_by_label(label).rect();
    // The window of the test has a margin.
    let half = 0.5 * area(&room, "Floor").width() - 1.0;
    assert!(half > 310.0);
    for bar in ["Panel", "Effects"] {
        room.window.get_by_label(bar).click();
        room.run(20);
        assert!(area(&room, "Floor").width() >= half, "{bar}: {}", area(&room, "Floor"));
    }
    assert!(!room.says("Contacts"), "one panel at a time");
    room.window.key_press(Key::F2);
    room.run(6);
    assert!(area(&room, "Drawing board").width() >= half);
    room.window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    room.run(6);
    assert!(area(&room, "Drawing board").width() >= half);
    room.window.get_by_label("Text").click();
    room.run(20);
    assert!(area(&room, "Drawing board").width() >= half);
}

#[test]
fn what_a_panel_covers_can_be_fitted_into_view_and_back() {
    let mut room = room(1280.0, 800.0);
    let before = home(&room);
    assert!(!room.says("· fit"));
    room.window.get_by_label("Plots").click();
    room.run(20);
    room.window.get_by_label_contains("· fit").click();
    room.run(3);
    let floor = room.window.get_by_label("Floor").rect();
    let labels = ["Home", "North", "South", "Zoom"];
    let all = labels.iter().all(|label| floor.contains_rect(room.window.get_by_label(label).rect()));
    assert!(all && home(&room).width() < before.width());
    room.window.get_by_label("Plots").click();
    room.run(20);
    room.window.get_by_label_contains("· fit").click();
    room.run(3);
    assert_eq!(home(&room), before);
}
