//! A person's body: its stance and the reach of its feet.

use std::f32::consts::TAU;

use glam::Vec2;
use thiserror::Error;

use super::footprint::{Print, shoe_size};
use super::footwear::Footwear;
use super::gait::PREFERRED_M_S;
use super::plate::GRAVITY;
use super::track::{Pose, forward};
use underfoot::units::Newtons;

/// Measures of a body and its movement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Person {
    /// Body mass, in kilograms.
    pub mass_kg: f32,
    /// Length of the bare foot, in metres.
    pub foot_length_m: f32,
    /// Walking speed, in metres per second; see [`super::Gait::at_speed`].
    pub speed_m_s: f32,
    /// Sideways distance between the feet while walking, in metres.
    pub step_width_m: f32,
    /// Sideways distance between the feet while standing, in metres.
    pub stand_width_m: f32,
    /// Outward angle of each foot, in radians.
    pub toe_out: f32,
    /// Maximum distance from the standing foot to the other one, centre to centre, in metres.
    pub reach_m: f32,
    /// Footwear. It affects the print only if the person rolls like recorded people
    /// ([`super::Performance::rolling_as_people_do`]).
    pub footwear: Footwear,
}

impl Default for Person {
    /// An adult of 70 kg with 27 cm feet.
    fn default() -> Self {
        Self {
            mass_kg: 70.0,
            foot_length_m: 0.27,
            speed_m_s: PREFERRED_M_S,
            step_width_m: 0.12,
            stand_width_m: 0.16,
            toe_out: 0.1,
            reach_m: 0.85,
            footwear: Footwear::default(),
        }
    }
}

impl Person {
    /// Returns the body's weight.
    #[must_use]
    pub fn weight(&self) -> Newtons {
        Newtons(self.mass_kg * GRAVITY)
    }
}

/// Reason why a person can't make a move.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum MoveError {
    /// The person is not on the floor yet.
    #[error("the person is not on the floor: let it Enter first")]
    NotThere,
    /// The person is on the floor already.
    #[error("the person is on the floor already: let it Leave first")]
    AlreadyThere,
    /// A place, direction or force is NaN or infinite.
    #[error("places, directions and forces must be finite numbers")]
    NotFinite,
    /// The place is out of reach of the foot, given the position of the other one.
    #[error(
        "the foot would have to reach {distance_m:.2} m from the one that stands, further than {reach_m:.2} m: WalkTo somewhere nearer first"
    )]
    OutOfReach {
        /// Distance from the standing foot.
        distance_m: f32,
        /// Maximum reach of the foot.
        reach_m: f32,
    },
    /// The other foot stands on the place.
    #[error("the other foot stands there, {distance_m:.2} m away: WalkTo beside the place first")]
    Occupied {
        /// Distance from the standing foot.
        distance_m: f32,
    },
    /// The force exceeds the body's weight.
    #[error("a person of {weight_n:.0} N cannot press with {force_n:.0} N")]
    TooHeavy {
        /// Requested force, in newtons.
        force_n: f32,
        /// Weight of the person, in newtons.
        weight_n: f32,
    },
}

/// Sign of the sideways direction: index 0 is left, 1 is right.
pub(super) const SIDES: [f32; 2] = [-1.0, 1.0];

/// Roll of a pressing foot: the load is on the ball.
pub(super) const PRESS_ROLL: f32 = 0.6;

/// A stance on both feet.
#[derive(Clone, Copy, Debug)]
pub(super) struct TwoFootStance {
    /// Midpoint between the feet.
    pub(super) middle: Vec2,
    pub(super) facing: f32,
    /// Left foot, right foot.
    pub(super) feet: [Pose; 2],
}

impl TwoFootStance {
    /// The foot, 0 or 1, with the shorter way to `target` without crossing the other one.
    pub(super) fn nearer_foot(&self, target: Vec2) -> usize {
        let to_right = -forward(self.facing).perp();
        usize::from((target - self.middle).dot(to_right) >= 0.0)
    }
}

impl Person {
    /// Pose of one foot for a body centred at `middle`.
    pub(super) fn foot_beside(&self, middle: Vec2, facing: f32, side: usize, width_m: f32) -> Pose {
        let to_right = -forward(facing).perp();
        Pose {
            position: middle + to_right * (0.5 * width_m * SIDES[side]),
            heading: facing - self.toe_out * SIDES[side],
        }
    }

    /// The stance with the feet side by side.
    pub(super) fn standing(&self, middle: Vec2, facing: f32) -> TwoFootStance {
        let feet = [0, 1].map(|side| self.foot_beside(middle, facing, side, self.stand_width_m));
        TwoFootStance { middle, facing, feet }
    }

    /// Pose of the shoe with its ball on `target`.
    pub(super) fn pose_pressing(&self, target: Vec2, heading: f32) -> Pose {
        let print = Print::Shoe { length_m: self.foot_length_m, roll: PRESS_ROLL };
        Pose { position: target - Vec2::from_angle(heading).rotate(print.centre_of_pressure()), heading }
    }

    /// Checks that a foot reaches a pose, and that the pose does not overlap the other foot in `stance`.
    pub(super) fn can_put(&self, pose: Pose, stance: Pose) -> Result<(), MoveError> {
        let distance_m = pose.position.distance(stance.position);
        if distance_m > self.reach_m {
            return Err(MoveError::OutOfReach { distance_m, reach_m: self.reach_m });
        }
        if shoes_overlap(pose, stance, 0.5 * shoe_size(self.foot_length_m)) {
            return Err(MoveError::Occupied { distance_m });
        }
        Ok(())
    }
}

/// True if two shoes of the same half size overlap; each is treated as the ellipse inside its outline.
fn shoes_overlap(one: Pose, other: Pose, half: Vec2) -> bool {
    // Points on the edge of one shoe, in the frame of the other.
    (0..24).any(|step| {
        let edge = Vec2::from_angle(step as f32 * TAU / 24.0) * half;
        let at = one.position + Vec2::from_angle(one.heading).rotate(edge);
        let seen = Vec2::from_angle(-other.heading).rotate(at - other.position);
        (seen / half).length_squared() < 1.0
    })
}
