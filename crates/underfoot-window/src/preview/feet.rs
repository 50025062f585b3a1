//! Feet from input devices: the mouse as a working foot, a standing foot, and the feet of fingers. This module does
//! not use egui, only floor metres and seconds.

use std::f32::consts::{PI, TAU};

use glam::Vec2;

use super::feed::{FootSink, PreviewFoot};
use super::touches::{Fingers, FloorTouch};
use underfoot::units::Newtons;

/// Initial force of a working foot, until the wheel changes it: enough for every built-in control.
const WORKING: Newtons = Newtons(150.0);

/// Force of a foot that carries a person while the other foot works.
const STANDING: Newtons = Newtons(600.0);

/// Minimum and maximum force that the wheel can set.
const FORCES: (f32, f32) = (5.0, 1500.0);

/// Length of a mean adult's shoe.
const LENGTH_M: f32 = 0.28;

/// Roll of a working foot: it presses controls with the ball.
const WORKING_ROLL: f32 = 0.75;

/// Roll of a standing foot: it rests on the whole sole.
const STANDING_ROLL: f32 = 0.40;

/// Input of one frame from mouse, fingers and pens.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct HandInput {
    /// Actions of the mouse since the last frame, in order.
    pub(super) moves: Vec<Move>,
    /// Actions of fingers and pens since the last frame, in order.
    pub(super) touches: Vec<FloorTouch>,
    /// Position of the pointer over the floor, in floor metres; `None` elsewhere.
    pub(super) pointer: Option<Vec2>,
    /// Whether the button is still down.
    pub(super) down: bool,
    /// Notches of the wheel, away from the user positive.
    pub(super) wheel: f32,
    /// Requested turn, counter-clockwise in radians.
    pub(super) turn_rad: f32,
    /// Whether the pointer is on the standing foot's handle.
    pub(super) on_handle: bool,
    /// Drag of the standing foot, in floor metres.
    pub(super) drag: Vec2,
    /// Seconds since the last frame.
    pub(super) elapsed_s: f32,
}

/// One action of the mouse, in floor metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Move {
    /// It moved here.
    To(Vec2),
    /// Its button was pressed here, on the bare floor.
    Press(Vec2),
    /// Its button was released here.
    Release(Vec2),
}

/// The foot of the mouse, the standing foot, and those of fingers.
#[derive(Debug)]
pub(super) struct MouseFeet {
    working: MouseFoot,
    standing: Option<MouseFoot>,
    fingers: Fingers,
    /// Point of action of the working foot's force: under the pointer.
    at: Option<Vec2>,
    /// Whether the button presses it down.
    held: bool,
    /// The feet in their last position.
    all: Vec<PreviewFoot>,
}

/// One foot, with its force while it is down.
#[derive(Debug)]
struct MouseFoot {
    shoe: PreviewFoot,
    wanted: Newtons,
}

impl MouseFoot {
    fn new(position: Vec2, wanted: Newtons, roll: f32, left: bool) -> Self {
        let force = Newtons::ZERO;
        Self {
            shoe: PreviewFoot { position, heading_rad: 0.0, length_m: LENGTH_M, force, roll, left },
            wanted,
        }
    }

    fn press(&mut self, notches: f32) {
        self.wanted = Newtons((self.wanted.0 * 1.12_f32.powf(notches)).clamp(FORCES.0, FORCES.1));
    }

    fn turn(&mut self, turn_rad: f32) {
        // Wrap to half a turn either way, for the read-out.
        self.shoe.heading_rad = (self.shoe.heading_rad + turn_rad + PI).rem_euclid(TAU) - PI;
    }
}

impl MouseFeet {
    pub(super) fn new() -> Self {
        Self {
            working: MouseFoot::new(Vec2::ZERO, WORKING, WORKING_ROLL, false),
            standing: None,
            fingers: Fingers::default(),
            at: None,
            held: false,
            all: Vec::with_capacity(2),
        }
    }

    /// Moves the feet by the input of one frame; the sink turns the paths into steps and slides.
    pub(super) fn step(&mut self, hand: &HandInput, sink: &mut dyn FootSink) {
        match (&mut self.standing, hand.on_handle && !self.held) {
            (Some(standing), true) => {
                standing.press(hand.wheel);
                standing.turn(hand.turn_rad);
            }
            _ => {
                self.working.press(hand.wheel);
                self.working.turn(hand.turn_rad);
            }
        }
        if let Some(standing) = &mut self.standing {
            standing.shoe.position += hand.drag;
            standing.shoe.force = standing.wanted;
        }
        let is_touched = self.fingers.are_down() || !hand.touches.is_empty();
        let usual = PreviewFoot { force: self.working.wanted, ..self.working.shoe };
        let touched = self.fingers.step(&hand.touches, usual, sink);
        // The system reports the first finger as a mouse too.
        let (moves, pointer) = if is_touched { (&[][..], None) } else { (&hand.moves[..], hand.pointer) };
        let mut path = Vec::with_capacity(moves.len() + 1);
        for step in moves {
            match *step {
                Move::To(at) => path.push(self.working_at(at, sink)),
                Move::Press(at) => {
                    self.held = true;
                    path.push(self.working_at(at, sink));
                }
                Move::Release(at) => {
                    path.push(self.working_at(at, sink));
                    self.held = false;
                    path.push(self.working_at(at, sink));
                }
            }
        }
        // A pointer outside the floor, or a button whose release went unreported, lifts the foot where it was.
        self.held &= hand.down && pointer.is_some();
        self.at = pointer;
        match pointer {
            Some(at) => path.push(self.working_at(at, sink)),
            None => path.clear(),
        }
        self.all.clear();
        // Over the handle of the standing foot, the mouse moves that foot.
        self.all.extend((self.at.is_some() && (self.held || !hand.on_handle)).then_some(self.working.shoe));
        self.all.extend(self.standing.as_ref().map(|foot| foot.shoe));
        self.all.extend(touched.iter().filter_map(|path| path.last()).filter(|foot| foot.force.0 > 0.0));
        let mut paths = vec![path, self.standing.iter().map(|foot| foot.shoe).collect()];
        paths.extend(touched);
        sink.lead(hand.elapsed_s, &paths);
    }

    /// The working foot with its centre of pressure at `at`, pressing while the button is down.
    fn working_at(&mut self, at: Vec2, sink: &dyn FootSink) -> PreviewFoot {
        let shoe = &mut self.working.shoe;
        shoe.force = if self.held { self.working.wanted } else { Newtons::ZERO };
        shoe.position = Vec2::ZERO;
        shoe.position = at - sink.centre_of_pressure(shoe);
        *shoe
    }

    /// The feet in their last position; the working one first.
    pub(super) fn shoes(&self) -> &[PreviewFoot] {
        &self.all
    }

    /// The standing foot, if there is one.
    pub(super) fn standing(&self) -> Option<&PreviewFoot> {
        self.standing.as_ref().map(|foot| &foot.shoe)
    }

    /// Places the standing foot with its middle at `position`, or moves it there.
    pub(super) fn stand(&mut self, position: Vec2) {
        match &mut self.standing {
            Some(standing) => standing.shoe.position = position,
            None => {
                let mut foot = MouseFoot::new(position, STANDING, STANDING_ROLL, true);
                foot.shoe.heading_rad = self.working.shoe.heading_rad;
                self.standing = Some(foot);
            }
        }
    }

    /// Removes the standing foot from the floor.
    pub(super) fn lift_standing(&mut self) {
        self.standing = None;
    }

    /// Lifts the working feet, for example when the window loses the focus in mid-press.
    pub(super) fn lift_working(&mut self) {
        self.held = false;
        self.fingers.lift();
    }

    /// Whether the button presses the working foot down.
    pub(super) fn is_pressing(&self) -> bool {
        self.held
    }

    /// The force of the foot under the pointer once it is down, and its heading in radians.
    pub(super) fn wanted(&self, on_handle: bool) -> (Newtons, f32) {
        let foot = self.standing.as_ref().filter(|_| on_handle && !self.held).unwrap_or(&self.working);
        (foot.wanted, foot.shoe.heading_rad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Records the last paths.
    #[derive(Default)]
    struct Given(Vec<Vec<PreviewFoot>>);

    impl FootSink for Given {
        fn lead(&mut self, _over_s: f32, paths: &[Vec<PreviewFoot>]) {
            self.0 = paths.to_vec();
        }
    }

    impl Given {
        fn working(&self) -> PreviewFoot {
            *self.0[0].last().unwrap()
        }

        fn standing(&self) -> PreviewFoot {
            *self.0[1].last().unwrap()
        }
    }

    fn hand(x: f32, y: f32) -> HandInput {
        let at = Vec2::new(x, y);
        HandInput {
            moves: vec![Move::To(at)],
            pointer: Some(at),
            elapsed_s: 1.0 / 60.0,
            ..HandInput::default()
        }
    }

    fn pressing(x: f32, y: f32) -> HandInput {
        HandInput { moves: vec![Move::Press(Vec2::new(x, y))], down: true, ..hand(x, y) }
    }

    fn holding(x: f32, y: f32) -> HandInput {
        HandInput { down: true, ..hand(x, y) }
    }

    #[test]
    fn holding_the_button_presses_and_letting_go_lifts_the_foot() {
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        feet.step(&hand(0.5, 0.6), &mut given);
        assert_eq!(given.working().force, Newtons::ZERO, "a foot in the air follows the mouse");
        feet.step(&pressing(0.5, 0.6), &mut given);
        assert_eq!(given.working().force, WORKING);
        feet.step(
            &HandInput { moves: vec![Move::Release(Vec2::new(0.5, 0.6))], ..hand(0.5, 0.6) },
            &mut given,
        );
        assert_eq!(given.working().force, Newtons::ZERO);
    }

    #[test]
    fn what_happens_within_one_frame_is_told_in_order() {
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        let [a, b, c] = [0.5, 0.6, 0.7].map(|x| Vec2::new(x, 0.6));
        let moves = vec![Move::To(a), Move::Press(a), Move::To(b), Move::Release(b), Move::To(c)];
        feet.step(&HandInput { moves, ..hand(0.7, 0.6) }, &mut given);
        let path: Vec<_> = given.0[0].iter().map(|foot| (acts_at(foot), foot.force.0)).collect();
        let expected = [(a, 0.0), (a, 150.0), (b, 150.0), (b, 150.0), (b, 0.0), (c, 0.0), (c, 0.0)];
        assert_eq!(path.len(), expected.len());
        for (told, expected) in path.iter().zip(expected) {
            assert!(told.0.distance(expected.0) < 1e-5 && told.1 == expected.1, "{path:?}");
        }
    }

    fn acts_at(foot: &PreviewFoot) -> Vec2 {
        Given::default().centre_of_pressure(foot)
    }

    #[test]
    fn the_pressure_is_under_the_pointer_however_the_foot_is_turned() {
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        feet.step(&pressing(0.5, 0.6), &mut given);
        for _ in 0..8 {
            feet.step(&HandInput { turn_rad: 0.9, ..holding(0.52, 0.61) }, &mut given);
            let centre = acts_at(&given.working());
            assert!(centre.distance(Vec2::new(0.52, 0.61)) < 1e-5, "{centre}");
        }
        assert!(given.working().heading_rad.abs() <= PI);
    }

    #[test]
    fn the_wheel_presses_harder_within_what_a_person_can_do() {
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        feet.step(&HandInput { wheel: 1.0, ..pressing(0.5, 0.6) }, &mut given);
        assert!((given.working().force.0 - 168.0).abs() < 0.1);
        for (wheel, limit) in [(90.0, FORCES.1), (-90.0, FORCES.0)] {
            feet.step(&HandInput { wheel, ..holding(0.5, 0.6) }, &mut given);
            assert_eq!(given.working().force.0, limit);
        }
    }

    #[test]
    fn the_standing_foot_stays_where_it_was_left_until_it_is_dragged() {
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        feet.stand(Vec2::new(0.9, 0.3));
        feet.step(&hand(0.2, 1.5), &mut given);
        assert_eq!(given.standing().position, Vec2::new(0.9, 0.3));
        assert_eq!(given.standing().force, STANDING);
        assert!(given.standing().left && !given.working().left, "the other foot works");
        let drag = HandInput { drag: Vec2::new(0.1, 0.0), on_handle: true, ..hand(0.9, 0.3) };
        feet.step(&drag, &mut given);
        assert_eq!(feet.shoes().len(), 1, "the hand holds the standing foot");
        assert!(given.standing().position.distance(Vec2::new(1.0, 0.3)) < 1e-6);
        feet.lift_standing();
        feet.step(&hand(0.2, 1.5), &mut given);
        assert!(given.0[1].is_empty());
        assert!(!given.working().left);
    }

    #[test]
    fn a_pointer_that_leaves_lifts_the_foot_where_it_was() {
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        feet.step(&pressing(0.5, 0.6), &mut given);
        feet.step(&HandInput { pointer: None, down: true, ..HandInput::default() }, &mut given);
        assert!(given.0[0].is_empty() && feet.shoes().is_empty(), "no foot, no ghost of one");
        feet.step(&holding(0.5, 0.6), &mut given);
        assert_eq!(given.working().force, Newtons::ZERO, "it stays lifted when the pointer comes back");
    }
}
