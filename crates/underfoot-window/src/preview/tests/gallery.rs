//! The gallery of layouts: opened from both modes, with a sentence of each, and closed again.

use super::*;
use crate::preview::bars::TopBar;
use eframe::egui::accesskit::Role;
use underfoot::schema::builtin_layouts;

/// A window that can open all shipped layouts; `begins` opens the gallery at once.
fn room(begins: bool) -> Room {
    let mut room = Room::simulated();
    let names = builtin_layouts().map(String::from).collect();
    room.window.state_mut().top_bar = TopBar::new(names, begins);
    room.run(3);
    room
}

fn is_open(room: &Room) -> bool {
    room.says("Layouts to start from")
}

#[test]
fn a_window_can_begin_with_the_gallery_in_which_each_layout_has_a_name_and_a_sentence() {
    let mut room = room(true);
    assert!(is_open(&room));
    for name in builtin_layouts() {
        let card = room.window.get_by_role_and_label(Role::Button, name);
        let text = card.accesskit_node().value().unwrap_or_default();
        assert!(text.contains(": ") && text.ends_with('.'), "{name}: {text}");
    }
    room.window.get_by_role_and_label(Role::Button, "pond").click();
    room.run(3);
    let index = builtin_layouts().position(|name| name == "pond").unwrap();
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::Open(index)));
    let designer = room.window.state().designer.as_ref().unwrap();
    assert_eq!(designer.file_text(), builtin_layout("pond").unwrap());
    assert!(!is_open(&room));
}

#[test]
fn the_first_card_has_the_keyboard_and_escape_opens_nothing() {
    let mut room = room(false);
    room.window.get_by_label("Layout").click();
    room.run(3);
    let focused = room.window.query_all_by(|node| node.is_focused()).next();
    let focused = focused.and_then(|node| node.accesskit_node().label());
    assert_eq!(focused.as_deref(), builtin_layouts().next());
    room.window.key_press(Key::Escape);
    room.run(3);
    assert!(!is_open(&room) && room.commands.try_recv().is_err());
}

#[test]
fn keys_lead_to_the_next_card_and_open_its_layout() {
    let mut room = room(false);
    room.window.get_by_label("Layout").click();
    room.run(6);
    room.window.key_press(Key::ArrowRight);
    room.run(3);
    while room.commands.try_recv().is_ok() {}
    room.window.key_press(Key::Enter);
    room.run(3);
    assert!(!is_open(&room));
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::Open(1)));
}

#[test]
fn a_layout_of_the_gallery_is_on_drawing_board_and_floor_in_design() {
    let mut room = room(false);
    for name in ["Design", "File", "Gallery"] {
        room.window.get_by_label(name).click();
        room.run(4);
    }
    while room.commands.try_recv().is_ok() {}
    room.window.get_by_role_and_label(Role::Button, "surgical").click();
    room.run(4);
    let designer = room.window.state().designer.as_ref().unwrap();
    assert!(designer.is_open && designer.file_text() == builtin_layout("surgical").unwrap());
    let tried = std::iter::from_fn(|| room.commands.try_recv().ok()).find_map(|command| match command {
        PreviewCommand::Try { layout, .. } => Some(layout.title.clone()),
        _ => None,
    });
    assert_eq!(tried.as_deref(), Some("Image viewer"));
}
