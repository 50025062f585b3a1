//! One thing that presses on the floor in a scene: a foot, a knee, a wheel, the tip of a stick.

use glam::Vec2;

use super::body::Body;
use crate::sim::curve::Curve;
use crate::sim::foot::Load;
use crate::sim::footprint::Print;
use crate::sim::footwear::Footwear;
use crate::sim::rolling::Rolling;
use crate::sim::sway::Sway;
use crate::sim::track::forward;
use crate::units::Newtons;

/// What it looks like from below.
#[derive(Clone, Debug)]
pub(super) enum Sole {
    /// A foot that stands or works: its roll says how.
    Foot { length_m: f32, footwear: Footwear },
    /// A foot in a step of its own: its roll is the phase of it.
    Step { length_m: f32, footwear: Footwear, rolling: Box<Rolling> },
    /// Half of the width and length of something that presses evenly.
    Round { half_m: Vec2 },
}

/// Something that presses; it is there as long as its force says.
#[derive(Clone, Debug)]
pub(super) struct Thing {
    pub(super) sole: Sole,
    /// In newtons.
    pub(super) force: Curve,
    /// The middle of it, in floor metres.
    pub(super) x: Curve,
    pub(super) y: Curve,
    /// Radians counter-clockwise from north.
    pub(super) heading: Curve,
    /// Heel (0) to toes (1).
    pub(super) roll: Curve,
    /// How it sways, and which share of the sideways sway it gets.
    pub(super) sway: Option<(Sway, f32)>,
    end_s: f64,
}

impl Thing {
    /// Something at a place, without force yet.
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

    /// A foot of somebody, standing.
    pub(super) fn foot(body: &Body, at: Vec2, heading: f32) -> Self {
        let person = body.person();
        let sole = Sole::Foot { length_m: person.foot_length_m, footwear: person.footwear };
        Self::at(sole, at, heading)
    }

    /// One step of somebody who walks, from `landing_s` on, with the peak `peak_n`.
    pub(super) fn step(
        body: &mut Body,
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

    /// Presses with `newtons` from `at_s` on, reached evenly from what it was.
    pub(super) fn presses(&mut self, at_s: f64, newtons: f32) -> &mut Self {
        self.force.rest(at_s, newtons.max(0.0));
        self.end_s = self.end_s.max(at_s);
        self
    }

    /// Moves there until `at_s`, from where it was when it last came to rest.
    pub(super) fn goes(&mut self, at_s: f64, to: Vec2) -> &mut Self {
        self.x.rest(at_s, to.x);
        self.y.rest(at_s, to.y);
        self
    }

    /// Stays where it is until `at_s`, in every respect but its force.
    pub(super) fn stays(&mut self, at_s: f64) -> &mut Self {
        for curve in [&mut self.x, &mut self.y, &mut self.heading, &mut self.roll] {
            curve.hold(at_s);
        }
        self
    }

    /// When it has last pressed.
    pub(super) const fn end_s(&self) -> f64 {
        self.end_s
    }

    /// The load at a moment; `None` while it is in the air.
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

/// Roll of a foot that stands, a little more than half of its load on the heel.
pub(super) const STAND_ROLL: f32 = 0.4;

/// Where the feet stand on both sides of a middle, left first: place and heading.
pub(super) fn pair(middle: Vec2, facing: f32, width_m: f32, turn_out: f32) -> [(Vec2, f32); 2] {
    let right = -forward(facing).perp();
    [-1.0, 1.0].map(|side| (middle + right * (0.5 * width_m * side), facing - turn_out * side))
}
