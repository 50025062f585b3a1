//! Groups and their display in the inspector.

use super::*;

impl Desk {
    fn group_of_pans() -> Self {
        let mut desk = Self::map();
        let (north, south) = (desk.place("pan_north"), desk.place("pan_south"));
        desk.drag(north + vec2(-130.0, -60.0), south + vec2(130.0, 40.0));
        desk.command(Modifiers::COMMAND, Key::G);
        desk
    }
}

#[test]
fn the_inspector_of_a_group_shows_its_name_place_and_members() {
    let mut desk = Desk::group_of_pans();
    assert!(desk.says("Group group_1") && desk.says("4 members"));
    assert_eq!(desk.field("id").value().as_deref(), Some("group_1"));
    for name in ["pan_north", "pan_south", "pan_west", "pan_east"] {
        assert!(desk.says(&format!("Member: Control {name}")), "{name}");
    }
    desk.field("id").focus();
    desk.window.run_steps(2);
    keyboard::fill(&mut desk, "pans");
    assert!(desk.text().contains("Group(id: \"pans\""), "{}", desk.text());
    desk.click("Member: Control pan_west");
    assert_eq!(desk.designer().edited.document.id_of(&desk.designer().edited.selected[0]), Some("pan_west"));
}

#[test]
fn what_the_controls_of_a_group_have_in_common_is_changed_in_all_of_them() {
    let mut desk = Desk::group_of_pans();
    assert!(desk.says("In common"));
    let press = desk.field("press_n").rect().center();
    assert!(press.x > 1000.0, "it is in the inspector");
    desk.field("press_n").focus();
    desk.window.run_steps(2);
    keyboard::fill(&mut desk, "77");
    let pans = |desk: &Desk| {
        let pans = desk.designer().layout().widgets.iter().filter(|one| one.id.as_str().starts_with("pan_"));
        let force = |one: &underfoot::layout::Widget| one.behaviour.thresholds().press;
        pans.map(force).collect::<Vec<_>>()
    };
    let forces = pans(&desk);
    assert!(forces.len() == 4 && forces.iter().all(|force| *force == forces[0]), "{forces:?}");
    assert_eq!(desk.text().matches("press_n: 77").count(), 4, "{}", desk.text());
    // It is one undo step. A text field with the focus would take back its own text.
    desk.key(Key::Escape);
    desk.command(Modifiers::COMMAND, Key::Z);
    assert!(!desk.text().contains("press_n: 77"));
}

#[test]
fn a_field_that_differs_says_so_and_becomes_the_same_when_it_is_set() {
    let text =
        builtin_layout("map").unwrap().replacen("label: \"North\"", "press_n: 90, label: \"North\"", 1);
    let mut desk = Desk::on(&text, None);
    let (north, south) = (desk.place("pan_north"), desk.place("pan_south"));
    // Without a group, several selected controls share the same common fields.
    desk.drag(north + vec2(-130.0, -60.0), south + vec2(130.0, 40.0));
    assert!(desk.says("4 selected") && desk.says("differs"));
    desk.field("press_n").focus();
    desk.window.run_steps(2);
    keyboard::fill(&mut desk, "66");
    assert_eq!(desk.text().matches("press_n: 66").count(), 4, "{}", desk.text());
    assert!(!desk.text().contains("press_n: 90"));
}
