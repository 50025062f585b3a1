//! A frozen pond.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::relief::Recovery;
use super::tile::{Stride, TileEvent};
use super::{Fracture, IceSpec, Onsets, PlaceModes, Relief};
use crate::floor::Rect;
use crate::units::Instant;

/// The state of a frozen pond.
///
/// # Source
/// Paper, section 4.1. Depth, weakness and refreezing are ours.
#[derive(Clone, Debug)]
pub(super) struct Ice {
    spec: IceSpec,
    rng: Pcg64Mcg,
    pub(super) fracture: Fracture,
    pub(super) relief: Relief,
    /// For each tile of the floor: its process and its resonance.
    tiles: Vec<(Onsets, PlaceModes)>,
}

/// Factor of the pitch of ice that is nearly broken through: a plate's pitch is proportional to its thickness.
const THIN_PITCH: f32 = 0.45;

impl Ice {
    pub(super) fn new(spec: IceSpec, area: Rect, seed: u32, tiles: usize) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.into());
        let tiles =
            (0..tiles).map(|_| (Onsets::new(&mut rng), PlaceModes::draw(&spec.ring, &mut rng))).collect();
        let recovery = Recovery { seconds: spec.sheet.refreeze_s, is_ice: true };
        Self {
            spec,
            rng,
            fracture: Fracture::new(spec.cracks, area),
            relief: Relief::new(area, recovery),
            tiles,
        }
    }

    pub(super) fn tread(&mut self, stride: &Stride<'_>, mut give: impl FnMut(TileEvent)) {
        let Self { spec, rng, fracture, relief, tiles } = self;
        let Some((onsets, resonance)) = tiles.get_mut(stride.tile) else { return };
        let kinetic = [stride.before, stride.after].map(|motion| stride.elastic.kinetic_j(&motion));
        if kinetic.iter().all(|kinetic| *kinetic <= f64::from(spec.calm_j)) {
            return;
        }
        let depth = relief.depth_at(stride.place, stride.from);
        let rates = kinetic.map(|kinetic| spec.onsets_per_s(kinetic, depth));
        onsets.advance(rates, stride.elastic.step_s(), rng, |share, rng| {
            let energy_j = spec.energy.quantile(rng.random()) as f32;
            let growth = fracture.grow(stride.place, energy_j, stride.from, rng);
            relief.wear(stride.place, spec.sheet.depth_per_j * energy_j, spec.sheet.reach_m, stride.from);
            let pitch = 1.0 - (1.0 - THIN_PITCH) * depth;
            let click = resonance.strike(&spec.ring, energy_j / spec.energy.most_j, pitch, rng);
            give(TileEvent { share, energy_j, place: stride.place, seed: Some(growth.seed), click });
        });
    }

    /// Closes cracks that are due; returns whether there were any.
    pub(super) fn heal(&mut self, now: Instant) -> bool {
        let before = self.fracture.revision();
        self.fracture.heal(now);
        self.fracture.revision() != before
    }
}
