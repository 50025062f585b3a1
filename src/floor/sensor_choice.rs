//! Some sensors of a floor, to switch off and on.

use std::fmt;

use thiserror::Error;

use super::{Floor, Geometry, SensorId, TileId};

/// Some sensors of a floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorChoice {
    /// All sensors of a tile.
    Tile(TileId),
    /// One sensor.
    Sensor(SensorId),
    /// The sensor on a channel of a board, both from 0.
    Channel {
        /// Number of the board.
        board: u16,
        /// Number of the channel, in the order of the packet's arguments.
        channel: u16,
    },
}

/// Error: the floor has no such sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the floor has no {0}")]
pub struct NoSuchSensor(pub SensorChoice);

impl fmt::Display for SensorChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tile(tile) => write!(f, "tile {tile} with sensors"),
            Self::Sensor(SensorId { tile, corner }) => {
                write!(f, "sensor {} ({corner}) under tile {tile}", corner.index())
            }
            Self::Channel { board, channel } => {
                write!(f, "sensor on channel {channel} of board {board}")
            }
        }
    }
}

impl SensorChoice {
    /// Returns the chosen sensors of `floor`, at least one.
    ///
    /// # Errors
    /// [`NoSuchSensor`] if the floor has none of them.
    pub fn sensors(self, floor: &Floor) -> Result<Vec<SensorId>, NoSuchSensor> {
        self.wired(&floor.geometry, |board, channel| {
            *floor.boards.get(usize::from(board))?.channels.get(usize::from(channel))?
        })
    }

    /// As [`SensorChoice::sensors`], on a floor of this `geometry`; `sensor` returns the sensor on a channel.
    pub(crate) fn wired(
        self,
        geometry: &Geometry,
        sensor: impl Fn(u16, u16) -> Option<SensorId>,
    ) -> Result<Vec<SensorId>, NoSuchSensor> {
        let chosen: Vec<SensorId> = match self {
            Self::Tile(tile) => {
                geometry.sensors(tile).iter().map(|&corner| SensorId { tile, corner }).collect()
            }
            Self::Sensor(sensor) => vec![sensor],
            Self::Channel { board, channel } => sensor(board, channel).into_iter().collect(),
        };
        let is_there = |sensor: &SensorId| {
            geometry.has(sensor.tile) && geometry.sensors(sensor.tile).contains(&sensor.corner)
        };
        let chosen: Vec<SensorId> = chosen.into_iter().filter(is_there).collect();
        if chosen.is_empty() { Err(NoSuchSensor(self)) } else { Ok(chosen) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::{Corner, Geometry};

    #[test]
    fn a_tile_a_sensor_and_a_channel_name_the_same_sensors_and_others_none() {
        let floor = Floor::of(Geometry::of_paper_tiles(2, 1).unwrap());
        let tile = TileId::new(1, 0);
        let all = SensorChoice::Tile(tile).sensors(&floor).unwrap();
        assert_eq!(all.len(), 4);
        let sensor = SensorId { tile, corner: Corner::NorthWest };
        assert_eq!(SensorChoice::Sensor(sensor).sensors(&floor), Ok(vec![all[2]]));
        assert_eq!(SensorChoice::Channel { board: 0, channel: 6 }.sensors(&floor), Ok(vec![sensor]));
        for none in [
            SensorChoice::Tile(TileId::new(2, 0)),
            SensorChoice::Sensor(SensorId { tile: TileId::new(0, 1), ..sensor }),
            SensorChoice::Channel { board: 0, channel: 8 },
            SensorChoice::Channel { board: 1, channel: 0 },
        ] {
            assert_eq!(none.sensors(&floor), Err(NoSuchSensor(none)));
        }
    }
}
