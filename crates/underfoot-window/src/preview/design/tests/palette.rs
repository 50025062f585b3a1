//! The palette: search, sections, the user's own kinds, and things used before.

use super::*;

impl Desk {
    fn search(&mut self, words: &str) {
        self.window.get_by_label("Search things").focus();
        self.window.run_steps(2);
        self.window.event(Event::Text(words.into()));
        self.window.run_steps(2);
    }

    fn row(&self, label: &str) -> egui::Rect {
        self.window.get_by_label(label).rect()
    }
}

fn empty() -> String {
    Template::Empty.text(&Floor::default().geometry)
}

#[test]
fn a_thing_is_found_by_its_name_and_put_down_by_keyboard() {
    let mut desk = Desk::on(&empty(), None);
    desk.key(Key::F6);
    desk.window.event(Event::Text("grav".into()));
    desk.window.run_steps(2);
    assert!(desk.says("Put down: gravel") && !desk.says("Put down: button"));
    desk.key(Key::Enter);
    assert_eq!(desk.designer().layout().grounds.len(), 1, "{}", desk.text());
    assert!(desk.says("Put down: button"), "the whole list again");
    desk.search("nothing like it");
    assert!(desk.says("Nothing is called so."));
    desk.key(Key::Escape);
    assert!(desk.says("Put down: button"));
}

#[test]
fn the_hint_of_the_search_does_not_cover_what_is_found() {
    let mut desk = Desk::on(&empty(), None);
    let search = desk.row("Search things").center();
    desk.window.event(Event::PointerMoved(search));
    desk.window.run_steps(60);
    assert!(desk.says("several at once"), "while nothing is typed");
    desk.button(search, true);
    desk.button(search, false);
    desk.window.event(Event::Text("slider".into()));
    desk.window.event(Event::PointerMoved(search + vec2(2.0, 0.0)));
    desk.window.run_steps(60);
    assert!(!desk.says("several at once"));
    desk.key(Key::Enter);
    desk.window.run_steps(60);
    assert!(!desk.says("several at once"), "{}", desk.text());
}

#[test]
fn a_section_is_found_by_what_feet_do_there() {
    let mut desk = Desk::on(&empty(), None);
    assert!(desk.says("Slide") && desk.says("Walk on"));
    desk.search("slide");
    assert!(desk.says("Put down: slider") && desk.says("Put down: dial") && !desk.says("Put down: ice"));
}

#[test]
fn arrow_keys_lead_from_the_search_through_the_list() {
    let mut desk = Desk::on(&empty(), None);
    desk.key(Key::F6);
    desk.key(Key::ArrowDown);
    assert!(desk.window.get_by_label("Put down: button").is_focused());
    desk.key(Key::ArrowDown);
    desk.key(Key::Enter);
    assert_eq!(desk.designer().layout().widgets.len(), 1, "{}", desk.text());
    desk.key(Key::ArrowUp);
    assert!(desk.window.get_by_label("Put down: button").is_focused());
}

#[test]
fn the_kinds_of_the_layout_come_first_and_what_was_used_is_offered_again() {
    let text = empty().replacen(
        "regions:",
        "kinds: [(name: \"big_one\", from: \"button\", press_n: 80)], regions:",
        1,
    );
    let mut desk = Desk::on(&text, None);
    assert!(
        desk.says("Your own") && desk.row("Put down: big one").top() < desk.row("Put down: button").top()
    );
    assert!(!desk.says("Put down again"));
    desk.search("big one");
    desk.key(Key::Enter);
    assert!(desk.text().contains("kind: \"big_one\""), "{}", desk.text());
    assert!(desk.row("Put down again: big one").top() < desk.row("Put down: button").top());
    desk.click("Put down again: big one");
    let board = desk.window.get_by_label("Drawing board").rect().center();
    desk.drag(board, board);
    assert_eq!(desk.designer().layout().widgets.len(), 2, "{}", desk.text());
}

#[test]
fn several_with_labels_are_put_in_a_row_by_one_search_and_undone_at_once() {
    let mut desk = Desk::on(&empty(), None);
    let first = desk.text();
    desk.search("button: Welcome, Map, Über uns");
    assert!(desk.says("Put down: button"));
    desk.key(Key::Enter);
    let layout = desk.designer().layout();
    let labels: Vec<&str> = layout.widgets.iter().map(|widget| widget.label.as_str()).collect();
    assert_eq!(labels, ["Welcome", "Map", "Über uns"], "{}", desk.text());
    assert!(layout.widgets.windows(2).all(|pair| pair[1].area.min.x > pair[0].area.max.x + 0.05));
    assert!(desk.designer().edited.findings.is_empty(), "{:?}", desk.designer().edited.findings);
    assert_eq!(desk.designer().edited.selected.len(), 3);
    // In the field of the search, the keys of undo are the field's own.
    desk.key(Key::Escape);
    desk.command(Modifiers::COMMAND, Key::Z);
    assert_eq!(desk.text(), first, "one step");
}

#[test]
fn a_search_of_several_parts_puts_all_of_them_or_none() {
    let mut desk = Desk::on(&empty(), None);
    let first = desk.text();
    for search in ["2 switch; nothing like it", "nothing like it; button"] {
        desk.search(search);
        desk.key(Key::Enter);
        assert_eq!(desk.text(), first, "{search}");
        desk.key(Key::Escape);
    }
    desk.search("2 switch; dial: Vol; switch: Light");
    desk.key(Key::Enter);
    let ids: Vec<_> = desk.designer().layout().widgets.iter().map(|widget| widget.id.to_string()).collect();
    assert_eq!(ids, ["switch", "switch_2", "vol", "light"], "{}", desk.text());
    assert!(desk.designer().edited.findings.is_empty(), "{:?}", desk.designer().edited.findings);
    assert!(desk.says("Put down again: dial"));
}

#[test]
fn a_thing_stays_in_hand_while_shift_is_held_or_labels_are_left() {
    let mut desk = Desk::on(&empty(), None);
    let board = desk.window.get_by_label("Drawing board").rect().center();
    desk.click("Put down: button");
    desk.window.event(Event::ModifiersChanged(Modifiers::SHIFT));
    for east in [-150.0, 0.0] {
        desk.drag(board + vec2(east, 0.0), board + vec2(east, 0.0));
    }
    desk.window.event(Event::ModifiersChanged(Modifiers::NONE));
    desk.drag(board + vec2(150.0, 0.0), board + vec2(150.0, 0.0));
    assert_eq!(desk.designer().layout().widgets.len(), 3, "{}", desk.text());
    // The last one has left the hand: this click selects.
    desk.drag(board + vec2(0.0, -120.0), board + vec2(0.0, -120.0));
    assert_eq!(desk.designer().layout().widgets.len(), 3);

    let mut desk = Desk::on(&empty(), None);
    desk.search("switch: Light, Sound");
    desk.click("Put down: switch");
    for east in [-120.0, 120.0] {
        desk.drag(board + vec2(east, 0.0), board + vec2(east, 0.0));
        assert_eq!(desk.says("next: Sound"), east < 0.0, "{east}");
    }
    let ids: Vec<_> = desk.designer().layout().widgets.iter().map(|widget| widget.id.to_string()).collect();
    assert_eq!(ids, ["light", "sound"]);
}
