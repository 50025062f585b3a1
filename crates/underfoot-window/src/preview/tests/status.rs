//! The status bar at the window's lower edge.

use super::*;

fn line(room: &Room) -> Vec<(String, f32)> {
    let parts = room.window.query_all_by_role(egui::accesskit::Role::Status);
    parts.map(|node| (node.accesskit_node().label().unwrap_or_default(), node.rect().left())).collect()
}

#[test]
fn the_line_tells_source_rates_and_losses_and_nothing_in_it_moves() {
    let mut room = Room::of(true, 1280.0, 800.0);
    let mut snapshot = at_rest(&map());
    room.write(snapshot.clone());
    let before = line(&room);
    assert!(room.says("simulated floor"), "{before:?}");
    assert!(before.iter().any(|(text, _)| text == "0 lost, 0 refused"), "{before:?}");
    // 6000 packets and 1000 frames a second, for one second, and then losses.
    for _ in 0..60 {
        snapshot.counters.packets += 100;
        snapshot.counters.frames += 17;
        room.snapshots.write(snapshot.clone());
        room.run(1);
    }
    (snapshot.counters.lost, snapshot.counters.malformed) = (123_456, 7_890);
    room.write(snapshot);
    let after = line(&room);
    assert!(after.iter().any(|(text, _)| text == "123\u{a0}456 lost, 7\u{a0}890 refused"), "{after:?}");
    let rate = after.iter().find_map(|(text, _)| text.strip_suffix(" packets/s")).unwrap();
    let rate: f32 = rate.replace('\u{a0}', "").parse().unwrap();
    assert!((rate - 6000.0).abs() < 200.0, "{rate}");
    let places = |line: &[(String, f32)]| line.iter().map(|(_, left)| *left).collect::<Vec<_>>();
    assert_eq!(places(&before), places(&after));
}

#[test]
fn a_narrow_window_tells_as_much_as_there_is_room_for() {
    let mut wide = Room::of(true, 1280.0, 800.0);
    wide.run(2);
    let mut narrow = Room::of(true, 640.0, 420.0);
    narrow.run(2);
    let (wide, narrow) = (line(&wide), line(&narrow));
    assert!(narrow.len() < wide.len() && narrow.len() > 1, "{narrow:?}");
    assert!(narrow.iter().all(|(_, left)| *left < 640.0 - 40.0));
}
