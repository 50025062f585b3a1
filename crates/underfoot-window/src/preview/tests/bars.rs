//! The bars at the edges: menus, buttons, and messages across the window.

use eframe::egui::accesskit::Role;

use super::*;
use underfoot_scene::scene::Theme;

#[test]
fn a_lost_floor_is_said_across_the_view() {
    let mut room = Room::simulated();
    let mut snapshot = at_rest(&map());
    snapshot.counters.packets = 6000;
    room.write(snapshot.clone());
    assert!(!room.says("No sensor packets"));
    snapshot.link = LinkState::Lost;
    room.snapshots.write(snapshot);
    room.run(24);
    assert!(room.says("No sensor packets for 0.4 s. Every control is released."));
}

#[test]
fn a_bad_layout_is_told_while_the_last_good_one_works() {
    let mut room = Room::simulated();
    let diagnostics: String =
        (1..=30).map(|line| format!("error: layouts/map.ron:{line}:5: unknown field `pres_n`\n")).collect();
    room.layouts.send(LayoutNews::Refused { name: "map.ron".into(), diagnostics }).unwrap();
    room.run(3);
    assert!(room.says("map.ron has problems"));
    assert!(room.says("layouts/map.ron:30:5: unknown field"));
    let home = room.place("Home");
    room.press(home);
    assert!(acts_at(&room.feet().0.unwrap()).distance(middle_of("Home")) < 0.005);
    room.release(home);
    // After a repair: another page of controls, and no problems any more.
    let mut layout = Layout { title: "Mended".into(), ..map() };
    layout.widgets.truncate(1);
    let name = "map.ron".into();
    room.layouts.send(loaded(Arc::new(layout), name)).unwrap();
    room.run(3);
    assert!(!room.says("has problems"));
    assert!(room.says("saved changes loaded"));
    assert!(!room.says("Home") && room.says("Zoom in"));
}

#[test]
fn notices_stay_until_they_are_put_away() {
    let mut room = Room::simulated();
    room.notices.send("No sound card was found.".into()).unwrap();
    room.run(3);
    assert!(room.says("No sound card was found."));
    room.window.get_by_label("Hide: No sound card was found.").click();
    room.run(3);
    assert!(!room.says("No sound card was found."));
}

#[test]
fn the_floor_is_muted_by_button_and_key_and_says_so() {
    let mut room = Room::simulated();
    room.window.get_by_label("Mute").click();
    room.run(2);
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::Mute(true)));
    assert!(!room.says("muted"), "it is once the floor says so");
    let mut snapshot = at_rest(&map());
    snapshot.muted.all = true;
    room.write(snapshot.clone());
    assert!(room.says("muted"));
    let button = room.window.get_by_label("Mute");
    assert_eq!(button.accesskit_node().toggled(), Some(egui::accesskit::Toggled::True));
    room.window.key_press(Key::M);
    room.run(2);
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::Mute(false)));
    // A single tile: the selected one.
    snapshot.muted.all = false;
    room.write(snapshot.clone());
    let tile = Floor::default().geometry.tile_under(middle_of("Home")).unwrap();
    room.window.get_by_label("Mute tile").click();
    room.run(2);
    let Ok(PreviewCommand::MuteTile { tile: selected, on: true }) = room.commands.try_recv() else {
        panic!("not muted")
    };
    snapshot.muted.tiles = vec![selected, tile];
    room.write(snapshot);
    assert!(room.says("2 muted"));
    room.window.get_by_label("Mute tile").click();
    room.run(2);
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::MuteTile { tile: selected, on: false }));
}

#[test]
fn warnings_are_counted_and_listed_and_an_opened_layout_is_not_called_saved() {
    let mut room = Room::simulated();
    assert!(!room.says("warning"));
    let warnings = Warnings { count: 2, text: "warning[U101]: \"home\" is 4.0 cm wide".into() };
    let (layout, name) = (Arc::new(map()), "map".to_owned());
    room.layouts
        .send(LayoutNews::Loaded { layout, revision: 0, name, cause: LayoutCause::Opened, warnings })
        .unwrap();
    room.run(3);
    assert!(room.says("map: opened") && !room.says("saved"));
    assert!(!room.says("U101"));
    room.window.get_by_label("2 warnings").click();
    room.run(3);
    assert!(room.says("U101"));
}

#[test]
fn layers_are_chosen_in_a_menu_that_stays_open() {
    let mut room = Room::simulated();
    room.write(pressing(&map()));
    assert!(!room.says("Uncertainty"));
    room.window.get_by_label("Layers").click();
    room.run(3);
    room.window.get_by_role_and_label(Role::CheckBox, "Uncertainty").click();
    room.run(3);
    assert!(room.window.state().view.show.uncertainty);
    room.window.get_by_label("All").click();
    room.run(3);
    let mut show = room.window.state().view.show;
    assert!(Show::LAYERS.iter().all(|(_, layer)| *layer(&mut show)), "{show:?}");
    for (name, _) in Show::LAYERS {
        let tick = room.window.get_by_role_and_label(Role::CheckBox, name);
        assert_eq!(tick.accesskit_node().toggled(), Some(egui::accesskit::Toggled::True), "{name}");
    }
    room.window.get_by_label("Usual").click();
    room.run(3);
    assert_eq!(room.window.state().view.show, Show::WINDOW);
}

#[test]
fn a_layout_is_opened_by_name() {
    let mut room = Room::simulated();
    room.window.get_by_label("Layout").click();
    room.run(3);
    room.window.get_by_label("Surgery").click();
    room.run(3);
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::Open(1)));
}

#[test]
fn colours_and_the_side_panel_are_changed_by_buttons() {
    let mut room = Room::simulated();
    room.window.get_by_label("Appearance").click();
    room.run(3);
    for (name, theme) in Theme::NAMED {
        room.window.get_by_label(&format!("Window: {name}")).click();
        room.run(3);
        assert_eq!(room.window.state().appearance.theme(), theme, "{name}");
    }
    room.window.get_by_label("Projected: High contrast").click();
    room.run(3);
    assert_eq!(room.window.state().appearance.projected().faces, Theme::CONTRAST.faces);
    room.window.key_press(Key::Escape);
    room.run(3);
    let before = room.window.get_by_label("Floor").rect().width();
    assert!(room.says("Contacts"));
    room.window.get_by_label("Panel").click();
    room.run(20);
    assert!(!room.says("Contacts"));
    assert!(room.window.get_by_label("Floor").rect().width() > before + 200.0);
}

#[test]
fn the_help_at_the_lower_edge_tells_what_can_be_done_where() {
    let mut room = Room::simulated();
    assert!(room.says("stance foot here"));
    room.window.get_by_label("Design").click();
    room.run(4);
    assert!(room.says("no snapping") && !room.says("stance foot here"));
    let mut real = Room::of(false, 1280.0, 800.0);
    real.run(2);
    assert!(real.says("look at a tile") && !real.says("stance foot here"), "feet are real there");
}

#[test]
fn the_size_of_the_text_is_chosen_by_keys_and_menu_and_remembered_with_the_colours() {
    let mut room = Room::simulated();
    let factor = |room: &Room| room.window.ctx.zoom_factor();
    let before = factor(&room);
    for _ in 0..3 {
        room.window.key_press_modifiers(Modifiers::COMMAND, Key::Plus);
        room.run(2);
    }
    assert!((factor(&room) / before - 1.3).abs() < 0.01, "{}", factor(&room));
    room.window.key_press_modifiers(Modifiers::COMMAND, Key::Minus);
    room.run(2);
    room.window.get_by_label("Appearance").click();
    room.run(3);
    assert!(room.says("Text 120 %"));
    room.window.get_by_label("Window: Dark").click();
    room.run(3);
    let kept = std::fs::read_to_string(room.folder.path().join("window")).unwrap();
    assert!(kept.contains("text 12") && kept.contains("window dark"), "{kept}");
    room.window.key_press_modifiers(Modifiers::COMMAND, Key::Num0);
    room.run(2);
    assert_eq!(factor(&room), before);
    for _ in 0..40 {
        room.window.key_press_modifiers(Modifiers::COMMAND, Key::Minus);
    }
    room.run(3);
    assert!((factor(&room) / before - 0.7).abs() < 0.01, "no smaller than can be read: {}", factor(&room));
}
