//! Forwarding of boards' packets between the computers of a floor.
//!
//! A computer senses somewhat more than its own area ([`Area::sensed`]). Each board sends to one computer, its home;
//! if other computers sense tiles of that board too, its home forwards the packets to them.

use std::collections::BTreeSet;
use std::net::{IpAddr, SocketAddr};

use super::{Area, Board, Floor, SensorId, TileBlock};

/// The computers that need the packets of one board in addition to the board's home.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Forwarding {
    /// The board's OSC address.
    pub address: String,
    /// Addresses on which these computers receive packets.
    pub to: Vec<SocketAddr>,
}

impl Floor {
    /// Returns the area with the computer that `board` sends to: the one with most of its sensors, the first in the
    /// list among equals. `None` for a floor without areas and for a board without sensors.
    #[must_use]
    pub fn home(&self, board: &Board) -> Option<&Area> {
        let sensors = |area: &&Area| {
            let own = |sensor: &&SensorId| area.tiles.contains(sensor.tile);
            board.channels.iter().flatten().filter(own).count()
        };
        // Among equals, `max_by_key` returns the last.
        self.areas.iter().rev().filter(|area| sensors(area) > 0).max_by_key(sensors)
    }

    /// Returns the packets that the computer of `area` forwards: those of boards with this home and with tiles that
    /// other computers sense. Areas without an address receive nothing.
    #[must_use]
    pub fn forwardings(&self, area: &Area) -> Vec<Forwarding> {
        let others = self.areas.iter().filter(|other| other.id != area.id);
        let others: Vec<_> =
            others.filter_map(|other| Some((other.sensed(&self.geometry), other.listen?))).collect();
        let own = self.boards.iter().filter(|board| self.home(board).is_some_and(|home| home.id == area.id));
        let forwardings = own.map(|board| {
            let sensors = || board.channels.iter().flatten();
            let needs =
                |(sensed, _): &&(TileBlock, SocketAddr)| sensors().any(|sensor| sensed.contains(sensor.tile));
            let to = others.iter().filter(needs).map(|(_, listen)| *listen).collect();
            Forwarding { address: board.address.clone(), to }
        });
        forwardings.filter(|forwarding| !forwarding.to.is_empty()).collect()
    }

    /// Returns the areas whose computers forward packets to that of `area`; none if `area` has no address.
    #[must_use]
    pub fn forwarders(&self, area: &Area) -> Vec<&Area> {
        let sensed = area.sensed(&self.geometry);
        let is_sensed =
            |board: &&Board| board.channels.iter().flatten().any(|sensor| sensed.contains(sensor.tile));
        let boards = self.boards.iter().filter(|_| area.listen.is_some()).filter(is_sensed);
        let homes: BTreeSet<&str> = boards.filter_map(|board| Some(self.home(board)?.id.as_str())).collect();
        self.areas.iter().filter(|other| other.id != area.id && homes.contains(other.id.as_str())).collect()
    }

    /// Returns the known addresses of the computers that forward packets to that of `area`.
    pub fn forwarding_addresses(&self, area: &Area) -> impl Iterator<Item = IpAddr> {
        self.forwarders(area).into_iter().filter_map(|home| Some(home.listen?.ip()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::{Geometry, TileId};

    /// Three areas of 8 x 2 tiles in a row; the last has no address.
    fn hall() -> Floor {
        let area = |id: &str, number: u16| Area {
            listen: (number < 2).then(|| ([192, 168, 1, 10 + number as u8], 9000).into()),
            ..Area::new(id, TileBlock { first: TileId::new(8 * number, 0), columns: 8, rows: 2 })
        };
        let areas = vec![area("west", 0), area("middle", 1), area("east", 2)];
        Floor::of(Geometry::of_paper_tiles(24, 2).unwrap()).with_areas(areas)
    }

    #[test]
    fn a_board_s_home_has_most_of_it_and_forwards_to_those_who_sense_some_of_it() {
        let mut floor = hall();
        let home = |floor: &Floor, board: usize| floor.home(&floor.boards[board]).map(|area| area.id.clone());
        assert_eq!(home(&floor, 0).as_deref(), Some("west"));
        assert_eq!(home(&floor, 4).as_deref(), Some("middle"));
        let west = floor.forwardings(&floor.areas[0]);
        let middle: SocketAddr = ([192, 168, 1, 11], 9000).into();
        assert_eq!(
            west,
            [0, 3].map(|board| Forwarding { address: floor.boards[board].address.clone(), to: vec![middle] })
        );
        let from_east = floor.forwardings(&floor.areas[2]);
        assert_eq!(from_east.len(), 2, "{from_east:?}");
        // Both neighbours sense the middle, but the east has no address.
        assert!(floor.forwardings(&floor.areas[1]).iter().all(|one| one.to.len() == 1));
        assert_eq!(floor.forwarders(&floor.areas[0]), [&floor.areas[1]]);
        assert_eq!(floor.forwarding_addresses(&floor.areas[0]).collect::<Vec<_>>(), [middle.ip()]);
        assert_eq!(floor.forwarders(&floor.areas[2]), [] as [&Area; 0], "nobody knows where it listens");
        // Each area has half of a board: the first in the list is its home.
        let both = floor.boards[1].channels[..16].to_vec();
        floor.boards[0].channels.splice(..16, both);
        assert_eq!(home(&floor, 0).as_deref(), Some("west"));
        floor.areas.swap(0, 1);
        assert_eq!(home(&floor, 0).as_deref(), Some("middle"));
        floor.boards[0].channels.fill(None);
        assert_eq!(home(&floor, 0), None);
    }
}
