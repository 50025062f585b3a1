//! The movement of the pointer between two frames, in the order of its events.
//!
//! A window with slow frames gets the approach, the press and the drag at once. Only the movement between press and
//! release is the drag.

use eframe::egui::{Event, InputState, PointerButton, Pos2, Vec2};

/// The movement of the pointer while `button` was down, in points.
pub(super) fn way_while_down(input: &InputState, button: PointerButton) -> Vec2 {
    let pointer = &input.pointer;
    let begin = pointer.latest_pos().map(|at| at - pointer.delta());
    way(&input.events, begin, pointer.button_down(button), button)
}

/// The position of the last frame's first press of `button`, if any.
pub(super) fn pressed_at(input: &InputState, button: PointerButton) -> Option<Pos2> {
    input.events.iter().find_map(|event| match event {
        Event::PointerButton { pos, button: own, pressed: true, .. } if *own == button => Some(*pos),
        _ => None,
    })
}

/// The movement from `begin`, with the state of the button after the events.
fn way(events: &[Event], begin: Option<Pos2>, is_down_after: bool, button: PointerButton) -> Vec2 {
    let is_own = |own: &PointerButton| *own == button;
    // The first change implies the state before it.
    let first = events.iter().find_map(|event| match event {
        Event::PointerButton { button, pressed, .. } if is_own(button) => Some(!pressed),
        _ => None,
    });
    let mut is_down = first.unwrap_or(is_down_after);
    let (mut at, mut way) = (begin, Vec2::ZERO);
    for event in events {
        let (to, then) = match event {
            Event::PointerMoved(to) => (*to, is_down),
            Event::PointerButton { pos, button, pressed, .. } if is_own(button) => (*pos, *pressed),
            _ => continue,
        };
        if let Some(from) = at.filter(|_| is_down) {
            way += to - from;
        }
        (at, is_down) = (Some(to), then);
    }
    way
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Modifiers, pos2, vec2};

    use super::*;

    fn button(pos: Pos2, pressed: bool) -> Event {
        Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
    }

    fn at(x: f32) -> Pos2 {
        pos2(x, 7.0)
    }

    fn moved(x: f32) -> Event {
        Event::PointerMoved(at(x))
    }

    #[test]
    fn only_the_way_between_press_and_release_counts() {
        let way = |events: &[Event], down| way(events, Some(at(0.0)), down, PointerButton::Primary).x;
        // All within one frame: approach, press, drag, release, departure.
        let all =
            [moved(100.0), button(at(100.0), true), moved(130.0), button(at(135.0), false), moved(500.0)];
        assert_eq!(way(&all, false), 35.0);
        assert_eq!(way(&all[..3], true), 30.0, "it is held on");
        assert_eq!(way(&all[2..], false), 135.0, "it was held before");
        assert_eq!(way(&[moved(40.0)], true), 40.0);
        assert_eq!(way(&[moved(40.0)], false), 0.0);
    }

    #[test]
    fn of_two_drags_in_one_frame_both_count() {
        let events =
            [button(at(0.0), true), button(at(5.0), false), moved(50.0), button(at(50.0), true), moved(60.0)];
        let way = way(&events, Some(at(0.0)), true, PointerButton::Primary);
        assert_eq!(way, vec2(15.0, 0.0));
    }

    #[test]
    fn a_pointer_that_was_nowhere_has_come_no_way() {
        assert_eq!(way(&[moved(40.0)], None, true, PointerButton::Primary), Vec2::ZERO);
    }
}
