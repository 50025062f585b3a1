//! Design mode by keyboard alone.

use super::*;

/// Types into the field with the focus, replaces its text, and moves to the next field.
pub(super) fn fill(desk: &mut Desk, text: &str) {
    desk.window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    desk.window.run_steps(1);
    desk.window.event(Event::Text(text.into()));
    desk.window.run_steps(1);
    desk.key(Key::Tab);
}

#[test]
fn a_layout_is_built_from_an_empty_floor_by_keyboard() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let empty = crate::edit::Template::Empty.text(&Floor::default().geometry);
    std::fs::write(&path, &empty).unwrap();
    let mut desk = Desk::on(&empty, Some(path.clone()));
    for kind in ["button", "switch", "slider"] {
        desk.window.get_by_label(&format!("Put down: {kind}")).focus();
        desk.window.run_steps(1);
        desk.key(Key::Enter);
    }
    let ids: Vec<_> = desk.designer().layout().widgets.iter().map(|widget| widget.id.to_string()).collect();
    assert_eq!(ids, ["button", "switch", "slider"]);
    let before = desk.area("slider");
    desk.command(Modifiers::COMMAND, Key::ArrowUp);
    assert!((desk.area("slider").min.y - before.min.y - 0.01).abs() < 1e-4);
    desk.command(Modifiers::COMMAND, Key::D);
    assert_eq!(desk.designer().layout().widgets.len(), 4);
    desk.command(Modifiers::COMMAND, Key::S);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), desk.text());
    assert!(desk.text().starts_with(&empty[..200]), "comments stay");
}

/// Builds the layout `map.ron` from an empty file by keyboard, one control after the other, as a beginner would.
#[test]
fn the_shipped_map_is_built_from_an_empty_file_by_keyboard() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    std::fs::write(&path, "").unwrap();
    let empty = Template::Empty.text(&Floor::default().geometry);
    let mut desk = Desk::with(&empty, Some(path.clone()), tempfile::tempdir().unwrap());
    let field = |desk: &mut Desk, name: &str, text: &str| {
        desk.field(name).focus();
        desk.window.run_steps(2);
        fill(desk, text);
    };
    field(&mut desk, "title", "Map navigation");
    desk.click("Region main");
    field(&mut desk, "id", "map");
    // First reduce the depth: five tiles from the second row on would leave the floor.
    field(&mut desk, "size depth", "4");
    field(&mut desk, "at north", "2");
    let controls = [
        ("button", "pan_north", "North", "1.9", "2.9", "0.6", "0.5"),
        ("button", "pan_south", "South", "1.9", "2.2", "0.6", "0.5"),
        ("button", "pan_west", "West", "1.1", "2.55", "0.55", "0.5"),
        ("button", "pan_east", "East", "2.75", "2.55", "0.55", "0.5"),
        ("round button", "home", "Home", "0.2", "2.2", "0.6", "0.6"),
        ("switch", "satellite", "Satellite", "3.6", "2.2", "0.7", "0.6"),
        ("slider", "zoom", "Zoom", "4.5", "2.2", "1.35", "0.6"),
    ];
    for (kind, id, label, east, north, width, depth) in controls {
        desk.designer_mut().panes.pane = None;
        desk.key(Key::F6);
        desk.window.event(Event::Text(kind.into()));
        desk.window.run_steps(1);
        desk.key(Key::Enter);
        let values = [("id", id), ("label", label), ("size width", width), ("size depth", depth)];
        for (name, text) in values.into_iter().chain([("at north", north), ("at east", east)]) {
            field(&mut desk, name, text);
        }
    }
    field(&mut desk, "initial", "0.3");
    desk.command(Modifiers::COMMAND, Key::S);
    let saved = std::fs::read_to_string(&path).unwrap();
    let geometry = Floor::default().geometry;
    let resolved = |text: &str| parse_layout(text, "it", &Kinds::builtin(), &geometry).unwrap().layout;
    assert_eq!(resolved(&saved), resolved(builtin_layout("map").unwrap()), "{saved}");
}

#[test]
fn the_key_f6_leads_from_part_to_part_and_a_feel_can_be_heard() {
    let mut desk = Desk::map();
    desk.key(Key::F6);
    desk.key(Key::F6);
    desk.key(Key::Enter);
    assert_eq!(desk.designer().edited.selected.len(), 1, "the first thing on the floor");
    let home = desk.place("home");
    desk.drag(home, home);
    desk.click("Feel");
    desk.click("Hear at the press");
    assert!(desk.commands.try_iter().any(|told| matches!(told, PreviewCommand::Feel { .. })));
    desk.key(Key::F6);
    assert!(desk.field("id").is_focused());
}

#[test]
fn what_is_being_typed_counts_when_the_floor_is_tried() {
    let mut desk = Desk::map();
    let home = desk.place("home");
    desk.drag(home, home);
    desk.field("label").focus();
    desk.window.run_steps(2);
    desk.window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    desk.window.run_steps(1);
    desk.window.event(Event::Text("Start".into()));
    desk.window.run_steps(1);
    desk.key(Key::F2);
    assert!(!desk.designer().is_open && desk.text().contains("label: \"Start\""), "{}", desk.text());
    let told = desk.commands.try_iter().last();
    let Some(PreviewCommand::Try { layout, .. }) = told else { panic!("{told:?}") };
    assert!(layout.widgets.iter().any(|widget| widget.label == "Start"));
}
