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
