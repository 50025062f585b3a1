//! Which tiles carry something.

mod rims;
mod threshold;

use std::time::Duration;

use multiversion::multiversion;

use self::threshold::Thresholds;
use super::corners::is_possible;
use super::tile::{LoadedTile, NO_WEIGHT, Place, TileReading};
use super::{ForceFrame, Quality};
use crate::floor::{Geometry, PositionMap, TileId};
use crate::units::{Instant, Newtons};

/// Marks a tile without load in the map from tile to list position.
const NONE: u32 = u32::MAX;

/// Marks a block with a loaded tile.
const LOADED: u8 = 1;

/// The bit that tells [`Quality::Stale`] and [`Quality::Faulty`], of which one is estimated, from the better two.
const LOST: u8 = 2;

/// Marks a block with a tile that carries something, but too little to be loaded.
const LIGHT: u8 = 4;

/// From a tile to each of the eight around it, in columns and rows.
pub(super) const AROUND: [(i32, i32); 8] =
    [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];

/// Tiles examined together.
const BLOCK: usize = 16;

/// From which force on a tile counts as loaded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadThreshold {
    /// An empty tile becomes loaded at this force.
    pub on: Newtons,
    /// A loaded tile stays so down to this force; at most `on`.
    pub off: Newtons,
}

impl Default for LoadThreshold {
    /// 6 N on, 4 N off: above four sensors with half a newton of offset each and
    /// their noise, far below a tapping toe (our choice).
    fn default() -> Self {
        Self { on: Newtons(6.0), off: Newtons(4.0) }
    }
}

/// The tiles under load, found anew each frame.
///
/// One pass over the floor adds four numbers per tile and compares the sum;
/// everything after that, here and behind, grows with the loaded tiles alone.
#[derive(Clone, Debug)]
pub(super) struct LoadedTiles {
    geometry: Geometry,
    thresholds: Thresholds,
    /// Which tile each one is, and its centre.
    places: Vec<Place>,
    /// Per tile of the floor; none for the tiles past the end.
    maps: Vec<Option<PositionMap>>,
    sums: Vec<f32>,
    /// Position in `list` per tile of the floor, or `NONE`.
    place: Vec<u32>,
    list: Vec<LoadedTile>,
    /// The list of the last frame.
    last: Vec<LoadedTile>,
    /// Per block of tiles, what there is: [`LOADED`], [`LOST`] where a sensor is, [`LIGHT`].
    blocks: Vec<u8>,
    /// Indices that pass the lower threshold, reused.
    candidates: Vec<u32>,
    at: Option<Instant>,
    /// Since the last frame.
    dt: Duration,
}

impl LoadedTiles {
    pub(super) fn new(geometry: Geometry, threshold: LoadThreshold) -> Self {
        let tiles = geometry.tile_count();
        Self {
            geometry,
            thresholds: Thresholds::new(tiles, threshold),
            places: (0..tiles).map(|index| Place::of(&geometry, index)).collect(),
            maps: Vec::new(),
            sums: vec![0.0; tiles],
            place: vec![NONE; tiles],
            list: Vec::with_capacity(tiles.min(4096)),
            last: Vec::with_capacity(tiles.min(4096)),
            blocks: vec![0; tiles.div_ceil(BLOCK)],
            candidates: Vec::with_capacity(tiles),
            at: None,
            dt: Duration::ZERO,
        }
    }

    /// Corrects each tile by its map from now on.
    pub(super) fn set_maps(&mut self, maps: &[Option<PositionMap>]) {
        self.maps = maps.to_vec();
    }

    pub(super) fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The loaded tiles in tile-index order.
    pub(super) fn list(&self) -> &[LoadedTile] {
        &self.list
    }

    /// Position in [`Self::list`] of the tile at `column`, `row`; `None` off the floor or without load.
    pub(super) fn find(&self, column: i32, row: i32) -> Option<usize> {
        let tile = TileId::new(column.try_into().ok()?, row.try_into().ok()?);
        let place = *self.place.get(self.geometry.index(tile)?)?;
        (place != NONE).then_some(place as usize)
    }

    /// Position in [`Self::list`] of the tile at `index`; `None` past the last tile or without load.
    pub(super) fn position(&self, index: u32) -> Option<u32> {
        self.place.get(index as usize).copied().filter(|&place| place != NONE)
    }

    /// What the tile at `index` feels; nothing for an index past the last tile.
    pub(super) fn reading(&self, index: usize) -> TileReading {
        let force = Newtons(self.sums.get(index).copied().unwrap_or_default());
        match self.place.get(index).and_then(|&place| self.list.get(place as usize)) {
            Some(loaded) => loaded.reading(&self.geometry),
            None => TileReading { force, centroid: None, quality: Quality::Live },
        }
    }

    /// Takes in a frame. Tiles the frame doesn't have carry no load; tiles it has too many are not examined.
    pub(super) fn update(&mut self, frame: &ForceFrame) {
        let is_first = self.at.is_none();
        self.dt = self.at.map_or(Duration::ZERO, |last| frame.at.since(last));
        self.at = Some(frame.at);
        self.candidates.clear();
        let off = self.thresholds.least();
        let missing = frame.forces.len().min(frame.quality.len());
        if let Some(rest) = self.sums.get_mut(missing..) {
            rest.fill(0.0);
        }
        survey(&mut self.sums, &frame.forces, &frame.quality, off, &mut self.blocks);
        if is_first {
            self.thresholds.begin(&frame.forces);
        }
        self.thresholds.smooth(&self.sums);
        let mut is_any_light = false;
        for (block, &worth) in self.blocks.iter().enumerate() {
            is_any_light |= worth & LIGHT != 0;
            let is_noisy = self.thresholds.is_noisy(block);
            if worth & !LIGHT == 0 && !is_noisy {
                continue;
            }
            let from = block * BLOCK;
            let upto = (from + BLOCK).min(missing);
            let sums = self.sums.get(from..upto).unwrap_or_default();
            if worth & LOST == 0 && !is_noisy {
                let loaded = (from as u32..).zip(sums).filter(|(_, sum)| **sum >= off);
                self.candidates.extend(loaded.map(|(index, _)| index));
                continue;
            }
            for (index, sum) in (from..).zip(sums) {
                let is_lost = frame.quality[index].iter().any(|&quality| quality >= Quality::Stale);
                if self.thresholds.deciding(index, *sum) >= off || is_lost {
                    self.candidates.push(index as u32);
                }
            }
        }
        self.sift(frame);
        // Without tiles that carry something and are not listed, as in nearly every frame of a small floor, there is
        // nothing to gather.
        if is_any_light || self.candidates.len() > self.list.len() {
            self.gather(frame);
        }
        let list = self.list.iter().map(|tile| tile.index);
        self.thresholds.visit(&self.sums, &self.place, list, self.dt.as_secs_f32());
    }

    /// From candidates to loaded tiles.
    fn sift(&mut self, frame: &ForceFrame) {
        // Which tiles were loaded in the last frame must be known until the new list stands.
        std::mem::swap(&mut self.list, &mut self.last);
        self.list.clear();
        for &index in &self.candidates {
            let index = index as usize;
            let (forces, quality) = (&frame.forces[index], &frame.quality[index]);
            let before = self.last.get(self.place[index] as usize);
            let dt = self.dt.as_secs_f32();
            let least = self.thresholds.least_of(index, self.sums[index], before.is_some(), dt);
            let map = self.maps.get(index).and_then(Option::as_ref);
            if *quality == [Quality::Live; 4] && before.is_none_or(LoadedTile::is_settled) {
                if is_possible(forces) {
                    self.list.extend(LoadedTile::new(self.places[index], &self.geometry, forces, least, map));
                }
                continue;
            }
            let may_start = frame.may_start.get(index) == Some(&true);
            let (carried, tile) = LoadedTile::of_any_quality(
                self.places[index],
                &self.geometry,
                (*forces, *quality, may_start),
                least,
                map,
                before,
                dt,
            );
            if let Some(carried) = carried {
                // What a lost sensor reads is not a load.
                self.sums[index] = carried;
            }
            self.list.extend(tile);
        }
        for old in &self.last {
            let index = old.index as usize;
            self.place[index] = NONE;
            if self.sums[index] < self.thresholds.least() {
                self.thresholds.note_low(index, self.sums[index]);
            }
        }
        for (position, loaded) in self.list.iter_mut().enumerate() {
            self.place[loaded.index as usize] = position as u32;
            loaded.noise_n = self.thresholds.noise_n(loaded.index as usize);
            loaded.left_n = self.thresholds.left_n(loaded.index as usize, loaded.wrench.force);
        }
    }
}

/// Adds up each tile's forces, and says of each block of tiles whether one carries `off` or more ([`LOADED`]),
/// lacks a sensor ([`LOST`]) or carries less than `off` but more than nothing ([`LIGHT`]).
///
/// Without branches, over plain arrays: compiled for what the processor offers.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw", "x86_64+avx2", "aarch64+neon"))]
fn survey(sums: &mut [f32], forces: &[[f32; 4]], quality: &[[Quality; 4]], off: f32, blocks: &mut [u8]) {
    blocks.fill(0);
    let tiles = sums.chunks_mut(BLOCK).zip(forces.chunks(BLOCK).zip(quality.chunks(BLOCK)));
    for (worth, (sums, (forces, quality))) in blocks.iter_mut().zip(tiles) {
        if let (Ok(sums), Ok(forces), Ok(quality)) = (
            <&mut [f32; BLOCK]>::try_from(&mut *sums),
            <&[[f32; 4]; BLOCK]>::try_from(forces),
            <&[[Quality; 4]; BLOCK]>::try_from(quality),
        ) {
            *worth = survey_block(sums, forces, quality, off);
            continue;
        }
        for (sum, (forces, quality)) in sums.iter_mut().zip(forces.iter().zip(quality)) {
            *worth |= survey_block(std::array::from_mut(sum), &[*forces], &[*quality], off);
        }
    }
}

#[inline(always)]
fn survey_block<const TILES: usize>(
    sums: &mut [f32; TILES],
    forces: &[[f32; 4]; TILES],
    quality: &[[Quality; 4]; TILES],
    off: f32,
) -> u8 {
    for (sum, [sw, se, nw, ne]) in sums.iter_mut().zip(forces) {
        *sum = (sw + se) + (nw + ne);
    }
    let loaded = sums.iter().fold(0, |loaded, sum| loaded | u8::from(*sum >= off));
    let light = sums.iter().fold(0, |light, sum| light | u8::from((*sum > NO_WEIGHT) & (*sum < off)));
    let worst = quality.as_flattened().iter().fold(0, |seen, &quality| seen | quality as u8);
    (loaded * LOADED) | (worst & LOST) | (light * LIGHT)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame_with(geometry: &Geometry, index: usize, forces: [f32; 4]) -> ForceFrame {
        let mut frame = ForceFrame::empty(geometry);
        frame.forces[index] = forces;
        frame
    }

    #[test]
    fn a_tile_needs_more_to_become_loaded_than_to_stay_so() {
        let geometry = Geometry::default();
        let mut tiles = LoadedTiles::new(geometry, LoadThreshold::default());
        for (force, loaded) in [(5.0, 0), (6.5, 1), (5.0, 1), (3.9, 0), (5.0, 0)] {
            tiles.update(&frame_with(&geometry, 8, [force / 4.0; 4]));
            assert_eq!(tiles.list().len(), loaded, "at {force} N");
        }
        assert_eq!(tiles.reading(8).force, Newtons(5.0));
        assert_eq!(tiles.reading(8).centroid, None);
    }

    #[test]
    fn a_dead_sensor_leaves_its_tile_usable_two_do_not() {
        let geometry = Geometry::default();
        let mut tiles = LoadedTiles::new(geometry, LoadThreshold::default());
        let mut frame = frame_with(&geometry, 3, [25.0, 25.0, 25.0, 0.0]);
        frame.quality[3][3] = Quality::Faulty;
        tiles.update(&frame);
        assert_eq!(tiles.reading(3).force, Newtons(100.0));
        assert_eq!(tiles.reading(3).quality, Quality::Degraded);
        frame.forces[7][1] = 400.0;
        frame.quality[7][1] = Quality::Faulty;
        tiles.update(&frame);
        assert_eq!(tiles.reading(7).force, Newtons::ZERO, "a short circuit is no load");
        frame.quality[3][0] = Quality::Stale;
        tiles.update(&frame);
        assert!(tiles.list().is_empty());
    }

    #[test]
    fn a_light_rim_belongs_to_the_foot_and_not_to_its_other_rim() {
        let geometry = Geometry::default();
        let mut tiles = LoadedTiles::new(geometry, LoadThreshold::default());
        // The foot stands in the north-east of its tile (7) and reaches over both edges: 8 N on the tile to the
        // east (8), near their common edge, and 5 N, less than makes a tile count, on the one to the north (13).
        let mut frame = frame_with(&geometry, 7, [40.0, 110.0, 110.0, 240.0]);
        frame.forces[8] = [0.0, 0.0, 7.0, 1.0];
        frame.forces[13] = [1.0, 4.0, 0.0, 0.0];
        tiles.update(&frame);
        let force = |index| tiles.list().iter().find(|tile| tile.index == index).unwrap().wrench.force;
        assert_eq!([force(7), force(8)], [505.0, 8.0]);
        // Without the foot there is nobody else, whether the rim could keep a tile loaded or not.
        frame.forces[7] = [0.0; 4];
        for light in [[1.0, 4.0, 0.0, 0.0], [0.5, 1.5, 0.0, 0.0]] {
            frame.forces[13] = light;
            tiles.update(&frame);
            assert_eq!(tiles.list().len(), 1);
            assert!(tiles.list()[0].wrench.force > 8.0);
        }
    }

    #[test]
    fn a_frame_of_another_size_is_no_accident() {
        let mut tiles = LoadedTiles::new(Geometry::default(), LoadThreshold::default());
        for side in [1, 2, 12] {
            let other = Geometry::of_paper_tiles(side, side).unwrap();
            tiles.update(&frame_with(&other, 0, [50.0; 4]));
            assert_eq!(tiles.list().len(), 1);
        }
        assert_eq!(tiles.find(0, 0), Some(0));
        assert_eq!(tiles.find(-1, 0), None);
        assert_eq!(tiles.find(6, 0), None);
    }
}
