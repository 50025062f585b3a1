//! The panels at the side and the effect tuner: their content and their commands.

use super::*;

/// Scrolls to a line of the panel.
fn scroll_to(room: &mut Room, label: &str) {
    room.window.get_by_label(label).scroll_to_me();
    room.run(20);
}

#[test]
fn the_panel_follows_the_foot_and_lists_its_sensors() {
    let mut room = Room::simulated();
    let mut snapshot = pressing(&map());
    let index = Floor::default().geometry.index(TileId::new(0, 4)).unwrap();
    snapshot.tiles[index].quality[2] = underfoot::sense::Quality::Faulty;
    room.write(snapshot);
    assert!(room.says("Tile 0, 4"));
    assert!(room.says(", faulty"));
    assert!(room.says("Contact 7 cursor: 152 newtons"));
    assert!(room.says("Contact 6 : 520 newtons"));
    let pressed = room.window.get_by_label("Zoom in");
    assert_eq!(pressed.accesskit_node().toggled(), Some(egui::accesskit::Toggled::True));
}

#[test]
fn the_panel_says_in_one_line_how_the_sensors_are_and_names_those_in_trouble() {
    let mut room = Room::simulated();
    let mut snapshot = pressing(&map());
    snapshot.health.counts = [144, 0, 0, 0];
    room.write(snapshot.clone());
    assert!(room.says("Sensors: all 144 live"));
    snapshot.health.counts = [143, 0, 0, 1];
    let sensor = SensorId { tile: TileId::new(2, 1), corner: Corner::SouthWest };
    snapshot.health.troubles.push((sensor, underfoot::sense::Trouble::Stuck));
    room.write(snapshot);
    scroll_to(&mut room, "Sensors: 1 faulty, 143 live");
    room.window.get_by_label("Sensors: 1 faulty, 143 live").click();
    room.run(20);
    assert!(room.says("tile (2, 1) sw: stuck"));
}

#[test]
fn events_are_listed_newest_first() {
    let mut room = Room::simulated();
    room.happen(event(100, "home"));
    let changed = EventKind::Changed(Value::Number(7.25));
    room.happen(WidgetEvent { kind: changed, ..event(200, "time") });
    room.run(2);
    let (older, newer) = (room.place("home pressed"), room.place("time changed 7.250"));
    assert!(newer.y < older.y);
    assert!(room.says("2 so far"));
}

#[test]
fn the_list_of_events_is_searched_and_copied() {
    let mut room = Room::simulated();
    for (at, id) in [(100, "home"), (200, "time")] {
        room.happen(event(at, id));
    }
    room.run(2);
    room.window.get_by_label("Search events").focus();
    room.run(1);
    room.window.event(Event::Text("hom".into()));
    room.run(2);
    assert!(room.says("home pressed") && !room.says("time pressed"));
    // Keys in a text field neither press a control nor mute.
    assert!(room.commands.try_recv().is_err());
    room.window.get_by_label("Copy events").click();
    room.window.step();
    let copied = room.window.output().platform_output.commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    assert!(copied.is_some_and(|text| text.contains("\"home\"") && !text.contains("\"time\"")));
}

#[test]
fn the_panel_counts_what_gave_way_underfoot() {
    let mut room = Room::simulated();
    let text = builtin_layout("pond").unwrap();
    let pond = parse_layout(text, "pond", &Kinds::builtin(), &Floor::default().geometry).unwrap().layout;
    let mut snapshot = at_rest(&pond);
    let layout = Arc::new(pond);
    room.layouts.send(loaded(layout, "pond".into())).unwrap();
    let counters = GroundCounters { events: 5, unfelt: 0, evicted: 2 };
    let cracks = vec![Crack::default(); 3];
    snapshot.grounds = vec![GroundState { cracks, counters, ..GroundState::default() }];
    room.write(snapshot);
    assert!(!room.says("evicted"), "one line until it is opened");
    room.window.get_by_label("Ice: 3 pieces").click();
    room.run(20);
    assert!(room.says("evicted by new pieces: 2") && room.says("seeds: 0"));
}

#[test]
fn an_apps_part_can_be_played_from_the_panel() {
    let mut room = Room::simulated();
    scroll_to(&mut room, "Controls, as an app sets them");
    room.window.get_by_label("Controls, as an app sets them").click();
    room.run(20);
    scroll_to(&mut room, "home works");
    room.window.get_by_label("home works").click();
    room.run(3);
    let id = WidgetId::new("home");
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::Enable { id, enabled: false }));
    room.window.get_by_label("satellite value").scroll_to_me();
    room.run(3);
    room.window.get_by_label("satellite value").click();
    room.run(3);
    let id = WidgetId::new("satellite");
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::Set { id, value: Value::Switch(true) }));
}

/// The state of the map if the floor file of the hall lacks the calibration of `home`.
fn home_is_off() -> underfoot::engine::Snapshot {
    let page = map();
    let mut snapshot = at_rest(&page);
    snapshot.floor_file = underfoot::floor::FloorFile::new("hall.ron");
    let home = page.widget_index("home").unwrap();
    snapshot.widgets[home].off = Some(underfoot::widget::OffReason::NotCalibrated);
    snapshot
}

#[test]
fn the_panel_says_why_a_control_is_off() {
    let mut room = Room::simulated();
    scroll_to(&mut room, "Controls, as an app sets them");
    room.window.get_by_label("Controls, as an app sets them").click();
    room.run(20);
    assert!(!room.says("not calibrated"));
    room.write(home_is_off());
    room.run(3);
    assert!(room.says("not calibrated: hall.ron lacks"));
}

#[test]
fn a_control_that_is_off_says_why_under_the_pointer() {
    let mut room = Room::simulated();
    room.write(home_is_off());
    assert!(!room.says("hall.ron"));
    let home = room.place("Home");
    room.hover(home);
    // The pointer rests for longer than the tooltip delay of egui.
    room.run(60);
    assert!(room.says("not calibrated: hall.ron lacks"));
}

#[test]
fn an_effect_is_tuned_played_and_saved() {
    let mut room = Room::of(true, 1280.0, 900.0);
    assert!(!room.says("Revert"));
    room.window.get_by_label("Effects").click();
    room.run(3);
    room.window.get_by_label("Play").click();
    room.run(3);
    let Ok(PreviewCommand::Feel { effect, tile, .. }) = room.commands.try_recv() else {
        panic!("nothing is played")
    };
    assert_eq!(effect.kind.name(), "Click");
    assert!(tile < 36);
    // A slider at its far end: drawn at once, and played once the hand rests.
    let level = room.window.get_by_label("level_n").rect();
    let end = Pos2::new(level.right() - 70.0, level.center().y);
    room.press(end);
    room.release(end);
    room.run(20);
    let Ok(PreviewCommand::Feel { effect: louder, .. }) = room.commands.try_recv() else {
        panic!("not played by itself")
    };
    assert_ne!(louder, effect);
    assert!(!room.window.get_by_label("Revert").accesskit_node().is_disabled());
    room.window.get_by_label("Name to save as").focus();
    room.run(2);
    room.window.get_by_label("Name to save as").type_text("_2");
    room.run(2);
    room.window.get_by_label("Save as RON").click();
    room.run(3);
    let Ok(PreviewCommand::SaveEffect { name, text }) = room.commands.try_recv() else { panic!("not saved") };
    let (saved, _) = underfoot::schema::parse_effect(&text, "saved.ron", &Default::default()).unwrap();
    assert_eq!((name.as_str(), &saved.effect), ("crisp_click_2", &louder));
    assert_eq!(room.window.unnamed_widgets(), Vec::<String>::new());
    room.window.get_by_label("Effects").click();
    room.run(3);
    assert!(!room.says("Revert"));
}

#[test]
fn sensors_of_a_lost_floor_are_not_called_live() {
    let mut room = Room::simulated();
    let mut snapshot = at_rest(&map());
    snapshot.health.counts = [144, 0, 0, 0];
    snapshot.link = LinkState::Lost;
    room.write(snapshot);
    assert!(room.says("Sensors: none heard") && !room.says("144 live"));
}

#[test]
fn the_link_is_told_in_a_line_and_counted_when_it_is_opened() {
    let mut room = Room::simulated();
    let mut snapshot = pressing(&map());
    (snapshot.counters.lost, snapshot.counters.malformed) = (12, 3);
    room.write(snapshot);
    scroll_to(&mut room, "Link: 12 lost, 3 refused");
    room.window.get_by_label("Link: 12 lost, 3 refused").click();
    room.run(20);
    assert!(room.says("lost packets: 12") && room.says("refused: malformed: 3"));
}

#[test]
fn actuators_show_their_waves_and_the_card_that_plays_them() {
    let mut room = Room::simulated();
    let mut snapshot = pressing(&map());
    let status = DeviceStatus {
        name: "Card".into(),
        state: DeviceState::Lost,
        why: "it was unplugged".into(),
        ..DeviceStatus::default()
    };
    snapshot.device = Some(status);
    room.write(snapshot);
    assert!(room.says("Actuators: Card: ") && room.says("it was unplugged"));
    assert!(room.says("Actuator of tile 0, 4: 0.0 N"), "the tile under the foot");
}

#[test]
fn an_empty_floor_says_so_where_contacts_are_listed() {
    let mut room = Room::simulated();
    room.write(at_rest(&map()));
    assert!(!room.says("Contact 7"));
    room.write(pressing(&map()));
    let (heavy, light) = (room.place_of("Contact 6"), room.place_of("Contact 7"));
    assert!(heavy.x == light.x && heavy.y != light.y, "a line each: {heavy} {light}");
}
