//! The areas of a floor that several computers serve.

use std::net::SocketAddr;

use super::fields::Fields;
use super::floor_codecs::{CELL, TILES, ValidTiles};
use super::problem::Problem;
use super::reader::Reader;
use crate::floor::{ADDRESS, Area, Geometry, TileBlock, TileId};
use underfoot_format::codec::{At, Distinct, Seen, Written};
use underfoot_format::{Id, Opt, record};

record! {
    /// The tiles of a large floor that one computer serves.
    pub(super) struct FloorAreaRecord = "Area" with ValidTiles;
    /// Unique among the floor's areas.
    id: Written<String> = "id", At(Id);
    /// Its tile in the south-west corner.
    first: TileId = "at", CELL;
    /// Its width and depth in tiles.
    size: [u16; 2] = "size", TILES;
    /// Address on which its computer receives the packets of its boards, and those that its neighbours forward.
    listen: Option<Written<SocketAddr>> = "listen", Opt(At(ADDRESS)) => None;
}

/// The areas of a floor; 1024 are more than any floor has.
pub(super) const AREAS: Distinct<FloorAreaRecord> =
    Distinct { entry: "area", most: 1024, about: FloorAreaRecord::told_apart };

impl FloorAreaRecord {
    fn told_apart(_: usize, area: &Self, fields: &Fields<'_>, seen: &mut Seen) {
        if !fields.have_failed(&["id"]) {
            seen.check(fields, format!("the area \"{}\"", area.id.value), area.id.at.clone());
        }
    }

    pub(super) fn area(&self) -> Area {
        let [columns, rows] = self.size;
        let tiles = TileBlock { first: self.first, columns, rows };
        let listen = self.listen.as_ref().map(|listen| listen.value);
        Area { id: self.id.value.clone(), tiles, listen }
    }

    pub(super) fn of(area: &Area) -> Self {
        let TileBlock { first, columns, rows } = area.tiles;
        Self {
            id: area.id.clone().into(),
            first,
            size: [columns, rows],
            listen: area.listen.map(Written::from),
        }
    }
}

/// Reports areas that leave the floor or share tiles, and tiles outside of all areas.
pub(super) fn check(reader: &Reader<'_>, geometry: &Geometry, records: &[FloorAreaRecord]) {
    let floor = geometry.block();
    let blocks: Vec<TileBlock> = records.iter().map(|record| record.area().tiles).collect();
    let mut sound = true;
    for (number, (record, block)) in records.iter().zip(&blocks).enumerate() {
        let mut report = |message: String, expected: String| {
            sound = false;
            reader.report(Problem::error(record.id.at.clone(), message).expected(expected));
        };
        let id = &record.id.value;
        if block.common(&floor) != *block {
            report(format!("the area \"{id}\" has tiles beyond the floor"), format!("the floor has {floor}"));
        }
        let both = |(_, other): &(&FloorAreaRecord, &TileBlock)| !other.common(block).is_empty();
        if let Some((other, shared)) = records.iter().zip(&blocks).take(number).find(both) {
            let tile = shared.common(block).first;
            let message = format!("the areas \"{}\" and \"{id}\" share tile {tile}", other.id.value);
            report(message, "expected each tile in one area".into());
        }
    }
    for (number, record) in records.iter().enumerate() {
        let Some(listen) = &record.listen else { continue };
        let is_same =
            |other: &&FloorAreaRecord| other.listen.as_ref().is_some_and(|one| one.value == listen.value);
        if let Some(other) = records.iter().take(number).find(is_same) {
            let message =
                format!("the areas \"{}\" and \"{}\" have one address", other.id.value, record.id.value);
            let problem = Problem::error(listen.at.clone(), message);
            reader.report(problem.expected("expected an address for each computer"));
        }
    }
    let Some(last) = records.last().filter(|_| sound) else { return };
    if let Some(bare) = geometry.tiles().find(|tile| !blocks.iter().any(|block| block.contains(*tile))) {
        let problem = Problem::error(last.id.at.clone(), format!("tile {bare} is in no area"));
        reader.report(problem.expected("expected areas that cover the floor"));
    }
}
