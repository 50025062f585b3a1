//! The map from output channels to tiles, printed as a plan.

use std::fmt;

use crate::floor::{Floor, TileId};

/// The map from output channels to tiles, from the floor file; its text is a plan of the floor, north at the top.
///
/// Channels count from 0, as in the floor file; the labels on a sound card often count from 1.
#[derive(Clone, Copy, Debug)]
pub struct ChannelMap<'a> {
    floor: &'a Floor,
}

impl<'a> ChannelMap<'a> {
    /// The map of `floor`.
    #[must_use]
    pub const fn new(floor: &'a Floor) -> Self {
        Self { floor }
    }

    /// Returns every tile with an actuator, in tile-index order, and its channel, from 0.
    pub fn entries(&self) -> impl Iterator<Item = (TileId, u16)> + 'a {
        let tiles = self.floor.geometry.tiles().zip(&self.floor.actuators);
        tiles.filter_map(|(tile, actuator)| actuator.map(|actuator| (tile, actuator.channel)))
    }

    /// Returns the tiles that a device with this number of channels cannot drive.
    pub fn beyond(&self, channels: usize) -> impl Iterator<Item = (TileId, u16)> + 'a {
        self.entries().filter(move |(_, channel)| usize::from(*channel) >= channels)
    }

    /// Returns the channels that several tiles share, with their tiles: allowed, but usually a mistake.
    #[must_use]
    pub fn shared(&self) -> Vec<(u16, Vec<TileId>)> {
        let mut by_channel: Vec<(u16, Vec<TileId>)> = Vec::new();
        let mut entries: Vec<_> = self.entries().collect();
        entries.sort_by_key(|(_, channel)| *channel);
        for (tile, channel) in entries {
            match by_channel.last_mut() {
                Some((last, tiles)) if *last == channel => tiles.push(tile),
                _ => by_channel.push((channel, vec![tile])),
            }
        }
        by_channel.retain(|(_, tiles)| tiles.len() > 1);
        by_channel
    }
}

impl fmt::Display for ChannelMap<'_> {
    /// One row of the plan per line, `-` for a tile without an actuator; the numbers of the columns come last.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let geometry = &self.floor.geometry;
        let width = self.entries().map(|(_, channel)| channel.to_string().len()).max().unwrap_or(1).max(2);
        let block = geometry.block();
        for row in block.row_range().rev() {
            write!(f, "row {row:>3} |")?;
            for column in block.column_range() {
                let index = geometry.index(TileId::new(column, row));
                match index.and_then(|index| self.floor.actuators.get(index)).copied().flatten() {
                    Some(actuator) => write!(f, " {:>width$}", actuator.channel)?,
                    None => write!(f, " {:>width$}", "-")?,
                }
            }
            writeln!(f)?;
        }
        write!(f, " column |")?;
        for column in block.column_range() {
            write!(f, " {column:>width$}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::{Actuator, Geometry};

    #[test]
    fn the_plan_shows_the_north_at_the_top_and_bare_tiles_as_dashes() {
        let mut floor = Floor::of(Geometry::of_paper_tiles(3, 2).unwrap());
        floor.actuators[1] = None;
        floor.actuators[5] = Some(Actuator::nominal(100));
        let map = ChannelMap::new(&floor);
        let plan = "row   1 |   3   4 100\nrow   0 |   0   -   2\n column |   0   1   2";
        assert_eq!(map.to_string(), plan);
        assert_eq!(map.beyond(4).collect::<Vec<_>>(), [(TileId::new(1, 1), 4), (TileId::new(2, 1), 100)]);
        assert!(map.shared().is_empty());
    }

    #[test]
    fn tiles_on_one_channel_are_found() {
        let mut floor = Floor::of(Geometry::of_paper_tiles(3, 1).unwrap());
        floor.actuators[0] = Some(Actuator::nominal(2));
        assert_eq!(ChannelMap::new(&floor).shared(), [(2, vec![TileId::new(0, 0), TileId::new(2, 0)])]);
    }
}
