//! One material at work, whichever it is.

use super::grains::Grains;
use super::ice::Ice;
use super::tile::{Event, Stride};
use super::wood::Wood;
use super::{GroundState, Material};
use crate::floor::Rect;
use crate::units::Instant;

/// One material at work.
#[derive(Clone, Debug)]
pub(super) enum Bed {
    Ice(Box<Ice>),
    Grains(Box<Grains>),
    Wood(Box<Wood>),
}

impl Bed {
    pub(super) fn new(material: &Material, area: Rect, seed: u32, tiles: usize) -> Self {
        match material {
            Material::Ice(spec) => Self::Ice(Box::new(Ice::new(*spec, area, seed, tiles))),
            Material::Grain(spec) => Self::Grains(Box::new(Grains::new(*spec, area, seed, tiles))),
            Material::Wood(spec) => Self::Wood(Box::new(Wood::new(*spec, area, seed, tiles))),
        }
    }

    /// A load is there that nobody saw come.
    pub(super) fn settle(&mut self, tile: usize, displacement_m: f64) {
        if let Self::Wood(wood) = self {
            wood.settle(tile, displacement_m);
        }
    }

    /// One millisecond of one tile; what gives way is told to `give`.
    pub(super) fn tread(&mut self, stride: &Stride<'_>, give: impl FnMut(Event)) {
        match self {
            Self::Ice(ice) => ice.tread(stride, give),
            Self::Grains(grains) => grains.tread(stride, give),
            Self::Wood(wood) => wood.tread(stride, give),
        }
    }

    /// Lets heal what is due; the answer is whether anything was.
    pub(super) fn heal(&mut self, now: Instant) -> bool {
        match self {
            Self::Ice(ice) => ice.heal(now),
            Self::Grains(_) | Self::Wood(_) => false,
        }
    }

    pub(super) fn evicted(&self) -> u64 {
        match self {
            Self::Ice(ice) => ice.fracture.evicted(),
            Self::Grains(_) | Self::Wood(_) => 0,
        }
    }

    /// What only changes with events, into the memory that `state` has.
    pub(super) fn show(&self, state: &mut GroundState) {
        state.cracks.clear();
        state.seeds.clear();
        match self {
            Self::Ice(ice) => {
                // All that there can ever be, so that no later look takes memory.
                let (cracks, seeds) = ice.fracture.most();
                state.cracks.reserve_exact(cracks);
                state.seeds.reserve_exact(seeds);
                state.cracks.extend(ice.fracture.cracks());
                state.cracks.sort_unstable_by_key(|crack| (crack.line, crack.number));
                state.seeds.extend_from_slice(ice.fracture.seeds());
                state.relief.copy(&ice.relief);
            }
            Self::Grains(grains) => state.relief.copy(&grains.relief),
            Self::Wood(_) => {}
        }
    }
}
