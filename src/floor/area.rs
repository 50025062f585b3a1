//! Areas of a floor that is too large for one computer.

use std::net::SocketAddr;

use glam::Vec2;

use super::{Actuator, Board, Floor, Geometry, Rect, SensorId, TileBlock, TileId};

/// The tiles of a floor that one computer serves: it senses them, runs their controls and drives their actuators.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Area {
    /// Its id, unique on the floor.
    pub id: String,
    /// Its tiles; areas do not overlap.
    pub tiles: TileBlock,
    /// Address on which its computer receives packets: those of its boards, and those that its neighbours forward;
    /// `None` if the address is unknown, so that nothing is forwarded.
    pub listen: Option<SocketAddr>,
}

/// Distance beyond its area that a computer senses, in metres: the longest step (1.1 m) and half a foot, so that it
/// also senses the other foot of a person who steps into the area.
pub const SENSED_BEYOND_M: f32 = 1.2;

impl Area {
    /// The area called `id` with these `tiles`, without an address.
    #[must_use]
    pub fn new(id: &str, tiles: TileBlock) -> Self {
        Self { id: id.to_owned(), tiles, listen: None }
    }

    /// Returns the tiles that its computer senses: its own and those within [`SENSED_BEYOND_M`] of them.
    #[must_use]
    pub fn sensed(&self, geometry: &Geometry) -> TileBlock {
        let margin = (SENSED_BEYOND_M / geometry.pitch_m().min_element()).ceil() as u16;
        self.tiles.grown(margin).common(&geometry.block())
    }

    /// Whether `point` of the floor is in this area; a point beyond the floor counts as part of the nearest cell, and
    /// NaN as part of the first.
    ///
    /// Exactly one of a floor's areas holds a point.
    #[must_use]
    pub fn holds(&self, geometry: &Geometry, point: Vec2) -> bool {
        self.tiles.contains(nearest_tile(geometry, point))
    }
}

impl Floor {
    /// Returns the area called `id`; `None` if there is none.
    #[must_use]
    pub fn area(&self, id: &str) -> Option<&Area> {
        self.areas.iter().find(|area| area.id == id)
    }

    /// Divides the floor into areas. The actuators of each area use the channels of its own device, in the order of
    /// its tiles.
    #[must_use]
    pub fn with_areas(mut self, areas: Vec<Area>) -> Self {
        let mut next = vec![0; areas.len()];
        let cells = self.geometry.tiles().zip(&mut self.actuators);
        for (tile, actuator) in cells.filter(|(tile, _)| !self.geometry.is_missing(*tile)) {
            if let Some(number) = areas.iter().position(|area| area.tiles.contains(tile)) {
                *actuator = Some(Actuator::nominal(next[number]));
                next[number] += 1;
            }
        }
        Self { areas, ..self }
    }

    /// Returns the part of this floor that the computer of `area` serves: the tiles that it senses, and its own
    /// actuators and loudspeakers.
    ///
    /// Tiles keep their ids and points their coordinates. Boards without sensors there are omitted; the other boards
    /// keep their addresses and lose the sensors elsewhere. A loudspeaker belongs to the nearest area. `None` if the
    /// floor has no tile there.
    #[must_use]
    pub fn part(&self, area: &Area) -> Option<Self> {
        let geometry = self.geometry.part(&area.sensed(&self.geometry))?;
        let indices: Vec<usize> =
            geometry.tiles().map(|tile| self.geometry.index(tile)).collect::<Option<_>>()?;
        let boards = self.boards.iter().map(|board| Board {
            address: board.address.clone(),
            channels: {
                let here =
                    |sensor: &Option<SensorId>| sensor.filter(|sensor| geometry.index(sensor.tile).is_some());
                board.channels.iter().map(here).collect()
            },
            ..*board
        });
        let own = |index: &usize| area.tiles.contains(self.geometry.tile_at_index(*index));
        let near = |at: Vec2| area.holds(&self.geometry, at);
        Some(Self {
            geometry,
            boards: boards.filter(|board| board.channels.iter().any(Option::is_some)).collect(),
            calibration: of(&self.calibration, &indices)?,
            tare: of(&self.tare, &indices)?,
            actuators: indices
                .iter()
                .map(|index| self.actuators.get(*index).copied().flatten().filter(|_| own(index)))
                .collect(),
            drive: self.drive,
            responses: of(&self.responses, &indices)?,
            loudspeakers: self.loudspeakers.iter().filter(|one| near(one.at)).copied().collect(),
            position_maps: of(&self.position_maps, &indices)?,
            calibration_records: of(&self.calibration_records, &indices)?,
            map_records: of(&self.map_records, &indices)?,
            noiseless: self.noiseless,
            off: self.off.iter().filter(|sensor| geometry.index(sensor.tile).is_some()).copied().collect(),
            tared: self.tared,
            allow: self.allow.clone(),
            serial: Vec::new(),
            areas: Vec::new(),
            gateway: None,
            key: None,
            file: self.file.clone(),
        })
    }
}

/// Returns the entries at `indices`; `None` if one of them does not exist.
fn of<T: Clone>(all: &[T], indices: &[usize]) -> Option<Vec<T>> {
    indices.iter().map(|&index| all.get(index).cloned()).collect()
}

fn nearest_tile(geometry: &Geometry, point: Vec2) -> TileId {
    let Rect { min, max } = geometry.bounds();
    // The far edges belong to no tile's cell, and NaN lies in no cell.
    let inside = point.clamp(min, max - 0.5 * geometry.pitch_m());
    let nearest = [point, inside].into_iter().find_map(|point| geometry.cell_under(point));
    nearest.unwrap_or(geometry.first())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::Corner;

    /// Four areas of 6 x 6 tiles.
    fn hall() -> Floor {
        let areas = [("sw", 0, 0), ("se", 6, 0), ("nw", 0, 6), ("ne", 6, 6)].map(|(id, column, row)| {
            Area::new(id, TileBlock { first: TileId::new(column, row), columns: 6, rows: 6 })
        });
        Floor::of(Geometry::of_paper_tiles(12, 12).unwrap()).with_areas(areas.into())
    }

    #[test]
    fn a_part_has_a_margin_of_four_tiles_and_moves_none_of_them() {
        let floor = hall();
        let part = floor.part(floor.area("ne").unwrap()).unwrap();
        assert_eq!(part.geometry.block(), TileBlock { first: TileId::new(2, 2), columns: 10, rows: 10 });
        assert_eq!(part.actuators.iter().flatten().count(), 36);
        for (index, tile) in part.geometry.tiles().enumerate() {
            let whole = floor.geometry.index(tile).unwrap();
            let is_own = tile.column >= 6 && tile.row >= 6;
            assert_eq!(part.actuators[index], floor.actuators[whole].filter(|_| is_own), "{tile}");
        }
        // The device of each computer has the channels of its own tiles.
        assert_eq!(part.channel_count(), 36);
    }

    #[test]
    fn boards_keep_their_addresses_and_their_channels_places() {
        let floor = hall();
        let part = floor.part(floor.area("nw").unwrap()).unwrap();
        // Each row has a board of eight tiles and one of four; the part has ten columns and rows.
        assert_eq!(part.boards.len(), 20);
        let far = part.boards.iter().find(|board| board.address == "/underfoot/board/7").unwrap();
        let sensor = SensorId { tile: TileId::new(8, 3), corner: Corner::SouthWest };
        assert_eq!((far.channels.len(), far.channels[0], far.channels[8]), (16, Some(sensor), None));
    }

    #[test]
    fn every_point_is_in_one_area() {
        let floor = hall();
        let side = 12.0 * 0.304;
        for point in [(0.0, 0.0), (side, side), (side / 2.0, side / 2.0), (1.82, 1.83), (-3.0, 99.0)]
            .map(Vec2::from)
            .into_iter()
            .chain([Vec2::NAN, Vec2::new(f32::INFINITY, f32::NEG_INFINITY)])
        {
            let holders = floor.areas.iter().filter(|area| area.holds(&floor.geometry, point));
            assert_eq!(holders.count(), 1, "{point}");
        }
    }
}
