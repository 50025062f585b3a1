//! The first steps of a new user: each gets its tick from the floor, and all of them disappear for good.

use super::*;

fn steps(room: &Room) -> Vec<String> {
    let nodes = room.window.query_all_by_label_contains("Step ");
    nodes.filter_map(|node| node.accesskit_node().value()).collect()
}

/// A change of a value by a foot.
fn dragged(at_ms: u64) -> WidgetEvent {
    WidgetEvent { kind: EventKind::Changed(Value::Number(7.25)), ..event(at_ms, "time") }
}

#[test]
fn three_steps_are_ticked_by_what_the_floor_reports_and_do_not_come_back() {
    let mut room = Room::simulated();
    room.write(at_rest(&map()));
    let all = steps(&room);
    assert_eq!(all.len(), 3, "{all:?}");
    assert!(!all.iter().any(|step| step.ends_with("done")), "{all:?}");
    // The mouse alone ticks nothing: this floor reports no press.
    let home = room.place("Home");
    room.press(home);
    room.release(home);
    assert!(!steps(&room).iter().any(|step| step.ends_with("done")));
    room.happen(event(60_000, "home"));
    room.run(3);
    assert!(steps(&room).contains(&"Step 1: Press here, done".to_owned()), "{:?}", steps(&room));
    room.happen(dragged(60_100));
    room.run(3);
    assert!(steps(&room).contains(&"Step 2: Drag this, done".to_owned()));
    room.window.get_by_label("Stance foot").click();
    room.run(3);
    assert!(!steps(&room).iter().any(|step| step.starts_with("Step 3") && step.ends_with("done")));
    let mut snapshot = at_rest(&map());
    let at = map().stances[0].area.centre();
    crate::preview::sample::step_on(&mut snapshot, 3, at, 600.0, Vec2::ZERO);
    room.write(snapshot);
    assert_eq!(steps(&room).iter().filter(|step| step.ends_with("done")).count(), 3);
    room.run(180);
    assert!(steps(&room).is_empty(), "{:?}", steps(&room));
    let kept = std::fs::read_to_string(room.folder.path().join("window")).unwrap();
    assert!(kept.contains("first_steps off"), "{kept}");
}

#[test]
fn help_brings_the_first_steps_back_and_lists_the_keys_of_the_mode() {
    let mut room = Room::simulated();
    room.window.get_by_label("Help").click();
    room.run(3);
    assert!(room.says("softer"), "the keys of Try mode");
    room.window.get_by_label("First steps on the floor").click();
    room.run(3);
    assert!(steps(&room).is_empty());
    room.window.get_by_label("First steps on the floor").click();
    room.run(3);
    assert_eq!(steps(&room).len(), 3);
}

#[test]
fn help_offers_the_set_up_only_where_there_is_one() {
    let mut room = Room::simulated();
    room.window.get_by_label("Help").click();
    room.run(3);
    assert!(room.window.query_by_label("Set up a real floor").is_none(), "as in a browser");

    room.window.state_mut().window.options.set_up = Some(|| "The set-up opens.".into());
    room.run(3);
    room.window.get_by_label("Set up a real floor").click();
    room.run(3);
    assert!(room.says("The set-up opens."), "the message of the program");
    assert!(room.window.query_by_label("Set up a real floor").is_none(), "the menu is closed");
}

#[test]
fn the_steps_cover_no_control_and_appear_only_where_mouse_and_keys_are_feet() {
    for (width, height) in [(1280.0, 800.0), (640.0, 800.0)] {
        let mut room = Room::of(true, width, height);
        room.run(3);
        for step in steps(&room) {
            let card = room.window.get_by_label(&step).rect();
            for widget in map().widgets.iter().filter(|widget| widget.is_on(0)) {
                let control = room.window.get_by_label(&widget.label).rect();
                assert!(!control.intersects(card), "{step} covers {} at {width}", widget.label);
            }
        }
    }
    let mut real = Room::of(false, 1280.0, 800.0);
    real.run(3);
    assert!(steps(&real).is_empty());
}
