//! The sensors that a floor file switches off.

use std::ops::Range;

use super::floor_codecs::{SENSOR, SensorName, TILE, ValidTiles};
use super::problem::Problem;
use super::reader::Reader;
use crate::floor::{Corner, Floor, Geometry, SensorChoice, SensorId, TileId};
use underfoot_format::codec::{At, Written};
use underfoot_format::{Opt, num, record};

record! {
    /// Sensors that are switched off: all of a tile, one of them, or the one on a channel.
    pub(super) struct OffRecord = "Off" with ValidTiles => |it, faults| {
        faults.together(&["board", "channel"], [it.board.is_some(), it.channel.is_some()]);
        match (&it.tile, &it.corner, &it.board) {
            (Some(_), _, Some(_)) => {
                faults.error(&["board", "tile"], "a sensor is named by its tile or by its channel", "one too many");
            }
            (None, Some(_), _) => {
                faults.error(&["corner"], "this corner needs its tile", "of which tile?");
                faults.help("write tile: (column, row) before it");
            }
            (None, None, None) => {
                faults.error(&["tile", "board"], "this names no sensor", "which one is off?");
                faults.help("write (tile: (0, 0)), (tile: (0, 0), corner: Sw) or (board: 0, channel: 3)");
            }
            _ => {}
        }
    };
    /// The tile: all of its sensors, or one with `corner`.
    tile: Option<Written<TileId>> = "tile", Opt(At(TILE)) => None;
    /// The corner of the tile, or the sensor's number in `sensors_m`.
    corner: Option<Written<SensorName>> = "corner", Opt(At(SENSOR)) => None;
    /// Number of the board of a channel, from 0.
    board: Option<Written<u16>> = "board", Opt(At(num(0.0..=16_383.0))) => None;
    /// Number of the channel, from 0.
    channel: Option<Written<u16>> = "channel", Opt(At(num(0.0..=4095.0))) => None;
}

impl OffRecord {
    /// The sensors that it names, and where; `None` for a record that names none.
    fn choice(&self) -> Option<(SensorChoice, Range<usize>)> {
        match (&self.tile, &self.corner, &self.board, &self.channel) {
            (Some(tile), None, ..) => Some((SensorChoice::Tile(tile.value), tile.at.clone())),
            (Some(tile), Some(corner), ..) => {
                let sensor = SensorId { tile: tile.value, corner: corner.value.sensor };
                Some((SensorChoice::Sensor(sensor), corner.at.clone()))
            }
            (None, None, Some(board), Some(channel)) => {
                let choice = SensorChoice::Channel { board: board.value, channel: channel.value };
                Some((choice, channel.at.clone()))
            }
            _ => None,
        }
    }

    pub(super) fn apply(&self, floor: &mut Floor) {
        let chosen = self.choice().and_then(|(choice, _)| choice.sensors(floor).ok());
        for sensor in chosen.into_iter().flatten() {
            floor.switch(sensor, false);
        }
    }

    /// Reports sensors that `floor` does not have.
    pub(super) fn check(&self, reader: &Reader<'_>, floor: &Floor) {
        let Some((choice, at)) = self.choice() else { return };
        if let Err(none) = choice.sensors(floor) {
            reader.report(Problem::error(at, none.to_string()).expected("expected one of its sensors"));
        }
    }

    /// Returns the records of all sensors of `floor` that are off: whole tiles where all of their sensors are.
    pub(super) fn all(floor: &Floor) -> Vec<Self> {
        let is_off = |tile: TileId, corner: Corner| floor.off.contains(&SensorId { tile, corner });
        let none = || Self { tile: None, corner: None, board: None, channel: None };
        let of_tile = |tile: TileId, geometry: &Geometry| -> Vec<Self> {
            let sensors = geometry.sensors(tile);
            if !sensors.is_empty() && sensors.iter().all(|corner| is_off(tile, *corner)) {
                return vec![Self { tile: Some(tile.into()), ..none() }];
            }
            let off = sensors.iter().filter(|corner| is_off(tile, **corner));
            off.map(|&corner| {
                let name = SensorName::of(corner, geometry);
                Self { tile: Some(tile.into()), corner: Some(name.into()), ..none() }
            })
            .collect()
        };
        if floor.off.is_empty() {
            return Vec::new();
        }
        floor.geometry.tiles().flat_map(|tile| of_tile(tile, &floor.geometry)).collect()
    }
}
