//! The places at which a person stands.

use std::f32::consts::PI;

use glam::Vec2;

use crate::floor::{Corner, Geometry, TileId};

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

/// Distance of the outer marks from the middle of a tile, as a share of the way to the sensors: far enough to change
/// each sensor's share, near enough that the feet stay on the plate and no sensor carries more than half of the
/// person.
const OUT: f32 = 0.4;

impl StandingMark {
    /// Number of marks on each tile: the middle, and one towards each corner.
    pub const PER_TILE: usize = 5;

    /// The marks of `tiles` in the order of a walk, `rounds` times: each tile's middle, then around it. The person
    /// faces north on one tile and south on the next, and the other way in the next round, so that a lean of the body
    /// is not taken for a difference between sensors; on a single tile, north first and south later.
    #[must_use]
    pub fn of_tiles(geometry: &Geometry, tiles: &[TileId], rounds: usize) -> Vec<Self> {
        let alone = tiles.len() == 1;
        let known = tiles.iter().filter(|tile| geometry.has(**tile));
        let mut marks = Vec::with_capacity(Self::PER_TILE * tiles.len() * rounds);
        for (round, (number, &tile)) in
            (0..rounds).flat_map(|round| known.clone().enumerate().map(move |tile| (round, tile)))
        {
            for (step, away) in Self::away(geometry, tile).into_iter().enumerate() {
                let is_later = alone && step > Self::PER_TILE / 2;
                let is_turned = (number + round + usize::from(is_later)) % 2 == 1;
                let facing = if is_turned { PI } else { 0.0 };
                marks.push(Self { tile, at: geometry.centre(tile) + away, facing });
            }
        }
        marks
    }

    /// Places of a tile's marks, in metres from its centre.
    fn away(geometry: &Geometry, tile: TileId) -> [Vec2; Self::PER_TILE] {
        let places = geometry.sensor_places(tile);
        let sensors = geometry.sensors(tile).iter();
        let reach = sensors.map(|&sensor| places.place(sensor).abs()).fold(Vec2::ZERO, Vec2::max);
        let corner = |corner: Corner| corner.direction() * reach * OUT;
        [
            Vec2::ZERO,
            corner(Corner::SouthWest),
            corner(Corner::SouthEast),
            corner(Corner::NorthEast),
            corner(Corner::NorthWest),
        ]
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

    /// Returns the place on the tile in words: `middle`, `south-west` and so on.
    #[must_use]
    pub fn place_name(&self, geometry: &Geometry) -> &'static str {
        let off = self.at - geometry.centre(self.tile);
        match (off.x, off.y) {
            (x, y) if x == 0.0 && y == 0.0 => "middle",
            (x, y) if x < 0.0 && y < 0.0 => "south-west",
            (x, y) if x > 0.0 && y < 0.0 => "south-east",
            (x, _) if x > 0.0 => "north-east",
            _ => "north-west",
        }
    }
}
