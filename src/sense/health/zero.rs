//! The offset of each sensor beyond its tare: drift of its zero, and creep.

use std::ops::Range;

use super::creep::{AverageGains, Creep, LoadAverages};
use super::drift::{Drift, LIMIT};
use super::slow::Block;
use super::trouble::Sensor;
use crate::floor::{Calibration, Floor};

/// The offsets of all sensors beyond their tares, four to a tile (N).
#[derive(Clone, Debug)]
pub(super) struct Zeros {
    /// Offset of each sensor without load, as tracked so far.
    drifted: Vec<[f32; 4]>,
    /// Maximum tracked offset of each: 20 % of the sensor's range.
    limits: Vec<[f32; 4]>,
    /// Additional offset of each due to creep.
    crept: Vec<[f32; 4]>,
    /// Sum of both.
    offsets: Vec<[f32; 4]>,
    memories: Vec<LoadAverages>,
    creep: Creep,
}

impl Zeros {
    /// The sensors of `floor`, as they were at its tare.
    pub(super) fn new(floor: &Floor) -> Self {
        let tiles = floor.geometry.tile_count();
        let limits = |tile: usize| match floor.calibration.get(tile) {
            Some(laws) => laws.map(|law| LIMIT * law.force(u16::MAX).0),
            None => [LIMIT * Calibration::NOMINAL.force(u16::MAX).0; 4],
        };
        Self {
            drifted: vec![[0.0; 4]; tiles],
            limits: (0..tiles).map(limits).collect(),
            crept: vec![[0.0; 4]; tiles],
            offsets: vec![[0.0; 4]; tiles],
            memories: vec![LoadAverages::default(); tiles],
            creep: Creep::default(),
        }
    }

    /// The offset of each sensor.
    pub(super) fn offsets(&self) -> &[[f32; 4]] {
        &self.offsets
    }

    /// The part of each offset that is drift.
    pub(super) fn drifted(&self) -> &[[f32; 4]] {
        &self.drifted
    }

    /// Creep of the sensors, as a share of their load for each decade.
    pub(super) const fn creep(&self) -> f32 {
        self.creep.share()
    }

    /// Moves the correction of creep towards its estimate over `dt` seconds.
    pub(super) fn ease(&mut self, dt: f32) {
        self.creep.ease(dt);
    }

    /// Updates the estimate of creep with the readings of `tile` in a block.
    pub(super) fn learn_creep(&mut self, tile: usize, block: &Block) {
        let reads: f32 = block.means.iter().chain(&self.crept[tile]).sum();
        self.creep.learn(&mut self.memories[tile], reads, block.seconds);
    }

    /// Moves the zeros of `tile` if it is empty and quiet; see [`Drift::follow`].
    pub(super) fn follow_drift(
        &mut self,
        tile: usize,
        drift: &mut Drift,
        block: &Block,
        alone: bool,
        sensors: &mut [Sensor; 4],
    ) {
        drift.follow(block, alone, &self.limits[tile], &mut self.drifted[tile], sensors);
    }

    /// Updates the offsets of `tiles` with the floor's `forces` over the time of these `parts`.
    pub(super) fn follow_creep(
        &mut self,
        tiles: Range<usize>,
        parts: &AverageGains,
        forces: &[[f32; 4]],
        connected: &[bool],
    ) {
        self.creep.follow(
            parts,
            &forces[tiles.clone()],
            &connected[tiles.clone()],
            &mut self.memories[tiles.clone()],
            &mut self.crept[tiles.clone()],
        );
        let (drifted, crept) = (&self.drifted[tiles.clone()], &self.crept[tiles.clone()]);
        let both = drifted.as_flattened().iter().zip(crept.as_flattened());
        let offsets = self.offsets[tiles].as_flattened_mut();
        offsets.iter_mut().zip(both).for_each(|(offset, (drifted, crept))| *offset = drifted + crept);
    }
}
