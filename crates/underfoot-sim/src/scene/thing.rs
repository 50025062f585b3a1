//! One object on the floor in a scene: a foot, a knee, a wheel, the tip of a stick.

use glam::Vec2;

use super::body::RandomPerson;
use crate::curve::Curve;
use crate::foot::Load;
use crate::footprint::Print;
use crate::footwear::Footwear;
use crate::rolling::Rolling;
use crate::sway::Sway;
use crate::track::forward;
use underfoot::units::Newtons;

/// Contact area of an object.
#[derive(Clone, Debug)]
pub(super) enum Sole {
    /// A standing or working foot: `roll` is the position of the load between heel and toes.
    Foot { length_m: f32, footwear: Footwear },
    /// A foot in a recorded step: `roll` is the phase of the step.
    Step { length_m: f32, footwear: Footwear, rolling: Box<Rolling> },
    /// Half of the width and length of an object with uniform pressure.
    Round { half_m: Vec2 },
}

/// An object on the floor; it is present while its force is above zero.
#[derive(Clone, Debug)]
pub(super) struct SceneObject {
    pub(super) sole: Sole,
    /// Force in newtons.
    pub(super) force: Curve,
    /// Position of the centre, in floor metres.
    pub(super) x: Curve,
    pub(super) y: Curve,
    /// Heading, in radians counter-clockwise from north.
    pub(super) heading: Curve,
    /// Roll, from the heel (0) to the toes (1), or the phase of a step.
    pub(super) roll: Curve,
    /// The sway, and the object's share of the sideways sway.
    pub(super) sway: Option<(Sway, f32)>,
    end_s: f64,
}

impl SceneObject {
    /// An object at a place, without force yet.
    pub(super) fn at(sole: Sole, at: Vec2, heading: f32) -> Self {
        let still = |value| {
            let mut curve = Curve::default();
            curve.rest(0.0, value);
            curve
        };
        Self {
            sole,
            force: still(0.0),
            x: still(at.x),
            y: still(at.y),
            heading: still(heading),
            roll: still(STAND_ROLL),
            sway: None,
            end_s: 0.0,
        }
    }

    /// A standing foot of a person.
    pub(super) fn foot(body: &RandomPerson, at: Vec2, heading: f32) -> Self {
        let person = body.person();
        let sole = Sole::Foot { length_m: person.foot_length_m, footwear: person.footwear };
        Self::at(sole, at, heading)
    }

    /// One step of a walking person, from `landing_s` on, with the peak `peak_n`.
    pub(super) fn step(
        body: &mut RandomPerson,
        (at, heading): (Vec2, f32),
        side: f32,
        landing_s: f64,
        speed_m_s: f32,
        peak_n: impl FnOnce(&Rolling) -> f32,
    ) -> Self {
        let person = *body.person();
        let rolling = body.habit.step(speed_m_s, person.foot_length_m, side);
        let (peak, contact_s) = (peak_n(&rolling), rolling.contact_s());
        let sole = Sole::Step {
            length_m: person.foot_length_m,
            footwear: person.footwear,
            rolling: Box::new(rolling.clone()),
        };
        let mut thing = Self::at(sole, at, heading);
        let off_s = landing_s + f64::from(contact_s);
        thing.roll.rest(landing_s, 0.0);
        thing.roll.pass(landing_s, 0.0, 1.0 / contact_s);
        thing.roll.pass(off_s, 1.0, 1.0 / contact_s);
        thing.force.rest(landing_s, 0.0);
        for knot in 1..40_u8 {
            let phase = f32::from(knot) / 40.0;
            let slope = (rolling.force(phase + 0.0125) - rolling.force(phase - 0.0125)) / (0.025 * contact_s);
            thing.force.pass(
                landing_s + f64::from(phase * contact_s),
                peak * rolling.force(phase),
                peak * slope,
            );
        }
        thing.force.rest(off_s, 0.0);
        thing.end_s = off_s;
        thing
    }

    /// Changes the force smoothly to `newtons` at `at_s`.
    pub(super) fn presses(&mut self, at_s: f64, newtons: f32) -> &mut Self {
        self.force.rest(at_s, newtons.max(0.0));
        self.end_s = self.end_s.max(at_s);
        self
    }

    /// Moves to a place, which it reaches at `at_s`, from its last resting place.
    pub(super) fn goes(&mut self, at_s: f64, to: Vec2) -> &mut Self {
        self.x.rest(at_s, to.x);
        self.y.rest(at_s, to.y);
        self
    }

    /// Holds position, heading and roll until `at_s`, but not the force.
    pub(super) fn stays(&mut self, at_s: f64) -> &mut Self {
        for curve in [&mut self.x, &mut self.y, &mut self.heading, &mut self.roll] {
            curve.hold(at_s);
        }
        self
    }

    /// Time of the last force value (s).
    pub(super) const fn end_s(&self) -> f64 {
        self.end_s
    }

    /// Returns the load at a moment; `None` while the object is in the air.
    pub(super) fn load(&self, at_s: f64) -> Option<Load> {
        let (mut force, mut roll) = (self.force.at(at_s), self.roll.at(at_s));
        if force <= 0.0 {
            return None;
        }
        if let Some((sway, share)) = &self.sway {
            let (sideways, lengthways) = sway.at(at_s);
            force *= 1.0 + 2.0 * share * sideways;
            roll += lengthways;
        }
        let print = match &self.sole {
            Sole::Foot { length_m, footwear } => {
                let shoe = Print::Shoe { length_m: *length_m, roll: roll.clamp(0.0, 1.0) };
                let variance = shoe.variance();
                let radii = Vec2::new(variance.x.sqrt(), variance.y.sqrt());
                footwear.print(shoe.centre_of_pressure(), radii, *length_m)
            }
            Sole::Step { length_m, footwear, rolling } => {
                let (centre, radii) = rolling.pressure(roll);
                footwear.print(centre, radii, *length_m)
            }
            Sole::Round { half_m } => Print::Ellipse { half_m: *half_m },
        };
        Some(Load {
            print,
            position: Vec2::new(self.x.at(at_s), self.y.at(at_s)),
            heading: self.heading.at(at_s),
            force: Newtons(force),
        })
    }
}

/// Roll of a standing foot: a little more than half of its load is on the heel.
pub(super) const STAND_ROLL: f32 = 0.4;

/// Positions and headings of the feet on both sides of a midpoint, left first.
pub(super) fn pair(middle: Vec2, facing: f32, width_m: f32, turn_out: f32) -> [(Vec2, f32); 2] {
    let right = -forward(facing).perp();
    [-1.0, 1.0].map(|side| (middle + right * (0.5 * width_m * side), facing - turn_out * side))
}
