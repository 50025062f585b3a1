//! Rims of feet on tiles too light to be listed.

use glam::Vec2;

use super::tile_set::bits;
use super::{BLOCK, LoadedTiles};
use crate::sense::centroid::corners::known_corners;
use crate::sense::centroid::tile::{LoadedTile, NO_WEIGHT, Wrench, counted};
use crate::sense::{ForceFrame, Quality};

/// Distance from a foot's centre of pressure up to which it presses a tile that carries little, and the distance over
/// which this becomes uncertain (m): half a shoe (our choice).
const REACH_M: f32 = 0.16;
const REACH_FADE_M: f32 = 0.05;

/// Depth of such a load on its tile (m), and the force above which its own moment is more informative (N).
const RIM_M: f32 = 0.03;
const RIM_N: f32 = 4.0;

/// Minimum ratio of a foot's load on the tile it stands on to its rim's load (our choice).
const FOOT_PER_RIM: f32 = 2.0;

impl LoadedTiles {
    /// Adds the load of tiles too light to be listed to the listed tile to which it most likely belongs.
    ///
    /// The toes of a light foot over a seam press with less than the threshold of a tile, but far enough from the
    /// rest to move the centroid by centimetres.
    pub(super) fn gather(&mut self, frame: &ForceFrame) {
        // Maximum distance of a centroid from its tile's centre at which loads of the far side's neighbours may
        // belong to it.
        let astray_m = REACH_M - 0.5 * self.geometry.pitch_m();
        let faces = |arm: f32, side: i32, astray_m: f32| match side {
            -1 => arm < astray_m,
            1 => arm > -astray_m,
            _ => true,
        };
        self.near_light.surround(&self.survey.light);
        for block in 0..self.listed.block_count() {
            for place in bits(self.listed.blocks()[block] & self.near_light.blocks()[block]) {
                let index = block * BLOCK + place;
                let position = self.place[index] as usize;
                let tile = &self.list[position];
                let arm = tile.centroid - tile.centre;
                for light in self.survey.light.around(index as u32) {
                    let index = light.index as usize;
                    if faces(arm.x, light.east, astray_m.x)
                        && faces(arm.y, light.north, astray_m.y)
                        && self.survey.sums[index] > NO_WEIGHT + self.thresholds.unsure(index)
                    {
                        self.give(index, position, frame);
                    }
                }
            }
        }
    }

    /// Adds the load of the unlisted tile at `index` to the listed one at `position`, unless another one fits better.
    fn give(&mut self, index: usize, position: usize, frame: &ForceFrame) {
        // A tile with a lost sensor is too uncertain for so small a load.
        if frame.quality[index].iter().any(|&quality| quality >= Quality::Stale) {
            return;
        }
        let tile = self.geometry.tile_at_index(index);
        let places = self.geometry.sensor_places(tile);
        let Some((corners, _)) = known_corners(places, frame.forces[index], frame.quality[index]) else {
            return;
        };
        let centre = self.geometry.centre(tile);
        let half = 0.5 * self.geometry.pitch_m();
        let away = |listed: &LoadedTile| ((listed.centroid - centre).abs() - half).max(Vec2::ZERO).length();
        // A rim is the smaller part of a foot; it belongs to another rim only if there is no foot for it.
        let claim = |position: usize| {
            let listed = &self.list[position];
            let (away, is_rim) = (away(listed), listed.wrench.force < FOOT_PER_RIM * self.survey.sums[index]);
            (away >= REACH_M, is_rim, away, position)
        };
        let mine = claim(position);
        let mut others =
            self.listed.around(index as u32).map(|other| self.place[other.index as usize] as usize);
        let beaten = others.any(|other| other != position && claim(other) < mine);
        let share = ((REACH_M - mine.2) / REACH_FADE_M).clamp(0.0, 1.0);
        if beaten || share <= 0.0 {
            return;
        }
        let map = self.maps.get(index).and_then(Option::as_ref);
        let corners = map.map_or(corners, |map| map.trimmed(corners));
        let wrench = Wrench::of_corners(corners, places);
        let force = counted(wrench.force) * share;
        if force > 0.0 {
            // The tile hardly measures the place, but it is the edge of a foot on the listed tile.
            let rim = self.list[position].centroid - centre;
            let rim = rim.clamp(RIM_M - half, half - RIM_M);
            let sure = wrench.force * wrench.force / (wrench.force * wrench.force + RIM_N * RIM_N);
            self.list[position].add_strayed(force, centre + rim.lerp(wrench.arm(half), sure));
        }
    }
}
