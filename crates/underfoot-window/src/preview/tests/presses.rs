//! "Use this press": recorded presses of a control set its threshold.

use eframe::egui::accesskit::Role;

use super::*;
use underfoot::engine::{AnsweredPress, FootRole, FootState, Ignored, IgnoredPress};

/// A floor on which two people have pressed `home`: with 96 and 130 N, and once with 48 N, which was ignored.
fn pressed_home() -> Snapshot {
    let foot = |contact, person| FootState {
        contact: ContactId(contact),
        role: FootRole::Free,
        person,
        weight: None,
    };
    let (at, id) = (Instant::from_millis, WidgetId::new("home"));
    let answered = |at_ms, contact, force| AnsweredPress {
        at: at(at_ms),
        id: id.clone(),
        contact: ContactId(contact),
        force: Newtons(force),
    };
    let why = Ignored::TooLight;
    let ignored =
        IgnoredPress { at: at(9_500), id: id.clone(), contact: ContactId(22), force: Newtons(48.0), why };
    Snapshot {
        feet: vec![foot(21, 4), foot(22, 5)],
        answered: vec![answered(8_000, 21, 130.0), answered(9_000, 22, 96.0)],
        ignored: vec![ignored],
        ..at_rest(&map())
    }
}

/// A window with the built-in map as its layout and text.
pub(super) fn map_room() -> Room {
    let mut room = Room::simulated();
    let text = builtin_layout("map").unwrap();
    let map = parse_layout(text, "map", &Kinds::builtin(), &Floor::default().geometry).unwrap().layout;
    room.layouts.send(loaded(Arc::new(map), "map".into())).unwrap();
    room.run(2);
    room
}

pub(super) fn tried(room: &Room) -> Option<(Newtons, Newtons)> {
    let wishes: Vec<_> = room.commands.try_iter().collect();
    wishes.into_iter().rev().find_map(|wish| match wish {
        PreviewCommand::Try { layout, .. } => {
            let thresholds = layout.widgets[layout.widget_index("home")?].behaviour.thresholds();
            Some((thresholds.press, thresholds.release))
        }
        _ => None,
    })
}

pub(super) fn text(room: &Room) -> String {
    room.window.state().designer.as_ref().unwrap().text_of_layout().to_owned()
}

#[test]
fn presses_of_several_people_are_counted_and_their_spread_is_told() {
    let mut room = map_room();
    // The panel shows the first control of the layout until one is pressed: nothing moves then.
    let contacts = room.place("Contacts");
    assert!(room.says("no presses yet"));
    room.write(pressed_home());
    assert_eq!(room.place("Contacts"), contacts);
    // The panel shows the control that was pressed last without a click.
    assert!(room.says("Control Home") && room.says("takes 60 newtons, lets go below 40"));
    assert!(room.says("3 presses by 2 people: median 96 N"));
    assert!(room.says("48 to 130 N, quartiles 72 and 113 N"));
    assert!(room.says("what a foot at rest bears"), "half of 48 N is less");
}

#[test]
fn this_press_becomes_the_threshold_as_one_step_that_is_taken_back() {
    let mut room = map_room();
    room.write(pressed_home());
    let before = text(&room);
    room.window.get_by_label("Press by press").click();
    room.run(20);
    // This press was unintended.
    room.window.get_by_label_contains("48 newtons, too light").click();
    room.run(3);
    assert!(room.says("2 presses by 2 people"));
    while room.commands.try_recv().is_ok() {}
    room.window.get_by_label("Use this press").click();
    room.run(3);
    assert_eq!(tried(&room), Some((Newtons(48.0), Newtons(32.0))), "half of 96 N");
    assert!(room.says("home: takes 48 N, was 60 N; lets go below 32 N, was 40 N."));
    let after = text(&room);
    let changed: Vec<_> = before.lines().zip(after.lines()).filter(|(a, b)| a != b).collect();
    assert!(matches!(&changed[..], [(line, _)] if line.contains("id: \"home\"")), "{changed:?}");
    room.window.get_by_role_and_label(Role::Button, "Undo").click();
    room.run(3);
    assert_eq!((text(&room), tried(&room)), (before, Some((Newtons(60.0), Newtons(40.0)))));
    assert!(!room.says("was 60 N"));
}

#[test]
fn this_press_is_used_and_saved_at_once_or_saved_later() {
    let mut room = map_room();
    room.write(pressed_home());
    room.window.get_by_label("Use and save").click();
    room.run(3);
    assert_eq!(tried(&room), Some((Newtons(35.0), Newtons(23.0))));
    assert!(room.says("Save as"), "a layout without a file asks for its path");
    room.window.key_press(Key::Escape);
    room.run(3);
    assert!(!room.says("Use and save") && room.says("Undo"), "it is used");
    room.window.get_by_role_and_label(Role::Button, "Save").click();
    room.run(3);
    assert!(room.says("Save as"));
}

#[test]
fn the_key_takes_a_threshold_back_and_stepping_on_the_floor_never_sets_one() {
    let mut room = map_room();
    let before = text(&room);
    room.write(pressed_home());
    let home = room.place("Home");
    room.press(home);
    room.release(home);
    assert_eq!(text(&room), before);
    room.window.get_by_label("Use this press").click();
    room.run(3);
    assert_ne!(text(&room), before);
    room.window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    room.run(3);
    assert_eq!(text(&room), before);
}

#[test]
fn a_control_is_pinned_by_shift_click_and_its_presses_are_forgotten_on_request() {
    let mut room = map_room();
    let north = room.place("North");
    room.hover(north);
    let press = |pressed| Event::PointerButton {
        pos: north,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::SHIFT,
    };
    room.window.event(Event::ModifiersChanged(Modifiers::SHIFT));
    room.window.event(press(true));
    room.window.event(press(false));
    room.window.event(Event::ModifiersChanged(Modifiers::NONE));
    room.run(2);
    assert!(room.says("Control North") && room.says("no presses yet"));
    room.write(pressed_home());
    assert!(room.says("Control North"), "pinned");
    let disabled = room.window.get_by_label("Use this press").accesskit_node().is_disabled();
    assert!(disabled, "nobody pressed it");
    room.window.get_by_label("Follow the foot").click();
    room.run(3);
    assert!(room.says("3 presses"));
    room.window.get_by_label("Forget presses").click();
    room.run(3);
    assert!(room.says("Control Home") && room.says("no presses yet"));
}

#[test]
fn presses_that_were_ignored_stand_in_the_list_of_events_with_the_reason() {
    let mut room = map_room();
    room.write(pressed_home());
    assert!(room.says("home ignored 48 N: too light"));
    room.run(10);
    assert_eq!(room.window.query_all_by_label_contains("home ignored").count(), 1, "once");
    assert_eq!(room.window.unnamed_widgets(), Vec::<String>::new());
}

#[test]
fn a_press_beside_a_control_says_how_far_off_it_was_in_the_list() {
    let mut room = map_room();
    let page = Layout::clone(room.window.state().shown.layout());
    let north = &page.widgets.iter().find(|widget| widget.label == "North").unwrap();
    // North of the control lies free floor, or the edge of another control farther away.
    let place = Vec2::new(north.area.centre().x, north.area.max.y + 0.03);
    assert_eq!(page.widget_at(0, place), None);
    for step in 0..6 {
        let mut snapshot = at_rest(&page);
        snapshot.at = Instant::from_millis(1000 + 50 * step);
        if step < 5 {
            crate::preview::sample::step_on(&mut snapshot, 9, place, 80.0, Vec2::ZERO);
        }
        room.write(snapshot);
    }
    assert!(room.says("80 N, 3 cm beside North"));
    let miss = room.window.state().view.misses.latest().unwrap();
    assert!((miss.distance_m - 0.03).abs() < 0.002 && miss.id == north.id, "{miss:?}");
}

#[test]
fn the_panel_shows_the_control_that_is_dragged_not_the_one_before() {
    let mut room = map_room();
    room.write(pressed_home());
    assert!(room.says("Control Home"));
    let mut dragging = pressed_home();
    let page = Layout::clone(room.window.state().shown.layout());
    let is_slider =
        |it: &&underfoot::layout::Widget| matches!(it.behaviour, underfoot::widget::Behaviour::Slider(_));
    let slider = page.widgets.iter().find(is_slider).unwrap();
    dragging.held = vec![slider.id.clone()];
    room.write(dragging);
    assert!(room.says(&format!("Control {}", slider.label)));
    room.write(pressed_home());
    assert!(room.says(&format!("Control {}", slider.label)), "until the next press");
}
