//! Plots over time: their content, and dragging their thresholds.

use eframe::egui::accesskit::Role;

use super::presses::{map_room, text, tried};
use super::*;
use crate::preview::sample::step_on;

/// A press of 90 N on `home` for a tenth of a second, at 60 frames a second, starting at `at_ms`.
fn press_home(room: &mut Room, at_ms: u64) {
    let layout = Arc::clone(&room.window.state().shown.messages.layout);
    let home = layout.widgets[layout.widget_index("home").unwrap()].area.centre();
    for frame in 0..12_u64 {
        let mut snapshot = at_rest(&layout);
        snapshot.at = Instant::from_millis(at_ms + 16 * frame);
        if (3..9).contains(&frame) {
            step_on(&mut snapshot, 3, home, 90.0, Vec2::ZERO);
        }
        room.snapshots.write(snapshot);
        room.run(1);
    }
}

fn pinned(name: &str) -> Room {
    let mut room = map_room();
    room.window.state_mut().selection.pin_control(WidgetId::new(name));
    room.run(1);
    room
}

fn drag(room: &mut Room, from: Pos2, to: Pos2) {
    room.hover(from);
    room.button(from, PointerButton::Primary, true);
    for step in 1..=5_u8 {
        room.hover(from + (to - from) * (f32::from(step) / 5.0));
    }
    room.button(to, PointerButton::Primary, false);
    room.run(2);
}

#[test]
fn plots_are_opened_by_button_and_key_and_show_what_just_happened() {
    let mut room = pinned("home");
    press_home(&mut room, 1000);
    assert!(!room.says("Plot in N"));
    room.window.get_by_label("Plots").click();
    room.run(3);
    // The press was before the plot was opened.
    assert!(room.says("Plot in N: selected: home 0.0 N"));
    let geometry = room.window.state().shown.floor.geometry;
    let selected = WidgetId::new("home");
    let moves = |room: &Room| {
        let app = room.window.state();
        app.plots.are_moving(app.shown.now_s, &geometry, Some(&selected))
    };
    assert!(moves(&room));
    room.window.key_press(Key::P);
    room.run(3);
    assert!(!room.says("Plot in N"));
    assert!(!moves(&room), "an idle window stays idle");
}

#[test]
fn what_is_plotted_is_chosen_from_a_list_and_taken_out_again() {
    let mut room = pinned("satellite");
    room.window.get_by_label("Plots").click();
    room.run(3);
    room.window.get_by_label("Plot ...").click();
    room.run(3);
    room.window.get_by_label("Search what to plot").focus();
    room.run(1);
    room.window.event(Event::Text("tile 2, 1 ne".into()));
    room.run(2);
    room.window.get_by_label("tile 2, 1 sensor ne").click();
    room.run(3);
    assert!(room.says("Leave out tile 2, 1 sensor ne"), "the list stays open, and it is in the strip");
    // Places are in metres, values have no unit: each gets a plot of its own.
    room.window.key_press(Key::Escape);
    room.run(3);
    room.window.get_by_label("Plot satellite").click();
    room.run(3);
    assert!(
        room.says("Plot in N") && room.says("satellite force") && room.says("Plot in value: satellite value")
    );
    room.window.get_by_label("Leave out satellite value").click();
    room.run(3);
    assert!(!room.says("Plot in value"));
    room.window.get_by_label_contains("Plot tile ").click();
    room.run(3);
    assert!(room.says("Leave out tile 3, 3 force"), "the tile that the panel shows");
    assert_eq!(room.window.unnamed_widgets(), Vec::<String>::new());
}

#[test]
fn a_threshold_that_is_dragged_is_one_step_of_the_layout() {
    let mut room = pinned("home");
    let before = text(&room);
    room.window.get_by_label("Plots").click();
    room.run(3);
    let line = room.place("home takes");
    let plot = room.window.get_by_label_contains("Plot in N").rect();
    assert!(plot.contains(line), "{line} in {plot:?}");
    while room.commands.try_recv().is_ok() {}
    // The floor gets no command before the release.
    let up = room.place("home lets go").y - line.y;
    drag(&mut room, line, line - vec2(0.0, up));
    // 40 N and 60 N are as far apart as 60 N and 80 N.
    assert_eq!(tried(&room), Some((Newtons(80.0), Newtons(53.0))));
    assert!(room.says("home: takes 80 N, was 60 N; lets go below 53 N, was 40 N."));
    assert_ne!(text(&room), before);
    room.window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    room.run(3);
    assert_eq!(text(&room), before, "one step");
}

#[test]
fn a_threshold_is_moved_by_keys_and_a_drag_elsewhere_moves_none() {
    let mut room = pinned("home");
    room.window.get_by_label("Plots").click();
    room.run(3);
    let before = text(&room);
    let line = room.place("home takes");
    let plot = room.window.get_by_label_contains("Plot in N").rect();
    let free = Pos2::new(line.x, plot.top() + 12.0);
    drag(&mut room, free, free + vec2(0.0, 40.0));
    assert_eq!(text(&room), before);
    let grip = room.window.get_by_role_and_label(Role::Slider, "home takes");
    grip.focus();
    room.run(1);
    room.window.key_press(Key::ArrowUp);
    room.run(2);
    assert!(room.says("home: takes 61 N, was 60 N"));
}

#[test]
fn what_is_frozen_stays() {
    let mut room = pinned("home");
    press_home(&mut room, 1000);
    room.window.get_by_label("Plots").click();
    room.window.state_mut().selection.pin_control(WidgetId::new("home"));
    room.run(3);
    room.window.get_by_label("Freeze").click();
    room.run(2);
    let end = room.window.state().plots.seen_until();
    press_home(&mut room, 5000);
    assert_eq!(room.window.state().plots.seen_until(), end);
    room.window.get_by_label("Freeze").click();
    press_home(&mut room, 7000);
    assert_ne!(room.window.state().plots.seen_until(), end);
}
