//! The places at which a person stands.

use std::f32::consts::PI;

use glam::Vec2;

use crate::floor::{Geometry, TileId};

/// A place to stand: both feet together, the middle between them on the place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingMark {
    /// The tile of the mark.
    pub tile: TileId,
    /// The place, in floor metres.
    pub at: Vec2,
    /// Direction that the person faces, in radians counter-clockwise from north: 0 or π.
    pub facing: f32,
}

/// Distance of the outer marks from the middle, as a share of the way to the sensor: far enough to change each
/// sensor's share, near enough that the feet stay on the plate. Of four sensors the nearest carries 45 % of the person
/// and the farthest 5 %, of three 60 % and 20 %.
const OUT: f32 = 0.4;

impl StandingMark {
    /// The marks of `tiles` in the order of a walk, `rounds` times: the middle of each tile's sensors, then a mark
    /// towards each of them, once around. The person faces north on one tile and south on the next, and the other way
    /// in the next round, so that a lean of the body is not taken for a difference between sensors; on a single tile,
    /// north first and south later.
    #[must_use]
    pub fn of_tiles(geometry: &Geometry, tiles: &[TileId], rounds: usize) -> Vec<Self> {
        let alone = tiles.len() == 1;
        let known = tiles.iter().filter(|tile| geometry.has(**tile));
        let mut marks = Vec::new();
        for (round, (number, &tile)) in
            (0..rounds).flat_map(|round| known.clone().enumerate().map(move |tile| (round, tile)))
        {
            let places = Self::away(geometry, tile);
            let half = places.len() / 2;
            for (step, away) in places.into_iter().enumerate() {
                let is_later = alone && step > half;
                let is_turned = (number + round + usize::from(is_later)) % 2 == 1;
                let facing = if is_turned { PI } else { 0.0 };
                marks.push(Self { tile, at: geometry.centre(tile) + away, facing });
            }
        }
        marks
    }

    /// Places of a tile's marks, in metres from its centre.
    fn away(geometry: &Geometry, tile: TileId) -> Vec<Vec2> {
        let places = geometry.sensor_places(tile);
        let mut sensors: Vec<Vec2> =
            geometry.sensors(tile).iter().map(|sensor| places.place(*sensor)).collect();
        let middle = sensors.iter().sum::<Vec2>() / sensors.len().max(1) as f32;
        sensors.sort_by(|one, other| (*one - middle).to_angle().total_cmp(&(*other - middle).to_angle()));
        let towards = sensors.into_iter().map(|sensor| middle.lerp(sensor, OUT));
        [middle].into_iter().chain(towards).collect()
    }

    /// The tiles of `geometry` in the order of a walk: row by row, each row back from where the last one ended.
    #[must_use]
    pub fn walk(geometry: &Geometry) -> Vec<TileId> {
        let mut tiles: Vec<TileId> = geometry.tiles().filter(|tile| geometry.has(*tile)).collect();
        let first = geometry.first().row;
        tiles.sort_by_key(|tile| {
            let along =
                if (tile.row - first).is_multiple_of(2) { tile.column } else { u16::MAX - tile.column };
            (tile.row, along)
        });
        tiles
    }
}
