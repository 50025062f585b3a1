//! Editing as design tools have it: text in place, copies by Alt, drawing, the menu, undo with the selection.

use super::*;
use crate::edit::Address;

impl Desk {
    fn double_click(&mut self, at: Pos2) {
        self.window.event(Event::PointerMoved(at));
        self.window.run_steps(1);
        for pressed in [true, false, true, false] {
            self.button(at, pressed);
        }
        self.window.run_steps(2);
    }

    fn open_menu(&mut self, at: Pos2) {
        self.window.event(Event::PointerMoved(at));
        self.window.run_steps(1);
        for pressed in [true, false] {
            let (button, modifiers) = (PointerButton::Secondary, Modifiers::NONE);
            self.window.event(Event::PointerButton { pos: at, button, pressed, modifiers });
            self.window.run_steps(2);
        }
    }

    /// Clicks the entry of the open menu; the bar may have a button of the same name.
    fn choose_entry(&mut self, entry: &str) {
        let entries = self.window.query_all_by_label_contains(entry);
        entries.last().unwrap_or_else(|| panic!("no {entry}")).click();
        self.window.run_steps(3);
    }

    fn type_over(&mut self, text: &str) {
        self.window.event(Event::Text(text.into()));
        self.window.run_steps(1);
        self.key(Key::Enter);
    }

    fn hold(&mut self, modifiers: Modifiers) {
        self.window.event(Event::ModifiersChanged(modifiers));
        self.window.run_steps(1);
    }

    fn selected_ids(&self) -> Vec<String> {
        let edited = &self.designer().edited;
        let id = |record: &Address| edited.document.id_of(record).unwrap_or_default().to_owned();
        edited.selected.iter().map(id).collect()
    }

    fn undo(&mut self) {
        self.command(Modifiers::COMMAND, Key::Z);
    }
}

/// Whether each number of `value`, such as `(1.05, 2)`, is a multiple of 0.05.
fn is_round(value: &str) -> bool {
    let mut numbers = value.trim_matches(['(', ')']).split(',').map(|number| number.trim().parse::<f64>());
    numbers.all(|number| number.is_ok_and(|number| (number / 0.05 - (number / 0.05).round()).abs() < 1e-6))
}

#[test]
fn a_row_of_the_list_has_the_menu_that_its_record_has_on_the_floor() {
    let mut desk = Desk::map();
    let row = desk.window.get_by_label("Control home").rect().center();
    desk.open_menu(row);
    assert_eq!(desk.selected_ids(), ["home"]);
    desk.choose_entry("Rename");
    desk.type_over("start");
    assert!(desk.text().contains("id: \"start\"") && !desk.text().contains("id: \"home\""));
    assert_eq!(desk.selected_ids(), ["start"]);
}

#[test]
fn a_double_click_edits_the_label_where_the_foot_reads_it() {
    let mut desk = Desk::map();
    let first = desk.text();
    let home = desk.place("home");
    desk.double_click(home);
    assert!(desk.says("Label on the floor"));
    desk.type_over("Start");
    assert_eq!(desk.text(), first.replace("label: \"Home\"", "label: \"Start\""));
    assert!(!desk.says("Label on the floor"));
    desk.undo();
    assert_eq!(desk.text(), first);
    assert_eq!(desk.selected_ids(), ["home"]);
    desk.key(Key::Enter);
    desk.window.event(Event::Text("Never".into()));
    desk.window.run_steps(1);
    desk.key(Key::Escape);
    assert_eq!(desk.text(), first, "Escape leaves the label");
    assert_eq!(desk.selected_ids(), ["home"]);
}

#[test]
fn a_drag_with_alt_copies_and_undo_takes_the_copy_back() {
    let mut desk = Desk::map();
    let (first, before, home) = (desk.text(), desk.area("home"), desk.place("home"));
    desk.hold(Modifiers::ALT);
    desk.drag(home, home + vec2(0.0, -110.0));
    desk.hold(Modifiers::NONE);
    assert_eq!(desk.area("home"), before);
    assert_eq!(desk.selected_ids(), ["home_2"]);
    let copy = desk.area("home_2");
    assert!(copy.min.y > before.min.y + 0.1, "{copy:?}");
    assert!((copy.size() - before.size()).length() < 1e-4, "{copy:?}");
    desk.undo();
    assert_eq!(desk.text(), first);
    assert_eq!(desk.selected_ids(), ["home"], "the selection of that step");
    desk.command(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(desk.selected_ids(), ["home_2"]);
}

#[test]
fn a_control_becomes_as_large_as_it_is_drawn_in_round_numbers() {
    let mut desk = Desk::on(&Template::Empty.text(&Floor::default().geometry), None);
    let first = desk.text();
    desk.click("Put down: button");
    let board = desk.window.get_by_label("Drawing board").rect().center();
    desk.drag(board + vec2(-83.0, -41.0), board + vec2(61.0, 57.0));
    let size = desk.area("button").size();
    assert!(size.x > 1.2 * size.y, "{size}");
    let edited = &desk.designer().edited;
    for field in ["at", "size"] {
        let written = edited.document.written(&edited.selected[0], field).unwrap();
        assert!(is_round(written), "{field}: {written}");
    }
    desk.undo();
    assert_eq!(desk.text(), first);
}

#[test]
fn the_floor_stops_what_is_drawn_or_dragged_beyond_its_edge() {
    let mut desk = Desk::on(&Template::Empty.text(&Floor::default().geometry), None);
    let board = desk.window.get_by_label("Drawing board").rect();
    desk.window.get_by_label("Put down: place to stand").scroll_to_me();
    desk.window.run_steps(20);
    desk.click("Put down: place to stand");
    desk.drag(board.center(), egui::pos2(board.right() - 3.0, board.center().y + 80.0));
    let edge = Floor::default().geometry.bounds().max.x;
    let stances = &desk.designer().layout().stances;
    assert_eq!(stances.len(), 2, "{}", desk.text());
    assert!((stances[1].area.max.x - edge).abs() < 1e-4, "{:?}", stances[1].area);

    let mut desk = Desk::map();
    let home = desk.place("home");
    desk.drag(home, egui::pos2(board.left() + 3.0, home.y));
    assert!(desk.area("home").min.x.abs() < 1e-4, "{:?}", desk.area("home"));
    assert!(!desk.says("beyond the floor"));
}

#[test]
fn dragged_places_are_round_until_control_turns_snapping_off() {
    let mut desk = Desk::map();
    let at = |desk: &Desk| {
        let edited = &desk.designer().edited;
        edited.document.written(&edited.selected[0], "at").unwrap().to_owned()
    };
    let home = desk.place("home");
    desk.drag(home, home + vec2(13.0, -93.0));
    assert!(is_round(&at(&desk)), "{}", at(&desk));
    let home = desk.place("home");
    desk.hold(Modifiers::COMMAND);
    desk.drag(home, home + vec2(11.3, 7.7));
    assert!(!is_round(&at(&desk)), "{}", at(&desk));
}

#[test]
fn the_menu_pastes_the_appearance_and_the_feel_alone() {
    let mut desk = Desk::on(builtin_layout("surgical").unwrap(), None);
    let look = |desk: &Desk, id: &str| {
        let layout = desk.designer().layout();
        layout.widgets[layout.widget_index(id).unwrap()].clone()
    };
    let (source, other) = ("capture", desk.designer().layout().widgets[0].id.to_string());
    let edited = &desk.designer().edited;
    let item = edited.items.iter().find(|item| item.name == source).unwrap();
    let copied = edited.document.copy(std::slice::from_ref(&item.record));
    let (first, before) = (desk.text(), look(&desk, &other));
    let place = desk.place(&other);
    desk.open_menu(place);
    assert_eq!(desk.selected_ids(), std::slice::from_ref(&other));
    desk.choose_entry("Paste appearance");
    desk.window.event(Event::Paste(copied.clone()));
    desk.window.run_steps(3);
    let (from, after) = (look(&desk, source), look(&desk, &other));
    assert_eq!((after.look.face, after.look.lit), (from.look.face, from.look.lit));
    assert_eq!((after.feel, after.area), (before.feel, before.area));
    desk.undo();
    assert_eq!(desk.text(), first);
    desk.open_menu(place);
    desk.choose_entry("Paste feel");
    desk.window.event(Event::Paste(copied));
    desk.window.run_steps(3);
    assert_eq!(look(&desk, &other).feel, from.feel);
}

#[test]
fn an_id_that_the_menu_changes_is_followed_by_its_neighbours_and_its_lock() {
    let text = "Layout(version: 1, regions: [(id: \"r\", at: (0, 1), size: (6, 5))], widgets: [
        (id: \"a\", kind: \"button\", at: (1, 2), size: (0.6, 0.6), label: \"A\"), // a
        (id: \"b\", kind: \"button\", right_of: \"a\", gap: 0.3, /* gap */ label: \"B\"),
    ])";
    let mut desk = Desk::on(text, None);
    desk.click("Hide: b");
    let place = desk.place("a");
    desk.open_menu(place);
    desk.choose_entry("Rename");
    desk.type_over("first");
    assert_eq!(desk.text(), text.replace("\"a\"", "\"first\""));
    desk.undo();
    assert_eq!(desk.text(), text);
    // A hidden control stays hidden under its new id.
    desk.click("Control b");
    desk.field("id").focus();
    desk.window.run_steps(2);
    keyboard::fill(&mut desk, "second");
    assert!(
        desk.text().contains("\"second\"") && desk.window.query_by_label("On the floor: second").is_none()
    );
}

#[test]
fn several_are_moved_by_a_typed_amount() {
    let mut desk = Desk::map();
    let first = desk.text();
    let (north, south) = (desk.place("pan_north"), desk.place("pan_south"));
    desk.drag(north + vec2(-130.0, -60.0), south + vec2(130.0, 40.0));
    let before = (desk.area("pan_north"), desk.area("pan_west"));
    desk.window.get_by_label("all north").focus();
    desk.window.run_steps(2);
    desk.type_over("+0.1");
    let pitch = Floor::default().geometry.pitch_m();
    for (id, before) in [("pan_north", before.0), ("pan_west", before.1)] {
        assert!((desk.area(id).min.y - before.min.y - 0.1 * pitch.y).abs() < 1e-4, "{id}");
    }
    assert_eq!(desk.designer().edited.selected.len(), 4);
    desk.undo();
    assert_eq!(desk.text(), first);
}

#[test]
fn the_list_of_problems_mends_them_one_by_one_or_all_at_once() {
    let crowded = builtin_layout("map").unwrap().replace("at: (1.9, 2.9)", "at: (1.9, 2.75)");
    let mut desk = Desk::on(&crowded, None);
    assert!(desk.says("Problem: U102"), "{}", desk.text());
    desk.window.get_by_label_contains("Move them apart: U102").click();
    desk.window.run_steps(3);
    assert!(!desk.says("Problem: U102"), "{}", desk.text());
    desk.undo();
    assert_eq!(desk.text(), crowded);
    desk.window.get_by_label_contains("Mend all").click();
    desk.window.run_steps(3);
    assert!(desk.designer().edited.findings.is_empty(), "{}", desk.text());
    desk.undo();
    assert_eq!(desk.text(), crowded);
}

#[test]
fn home_end_and_page_keys_move_through_the_list() {
    let mut desk = Desk::map();
    let rows = ["Region map", "Control home", "Control pan_north", "Control zoom"];
    let has_focus = |desk: &Desk, name: &str| desk.window.get_by_label(name).is_focused();
    desk.window.get_by_label(rows[1]).focus();
    desk.window.run_steps(2);
    desk.key(Key::Home);
    assert!(!has_focus(&desk, rows[1]));
    desk.key(Key::End);
    let last = desk.designer().edited.items.last().unwrap().name.clone();
    assert!(has_focus(&desk, &format!("Control {last}")), "{last}");
    desk.key(Key::PageUp);
    assert!(!has_focus(&desk, &format!("Control {last}")));
    desk.key(Key::PageDown);
    assert!(has_focus(&desk, &format!("Control {last}")));
}

#[test]
fn design_begins_with_the_control_that_a_foot_used_and_turns_it_within_its_region() {
    let mut desk = Desk::map();
    let zoom = underfoot::widget::WidgetId::new("zoom");
    desk.key(Key::F2);
    desk.window.run_steps(4);
    desk.window.state_mut().selection.pin_control(zoom);
    desk.key(Key::F2);
    assert_eq!(desk.selected_ids(), ["zoom"]);
    let before = desk.area("zoom").size();
    desk.key(Key::R);
    let (after, layout) = (desk.area("zoom"), desk.designer().layout());
    assert!((after.size() - glam::Vec2::new(before.y, before.x)).length() < 1e-3, "{after:?}");
    let region = layout.regions[0].area.grown(1e-3);
    assert!(region.contains(after.min) && region.contains(after.max), "{after:?} in {region:?}");
    // The user's own selection stays until a foot uses another control.
    desk.click("Control home");
    for _ in 0..2 {
        desk.key(Key::F2);
        desk.window.run_steps(4);
    }
    assert_eq!(desk.selected_ids(), ["home"]);
}

#[test]
fn several_become_as_the_first_one_is_by_a_key_or_from_the_menu() {
    let mut desk = Desk::map();
    let first = desk.text();
    let (home, west) = (desk.place("home"), desk.place("pan_west"));
    desk.drag(home, home);
    desk.hold(Modifiers::SHIFT);
    desk.drag(west, west);
    desk.hold(Modifiers::NONE);
    desk.command(Modifiers::COMMAND, Key::E);
    assert!((desk.area("pan_west").size() - desk.area("home").size()).length() < 1e-4, "{}", desk.text());
    assert!(desk.says("made like home"));
    desk.undo();
    assert_eq!(desk.text(), first);
    desk.open_menu(home);
    desk.choose_entry("Make alike");
    assert!((desk.area("pan_west").size() - desk.area("home").size()).length() < 1e-4, "{}", desk.text());
}
