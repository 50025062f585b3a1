//! The mouse as a foot, and the foot that stands: no egui here, only floor metres and seconds.

use std::f32::consts::{PI, TAU};

use glam::Vec2;

use super::feed::{FootSink, PreviewFoot};
use crate::units::Newtons;

/// What a foot that works presses with, until the wheel says otherwise: enough for every built-in control.
const WORKING: Newtons = Newtons(150.0);

/// What a foot presses with that a person stands on, the other one working.
const STANDING: Newtons = Newtons(600.0);

/// The least and the most the wheel can ask for.
const FORCES: (f32, f32) = (5.0, 1500.0);

/// A mean adult's shoe.
const LENGTH_M: f32 = 0.28;

/// A foot that works a control does it with its ball.
const WORKING_ROLL: f32 = 0.75;

/// A foot that stands rests on all of its sole.
const STANDING_ROLL: f32 = 0.40;

/// Time in which a force comes within a third of what it shall be: a brisk step, not a stamp.
const RAMP_S: f32 = 0.030;

/// The shortest press: a click on the mouse is over before a foot has come down.
const SHORTEST_S: f32 = 0.150;

/// Force below which a lifted foot is in the air.
const IN_THE_AIR: f32 = 1.0;

/// What the person at the mouse does, from one frame to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Hand {
    /// Where the pointer is over the floor, in floor metres; `None` if it is elsewhere.
    pub(super) pointer: Option<Vec2>,
    /// Whether a press began on the bare floor.
    pub(super) pressed: bool,
    /// Whether the button is still down.
    pub(super) down: bool,
    /// Notches of the wheel, away from the user positive.
    pub(super) wheel: f32,
    /// Turn asked for, counter-clockwise in radians.
    pub(super) turn_rad: f32,
    /// Whether the pointer is on the standing foot's handle.
    pub(super) on_handle: bool,
    /// How far the standing foot is dragged, in floor metres.
    pub(super) drag: Vec2,
    /// Seconds since the last frame.
    pub(super) elapsed_s: f32,
}

/// The mouse's foot and the standing one.
#[derive(Debug)]
pub(super) struct MouseFeet {
    working: MouseFoot,
    standing: Option<MouseFoot>,
    /// Where the working foot's force acts: under the pointer.
    at: Option<Vec2>,
    /// Whether the button holds it down.
    held: bool,
    /// How long it has been down.
    down_s: f32,
    /// Scratch for the sink.
    all: Vec<PreviewFoot>,
}

/// One foot, with the force it is going to.
#[derive(Debug)]
struct MouseFoot {
    shoe: PreviewFoot,
    /// What it presses with once it is down.
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
        // Kept within half a turn either way, for the read-out.
        self.shoe.heading_rad = (self.shoe.heading_rad + turn_rad + PI).rem_euclid(TAU) - PI;
    }

    fn approach(&mut self, force: f32, elapsed_s: f32) {
        let share = 1.0 - (-elapsed_s / RAMP_S).exp();
        let now = self.shoe.force.0 + (force - self.shoe.force.0) * share;
        self.shoe.force = if force == 0.0 && now < IN_THE_AIR { Newtons::ZERO } else { Newtons(now) };
    }
}

impl MouseFeet {
    pub(super) fn new() -> Self {
        Self {
            working: MouseFoot::new(Vec2::ZERO, WORKING, WORKING_ROLL, false),
            standing: None,
            at: None,
            held: false,
            down_s: 0.0,
            all: Vec::with_capacity(2),
        }
    }

    /// Moves the feet by what the hand does and hands them to the sink.
    pub(super) fn step(&mut self, hand: &Hand, sink: &mut dyn FootSink) {
        let working_down = self.held || self.working.shoe.force > Newtons::ZERO;
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
            standing.approach(standing.wanted.0, hand.elapsed_s);
        }
        if hand.pressed && hand.pointer.is_some() {
            (self.held, self.down_s) = (true, 0.0);
        }
        self.down_s += hand.elapsed_s;
        // A pointer that is gone lifts the foot where it was.
        if self.held && ((!hand.down && self.down_s >= SHORTEST_S) || hand.pointer.is_none()) {
            self.held = false;
        }
        self.at = match hand.pointer {
            Some(pointer) => Some(pointer),
            None if working_down => self.at,
            None => None,
        };
        self.working.approach(if self.held { self.working.wanted.0 } else { 0.0 }, hand.elapsed_s);
        if let Some(at) = self.at {
            self.working.shoe.position = Vec2::ZERO;
            self.working.shoe.position = at - sink.centre_of_pressure(&self.working.shoe);
        }
        self.all.clear();
        self.all.extend(self.standing.as_ref().map(|foot| foot.shoe));
        // Over the standing foot's handle the hand holds that foot.
        self.all.extend(
            (self.at.is_some() && (working_down || self.held || !hand.on_handle))
                .then_some(self.working.shoe),
        );
        sink.set(&self.all);
    }

    /// The feet as last handed to the sink.
    pub(super) fn shoes(&self) -> &[PreviewFoot] {
        &self.all
    }

    /// The standing foot, if there is one.
    pub(super) fn standing(&self) -> Option<&PreviewFoot> {
        self.standing.as_ref().map(|foot| &foot.shoe)
    }

    /// Stands a foot with its middle at `position`, in place of one that stood elsewhere.
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

    /// Takes the standing foot off the floor.
    pub(super) fn lift_standing(&mut self) {
        self.standing = None;
    }

    /// Lifts the working foot, as when the window loses the keyboard in mid-press.
    pub(super) fn lift_working(&mut self) {
        self.held = false;
    }

    /// Whether the button holds the working foot down.
    pub(super) fn is_pressing(&self) -> bool {
        self.held
    }

    /// What the foot under the hand presses with once it is down, and where its toes point.
    pub(super) fn wanted(&self, on_handle: bool) -> (Newtons, f32) {
        let foot = self.standing.as_ref().filter(|_| on_handle && !self.held).unwrap_or(&self.working);
        (foot.wanted, foot.shoe.heading_rad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keeps what it was given.
    #[derive(Default)]
    struct Given(Vec<PreviewFoot>);

    impl FootSink for Given {
        fn set(&mut self, feet: &[PreviewFoot]) {
            self.0 = feet.to_vec();
        }
    }

    const PICTURE_S: f32 = 1.0 / 60.0;

    fn hand(x: f32, y: f32) -> Hand {
        Hand { pointer: Some(Vec2::new(x, y)), elapsed_s: PICTURE_S, ..Hand::default() }
    }

    fn pressing(x: f32, y: f32) -> Hand {
        Hand { pressed: true, down: true, ..hand(x, y) }
    }

    fn holding(x: f32, y: f32) -> Hand {
        Hand { down: true, ..hand(x, y) }
    }

    fn run(feet: &mut MouseFeet, given: &mut Given, hand: Hand, frames: usize) {
        for _ in 0..frames {
            feet.step(&hand, given);
        }
    }

    #[test]
    fn holding_the_button_brings_the_force_up_and_letting_go_lifts_the_foot() {
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        feet.step(&hand(0.5, 0.6), &mut given);
        assert_eq!(given.0[0].force, Newtons::ZERO, "a foot in the air follows the mouse");
        feet.step(&pressing(0.5, 0.6), &mut given);
        let first = given.0[0].force.0;
        assert!((20.0..130.0).contains(&first), "it ramps: {first}");
        run(&mut feet, &mut given, holding(0.5, 0.6), 15);
        assert!((given.0[0].force.0 - WORKING.0).abs() < 1.0);
        run(&mut feet, &mut given, hand(0.5, 0.6), 20);
        assert_eq!(given.0[0].force, Newtons::ZERO);
    }

    #[test]
    fn the_pressure_is_under_the_pointer_however_the_foot_is_turned() {
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        feet.step(&pressing(0.5, 0.6), &mut given);
        for _ in 0..8 {
            feet.step(&Hand { turn_rad: 0.9, ..holding(0.52, 0.61) }, &mut given);
            let centre = given.centre_of_pressure(&given.0[0]);
            assert!(centre.distance(Vec2::new(0.52, 0.61)) < 1e-5, "{centre}");
        }
        assert!(given.0[0].heading_rad.abs() <= PI);
    }

    #[test]
    fn a_click_is_a_whole_step() {
        // Pressed and released between two frames.
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        feet.step(&Hand { down: false, ..pressing(0.5, 0.6) }, &mut given);
        let mut most = 0.0_f32;
        for _ in 0..40 {
            feet.step(&hand(0.5, 0.6), &mut given);
            most = most.max(given.0[0].force.0);
        }
        assert!(most > 0.9 * WORKING.0, "{most}");
        assert_eq!(given.0[0].force, Newtons::ZERO);
    }

    #[test]
    fn the_wheel_presses_harder_within_what_a_person_can_do() {
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        feet.step(&Hand { wheel: 1.0, ..pressing(0.5, 0.6) }, &mut given);
        run(&mut feet, &mut given, holding(0.5, 0.6), 20);
        assert!((given.0[0].force.0 - 168.0).abs() < 1.0, "{}", given.0[0].force.0);
        run(&mut feet, &mut given, Hand { wheel: 5.0, ..holding(0.5, 0.6) }, 20);
        assert!(given.0[0].force.0 <= FORCES.1);
        run(&mut feet, &mut given, Hand { wheel: -9.0, ..holding(0.5, 0.6) }, 40);
        assert!((given.0[0].force.0 - FORCES.0).abs() < 0.1);
    }

    #[test]
    fn the_standing_foot_stays_where_it_was_left_until_it_is_dragged() {
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        feet.stand(Vec2::new(0.9, 0.3));
        run(&mut feet, &mut given, hand(0.2, 1.5), 30);
        assert_eq!(given.0[0].position, Vec2::new(0.9, 0.3));
        assert!((given.0[0].force.0 - STANDING.0).abs() < 1.0);
        assert!(given.0[0].left && !given.0[1].left, "the other foot works");
        let drag = Hand { drag: Vec2::new(0.1, 0.0), on_handle: true, ..hand(0.9, 0.3) };
        feet.step(&drag, &mut given);
        assert_eq!(given.0.len(), 1, "the hand holds the standing foot");
        assert!(given.0[0].position.distance(Vec2::new(1.0, 0.3)) < 1e-6);
        feet.lift_standing();
        feet.step(&hand(0.2, 1.5), &mut given);
        assert_eq!(given.0.len(), 1);
        assert!(!given.0[0].left);
    }

    #[test]
    fn a_pointer_that_leaves_lifts_the_foot_where_it_was() {
        let (mut feet, mut given) = (MouseFeet::new(), Given::default());
        run(&mut feet, &mut given, pressing(0.5, 0.6), 20);
        let stood = given.0[0].position;
        let gone = Hand { pointer: None, down: true, elapsed_s: PICTURE_S, ..Hand::default() };
        feet.step(&gone, &mut given);
        assert_eq!(given.0[0].position, stood);
        run(&mut feet, &mut given, gone, 30);
        assert!(given.0.is_empty(), "no foot, no ghost of one");
    }
}
