//! The hardware of one floor.

use std::collections::BTreeSet;
use std::net::SocketAddr;

use underfoot_packet::BoardAddress;

use super::{
    Area, Calibration, CalibrationRecord, Corner, CountRange, Day, Drive, FloorFile, Geometry, Loudspeaker,
    MapRecord, Network, PositionMap, Response, SensorId, SerialWire, TileId,
};
use crate::units::Newtons;

/// The hardware of one floor: geometry, boards, calibration, actuators.
///
/// The per-tile vectors are in tile-index order and as long as [`Geometry::tile_count`]; [`Floor::of`] makes a
/// consistent floor to start from.
#[derive(Clone, Debug, PartialEq)]
pub struct Floor {
    /// The places of tiles and sensors.
    pub geometry: Geometry,
    /// The acquisition boards; a board's position in this list is its number.
    pub boards: Vec<Board>,
    /// Calibration of each tile's sensors, in [`Corner::ALL`] order; positions without a sensor are nominal.
    pub calibration: Vec<[Calibration; 4]>,
    /// Force that each sensor reads on the empty floor; it is subtracted from every reading.
    pub tare: Vec<[Newtons; 4]>,
    /// The actuator under each tile; `None` for a tile without one.
    pub actuators: Vec<Option<Actuator>>,
    /// The amplifiers that drive the actuators.
    pub drive: Drive,
    /// The measured response of each tile's actuator, which the rack equalises; `None` without a measurement.
    pub responses: Vec<Option<Response>>,
    /// The loudspeakers beside the floor, at most 8.
    pub loudspeakers: Vec<Loudspeaker>,
    /// The position map of each tile; `None` without a measurement.
    pub position_maps: Vec<Option<PositionMap>>,
    /// Day and error of the fit of each law in `calibration`; `None` if unknown.
    pub calibration_records: Vec<[Option<CalibrationRecord>; 4]>,
    /// Day and error of the fit of each of `position_maps`; `None` if unknown.
    pub map_records: Vec<Option<MapRecord>>,
    /// Whether the readings lack noise of their own, as those of an app or of a simulation without noise. Sensors
    /// that repeat their readings are then not detected, and controls with the guard `HoldToRun` work with them.
    pub noiseless: bool,
    /// The sensors that are switched off: their readings never count. Their tiles continue with the others; a tile
    /// with two or more of them off senses nothing.
    pub off: BTreeSet<SensorId>,
    /// The day on which `tare` was measured; `None` if unknown.
    pub tared: Option<Day>,
    /// The networks that boards may send from; only this machine if it is empty.
    pub allow: Vec<Network>,
    /// The serial ports of boards, beside the network; empty on a part of a larger floor.
    pub serial: Vec<SerialWire>,
    /// The parts of the floor with a computer of their own; empty if one computer serves the whole floor.
    pub areas: Vec<Area>,
    /// The address on which the gateway listens for the areas' computers; `None` if it is set elsewhere.
    pub gateway: Option<SocketAddr>,
    /// Path of the file with the key that the areas' computers share, as in the floor file: relative to its folder,
    /// or absolute. `None` without one.
    pub key: Option<String>,
    /// The file that it was read from.
    pub file: FloorFile,
}

impl Floor {
    /// A floor of this geometry wired like the paper's: each row of tiles has its own boards (up to eight tiles a
    /// board, one channel a sensor, in the order of [`Corner::ALL`]), nominal calibration, no tare, and an actuator
    /// under each tile, channel by channel.
    #[must_use]
    pub fn of(geometry: Geometry) -> Self {
        let tiles = geometry.tile_count();
        Self {
            boards: boards_by_row(&geometry),
            calibration: vec![[Calibration::NOMINAL; 4]; tiles],
            tare: vec![[Newtons::ZERO; 4]; tiles],
            actuators: usual_actuators(&geometry),
            drive: Drive::default(),
            responses: vec![None; tiles],
            loudspeakers: Vec::new(),
            position_maps: vec![None; tiles],
            calibration_records: vec![[None; 4]; tiles],
            map_records: vec![None; tiles],
            noiseless: false,
            off: BTreeSet::new(),
            tared: None,
            allow: Vec::new(),
            serial: Vec::new(),
            areas: Vec::new(),
            gateway: None,
            key: None,
            file: FloorFile::NONE,
            geometry,
        }
    }

    /// Sets the law of a sensor; false if the floor has no such sensor.
    ///
    /// Measurements with the old law are converted or removed: the tare becomes the force of the new law at the same
    /// voltage, and the position map of the tile is removed.
    pub fn recalibrate(
        &mut self,
        sensor: SensorId,
        law: Calibration,
        record: Option<CalibrationRecord>,
    ) -> bool {
        let Some(tile) = self.geometry.index(sensor.tile) else { return false };
        let corner = sensor.corner.index();
        let (Some(laws), Some(tares)) = (self.calibration.get_mut(tile), self.tare.get_mut(tile)) else {
            return false;
        };
        let old = std::mem::replace(&mut laws[corner], law);
        if let Some(records) = self.calibration_records.get_mut(tile) {
            records[corner] = record;
        }
        if old != law {
            let volts = old.volts_at(tares[corner]);
            if tares[corner] != Newtons::ZERO && !volts.is_nan() {
                let tare = law.force_at(volts);
                tares[corner] = if tare.is_finite() { tare } else { Newtons::ZERO };
            }
            if let Some(map) = self.position_maps.get_mut(tile) {
                *map = None;
            }
            if let Some(record) = self.map_records.get_mut(tile) {
                *record = None;
            }
        }
        true
    }

    /// Switches a sensor off, or on again.
    pub fn switch(&mut self, sensor: SensorId, on: bool) {
        if on {
            self.off.remove(&sensor);
        } else {
            self.off.insert(sensor);
        }
    }

    /// Returns the law of a sensor; the nominal one for a sensor that the floor does not have.
    #[must_use]
    pub fn law(&self, sensor: SensorId) -> Calibration {
        let tile = self.geometry.index(sensor.tile).and_then(|tile| self.calibration.get(tile));
        tile.map_or(Calibration::NOMINAL, |laws| laws[sensor.corner.index()])
    }

    /// Returns the sensors with exactly the nominal part's calibration, which are unmeasured.
    ///
    /// This is normal on a floor whose boards send newtons.
    pub fn uncalibrated(&self) -> impl Iterator<Item = SensorId> + '_ {
        self.geometry.tiles().zip(&self.calibration).flat_map(|(tile, laws)| {
            let nominal = |corner: &Corner| laws[corner.index()] == Calibration::NOMINAL;
            let sensors = self.geometry.sensors(tile).iter().copied();
            sensors.filter(nominal).map(move |corner| SensorId { tile, corner })
        })
    }

    /// Returns the number of channels that a device needs for this floor: the highest channel of any actuator or
    /// loudspeaker plus one.
    #[must_use]
    pub fn channel_count(&self) -> usize {
        let actuators = self.actuators.iter().flatten().map(|actuator| actuator.channel);
        let channels = actuators.chain(self.loudspeakers.iter().map(|loudspeaker| loudspeaker.channel));
        channels.map(|channel| usize::from(channel) + 1).max().unwrap_or(0)
    }
}

impl Default for Floor {
    /// The paper's 6 x 6 floor: six boards, 144 sensors, 36 actuators.
    fn default() -> Self {
        Self::of(Geometry::default())
    }
}

/// One acquisition board: the address of its packets and the sensor of each argument.
#[derive(Clone, Debug, PartialEq)]
pub struct Board {
    /// OSC address of its packets, `/underfoot/board/<number>` by default.
    pub address: String,
    /// The sensor on each channel, in argument order; `None` for an unused channel.
    pub channels: Vec<Option<SensorId>>,
    /// Packets a second, 10 to 4000; `None` if they are measured.
    pub rate_hz: Option<f32>,
    /// The range of its counts.
    pub range: CountRange,
}

impl Board {
    /// A board with these sensors that sends counts of 16 bits, at a rate to be measured.
    #[must_use]
    pub fn new(address: impl Into<String>, channels: Vec<Option<SensorId>>) -> Self {
        Self { address: address.into(), channels, rate_hz: None, range: CountRange::WHOLE }
    }
}

/// The vibrotactile actuator under one tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuator {
    /// Output channel of the audio device, from 0.
    pub channel: u16,
    /// Force at the plate for a full-scale sample, in newtons; positive.
    pub full_scale: Newtons,
}

impl Actuator {
    /// The actuator on `channel` with the paper's 40 N at full scale.
    #[must_use]
    pub const fn nominal(channel: u16) -> Self {
        Self { channel, full_scale: Newtons(40.0) }
    }
}

/// Maximum number of tiles of one 32-channel board.
const TILES_PER_BOARD: u16 = 8;

/// An actuator under each tile, channel by channel in tile order.
fn usual_actuators(geometry: &Geometry) -> Vec<Option<Actuator>> {
    let mut channels = 0..=u16::MAX;
    let under = |tile| geometry.has(tile).then(|| channels.next()).flatten().map(Actuator::nominal);
    geometry.tiles().map(under).collect()
}

fn boards_by_row(geometry: &Geometry) -> Vec<Board> {
    let mut boards = Vec::new();
    let block = geometry.block();
    for row in block.row_range() {
        for west in block.column_range().step_by(TILES_PER_BOARD.into()) {
            let east = (west + TILES_PER_BOARD).min(block.column_range().end);
            let channels = (west..east)
                .flat_map(|column| {
                    let tile = TileId::new(column, row);
                    geometry.sensors(tile).iter().map(move |&corner| Some(SensorId { tile, corner }))
                })
                .collect();
            let board = Board::new(BoardAddress(boards.len()).to_string(), channels);
            boards.extend(Some(board).filter(|board| !board.channels.is_empty()));
        }
    }
    boards
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::LawKind;

    #[test]
    fn the_papers_floor_has_one_board_of_24_channels_per_row() {
        let floor = Floor::default();
        assert_eq!(floor.boards.len(), 6);
        assert!(floor.boards.iter().all(|board| board.channels.len() == 24));
        assert_eq!(floor.boards[2].address, "/underfoot/board/2");
        let second_tile_nw = floor.boards[2].channels[6].unwrap();
        assert_eq!(second_tile_nw, SensorId { tile: TileId::new(1, 2), corner: Corner::NorthWest });
        assert_eq!(floor.channel_count(), 36);
    }

    #[test]
    fn a_new_law_keeps_the_tare_s_voltage_and_drops_the_map_made_through_the_old_one() {
        let mut floor = Floor::of(Geometry::of_paper_tiles(2, 1).unwrap());
        let sensor = SensorId { tile: TileId::new(1, 0), corner: Corner::NorthWest };
        let counts = 30_000;
        floor.tare[1][2] = Calibration::NOMINAL.force(counts);
        floor.position_maps = vec![Some(PositionMap::NONE); 2];
        let law = Calibration::exponential(0.6, 1.3);
        let record = CalibrationRecord { day: Day::of_unix_seconds(0), residual: 0.05 };
        assert!(floor.recalibrate(sensor, law, Some(record)));
        assert_eq!((floor.law(sensor), floor.calibration_records[1][2]), (law, Some(record)));
        assert!((floor.tare[1][2] - law.force(counts)).abs().0 < 1e-3, "{:?}", floor.tare[1][2]);
        assert_eq!(floor.position_maps, [Some(PositionMap::NONE), None]);
        let linear = Calibration::of(LawKind::Linear, [80.0, 0.4]);
        assert!(floor.recalibrate(sensor, linear, None));
        assert!((floor.tare[1][2] - linear.force(counts)).abs().0 < 1e-2, "{:?}", floor.tare[1][2]);
        assert!(!floor.recalibrate(SensorId { tile: TileId::new(2, 0), ..sensor }, law, None));
    }

    #[test]
    fn wide_rows_are_shared_by_boards_of_at_most_32_channels() {
        let floor = Floor::of(Geometry::of_paper_tiles(24, 2).unwrap());
        assert_eq!(floor.boards.len(), 6);
        assert!(floor.boards.iter().all(|board| board.channels.len() == 32));
    }
}
