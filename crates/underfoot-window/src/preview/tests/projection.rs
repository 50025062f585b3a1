//! The projection: its controls, its corners, and its file.

use super::*;

#[test]
fn the_projection_shows_controls_only_and_is_closed_by_the_key_that_opened_it() {
    let mut room = Room::simulated();
    room.window.key_press(Key::F11);
    room.run(3);
    assert!(room.says("Projected floor") && room.says("Projected Home"));
    assert!(!room.says("Corner 1"), "feet and stray clicks move nothing");
    room.window.key_press(Key::F11);
    room.run(3);
    assert!(!room.says("Projected floor"));
}

#[test]
fn a_projection_that_nobody_has_adjusted_keeps_the_floors_shape_when_its_window_gets_another_one() {
    let mut room = Room::simulated();
    room.window.get_by_label("Project").click();
    room.run(3);
    // From 4:3, the initial shape of a window, to the 16:10 of another screen.
    for size in [vec2(960.0, 720.0), vec2(1280.0, 800.0)] {
        room.window.set_size(size);
        room.run(3);
        let home = room.window.get_by_label("Projected Home").rect().size();
        assert!((home.x / home.y - 1.0).abs() < 0.01, "a round button is round: {home}");
    }
}

#[test]
fn a_corner_follows_the_mouse_from_where_it_was_pressed_however_seldom_the_window_draws() {
    let mut room = Room::simulated();
    room.window.get_by_label("Project").click();
    room.run(3);
    room.window.key_press(Key::C);
    room.run(3);
    let button = |pos: Pos2, pressed: bool| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    // The approach, the press and half of the drag within one frame; the rest within the next.
    let (first, far) = (room.place("Corner 1"), room.place("Corner 3"));
    let on = first + vec2(5.0, -4.0);
    room.window.event(Event::PointerMoved(far));
    room.run(1);
    room.at_once([Event::PointerMoved(on), button(on, true), Event::PointerMoved(on + vec2(20.0, 10.0))]);
    let moved = room.place("Corner 1") - first;
    assert!((moved - vec2(20.0, 10.0)).length() < 0.5, "{moved}");
    room.at_once([button(on + vec2(40.0, 20.0), false), Event::PointerMoved(far)]);
    room.run(1);
    let moved = room.place("Corner 1") - first;
    assert!((moved - vec2(40.0, 20.0)).length() < 0.5, "{moved}");
    // A whole drag within one frame, and a click that moves nothing.
    let third = room.place("Corner 3");
    let to = third - vec2(30.0, 15.0);
    let touch = [button(room.place("Corner 2"), true), button(room.place("Corner 2"), false)];
    let drag = [button(third, true), Event::PointerMoved(to), button(to, false), Event::PointerMoved(first)];
    let second = room.place("Corner 2");
    room.at_once(touch.into_iter().chain(drag));
    room.run(1);
    assert!((room.place("Corner 3") - to).length() < 0.5);
    assert_eq!(room.place("Corner 2"), second);
    assert!(room.folder.path().join("projection.txt").exists(), "what was let go is kept");
}

#[test]
fn the_projection_is_laid_onto_the_floor_by_its_corners() {
    let mut room = Room::simulated();
    room.window.get_by_label("Project").click();
    room.run(3);
    room.window.key_press(Key::C);
    room.run(3);
    let (first, home) = (room.place("Corner 1"), room.place("Projected Home"));
    room.hover(first);
    room.button(first, PointerButton::Primary, true);
    room.hover(first + vec2(30.0, 20.0));
    room.hover(first + vec2(60.0, 40.0));
    room.button(first + vec2(60.0, 40.0), PointerButton::Primary, false);
    let moved = room.place("Corner 1") - first;
    assert!((moved - vec2(60.0, 40.0)).length() < 2.0, "{moved}");
    assert_ne!(room.place("Projected Home"), home, "the controls go along");
    // By keys: the third corner, by one point and by ten.
    let third = room.place("Corner 3");
    room.window.key_press(Key::Num3);
    room.window.key_press(Key::ArrowLeft);
    room.run(2);
    room.window.key_press_modifiers(Modifiers::SHIFT, Key::ArrowUp);
    room.run(2);
    let moved = room.place("Corner 3") - third;
    assert!((moved - vec2(-1.0, -10.0)).length() < 0.1, "{moved}");
    let apart = |room: &Room| room.place("Projected East").x - room.place("Projected West").x;
    assert!(apart(&room) > 1.0);
    room.window.key_press(Key::M);
    room.run(2);
    assert!(apart(&room) < -1.0, "mirrored");
    room.window.key_press(Key::C);
    room.run(2);
    assert!(!room.says("Corner 1") && room.says("Projected Home"));
    let kept = std::fs::read_to_string(room.folder.path().join("projection.txt")).unwrap();
    assert!(kept.contains("mirrored true"), "{kept}");
}
