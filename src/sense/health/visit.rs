//! Visits to a share of the floor with each frame: averages over 64 ms, and the faults and offsets that show in them.

use super::averages::SHARES;
use super::creep::AverageGains;
use super::slow::GAP_S;
use super::trouble::Sensor;
use super::{Health, RangeEnd, is_connected};
use crate::floor::{Geometry, TileBlock, TileId};
use crate::sense::ForceFrame;
use crate::sense::centroid::corners;
use crate::units::Instant;

/// The shares of the floor, and the time of the last visit to each.
#[derive(Clone, Debug)]
pub(super) struct FloorShares {
    /// The first tile of each share of the floor, and the end of the last one.
    bounds: [usize; SHARES + 1],
    visited: [Option<Instant>; SHARES],
}

impl FloorShares {
    pub(super) fn new(geometry: &Geometry) -> Self {
        Self { bounds: bounds(geometry), visited: [None; SHARES] }
    }

    /// The tiles of this share.
    pub(super) fn tiles(&self, share: usize) -> std::ops::Range<usize> {
        self.bounds[share]..self.bounds[share + 1]
    }

    /// Notes a visit to this share; returns the time since the last one, at most [`GAP_S`] (s).
    fn visit(&mut self, share: usize, now: Instant) -> f32 {
        let last = self.visited[share].replace(now);
        last.map_or(0.0, |last| now.since(last).as_secs_f32().min(GAP_S))
    }
}

/// The first tile of each share of the floor, and the end of the last one.
///
/// A tile is in the same share for every division of the whole floor, so that each computer with this tile averages
/// it over the same frames.
fn bounds(geometry: &Geometry) -> [usize; SHARES + 1] {
    let (columns, rows) = geometry.whole();
    let (columns, whole) = (usize::from(columns), usize::from(columns) * usize::from(rows));
    let place = |tile: TileId| usize::from(tile.row) * columns + usize::from(tile.column);
    let places: Vec<usize> = geometry.tiles().map(place).collect();
    std::array::from_fn(|share| places.partition_point(|&place| place < whole * share / SHARES))
}

impl Health {
    /// Adds this frame to the averages of every [`SHARES`]th part of the floor in turn.
    pub(super) fn visit_share(&mut self, frame: &ForceFrame, sampled: Instant) {
        let share = self.number as usize % SHARES;
        let dt = self.shares.visit(share, sampled);
        let parts = AverageGains::of(dt);
        self.zeros.ease(dt / SHARES as f32);
        let tiles = self.shares.tiles(share);
        for tile in tiles.clone() {
            self.connected[tile] = is_connected(&frame.quality[tile], &self.sensors[tile]);
        }
        let Self { averages, intake, connected, .. } = self;
        if averages.add(share, tiles.clone(), &frame.forces, &intake.ends, connected) {
            tiles.clone().for_each(|tile| self.finish_block(tile, sampled));
        }
        self.zeros.follow_creep(tiles, &parts, &frame.forces, &self.connected);
    }

    fn finish_block(&mut self, tile: usize, at: Instant) {
        let alone = !self.has_loaded_neighbour(tile);
        let has_laws = self.intake.has_laws(tile) && self.coupled[tile];
        let is_measured = has_laws && !self.is_foreign();
        let Self { zeros, sensors, averages, slow, twist, .. } = self;
        let (slow, sensors) = (&mut slow[tile], &mut sensors[tile]);
        let had_trouble = sensors.map(|sensor| sensor.trouble());
        if let Some(block) = slow.finish(averages.block(tile), at) {
            self.loaded[tile] = block.is_loaded();
            self.first.note(tile, &block.means);
            if is_measured {
                slow.judge(&block, alone, twist.range(), sensors);
            }
            let is_sound = sensors.iter().all(|sensor| sensor.trouble().is_none());
            let has_lifted = block.lows.into_iter().any(corners::has_lifted)
                || block.ends.iter().any(|end| end.reads_nothing());
            if is_sound && has_laws && !has_lifted && !block.ends.contains(&RangeEnd::High) {
                twist.learn(block.means);
            }
            if is_sound && !block.ends.contains(&RangeEnd::High) {
                zeros.learn_creep(tile, &block);
            }
            zeros.follow_drift(tile, &mut slow.drift, &block, alone, sensors);
        } else {
            sensors.iter_mut().for_each(Sensor::interrupt);
        }
        let has_trouble = sensors.map(|sensor| sensor.trouble());
        if had_trouble != has_trouble {
            self.changes += 1;
            let fell_ill =
                had_trouble.iter().zip(has_trouble).filter(|(had, has)| has.is_some() && **had != *has);
            self.found += fell_ill.count() as u64;
            self.queue.watch(tile);
        }
    }

    /// Whether a part of a foot may stand on this tile, by the loads of its neighbours.
    fn has_loaded_neighbour(&self, tile: usize) -> bool {
        let first = self.geometry.tile_at_index(tile);
        let around = TileBlock { first, columns: 1, rows: 1 }.grown(1);
        let others = around.tiles().filter_map(|other| self.geometry.index(other));
        others.filter(|&other| other != tile).any(|other| self.loaded[other])
    }
}
