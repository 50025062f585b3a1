//! Snow, gravel and sand in motion.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::relief::Recovery;
use super::tile::{Stride, TileEvent};
use super::{Grain, GrainSpec, Onsets, PlaceModes, Relief};
use crate::floor::Rect;

/// The state of snow, gravel or sand.
///
/// # Source
/// P. R. Cook, "Physically Informed Sonic Modeling (PhISM)", Computer Music Journal 21(3), 1997: the system's energy
/// decays exponentially and has an external input; grains collide as a Poisson process, each as hard as the system's
/// energy. Here the input is the power that the bed under the foot dissipates, and the rate follows the root of the
/// energy, as speeds do.
#[derive(Clone, Debug)]
pub(super) struct GrainBed {
    spec: GrainSpec,
    rng: Pcg64Mcg,
    pub(super) relief: Relief,
    tiles: Vec<Bed>,
}

/// The grains under one tile.
#[derive(Clone, Debug)]
struct Bed {
    onsets: Onsets,
    /// Energy of the moving grains, in joules.
    energy_j: f64,
    /// The resonances of different stones; each collision uses one of them.
    stones: [PlaceModes; STONES],
}

/// Number of different resonances of the grains of one tile.
const STONES: usize = 4;

/// Below this share of the full energy no motion can be felt.
const STILL: f64 = 1e-4;

impl GrainBed {
    pub(super) fn new(spec: GrainSpec, area: Rect, seed: u32, tiles: usize) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.into());
        let bed = |_| Bed {
            onsets: Onsets::new(&mut rng),
            energy_j: 0.0,
            stones: std::array::from_fn(|_| PlaceModes::draw(&spec.ring, &mut rng)),
        };
        let tiles = (0..tiles).map(bed).collect();
        let recovery = Recovery { seconds: spec.renew_s, is_ice: false };
        Self { spec, rng, relief: Relief::new(area, recovery), tiles }
    }

    pub(super) fn tread(&mut self, stride: &Stride<'_>, mut give: impl FnMut(TileEvent)) {
        let Self { spec, rng, relief, tiles } = self;
        let Some(bed) = tiles.get_mut(stride.tile) else { return };
        let step_s = stride.elastic.step_s();
        let lost = [stride.before, stride.after].map(|motion| stride.elastic.lost_w(&motion));
        let work_j = 0.5 * (lost[0] + lost[1]) * step_s;
        let full = f64::from(spec.full_j);
        let before = bed.energy_j;
        if work_j < 1e-9 && before < STILL * full {
            bed.energy_j = 0.0;
            return;
        }
        let packed = relief.depth_at(stride.place, stride.from);
        let loose = f64::from(1.0 - (1.0 - spec.packed) * packed);
        bed.energy_j = (before + work_j * loose) * (-step_s / f64::from(spec.settle_s)).exp();
        if stride.after.v_m_s > 0.0 && spec.packing_per_j > 0.0 {
            relief.wear(stride.place, spec.packing_per_j * work_j as f32, spec.reach_m, stride.from);
        }
        let rates = [before, bed.energy_j].map(|energy| {
            let share = energy / full;
            if share < STILL { 0.0 } else { f64::from(spec.collisions_per_s) * share.sqrt() }
        });
        let moved = (bed.energy_j / full).min(1.0) as f32;
        let stones = &bed.stones;
        bed.onsets.advance(rates, step_s, rng, |share, rng| {
            let law = spec.energy.quantile(rng.random()) as f32 / spec.energy.most_j;
            let energy = law * moved;
            let stone = &stones[rng.random_range(0..STONES)];
            // Each grain of sand gets a random pitch; stones knock at their own pitch.
            let pitch = if spec.grain == Grain::Sand { rng.random_range(0.8..1.25) } else { 1.0 };
            let click = stone.strike(&spec.ring, energy, pitch, rng);
            give(TileEvent { share, energy_j: energy * spec.full_j, place: stride.place, seed: None, click });
        });
    }
}
