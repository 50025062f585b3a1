//! Finds the tiles that carry a load.

mod rims;
mod sift;
mod survey;
mod threshold;
mod tile_set;

use self::survey::Survey;
use self::threshold::LoadThresholds;
pub(super) use self::tile_set::TileSet;
use super::centroid::tile::{LoadedTile, PlacedTile, TileReading};
use super::{ForceFrame, Quality};
use crate::floor::{Geometry, PositionMap, TileId};
use crate::units::{Instant, Newtons};

/// Marks a tile without load in the map from tile to list position.
const NONE: u32 = u32::MAX;

/// Number of tiles examined together.
const BLOCK: usize = 16;

/// Force above which a tile counts as loaded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadThreshold {
    /// An empty tile becomes loaded at this force.
    pub on: Newtons,
    /// A loaded tile stays so down to this force; at most `on`.
    pub off: Newtons,
}

impl Default for LoadThreshold {
    /// 6 N on, 4 N off: above four sensors with half a newton of offset each and their noise, far below a tapping toe
    /// (our choice).
    fn default() -> Self {
        Self { on: Newtons(6.0), off: Newtons(4.0) }
    }
}

/// The tiles under load, found again in each frame.
///
/// One pass over the floor adds four numbers per tile and compares the sum; the cost of all later steps grows with
/// the loaded tiles alone.
#[derive(Clone, Debug)]
pub(super) struct LoadedTiles {
    geometry: Geometry,
    thresholds: LoadThresholds,
    /// Tile of each index, and its centre.
    places: Vec<PlacedTile>,
    /// Per tile of the floor; none for the tiles past the end.
    maps: Vec<Option<PositionMap>>,
    survey: Survey,
    /// Position in `list` per tile of the floor, or `NONE`.
    place: Vec<u32>,
    list: Vec<LoadedTile>,
    /// The list of the last frame.
    last: Vec<LoadedTile>,
    /// Position in `last` of each tile of `list`, or `NONE`.
    before: Vec<u32>,
    /// The tiles of the list.
    listed: TileSet,
    /// Tiles beside an unlisted tile with load.
    near_light: TileSet,
    /// Whether no tile needs any state from its past.
    is_settled: bool,
    at: Option<Instant>,
    /// Time since the last frame (s).
    dt: f32,
}

impl LoadedTiles {
    pub(super) fn new(geometry: Geometry, threshold: LoadThreshold) -> Self {
        let tiles = geometry.tile_count();
        Self {
            geometry,
            thresholds: LoadThresholds::new(tiles, threshold),
            places: (0..tiles).map(|index| PlacedTile::of(&geometry, index)).collect(),
            maps: Vec::new(),
            survey: Survey::new(&geometry),
            place: vec![NONE; tiles],
            list: Vec::with_capacity(tiles.min(4096)),
            last: Vec::with_capacity(tiles.min(4096)),
            before: Vec::with_capacity(tiles.min(4096)),
            listed: TileSet::new(&geometry),
            near_light: TileSet::new(&geometry),
            is_settled: true,
            at: None,
            dt: 0.0,
        }
    }

    /// Corrects each tile by its map from the next frame on.
    pub(super) fn set_maps(&mut self, maps: &[Option<PositionMap>]) {
        self.maps = maps.to_vec();
    }

    /// Learns the noise of the tiles from `frames`, as a floor in use does before the first foot; then the floor is as
    /// before its first frame.
    pub(super) fn learn_noise(&mut self, frames: &[ForceFrame]) {
        let mut last = None;
        let mut surveyed = Vec::with_capacity(frames.len());
        for frame in frames {
            self.survey.update(frame, self.thresholds.least());
            let dt = last.replace(frame.at).map_or(0.0, |last| frame.at.since(last).as_secs_f32());
            surveyed.push((dt, self.survey.sums.clone(), frame.forces.as_slice()));
        }
        self.thresholds.learn(surveyed.iter().map(|(dt, sums, forces)| (*dt, sums.as_slice(), *forces)));
    }

    pub(super) fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The loaded tiles in tile-index order.
    pub(super) fn list(&self) -> &[LoadedTile] {
        &self.list
    }

    /// Position of each tile of [`Self::list`] in the list of the last frame; beyond its end for tiles that were not
    /// in it.
    pub(super) fn before(&self) -> &[u32] {
        &self.before
    }

    /// The tiles of [`Self::list`].
    pub(super) fn listed(&self) -> &TileSet {
        &self.listed
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

    /// The reading of the tile at `index`; zero for an index past the last tile.
    pub(super) fn reading(&self, index: usize) -> TileReading {
        let force = Newtons(self.survey.sums.get(index).copied().unwrap_or_default());
        match self.place.get(index).and_then(|&place| self.list.get(place as usize)) {
            Some(loaded) => loaded.reading(&self.geometry),
            None => TileReading { force, centroid: None, quality: Quality::Live },
        }
    }

    /// Processes a frame. Tiles missing in the frame carry no load; surplus tiles are ignored.
    pub(super) fn update(&mut self, frame: &ForceFrame) {
        let is_first = self.at.is_none();
        self.dt = self.at.map_or(0.0, |last| frame.at.since(last).as_secs_f32());
        self.at = Some(frame.at);
        self.survey.update(frame, self.thresholds.least());
        if is_first {
            self.thresholds.begin(&frame.forces);
        }
        self.thresholds.smooth(&self.survey.sums);
        self.reconsider(frame);
        self.sift(frame);
        self.gather(frame);
        let list = self.list.iter().map(|tile| tile.index);
        self.thresholds.visit(&self.survey.sums, &self.place, list, self.dt);
    }
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
        // Without the foot no load remains, whether or not the rim could keep a tile loaded.
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
