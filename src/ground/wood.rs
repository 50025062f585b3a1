//! Planks.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::tile::{Stride, TileEvent};
use super::{PlaceModes, WoodSpec};
use crate::floor::Rect;
use crate::units::Newtons;
use crate::widget::Axis;

/// The state of planks: joints that stick and slip as the load on them changes, up or down.
///
/// A joint sticks to its neighbour until the strain between them exceeds its strength, then slips a part of the way
/// and sticks again. A load that changes faster makes more slips a second: the pitch of the creak rises.
#[derive(Clone, Debug)]
pub(super) struct Wood {
    spec: WoodSpec,
    area: Rect,
    rng: Pcg64Mcg,
    joints: Vec<Joint>,
    planks: Vec<PlaceModes>,
}

/// The joint of one tile's part of a plank.
#[derive(Clone, Copy, Debug)]
struct Joint {
    /// Displacement at which the joint is without strain, in metres.
    rest_m: f64,
    /// Force of the next slip, in newtons.
    strength_n: f64,
}

/// Maximum number of planks with different sounds.
const MOST_PLANKS: usize = 256;

impl Wood {
    pub(super) fn new(spec: WoodSpec, area: Rect, seed: u32, tiles: usize) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.into());
        let across = if spec.along == Axis::East { area.size().y } else { area.size().x };
        let count = ((across / spec.plank_m).ceil() as usize).clamp(1, MOST_PLANKS);
        let planks = (0..count).map(|_| PlaceModes::draw(&spec.ring, &mut rng)).collect();
        let joints =
            (0..tiles).map(|_| Joint { rest_m: 0.0, strength_n: strength(&spec, &mut rng) }).collect();
        Self { spec, area, rng, joints, planks }
    }

    /// Removes the strain of a joint under a load whose landing was not seen.
    pub(super) fn settle(&mut self, tile: usize, displacement_m: f64) {
        if let Some(joint) = self.joints.get_mut(tile) {
            joint.rest_m = displacement_m;
        }
    }

    pub(super) fn tread(&mut self, stride: &Stride<'_>, mut give: impl FnMut(TileEvent)) {
        let Self { spec, area, rng, joints, planks } = self;
        let Some(joint) = joints.get_mut(stride.tile) else { return };
        let stiffness = f64::from(spec.body.stiffness_n_m);
        let (first, last) = (stride.before.x_m, stride.after.x_m);
        let offset = stride.place - area.min;
        let across = if spec.along == Axis::East { offset.y } else { offset.x };
        let plank = ((across / spec.plank_m).max(0.0) as usize).min(planks.len() - 1);
        // At most so many slips a millisecond, for every input.
        for _ in 0..8 {
            let strain = last - joint.rest_m;
            if strain.abs() * stiffness <= joint.strength_n {
                break;
            }
            let bears_m = joint.strength_n / stiffness;
            // Where the straight way from first to last exceeds the strength of the joint.
            let limit = joint.rest_m + bears_m.copysign(strain);
            let share = if last == first { 1.0 } else { ((limit - first) / (last - first)).clamp(0.0, 1.0) };
            let left_m = bears_m * f64::from(1.0 - spec.slip);
            joint.rest_m = limit - left_m.copysign(strain);
            let energy_j = 0.5 * stiffness * (bears_m * bears_m - left_m * left_m);
            // The strongest joint gives the level.
            let most_m = f64::from(spec.stick.0) * f64::from(1.0 + spec.scatter) / stiffness;
            let relative = (energy_j / (0.5 * stiffness * most_m * most_m)).min(1.0) as f32;
            joint.strength_n = strength(spec, rng);
            if let Some(resonance) = planks.get(plank) {
                let click = resonance.strike(&spec.ring, relative, 1.0, rng);
                give(TileEvent { share, energy_j: energy_j as f32, place: stride.place, seed: None, click });
            }
        }
    }
}

fn strength(spec: &WoodSpec, rng: &mut Pcg64Mcg) -> f64 {
    let Newtons(mean) = spec.stick;
    f64::from(mean) * (1.0 + f64::from(spec.scatter) * (2.0 * rng.random::<f64>() - 1.0))
}
