//! The state of one ground, of any material.

use super::grains::GrainBed;
use super::ice::Ice;
use super::tile::{Stride, TileEvent};
use super::wood::Wood;
use super::{GroundMaterial, GroundState};
use crate::floor::Rect;
use crate::units::Instant;

/// The state of one ground.
#[derive(Clone, Debug)]
pub(super) enum Bed {
    Ice(Box<Ice>),
    Grains(Box<GrainBed>),
    Wood(Box<Wood>),
}

impl Bed {
    pub(super) fn new(material: &GroundMaterial, area: Rect, seed: u32, tiles: usize) -> Self {
        match material {
            GroundMaterial::Ice(spec) => Self::Ice(Box::new(Ice::new(*spec, area, seed, tiles))),
            GroundMaterial::Grain(spec) => Self::Grains(Box::new(GrainBed::new(*spec, area, seed, tiles))),
            GroundMaterial::Wood(spec) => Self::Wood(Box::new(Wood::new(*spec, area, seed, tiles))),
        }
    }

    /// Adapts a tile to a load whose landing was not seen.
    pub(super) fn settle(&mut self, tile: usize, displacement_m: f64) {
        if let Self::Wood(wood) = self {
            wood.settle(tile, displacement_m);
        }
    }

    /// Steps one tile by one millisecond; passes its events to `give`.
    pub(super) fn tread(&mut self, stride: &Stride<'_>, give: impl FnMut(TileEvent)) {
        match self {
            Self::Ice(ice) => ice.tread(stride, give),
            Self::Grains(grains) => grains.tread(stride, give),
            Self::Wood(wood) => wood.tread(stride, give),
        }
    }

    /// Closes cracks that are due; returns whether there were any.
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

    /// Copies the part that only changes with events into the memory of `state`.
    pub(super) fn show(&self, state: &mut GroundState) {
        state.cracks.clear();
        state.seeds.clear();
        match self {
            Self::Ice(ice) => {
                // The maximum of both, so that no later call allocates.
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
