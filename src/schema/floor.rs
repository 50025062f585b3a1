//! Floor files: geometry, boards, sensors, actuators.

use std::net::SocketAddr;
use std::path::Path;

use super::diagnostic::Diagnostics;
use super::fields::Fields;
use super::floor_areas::{self, AREAS, FloorAreaRecord};
use super::floor_codecs::ValidTiles;
use super::floor_measures::Measures;
use super::floor_off::OffRecord;
use super::floor_parts::{
    ActuatorRecord, BoardRecord, LoudspeakerRecord, MapEntry, ResponseRecord, SensorRecord, all_actuators,
};
use super::floor_serial::{self, SERIAL, SerialRecord};
use super::node::Node;
use super::pairs::Limits;
use super::problem::Problem;
use super::reader::Reader;
use super::source::{Source, read_text};
use super::version::{
    self, FIRST_VERSION, FORMAT_VERSION, VERSION, WITH_BOARD_RATES, WITH_PLATES, WITH_SENSORS_OFF,
    WITH_SERIAL_PORTS,
};
use crate::floor::{
    ADDRESS, Corner, CountRange, DAY, Day, Drive, Floor, FloorFile, Geometry, Loudspeaker, NETWORK, Network,
    PortName,
};
use underfoot_format::codec::{Distinct, Text};
use underfoot_format::describe::Description;
use underfoot_format::text::Entry;
use underfoot_format::{Flag, Flat, Opt, Rec, Record, list, record};

/// Reads the floor that the file at `path` describes.
///
/// # Errors
/// Every problem of the file, or that it cannot be read.
pub fn load_floor(path: &Path) -> Result<Floor, Diagnostics> {
    load_floor_with_ports(path, &|_| None)
}

/// As [`load_floor`], and reports each serial port of the file for which `absent` returns what to do about it: ports
/// belong to a computer, and a file can be read on others.
///
/// # Errors
/// As [`load_floor`], and for each absent port.
pub fn load_floor_with_ports(
    path: &Path,
    absent: &dyn Fn(&PortName) -> Option<String>,
) -> Result<Floor, Diagnostics> {
    let text = read_text(path)?;
    parse_floor_with_ports(&text, &path.display().to_string(), absent)
}

/// Reads the floor that `text` describes; fields that are not written are as on [`Floor::of`] its geometry.
///
/// `name` is the name of the text in diagnostics, usually a path.
///
/// # Errors
/// Every problem of the text.
pub fn parse_floor(text: &str, name: &str) -> Result<Floor, Diagnostics> {
    parse_floor_with_ports(text, name, &|_| None)
}

/// As [`parse_floor`], and reports absent serial ports as [`load_floor_with_ports`] does.
///
/// # Errors
/// Every problem of the text, and every absent port.
pub fn parse_floor_with_ports(
    text: &str,
    name: &str,
    absent: &dyn Fn(&PortName) -> Option<String>,
) -> Result<Floor, Diagnostics> {
    let source = Source::new(name, text)?;
    let reader = Reader::new(&source, FloorFileRecord::NAME, Limits::FLOOR);
    if let Some(newer) = version::newer(&reader, FloorFileRecord::NAME) {
        return Err(newer);
    }
    let floor = reader.root("floor").and_then(|node| floor(node, absent));
    reader.conclude(floor).map(|(floor, _)| Floor { file: FloorFile::new(name), ..floor })
}

fn floor(node: Node<'_>, absent: &dyn Fn(&PortName) -> Option<String>) -> Option<Floor> {
    let mut fields = node.fields(FloorFileRecord::NAME)?;
    let record = FloorFileRecord::read(&mut fields);
    let good = fields.are_read();
    let sides = [("tile_m", record.head.geometry.tile_m()), ("pitch_m", record.head.geometry.pitch_m())];
    let sides = sides.into_iter().filter(|(_, sides)| sides.x != sides.y);
    let newer = [
        ("serial", "serial ports", WITH_SERIAL_PORTS),
        ("sensors_m", "sensors at given places", WITH_PLATES),
        ("missing", "missing tiles", WITH_PLATES),
        ("plates", "plates that differ", WITH_PLATES),
        ("off", "sensors that are off", WITH_SENSORS_OFF),
    ];
    let sides = sides.map(|(name, _)| (name, "rectangular tiles", WITH_PLATES));
    let newer: Vec<_> = newer
        .into_iter()
        .chain(sides)
        .filter_map(|(name, things, first)| Some((fields.value_span(name)?, (things, first))))
        .collect();
    fields.finish();
    for (at, things) in newer {
        version::require(node.reader, at, things, ("floor", record.head.version));
    }
    record.check_rates(node.reader);
    let floor = record.floor();
    record.check_channels(node.reader, &floor);
    floor_serial::check(node.reader, &record.parts.serial, &floor);
    floor_serial::check_ports(node.reader, &record.parts.serial, absent);
    if good {
        let geometry = &floor.geometry;
        let boards = record.parts.boards.iter().flatten();
        boards.for_each(|board| board.check_sensors(node.reader, geometry));
        record.parts.sensors.iter().for_each(|sensor| sensor.check_sensor(node.reader, geometry));
        record.parts.off.iter().for_each(|off| off.check(node.reader, &floor));
        floor_areas::check(node.reader, &floor.geometry, &record.parts.areas);
    }
    good.then_some(floor)
}

/// A floor as written. Its parts stand on the tiles of its head, which are read first.
pub(super) struct FloorFileRecord {
    head: FloorHeadRecord,
    pub(super) parts: FloorPartsRecord,
}

record! {
    /// A floor: the places of its tiles and the hardware wired to them. Lengths are in metres, tiles are (column,
    /// row) from the south-west.
    struct FloorHeadRecord = "Floor";
    /// The version of the format.
    version: u32 = "version", VERSION => FORMAT_VERSION;
    /// Places of tiles and sensors.
    geometry: Geometry = "", Measures;
}

record! {
    /// The hardware of a floor.
    pub(super) struct FloorPartsRecord = "FloorParts" with ValidTiles;
    /// The parts of the floor with a computer of their own; one computer serves the whole floor if there are none.
    pub(super) areas: Vec<FloorAreaRecord> = "areas", AREAS => Vec::new();
    /// Address on which the gateway that joins these computers listens.
    pub(super) gateway: Option<SocketAddr> = "gateway", Opt(ADDRESS) => None;
    /// Path of the file with the key that these computers share, from the floor file's folder.
    pub(super) key: Option<String> = "key", Opt(Text(MAX_PATH)) => None;
    /// The boards; by default each row of tiles has its own, up to eight tiles a board.
    pub(super) boards: Option<Vec<BoardRecord>> = "boards", Opt(BOARDS) => None;
    /// Networks that the boards' packets come from; this machine alone if there are none.
    pub(super) allow: Vec<Network> = "allow", list("network", MAX_NETWORKS, NETWORK) => Vec::new();
    /// The serial ports of boards, beside the network.
    pub(super) serial: Vec<SerialRecord> = "serial", SERIAL => Vec::new();
    /// Whether the readings lack noise of their own, as those of an app or of a simulation without noise: repeated
    /// readings are then normal, and `HoldToRun` works with them.
    pub(super) noiseless: bool = "noiseless", Flag => false;
    /// Sensors that are switched off: their tiles continue with the others, and a tile without sensors carries nothing.
    pub(super) off: Vec<OffRecord> = "off", list("sensor", MOST_OFF, Rec) => Vec::new();
    /// The day on which the floor was tared.
    pub(super) tared: Option<Day> = "tared", Opt(DAY) => None;
    /// Calibration and tare of sensors; those that are not listed are nominal.
    pub(super) sensors: Vec<SensorRecord> = "sensors", SENSORS => Vec::new();
    /// Position maps of tiles, measured with pressed points.
    pub(super) maps: Vec<MapEntry> = "maps", MAPS => Vec::new();
    /// The amplifiers of the actuators.
    pub(super) drive: Drive = "drive", Rec => Drive::default();
    /// Response of the actuators without one of their own.
    pub(super) response: ResponseRecord = "", Flat;
    /// The actuators; by default each tile has one, channel by channel in tile order, from 0 in each area.
    pub(super) actuators: Option<Vec<ActuatorRecord>> = "actuators", Opt(ACTUATORS) => None;
    /// Loudspeakers beside the floor.
    pub(super) loudspeakers: Vec<LoudspeakerRecord> = "loudspeakers", LOUDSPEAKERS => Vec::new();
}

/// Maximum number of entries that switch sensors off.
const MOST_OFF: usize = TILES * Corner::ALL.len();

/// Maximum length of a path, in characters, as on Linux.
const MAX_PATH: usize = 4096;

/// Maximum number of networks that boards may send from.
const MAX_NETWORKS: usize = 256;

/// Maximum number of tiles of a floor.
const TILES: usize = (Geometry::MAX_SIDE as usize).pow(2);

const BOARDS: Distinct<BoardRecord> =
    Distinct { entry: "board", most: 16_384, about: BoardRecord::told_apart };

const SENSORS: Distinct<SensorRecord> = Distinct {
    entry: "sensor",
    most: TILES * Corner::ALL.len(),
    about: |_, sensor, fields, seen| {
        if !fields.have_failed(&["tile", "corner"]) {
            seen.check(fields, format!("the sensor of {}", sensor.id()), fields.span("tile"));
        }
    },
};

const MAPS: Distinct<MapEntry> = Distinct {
    entry: "map",
    most: TILES,
    about: |_, map, fields, seen| {
        if !fields.have_failed(&["tile"]) {
            seen.check(fields, format!("the map of tile {}", map.tile), fields.span("tile"));
        }
    },
};

const ACTUATORS: Distinct<ActuatorRecord> = Distinct {
    entry: "actuator",
    most: TILES,
    about: |_, actuator, fields, seen| {
        if !fields.have_failed(&["tile"]) {
            seen.check(fields, format!("the actuator of tile {}", actuator.tile), fields.span("tile"));
        }
    },
};

const LOUDSPEAKERS: Distinct<LoudspeakerRecord> = Distinct {
    entry: "loudspeaker",
    most: Loudspeaker::MOST,
    about: |_, loudspeaker, fields, seen| {
        if !fields.have_failed(&["channel"]) {
            let channel = &loudspeaker.channel;
            seen.check(fields, format!("channel {}", channel.value), channel.at.clone());
        }
    },
};

impl FloorFileRecord {
    /// Its name in files.
    pub(super) const NAME: &'static str = FloorHeadRecord::NAME;

    /// Reads the floor from `fields`.
    ///
    /// As in [`Record::read_fields`], a stand-in replaces an unreadable field. After an unreadable head, tiles are not
    /// checked.
    fn read(fields: &mut Fields<'_>) -> Self {
        let head = FloorHeadRecord::read_fields(fields, None, &());
        let valid = ValidTiles(fields.are_read().then_some(head.geometry));
        Self { head, parts: FloorPartsRecord::read_fields(fields, None, &valid) }
    }

    /// Returns the fields of the file that describes the floor.
    pub(super) fn written(&self) -> Vec<Entry> {
        let mut entries = Vec::new();
        self.head.write_fields(&mut entries);
        self.parts.write_fields(&mut entries);
        entries
    }

    /// Describes a floor and its fields.
    pub(super) fn describe() -> Description {
        let mut floor = FloorHeadRecord::describe();
        floor.fields.extend(FloorPartsRecord::describe().fields);
        floor
    }

    /// Makes the floor that the record describes.
    fn floor(&self) -> Floor {
        let parts = &self.parts;
        let mut floor =
            Floor::of(self.head.geometry).with_areas(parts.areas.iter().map(FloorAreaRecord::area).collect());
        if let Some(boards) = &parts.boards {
            floor.boards = boards
                .iter()
                .enumerate()
                .map(|(number, board)| board.board(number, &floor.geometry))
                .collect();
        }
        parts.sensors.iter().for_each(|sensor| sensor.apply(&mut floor));
        parts.maps.iter().for_each(|map| map.apply(&mut floor));
        if let Some(actuators) = &parts.actuators {
            floor.actuators.fill(None);
            actuators.iter().for_each(|actuator| actuator.apply(&mut floor));
        }
        for (own, actuator) in floor.responses.iter_mut().zip(&floor.actuators) {
            if let (None, Some(actuator)) = (&own, actuator) {
                *own = parts.response.of(actuator.full_scale);
            }
        }
        parts.off.iter().for_each(|off| off.apply(&mut floor));
        floor.gateway = parts.gateway;
        floor.key.clone_from(&parts.key);
        floor.noiseless = parts.noiseless;
        floor.tared = parts.tared;
        floor.allow.clone_from(&parts.allow);
        floor.serial = parts.serial.iter().map(|port| port.wire(&floor.boards)).collect();
        floor.drive = parts.drive;
        floor.loudspeakers = parts.loudspeakers.iter().map(LoudspeakerRecord::loudspeaker).collect();
        floor
    }

    /// Makes the record of `floor`; fields as on [`Floor::of`] its geometry are omitted.
    pub(super) fn of(floor: &Floor) -> Self {
        let usual = Floor::of(floor.geometry).with_areas(floor.areas.clone());
        let boards = (floor.boards != usual.boards).then(|| {
            (0..)
                .zip(&floor.boards)
                .map(|(number, board)| BoardRecord::of(board, number, &floor.geometry))
                .collect()
        });
        let (response, actuators) = all_actuators(floor);
        let is_usual =
            floor.actuators == usual.actuators && actuators.iter().all(|one| one.response.is_empty());
        let has_rates =
            floor.boards.iter().any(|board| board.rate_hz.is_some() || board.range != CountRange::WHOLE);
        let needed = [
            (has_rates, WITH_BOARD_RATES),
            (!floor.geometry.is_square_grid(), WITH_PLATES),
            (!floor.serial.is_empty(), WITH_SERIAL_PORTS),
            (!floor.off.is_empty(), WITH_SENSORS_OFF),
        ];
        let needed = needed.into_iter().filter_map(|(is_used, version)| is_used.then_some(version));
        let version = needed.max().unwrap_or(FIRST_VERSION);
        let head = FloorHeadRecord { version, geometry: floor.geometry };
        let parts = FloorPartsRecord {
            areas: floor.areas.iter().map(FloorAreaRecord::of).collect(),
            gateway: floor.gateway,
            key: floor.key.clone(),
            boards,
            allow: floor.allow.clone(),
            serial: floor.serial.iter().map(|wire| SerialRecord::of(wire, &floor.boards)).collect(),
            noiseless: floor.noiseless,
            off: OffRecord::all(floor),
            tared: floor.tared,
            sensors: SensorRecord::all(floor),
            maps: MapEntry::all(floor),
            drive: floor.drive,
            response,
            actuators: (!is_usual).then_some(actuators),
            loudspeakers: floor.loudspeakers.iter().map(LoudspeakerRecord::of).collect(),
        };
        Self { head, parts }
    }

    /// Reports rates and ranges of boards in a file of an older version.
    fn check_rates(&self, reader: &Reader<'_>) {
        let boards = self.parts.boards.iter().flatten();
        for at in boards.filter_map(BoardRecord::newer_at) {
            let things = ("rates and ranges of boards", WITH_BOARD_RATES);
            version::require(reader, at, things, ("floor", self.head.version));
        }
    }

    /// Reports loudspeakers on the channels of actuators.
    fn check_channels(&self, reader: &Reader<'_>, floor: &Floor) {
        for loudspeaker in self.parts.loudspeakers.iter().filter(|one| !one.channel.at.is_empty()) {
            let channel = &loudspeaker.channel;
            let area = floor.areas.iter().find(|area| area.holds(&floor.geometry, loudspeaker.at));
            let with_it = |tile| area.is_none_or(|area| area.tiles.contains(tile));
            let mut moved = floor.geometry.tiles().zip(&floor.actuators).filter(|(tile, _)| with_it(*tile));
            let is_taken = |(_, one): &(_, &Option<crate::floor::Actuator>)| {
                one.is_some_and(|one| one.channel == channel.value)
            };
            let Some((tile, _)) = moved.find(is_taken) else { continue };
            let message = format!("channel {} moves tile {tile} already", channel.value);
            let problem =
                Problem::error(channel.at.clone(), message).expected("expected a channel of its own");
            reader.report(problem.help(format!("channel {} is free", floor.channel_count())));
        }
    }
}
