//! Load of one area on its computer.

use serde::Serialize;

use super::datagram::{CONTACT_HZ, contacts, on_wire, sensor_packet};
use super::{Crowd, Machine};
use underfoot::floor::{Area, Board, Floor, Forwarding, TileBlock};

/// Packets per second that a board sends.
pub(super) const BOARD_HZ: f64 = 1000.0;

const MILLISECOND_US: f64 = 1000.0;

/// Maximum number of feet per person on the floor.
pub(super) const FEET: f64 = 2.0;

/// Active sound channels per person: two feet, each on two tiles.
pub(super) const CHANNELS_PER_PERSON: f64 = 4.0;

/// Standard deviations above the mean number of people that an area must serve.
const DEVIATIONS: f64 = 3.0;

/// Load of one area on its computer at the largest number of people that the plan expects.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AreaDemand {
    /// Name of the area; empty if the floor has no areas, or if the plan made them.
    pub id: String,
    /// Number of the area's own tiles from west to east.
    pub columns: u32,
    /// Number of the area's own tiles from south to north.
    pub rows: u32,
    /// Number of sensed tiles, including the area's own, from west to east.
    pub sensed_columns: u32,
    /// Number of sensed tiles, including the area's own, from south to north.
    pub sensed_rows: u32,
    /// Board packets that the area receives, per second.
    pub packets_per_s: f64,
    /// Bandwidth of these packets with their headers on the area's wire (Mb/s).
    pub in_mbit: f64,
    /// Board packets that the area forwards, per second; a packet counts once for each destination computer.
    pub forwards_per_s: f64,
    /// Number of computers that forward packets to this area.
    pub forwarders: u32,
    /// Contact datagrams that the area sends, per second.
    pub out_packets_per_s: f64,
    /// Bandwidth of the contact datagrams, the forwarded packets and their headers on the area's wire (Mb/s).
    pub out_mbit: f64,
    /// Number of channels of the area's sound card.
    pub channels: u32,
    /// Number of people on the area's own tiles.
    pub people: f64,
    /// Number of people on the tiles that the area senses.
    pub sensed_people: f64,
}

/// Tiles, boards and bytes of an area, independent of the number of people.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Extent {
    pub(super) columns: u32,
    pub(super) rows: u32,
    pub(super) sensed_columns: u32,
    pub(super) sensed_rows: u32,
    /// Number of boards that send to the area.
    pub(super) boards: u32,
    /// Bytes on the wire that these boards send each millisecond.
    pub(super) bytes: f64,
    /// Packets that the area forwards each millisecond, and their bytes on the wire.
    pub(super) forwards: u32,
    pub(super) forwarded_bytes: f64,
    /// Number of computers that forward packets to this area.
    pub(super) forwarders: u32,
    pub(super) channels: u32,
}

impl AreaDemand {
    /// Computes the demand of an area of `extent` on a floor of `tiles` tiles.
    pub(super) fn new(id: &str, extent: &Extent, tiles: f64, crowd: &Crowd) -> Self {
        let Extent { columns, rows, sensed_columns, sensed_rows, boards, bytes, channels, .. } = *extent;
        let share = |columns, rows| f64::from(columns) * f64::from(rows) / tiles.max(1.0);
        let people = people_on(share(columns, rows), crowd);
        let (datagrams, out_bytes) = contacts((FEET * people).ceil() as u32);
        Self {
            id: id.to_owned(),
            columns,
            rows,
            sensed_columns,
            sensed_rows,
            packets_per_s: f64::from(boards) * BOARD_HZ,
            in_mbit: mbit(bytes * BOARD_HZ),
            forwards_per_s: f64::from(extent.forwards) * BOARD_HZ,
            forwarders: extent.forwarders,
            out_packets_per_s: f64::from(datagrams) * CONTACT_HZ,
            out_mbit: mbit(out_bytes * CONTACT_HZ + extent.forwarded_bytes * BOARD_HZ),
            channels,
            people,
            sensed_people: people_on(share(sensed_columns, sensed_rows), crowd),
        }
    }

    /// Computes the demand of a whole floor on one computer.
    pub(super) fn whole(floor: &Floor, crowd: &Crowd) -> Self {
        let area = Area::new("", floor.geometry.block());
        Self::of(floor, &area, crowd)
    }

    /// Computes the demand of an area of a floor file; all numbers are 0 if the area has no tile on the floor. An
    /// area without a listening address receives no forwarded packets.
    #[must_use]
    pub fn of(floor: &Floor, area: &Area, crowd: &Crowd) -> Self {
        let Some(part) = floor.part(area) else { return Self { id: area.id.clone(), ..Self::default() } };
        let TileBlock { columns, rows, .. } = area.tiles.common(&floor.geometry.block());
        let bytes = |board: &Board| {
            let letters = u32::try_from(board.address.len()).unwrap_or(u32::MAX / 8);
            let channels = u32::try_from(board.channels.len()).unwrap_or(u32::MAX / 8);
            f64::from(on_wire(sensor_packet(letters, channels, crowd.format)))
        };
        let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        let forwardings = floor.forwardings(area);
        let forwarded = |forwarding: &Forwarding| {
            let board = floor.boards.iter().find(|board| board.address == forwarding.address);
            board.map_or(0.0, bytes) * forwarding.to.len() as f64
        };
        let extent = Extent {
            columns: columns.into(),
            rows: rows.into(),
            sensed_columns: part.geometry.columns().into(),
            sensed_rows: part.geometry.rows().into(),
            boards: count(part.boards.len()),
            bytes: part.boards.iter().map(bytes).sum(),
            forwards: count(forwardings.iter().map(|forwarding| forwarding.to.len()).sum()),
            forwarded_bytes: forwardings.iter().map(forwarded).sum(),
            forwarders: count(floor.forwarders(area).len()),
            channels: count(part.channel_count()),
        };
        Self::new(&area.id, &extent, floor.geometry.tile_count() as f64, crowd)
    }

    /// Returns the number of tiles that the area senses.
    #[must_use]
    pub fn sensed_tiles(&self) -> f64 {
        f64::from(self.sensed_columns) * f64::from(self.sensed_rows)
    }

    /// Returns the cores that the sensing thread needs: receiving packets, forwarding them, waking for packets that
    /// other computers forward, assembling frames, detecting contacts, and updating controls.
    #[must_use]
    pub fn sensing_cores(&self, machine: &Machine) -> f64 {
        let work = machine.base_us
            + self.packets_per_s / BOARD_HZ * machine.packet_us
            + self.forwards_per_s / BOARD_HZ * machine.forward_us
            + self.sensed_tiles() * (machine.assemble_tile_us + machine.sense_tile_us)
            + self.sensed_people * machine.person_us;
        let wakes = f64::from(self.forwarders) * machine.wake_us;
        // A busy thread needs no wake-up, so a wake-up costs only in the idle share of the time: solves `cores =
        // (work + wakes * (1 - cores)) / 1 ms`.
        (work + wakes) / (MILLISECOND_US + wakes)
    }

    /// Returns the cores that the sound needs.
    #[must_use]
    pub fn sound_cores(&self, machine: &Machine) -> f64 {
        let channels = f64::from(self.channels);
        let active = channels.min(CHANNELS_PER_PERSON * self.people);
        (channels * machine.channel_us + active * machine.active_channel_us) / 1000.0
    }
}

/// Number of people on a `share` of the floor: the mean times the crowding, at least the mean plus three standard
/// deviations (unless people are spread evenly), and at most all people.
fn people_on(share: f64, crowd: &Crowd) -> f64 {
    let all = f64::from(crowd.people);
    let mean = all * share;
    let by_chance = if crowd.crowding > 1.0 { mean + DEVIATIONS * mean.sqrt() } else { mean };
    (mean * crowd.crowding).max(by_chance).min(all)
}

pub(super) fn mbit(bytes_per_s: f64) -> f64 {
    bytes_per_s * 8.0 / 1e6
}

#[cfg(test)]
mod tests {
    use super::super::machine::tests::ROUND;
    use super::*;
    use underfoot::floor::{Geometry, TileId};

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-9 * b.abs().max(1.0)
    }

    #[test]
    fn the_papers_floor_with_two_people_by_hand() {
        let demand = AreaDemand::whole(&Floor::default(), &Crowd::of(2));
        assert_eq!((demand.columns, demand.rows, demand.sensed_columns, demand.sensed_rows), (6, 6, 6, 6));
        assert_eq!((demand.channels, demand.people, demand.sensed_people), (36, 2.0, 2.0));
        // Six boards of 24 channels. Each packet: 20 bytes of address, 28 of tags, 4 + 96 of numbers, 66 of headers =
        // 214 bytes.
        assert!(
            near(demand.packets_per_s, 6000.0) && near(demand.in_mbit, 6.0 * 214.0 * 8.0 / 1000.0),
            "{demand:?}"
        );
        // Four feet in one datagram: 48 bytes of bundle and count, 4 x 56 of contacts, 66 of headers.
        assert!(near(demand.out_packets_per_s, 100.0), "{demand:?}");
        assert!(near(demand.out_mbit, (48.0 + 224.0 + 66.0) * 8.0 * 100.0 / 1e6), "{demand:?}");
        // 20 + 6 x 1 + 36 x 0.2 + 2 x 10 us.
        assert!(near(demand.sensing_cores(&ROUND), 0.0532), "{}", demand.sensing_cores(&ROUND));
        // 36 x 1 and 8 x 2 us.
        assert!(near(demand.sound_cores(&ROUND), 0.052), "{}", demand.sound_cores(&ROUND));
    }

    #[test]
    fn an_area_of_a_hall_receives_what_is_sensed_around_it() {
        let west = Area::new("west", TileBlock { first: TileId::default(), columns: 6, rows: 6 });
        let east = TileBlock { first: TileId::new(6, 0), columns: 6, rows: 6 };
        let floor = Floor::of(Geometry::of_paper_tiles(12, 6).unwrap())
            .with_areas(vec![west.clone(), Area::new("east", east)]);
        let demand = AreaDemand::of(&floor, &west, &Crowd { crowding: 1.0, ..Crowd::of(8) });
        // Four tiles are 1.216 m; both boards of a row have sensors in the ten sensed columns.
        assert_eq!((demand.sensed_columns, demand.sensed_rows, demand.channels), (10, 6, 36));
        assert!(near(demand.packets_per_s, 12_000.0));
        assert!(near(demand.people, 4.0) && near(demand.sensed_people, 8.0 * 60.0 / 72.0), "{demand:?}");
        assert!(near(demand.forwards_per_s, 0.0), "nobody says where it listens");
    }

    #[test]
    fn an_area_forwards_the_packets_of_its_boards_that_others_sense() {
        let area = |id: &str, number: u16| Area {
            listen: Some(([127, 0, 0, 1], 9000 + number).into()),
            ..Area::new(id, TileBlock { first: TileId::new(8 * number, 0), columns: 8, rows: 2 })
        };
        let floor = Floor::of(Geometry::of_paper_tiles(24, 2).unwrap()).with_areas(vec![
            area("west", 0),
            area("middle", 1),
            area("east", 2),
        ]);
        let crowd = Crowd { crowding: 1.0, ..Crowd::of(0) };
        let [west, middle, east] = [0, 1, 2].map(|at| AreaDemand::of(&floor, &floor.areas[at], &crowd));
        // One board in each of two rows; the middle area forwards its packets to both neighbours.
        assert!(near(west.forwards_per_s, 2000.0) && near(east.forwards_per_s, 2000.0), "{west:?} {east:?}");
        assert!(near(middle.forwards_per_s, 4000.0), "{middle:?}");
        // 254 bytes for each packet, and 114 for the datagram without contacts, 100 times a second.
        assert!(
            near(middle.out_mbit, (4.0 * 254.0 * 1000.0 + 114.0 * 100.0) * 8.0 / 1e6),
            "{}",
            middle.out_mbit
        );
        assert_eq!((west.forwarders, middle.forwarders, east.forwarders), (1, 2, 1));
        // 20 + 6 boards x 1 + 4 x 0.5 + 32 tiles x 0.2 us, and 2 neighbours x 3 us in the idle share of a
        // millisecond.
        let sensing = middle.sensing_cores(&ROUND);
        assert!(near(sensing, 0.0344 + 0.006 * (1.0 - sensing)), "{sensing}");
    }

    #[test]
    fn more_people_than_on_average_are_expected_where_few_are() {
        let people = |share, crowding, people| people_on(share, &Crowd { crowding, ..Crowd::of(people) });
        // Mean of four: crowding gives 2 x 4, chance gives 4 + 3 x 2.
        assert_eq!(people(0.04, 2.0, 100), 10.0);
        // Mean of a hundred: crowding gives 2 x 100, which is more than chance gives.
        assert_eq!(people(0.1, 2.0, 1000), 200.0);
        assert_eq!(people(0.5, 2.0, 4), 4.0, "no more than there are");
        assert_eq!(people(0.1, 1.0, 100), 10.0, "spread evenly");
        assert_eq!(people(0.5, 2.0, 0), 0.0);
    }
}
