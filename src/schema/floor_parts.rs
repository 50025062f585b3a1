//! The parts of floor files: boards, sensors, position maps, actuators, loudspeakers.

use glam::Vec2;

use super::fields::Fields;
use super::floor_codecs::{
    CHANNEL as SENSOR_OF_CHANNEL, ChannelSensor, Points, SENSOR, SensorName, TILE, Table, ValidTiles,
};
use super::problem::Problem;
use super::reader::Reader;
use crate::floor::{
    Actuator, Board, Calibration, CalibrationRecord, Corner, CountRange, CountSign, DAY, Day, Floor,
    Geometry, Loudspeaker, MapRecord, PositionMap, Response, SensorId, TileId,
};
use crate::units::Newtons;
use crate::wire::MAX_CHANNELS;
use underfoot_format::codec::{At, Beside, Seen, Spelled, Written};
use underfoot_format::{Faults, Flat, Name, Num, Opt, Pair, list, num, record};
use underfoot_packet::BoardAddress;

record! {
    /// A board and its sensors, as whole tiles or sensor by sensor.
    pub(super) struct BoardRecord = "Board" with ValidTiles => BoardRecord::rules;
    /// OSC address of its packets; by default `/underfoot/board/` and its number, from 0.
    address: Option<String> = "address", Opt(ADDRESS) => None;
    /// Tiles, each with a channel for each of its sensors, in the order sw, se, nw, ne or of `sensors_m`.
    tiles: Option<Vec<Written<TileId>>> = "tiles",
        Opt(list("tile", MAX_CHANNELS / Corner::ALL.len(), At(TILE))) => None;
    /// The sensor on each channel, in the order of the packet's arguments.
    channels: Option<Vec<Written<Option<ChannelSensor>>>> = "channels",
        Opt(list("channel", MAX_CHANNELS, At(SENSOR_OF_CHANNEL))) => None;
    /// Packets a second; they are measured if it is not written.
    rate_hz: Option<Written<f32>> = "rate_hz", Opt(At(num(10.0..=4000.0))) => None;
    /// The greatest count, at the converter's full voltage: 1023 with 10 bits, 16777215 with 24 bits.
    full_scale: Option<Written<u32>> = "full_scale", Opt(At(num(1.0..=CountRange::MOST as f64))) => None;
    /// The sign of the counts.
    counts: Option<Written<CountSign>> = "counts", Opt(At(Name)) => None;
}

/// A literal OSC address, without pattern characters.
const ADDRESS: Spelled<String> = Spelled {
    about: "an OSC address in quotes",
    parse: |text| {
        let legal = |c: char| c.is_ascii_alphanumeric() || matches!(c, '/' | '_' | '-' | '.');
        let is_address =
            text.len() > 1 && text.starts_with('/') && !text.ends_with('/') && text.chars().all(legal);
        is_address.then(|| text.to_owned())
    },
    wrong: |name, _| format!("`{name}` is no OSC address"),
    expected: "expected parts of a-z, A-Z, 0-9, `_`, `-` and `.`, each after a `/`",
    help: |_| Some("write \"/underfoot/board/0\"".to_owned()),
    stand_in: String::new(),
};

impl BoardRecord {
    fn rules(&mut self, faults: &mut Faults) {
        match (&self.tiles, &self.channels) {
            (None, None) => {
                let message = "this board has neither `tiles` nor `channels`";
                faults.error(&["tiles", "channels"], message, "what does it measure?");
                faults.help("add tiles: [(0, 0), (1, 0)]: four channels each, sw se nw ne");
            }
            (Some(_), Some(_)) => {
                let message = "a board has `tiles` or `channels`, not both";
                faults.error(&["channels", "tiles"], message, "one too many");
            }
            _ => {}
        }
    }

    /// Reports boards with the same address, and channels with the same sensor.
    pub(super) fn told_apart(number: usize, board: &Self, fields: &Fields<'_>, seen: &mut Seen) {
        if !fields.have_failed(&["address"]) {
            let address = board.address.clone().unwrap_or_else(|| BoardAddress(number).to_string());
            seen.check(fields, format!("the address {address}"), fields.span("address"));
        }
        for (sensor, span) in board.sensors(|_| &Corner::ALL) {
            if let Some(sensor) = sensor {
                seen.check(fields, format!("the sensor of {sensor}"), span);
            }
        }
    }

    /// Returns the sensor of each channel, and its place in the text; `under` returns the sensors of a tile.
    fn sensors(
        &self,
        under: impl Fn(TileId) -> &'static [Corner],
    ) -> Vec<(Option<SensorId>, std::ops::Range<usize>)> {
        let of_tile = |tile: &Written<TileId>| {
            let (id, at) = (tile.value, tile.at.clone());
            under(id).iter().map(move |&corner| (Some(SensorId { tile: id, corner }), at.clone()))
        };
        match (&self.tiles, &self.channels) {
            (Some(tiles), None) => tiles.iter().flat_map(of_tile).collect(),
            (None, Some(channels)) => {
                let id = |channel: &Written<Option<ChannelSensor>>| channel.value.map(ChannelSensor::id);
                channels.iter().map(|channel| (id(channel), channel.at.clone())).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Makes the board with this number on a floor of this `geometry`.
    pub(super) fn board(&self, number: usize, geometry: &Geometry) -> Board {
        let address = self.address.clone().unwrap_or_else(|| BoardAddress(number).to_string());
        let sensors = self.sensors(|tile| geometry.sensors(tile));
        let channels = sensors.into_iter().map(|(sensor, _)| sensor).collect();
        let sign = self.counts.as_ref().map_or(CountSign::Unsigned, |sign| sign.value);
        let usual = CountRange { full_scale: CountRange::usual(sign), sign };
        let range =
            self.full_scale.as_ref().map_or(usual, |full| CountRange { full_scale: full.value, sign });
        Board { rate_hz: self.rate_hz.as_ref().map(|hz| hz.value), range, ..Board::new(address, channels) }
    }

    /// The place of its first field that needs a newer version of the format.
    pub(super) fn newer_at(&self) -> Option<std::ops::Range<usize>> {
        let rate = self.rate_hz.as_ref().map(|rate| rate.at.clone());
        let full_scale = self.full_scale.as_ref().map(|full_scale| full_scale.at.clone());
        let counts = self.counts.as_ref().map(|counts| counts.at.clone());
        rate.or(full_scale).or(counts)
    }

    /// Reports channels of sensors that a plate on three legs does not have.
    pub(super) fn check_sensors(&self, reader: &Reader<'_>, geometry: &Geometry) {
        for (sensor, at) in self.sensors(|tile| geometry.sensors(tile)) {
            check_sensor(reader, geometry, sensor, at);
        }
    }

    pub(super) fn of(board: &Board, number: usize, geometry: &Geometry) -> Self {
        let address = (board.address != BoardAddress(number).to_string()).then(|| board.address.clone());
        let tiles = whole_tiles(&board.channels, geometry);
        let written =
            |sensor: &Option<SensorId>| sensor.map(|sensor| ChannelSensor::of(sensor, geometry)).into();
        let channels = tiles.is_none().then(|| board.channels.iter().map(written).collect());
        let CountRange { full_scale, sign } = board.range;
        Self {
            address,
            tiles,
            channels,
            rate_hz: board.rate_hz.map(Written::from),
            full_scale: (full_scale != CountRange::usual(sign)).then(|| full_scale.into()),
            counts: (sign != CountSign::Unsigned).then(|| sign.into()),
        }
    }
}

/// Returns the tiles on some channels; `None` unless each has all of its sensors, in the usual order.
fn whole_tiles(mut channels: &[Option<SensorId>], geometry: &Geometry) -> Option<Vec<Written<TileId>>> {
    let mut tiles = Vec::new();
    while let Some(first) = channels.first() {
        let tile = (*first)?.tile;
        let usual = geometry.sensors(tile);
        let (own, rest) = channels.split_at_checked(usual.len().max(1))?;
        let is_usual =
            |(&corner, sensor): (&Corner, &Option<SensorId>)| *sensor == Some(SensorId { tile, corner });
        if usual.is_empty() || !usual.iter().zip(own).all(is_usual) {
            return None;
        }
        tiles.push(tile.into());
        channels = rest;
    }
    Some(tiles)
}

/// Reports a sensor at `at` that its tile does not have.
fn check_sensor(
    reader: &Reader<'_>,
    geometry: &Geometry,
    sensor: Option<SensorId>,
    at: std::ops::Range<usize>,
) {
    let Some(SensorId { tile, corner }) = sensor else { return };
    let sensors = geometry.sensors(tile);
    if sensors.is_empty() || sensors.contains(&corner) {
        return;
    }
    let message = format!("the plate of tile {tile} has no sensor {}", corner.index());
    reader.report(Problem::error(at, message).expected("expected a sensor from 0 to 2"));
}

record! {
    /// Calibration and tare of one sensor.
    pub(super) struct SensorRecord = "Sensor" with ValidTiles => |it, faults| {
        faults.together(&["calibrated", "residual"], [it.calibrated.is_some(), it.residual.is_some()]);
    };
    /// The tile above it.
    tile: TileId = "tile", TILE;
    /// The corner of the tile, or the sensor's number in `sensors_m`.
    corner: Written<SensorName> = "corner", At(SENSOR);
    /// The law that converts its voltage to newtons.
    law: Calibration = "law", Beside => Calibration::NOMINAL;
    /// Its reading on the empty floor.
    tare: Newtons = "tare_n", num(-5000.0..=5000.0).explicit() => Newtons::ZERO;
    /// The day on which its law was measured.
    calibrated: Option<Day> = "calibrated", Opt(DAY) => None;
    /// Root mean square of the law's error, as a share of the greatest force measured.
    residual: Option<f32> = "residual", Opt(num(0.0..=1e6)) => None;
}

impl SensorRecord {
    pub(super) fn id(&self) -> SensorId {
        SensorId { tile: self.tile, corner: self.corner.value.sensor }
    }

    /// Reports a sensor that its tile does not have.
    pub(super) fn check_sensor(&self, reader: &Reader<'_>, geometry: &Geometry) {
        check_sensor(reader, geometry, Some(self.id()), self.corner.at.clone());
    }

    pub(super) fn apply(&self, floor: &mut Floor) {
        let (Some(tile), corner) = (floor.geometry.index(self.tile), self.id().corner.index()) else {
            return;
        };
        let record = self.calibrated.zip(self.residual);
        let record = record.map(|(day, residual)| CalibrationRecord { day, residual });
        if let (Some(laws), Some(tares), Some(records)) = (
            floor.calibration.get_mut(tile),
            floor.tare.get_mut(tile),
            floor.calibration_records.get_mut(tile),
        ) {
            (laws[corner], tares[corner], records[corner]) = (self.law, self.tare, record);
        }
    }

    /// Returns the records of all sensors of `floor` that differ from the nominal one.
    pub(super) fn all(floor: &Floor) -> Vec<Self> {
        let tiles = floor.calibration.iter().zip(&floor.tare).zip(&floor.calibration_records);
        let sensors = floor.geometry.tiles().zip(tiles).flat_map(|(tile, ((laws, tares), records))| {
            floor.geometry.sensors(tile).iter().map(move |&corner| {
                let index = corner.index();
                let record = records[index];
                Self {
                    tile,
                    corner: SensorName::of(corner, &floor.geometry).into(),
                    law: laws[index],
                    tare: tares[index],
                    calibrated: record.map(|record| record.day),
                    residual: record.map(|record| record.residual),
                }
            })
        });
        let is_known = |sensor: &Self| {
            sensor.law != Calibration::NOMINAL || sensor.tare != Newtons::ZERO || sensor.calibrated.is_some()
        };
        sensors.filter(is_known).collect()
    }

    pub(super) fn law(&self) -> Calibration {
        self.law
    }
}

record! {
    /// The position map of one tile: measured, not edited.
    pub(super) struct MapEntry = "Map" with ValidTiles => |it, faults| {
        faults.together(&["mapped", "residual_m"], [it.mapped.is_some(), it.residual_m.is_some()]);
    };
    /// The tile.
    pub(super) tile: TileId = "tile", TILE;
    /// The day on which it was measured.
    mapped: Option<Day> = "mapped", Opt(DAY) => None;
    /// Position error with the map that 95 % of the points do not exceed.
    residual_m: Option<f32> = "residual_m", Opt(num(0.0..=10.0)) => None;
    /// For each sensor, the number added to a factor of one at each of 21 loads.
    trims: [[f32; PositionMap::TRIMS]; 4] = "trims", Table(PositionMap::MOST_TRIM) => PositionMap::NONE.trims;
    /// For the shift east and north, the coefficient of each of ten terms.
    bends: [[f32; PositionMap::BENDS]; 2] = "bends", Table(PositionMap::MOST_BEND) => PositionMap::NONE.bends;
}

impl MapEntry {
    pub(super) fn apply(&self, floor: &mut Floor) {
        let Some(tile) = floor.geometry.index(self.tile) else { return };
        let Self { trims, bends, .. } = *self;
        let residual_m = self.residual_m.unwrap_or(PositionMap::SOME_RESIDUAL_M);
        let record = self.mapped.zip(self.residual_m);
        if let (Some(map), Some(old)) = (floor.position_maps.get_mut(tile), floor.map_records.get_mut(tile)) {
            *map = Some(PositionMap { trims, bends, residual_m });
            *old = record.map(|(day, residual_m)| MapRecord { day, residual_m });
        }
    }

    /// Returns the position maps of all tiles of `floor`.
    pub(super) fn all(floor: &Floor) -> Vec<Self> {
        let maps = floor.geometry.tiles().zip(floor.position_maps.iter().zip(&floor.map_records));
        let entry = |(tile, (map, record)): (TileId, (&Option<PositionMap>, &Option<MapRecord>))| {
            let PositionMap { trims, bends, .. } = (*map)?;
            let (mapped, residual_m) = (record.map(|it| it.day), record.map(|it| it.residual_m));
            Some(Self { tile, mapped, residual_m, trims, bends })
        };
        maps.filter_map(entry).collect()
    }
}

record! {
    /// Frequency response of an actuator.
    pub(super) struct ResponseRecord = "Response" => |it, faults| {
        if it.decibels.is_some() && it.newtons.is_some() {
            let message = "there is `response_db` or `response_n`, not both";
            faults.error(&["response_n", "response_db"], message, "one too many");
        }
    };
    /// At each frequency, decibels relative to `full_scale_n`.
    decibels: Option<Vec<(f32, f32)>> = "response_db", Opt(Points(-100.0, 60.0)) => None;
    /// At each frequency, newtons of a full-scale sine.
    newtons: Option<Vec<(f32, f32)>> = "response_n", Opt(Points(1e-4, 10_000.0)) => None;
}

impl ResponseRecord {
    /// Returns the response of an actuator with nominal force `full_scale`; `None` if none is written.
    pub(super) fn of(&self, full_scale: Newtons) -> Option<Response> {
        let newtons = self.newtons.as_ref().and_then(|points| Response::of_newtons(points, full_scale));
        newtons.or_else(|| Response::of(self.decibels.clone()?))
    }

    pub(super) fn is_empty(&self) -> bool {
        self.decibels.is_none() && self.newtons.is_none()
    }
}

record! {
    /// The actuator under one tile.
    pub(super) struct ActuatorRecord = "Actuator" with ValidTiles;
    /// The tile.
    pub(super) tile: TileId = "tile", TILE;
    /// Output channel, from 0.
    channel: u16 = "channel", CHANNEL;
    /// Force at the plate for a full-scale sample.
    full_scale: Newtons = "full_scale_n", num(0.1..=10_000.0).explicit() => Actuator::nominal(0).full_scale;
    /// Its own response, if it differs from the common one.
    pub(super) response: ResponseRecord = "", Flat;
}

/// Valid output channels of a device.
const CHANNEL: Num = num(0.0..=4095.0);

impl ActuatorRecord {
    pub(super) fn apply(&self, floor: &mut Floor) {
        let Some(tile) = floor.geometry.index(self.tile) else { return };
        let slots = (floor.actuators.get_mut(tile), floor.responses.get_mut(tile));
        if let (Some(actuator), Some(response)) = slots {
            *actuator = Some(Actuator { channel: self.channel, full_scale: self.full_scale });
            *response = self.response.of(self.full_scale);
        }
    }
}

/// Returns the common response of the actuators of `floor`, and the actuators with their own.
pub(super) fn all_actuators(floor: &Floor) -> (ResponseRecord, Vec<ActuatorRecord>) {
    let moved = || floor.actuators.iter().zip(&floor.responses).filter(|(actuator, _)| actuator.is_some());
    let first = moved().next().and_then(|(_, response)| response.as_ref());
    let common = first.filter(|first| moved().all(|(_, own)| own.as_ref() == Some(*first)));
    let written = |response: Option<&Response>| ResponseRecord {
        decibels: response.map(|response| response.points().to_vec()),
        newtons: None,
    };
    let all = floor.geometry.tiles().zip(floor.actuators.iter().zip(&floor.responses));
    let actuators = all.filter_map(|(tile, (actuator, own))| {
        let Actuator { channel, full_scale } = (*actuator)?;
        let response = written(own.as_ref().filter(|_| common.is_none()));
        Some(ActuatorRecord { tile, channel, full_scale, response })
    });
    (written(common), actuators.collect())
}

record! {
    /// A loudspeaker beside the floor.
    pub(super) struct LoudspeakerRecord = "Loudspeaker";
    /// Its place, from the floor's south-west corner; may be outside of the floor.
    pub(super) at: Vec2 = "at_m", Pair { each: num(-1000.0..=1000.0), pattern: "(east, north)", parts: ["east", "north"] };
    /// Output channel, from 0.
    pub(super) channel: Written<u16> = "channel", At(CHANNEL);
    /// Its gain: at 0, a cue of 40 N with sound 1 is a full-scale sample.
    gain_db: f32 = "gain_db", num(-60.0..=24.0).explicit() => 0.0;
}

impl LoudspeakerRecord {
    pub(super) fn loudspeaker(&self) -> Loudspeaker {
        Loudspeaker { at: self.at, channel: self.channel.value, gain_db: self.gain_db }
    }

    pub(super) fn of(loudspeaker: &Loudspeaker) -> Self {
        let Loudspeaker { at, channel, gain_db } = *loudspeaker;
        Self { at, channel: channel.into(), gain_db }
    }
}
