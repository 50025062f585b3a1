//! The switch of the modes, the place of the floor in each of them, and the order of the keyboard.

use eframe::egui::accesskit::Role;

use super::*;

/// The area of a control in Try mode, or of its record in Design mode.
fn area(room: &Room, label: &str) -> egui::Rect {
    room.window.get_by_label(label).rect()
}

#[test]
fn one_switch_leads_to_each_mode_and_back() {
    let mut room = Room::simulated();
    let is_on = |room: &Room, mode: &str| {
        let button = room.window.get_by_role_and_label(Role::RadioButton, mode);
        button.accesskit_node().toggled() == Some(egui::accesskit::Toggled::True)
    };
    for mode in ["Design", "Project", "Try", "Project", "Design", "Try"] {
        room.window.get_by_role_and_label(Role::RadioButton, mode).click();
        room.run(6);
        let on: Vec<&str> = ["Try", "Design", "Project"].into_iter().filter(|it| is_on(&room, it)).collect();
        assert_eq!(on, [mode]);
        assert_eq!(room.says("Drawing board"), mode == "Design");
        assert_eq!(room.says("Projected floor"), mode == "Project");
        // The tools of a mode come with it.
        assert_eq!(room.says("Arrange"), mode == "Design");
        assert_eq!(room.says("Stance foot"), mode != "Design");
        assert_eq!(room.says("full screen"), mode == "Project");
    }
}

#[test]
fn tab_goes_to_the_floor_first_and_then_from_left_to_right() {
    let mut room = Room::simulated();
    room.write(at_rest(&map()));
    let focused = |room: &Room| -> Option<(String, egui::Rect)> {
        let node = room.window.query_all_by(|node| node.is_focused()).next()?;
        Some((node.accesskit_node().label().unwrap_or_default(), node.rect()))
    };
    let controls = map().widgets.iter().filter(|widget| widget.is_on(0)).count();
    let mut names = Vec::new();
    for _ in 0..controls {
        room.window.key_press(Key::Tab);
        room.run(2);
        names.extend(focused(&room).map(|(name, _)| name));
    }
    assert!(map().widgets.iter().filter(|it| it.is_on(0)).all(|it| names.contains(&it.label)), "{names:?}");
    let mut left = 0.0;
    for name in ["Try", "Design", "Project", "Layout", "Stance foot", "Mute", "Layers"] {
        room.window.key_press(Key::Tab);
        room.run(2);
        let (label, rect) = focused(&room).unwrap();
        assert_eq!(label, name);
        assert!(rect.left() > left, "{name}");
        left = rect.left();
    }
    room.window.key_press_modifiers(Modifiers::SHIFT, Key::Tab);
    room.run(2);
    assert_eq!(focused(&room).unwrap().0, "Mute");
}

#[test]
fn no_news_of_the_sound_comes_before_there_was_something_to_hear() {
    let mut room = Room::simulated();
    room.notices.send(crate::preview::Notice::Sound("No sound: no card was found.".into())).unwrap();
    room.run(5);
    assert!(!room.says("No sound"));
    room.window.state_mut().shown.messages.tell_silence();
    room.run(2);
    assert!(room.says("No sound: no card was found."));
}

#[test]
fn the_list_of_events_is_in_view_at_the_usual_size() {
    let mut room = Room::simulated();
    room.write(pressing(&map()));
    room.happen(event(100, "home"));
    room.run(4);
    let line = area(&room, "home pressed");
    assert!(line.bottom() < 760.0 && line.top() > 60.0, "{line}");
    let heading = area(&room, "Events");
    assert!(heading.top() < line.top() && line.bottom() - heading.top() < 200.0);
}
