//! The projection: its controls, its corners, and its file.

use super::*;

#[test]
fn the_projection_shows_controls_only_and_is_closed_by_the_key_that_opened_it() {
    let mut room = Room::simulated();
    room.window.key_press(Key::F11);
    room.run(3);
    assert!(room.says("Projected floor") && room.says("Projected Home"));
    assert!(room.says("Corner 1"), "the first time begins with the corners");
    room.window.key_press(Key::F11);
    room.run(3);
    assert!(!room.says("Projected floor"));
    room.window.key_press(Key::F11);
    room.run(3);
    assert!(room.says("Projected Home") && !room.says("Corner 1"), "feet and stray clicks move nothing");
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

const SECOND: &str = " of the second projector";

/// A window in which both projectors have their pictures side by side.
fn room_with_two() -> Room {
    let mut room = Room::of(true, 2600.0, 900.0);
    room.window.get_by_label("Project").click();
    room.run(3);
    room.window.key_press(Key::C);
    room.run(3);
    room.window.get_by_label("Projectors").click();
    room.run(3);
    assert!(!room.says(SECOND));
    room.window.get_by_label("Add a second projector").click();
    room.run(4);
    room
}

/// Begins the adjustment of corners in the window that shows one projector.
fn adjusting() -> Room {
    let mut room = Room::simulated();
    room.window.get_by_label("Project").click();
    room.run(3);
    room
}

fn drag(room: &mut Room, corner: &str, by: egui::Vec2) {
    let from = room.place(corner);
    room.hover(from);
    room.button(from, PointerButton::Primary, true);
    room.hover(from + by);
    room.button(from + by, PointerButton::Primary, false);
}

/// The corners that are shown as selected.
fn selected(room: &Room) -> Vec<u8> {
    let is_on = |corner: &u8| {
        let label = format!("Corner {corner}");
        let handle = room.window.get_by_label(&label);
        handle.accesskit_node().toggled() == Some(egui::accesskit::Toggled::True)
    };
    (1..=4).filter(is_on).collect()
}

#[test]
fn two_projectors_show_the_same_controls_by_corners_of_their_own() {
    let mut room = room_with_two();
    let (first, second) = ("Projected Home".to_owned(), format!("Projected Home{SECOND}"));
    let before = (room.place(&first), room.place(&second));
    room.window.get_by_label(&format!("Adjust corners{SECOND}")).click();
    room.run(3);
    assert!(room.says(&format!("Corner 1{SECOND}")));
    assert!(room.window.query_by_label("Corner 1").is_none(), "the first one is not being adjusted");
    for _ in 0..5 {
        room.window.key_press_modifiers(Modifiers::SHIFT, Key::ArrowRight);
        room.run(2);
    }
    assert_eq!(room.place(&first), before.0);
    assert!(room.place(&second).x > before.1.x + 1.0, "{} {}", room.place(&second), before.1);
    let kept = std::fs::read_to_string(room.folder.path().join("projection.txt")).unwrap();
    let (of_first, of_second) = kept.split_once("second on\n").unwrap();
    assert!(!of_first.contains("corner") && of_second.matches("corner").count() == 4, "{kept}");
}

#[test]
fn two_projectors_share_the_light_and_keys_change_that_of_the_one_in_use() {
    let mut room = room_with_two();
    assert!(room.says("Where both shine: 100 %"));
    room.window.get_by_label(&format!("Check page{SECOND}")).click();
    room.run(3);
    room.window.key_press(Key::Plus);
    room.run(3);
    assert!(room.says("Where both shine: 105 %"), "50 % and 55 %");
    let kept = std::fs::read_to_string(room.folder.path().join("projection.txt")).unwrap();
    assert!(kept.contains("brightness 50\nsecond on\nbrightness 55"), "{kept}");
    room.window.get_by_label("Remove the second projector").click();
    room.run(4);
    assert!(!room.says(SECOND) && room.says("Projected Home"));
    let kept = std::fs::read_to_string(room.folder.path().join("projection.txt")).unwrap();
    assert!(kept.contains("brightness 100\nsecond off\n"), "{kept}");
}

/// The brightest component that a projector's picture has.
fn brightest(room: &Room, picture: &str) -> u8 {
    let area = room.window.get_by_label(picture).rect().expand(1.0);
    let shapes = room.window.output().shapes.iter().filter(|shape| area.contains_rect(shape.clip_rect));
    let meshes = shapes.filter_map(|shape| match &shape.shape {
        egui::Shape::Mesh(mesh) => Some(mesh.vertices.iter().map(|vertex| vertex.color)),
        _ => None,
    });
    meshes.flatten().map(|color| color.r().max(color.g()).max(color.b())).max().unwrap_or_default()
}

#[test]
fn the_light_of_both_pictures_adds_up_to_that_of_one() {
    let mut room = room_with_two();
    for page in ["Check page".to_owned(), format!("Check page{SECOND}")] {
        room.window.get_by_label(&page).click();
        room.run(3);
    }
    let light = |room: &Room, picture: &str| (f32::from(brightest(room, picture)) / 255.0).powf(2.2);
    let second = format!("Projected floor{SECOND}");
    let sum = light(&room, "Projected floor") + light(&room, &second);
    assert!((sum - 1.0).abs() < 0.02, "{sum}");
    room.window.get_by_label("Remove the second projector").click();
    room.run(4);
    assert_eq!(brightest(&room, "Projected floor"), 255);
}

#[test]
fn a_key_moves_the_selected_corner_by_one_pixel_of_the_screen_whatever_the_size_of_texts() {
    let mut room = adjusting();
    room.window.set_pixels_per_point(1.5);
    room.run(3);
    // Away from the edge, at which handles stop.
    for _ in 0..3 {
        room.window.key_press_modifiers(Modifiers::SHIFT, Key::ArrowDown);
        room.run(2);
    }
    for (shift, pixels) in [(Modifiers::NONE, 1.0), (Modifiers::SHIFT, 10.0)] {
        let before = room.place("Corner 1");
        room.window.key_press_modifiers(shift, Key::ArrowRight);
        room.run(2);
        room.window.key_press_modifiers(shift, Key::ArrowDown);
        room.run(2);
        let moved = (room.place("Corner 1") - before) * room.window.ctx.pixels_per_point();
        assert!((moved - egui::Vec2::splat(pixels)).length() < 0.05, "{moved} pixels");
    }
}

#[test]
fn tab_and_numbers_choose_the_corner_that_arrows_move() {
    let mut room = adjusting();
    assert_eq!(selected(&room), [1]);
    for (shift, expected) in [(false, 2), (false, 3), (false, 4), (false, 1), (true, 4)] {
        let modifiers = if shift { Modifiers::SHIFT } else { Modifiers::NONE };
        room.window.key_press_modifiers(modifiers, Key::Tab);
        room.run(2);
        assert_eq!(selected(&room), [expected]);
    }
    room.window.key_press(Key::Num2);
    room.run(2);
    let places = |room: &Room| [1, 2, 3, 4].map(|corner| room.place(&format!("Corner {corner}")));
    let before = places(&room);
    room.window.key_press(Key::ArrowUp);
    room.run(2);
    let moved: Vec<bool> = places(&room).iter().zip(before).map(|(now, before)| *now != before).collect();
    assert_eq!(moved, [false, true, false, false]);
}

#[test]
fn the_adjustment_ends_in_the_main_window_once_all_four_corners_are_placed() {
    let mut room = adjusting();
    let beside = egui::pos2(1275.0, 795.0);
    for corner in ["Corner 1", "Corner 2", "Corner 3"] {
        drag(&mut room, corner, vec2(4.0, 3.0));
        room.hover(beside);
        assert!(room.says("Corner 4"), "{corner} is not the last one");
    }
    room.window.key_press(Key::Num4);
    room.window.key_press(Key::ArrowUp);
    room.run(2);
    assert!(room.says("Corner 4"), "it ends in the other window");
    room.hover(beside);
    room.run(1);
    assert!(!room.says("Corner 4") && room.says("Projected Home"));
    // The next adjustment begins anew.
    room.window.key_press(Key::C);
    room.run(2);
    room.hover(beside - vec2(5.0, 5.0));
    assert!(room.says("Corner 4"));
}

#[test]
fn escape_puts_a_dragged_corner_back_and_undo_takes_back_step_by_step() {
    let mut room = adjusting();
    let start = room.place("Corner 1");
    room.hover(start);
    room.button(start, PointerButton::Primary, true);
    room.hover(start + vec2(50.0, 30.0));
    assert!((room.place("Corner 1") - start).length() > 40.0);
    room.window.key_press(Key::Escape);
    room.run(2);
    assert_eq!(room.place("Corner 1"), start);
    room.button(start + vec2(50.0, 30.0), PointerButton::Primary, false);
    assert_eq!((room.place("Corner 1"), selected(&room).len()), (start, 1), "it is still being adjusted");
    // Two drags and some presses of keys are three steps.
    let third = room.place("Corner 3");
    drag(&mut room, "Corner 1", vec2(20.0, 10.0));
    drag(&mut room, "Corner 3", vec2(-15.0, -25.0));
    let dragged = room.place("Corner 3");
    for _ in 0..3 {
        room.window.key_press(Key::ArrowLeft);
        room.run(2);
    }
    let undo = |room: &mut Room| {
        room.window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        room.run(2);
    };
    undo(&mut room);
    assert_eq!(room.place("Corner 3"), dragged);
    undo(&mut room);
    assert_eq!(room.place("Corner 3"), third);
    assert!((room.place("Corner 1") - start - vec2(20.0, 10.0)).length() < 0.5);
    undo(&mut room);
    assert_eq!(room.place("Corner 1"), start);
    room.window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    room.run(2);
    assert!((room.place("Corner 1") - start - vec2(20.0, 10.0)).length() < 0.5, "done again");
}

#[test]
fn the_check_page_takes_the_place_of_the_controls_until_escape() {
    let mut room = adjusting();
    room.window.key_press(Key::C);
    room.run(3);
    assert!(room.says("Projected Home") && !room.says("Projected check page"));
    room.window.key_press(Key::T);
    room.run(3);
    assert!(room.says("Projected check page") && !room.says("Projected Home"));
    // Corners are adjusted over it too.
    room.window.key_press(Key::C);
    room.run(3);
    assert!(room.says("Corner 4") && room.says("Projected check page"));
    for expected in [(false, true, true), (false, false, true), (false, false, false)] {
        room.window.key_press(Key::Escape);
        room.run(3);
        let seen = (room.says("Corner 1"), room.says("Projected check page"), room.says("Projected floor"));
        assert_eq!(seen, expected);
    }
}
