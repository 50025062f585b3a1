//! Rims of feet on tiles too light to be listed.

use glam::Vec2;

use super::{AROUND, LoadedTiles, NONE};
use crate::sense::corners::known_corners;
use crate::sense::tile::{LoadedTile, NO_WEIGHT, Wrench, counted};
use crate::sense::{ForceFrame, Quality};

/// How far from its centre of pressure a foot presses on a tile that hardly feels it, and over which
/// distance this grows uncertain, in metres: half a shoe (our choice).
const REACH_M: f32 = 0.16;
const REACH_FADE_M: f32 = 0.05;

/// How deep such a load lies on its tile, in metres, and the force from which on its own moment says more.
const RIM_M: f32 = 0.03;
const RIM_N: f32 = 4.0;

/// How many times as much as its rim a foot carries at least on the tile it stands on (our choice).
const FOOT_PER_RIM: f32 = 2.0;

impl LoadedTiles {
    /// Counts what lies on tiles too light to be listed to the listed tile it most likely belongs to.
    ///
    /// The toes of a light foot over a seam press with less than what makes a tile count as loaded,
    /// but far enough from the rest to move the centroid by centimetres.
    pub(super) fn gather(&mut self, frame: &ForceFrame) {
        // How far from its tile's centre a centroid may lie for load on the far side's neighbours to be its own.
        let astray_m = REACH_M - 0.5 * self.geometry.pitch_m();
        let first = self.geometry.first();
        let (columns, rows) = (i32::from(self.geometry.columns()), i32::from(self.geometry.rows()));
        for position in 0..self.list.len() {
            let tile = &self.list[position];
            // Counted from the floor's first tile.
            let (column, row) = (tile.tile.column - first.column, tile.tile.row - first.row);
            let (column, row) = (i32::from(column), i32::from(row));
            let arm = tile.centroid - tile.centre;
            let sides = |arm: f32, at: i32, count: i32| {
                let low = at - i32::from(arm < astray_m);
                let high = at + i32::from(arm > -astray_m);
                low.max(0)..(high + 1).min(count)
            };
            let (around, along) = (sides(arm.y, row, rows), sides(arm.x, column, columns));
            for row in around {
                for column in along.clone() {
                    let index = (row * columns + column) as usize;
                    if self.place[index] == NONE
                        && self.sums[index] > NO_WEIGHT + self.thresholds.unsure(index)
                    {
                        self.give(index, position, frame);
                    }
                }
            }
        }
    }

    /// Gives the load of the unlisted tile at `index` to the listed one at `position`, if no other has a better claim.
    fn give(&mut self, index: usize, position: usize, frame: &ForceFrame) {
        // One with a sensor out is too uncertain to say anything of so little.
        if frame.quality[index].iter().any(|&quality| quality >= Quality::Stale) {
            return;
        }
        let Some((corners, _)) = known_corners(frame.forces[index], frame.quality[index]) else { return };
        let stray = self.geometry.tile_at_index(index);
        let (column, row) = (i32::from(stray.column), i32::from(stray.row));
        let centre = self.geometry.centre(stray);
        let half = 0.5 * self.geometry.pitch_m();
        let away = |listed: &LoadedTile| ((listed.centroid - centre).abs() - half).max(Vec2::ZERO).length();
        // A rim is the smaller part of a foot, and another rim's only if there is no foot that it can be of.
        let claim = |position: usize| {
            let listed = &self.list[position];
            let (away, is_rim) = (away(listed), listed.wrench.force < FOOT_PER_RIM * self.sums[index]);
            (away >= REACH_M, is_rim, away, position)
        };
        let mine = claim(position);
        let beaten = AROUND.iter().any(|(east, north)| {
            let other = self.find(column + east, row + north).filter(|&other| other != position);
            other.is_some_and(|other| claim(other) < mine)
        });
        let share = ((REACH_M - mine.2) / REACH_FADE_M).clamp(0.0, 1.0);
        if beaten || share <= 0.0 {
            return;
        }
        let map = self.maps.get(index).and_then(Option::as_ref);
        let corners = map.map_or(corners, |map| map.trimmed(corners));
        let wrench = Wrench::of_corners(corners, self.geometry.sensor_reach_m());
        let force = counted(wrench.force) * share;
        if force > 0.0 {
            // Where it acts is hardly felt, but it is the edge of a foot that stands over there.
            let rim = self.list[position].centroid - centre;
            let rim = rim.clamp(Vec2::splat(RIM_M - half), Vec2::splat(half - RIM_M));
            let sure = wrench.force * wrench.force / (wrench.force * wrench.force + RIM_N * RIM_N);
            self.list[position].add_strayed(force, centre + rim.lerp(wrench.arm(half), sure));
        }
    }
}
