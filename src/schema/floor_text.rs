//! Floor files, written.

use std::fmt::Write;

use super::floor::usual_address;
use super::floor_sensors::LAWS;
use super::version::FORMAT_VERSION;
use crate::floor::{
    Actuator, Board, Calibration, Corner, Drive, Floor, LawKind, Loudspeaker, MapRecord, SensorId, TileId,
};
use crate::units::Newtons;

/// The file that describes `floor`, with comments; [`super::parse_floor`] reads the same floor from it.
///
/// What is as on [`Floor::of`] its geometry is left out. A list of more than
/// about 40,000 sensors, or 4,000 mapped tiles, is longer than the 4 MB that are read
/// back; that and numbers outside of the ranges that files may hold are refused on
/// reading ([`super::save_floor`] refuses them on writing).
#[must_use]
pub fn write_floor(floor: &Floor) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write(floor, &mut text);
    text
}

fn write(floor: &Floor, text: &mut String) -> std::fmt::Result {
    let geometry = &floor.geometry;
    let usual = Floor::of(*geometry);
    writeln!(text, "// A floor: where its tiles are and what is wired to them.")?;
    writeln!(text, "// Tiles are (column, row) from the south-west, lengths in metres, forces in newtons.")?;
    writeln!(text, "Floor(")?;
    writeln!(text, "    version: {FORMAT_VERSION},")?;
    writeln!(text, "    columns: {},", geometry.columns())?;
    writeln!(text, "    rows: {},", geometry.rows())?;
    writeln!(text, "    tile_m: {:?},", geometry.tile_m())?;
    writeln!(text, "    pitch_m: {:?},", geometry.pitch_m())?;
    writeln!(text, "    sensor_inset_m: {:?},", geometry.sensor_inset_m())?;
    writeln!(text)?;
    if floor.boards == usual.boards {
        writeln!(text, "    // Each row of tiles has its own boards, up to eight tiles a board.")?;
    } else {
        writeln!(text, "    // Which tiles, or which sensors, are on the channels of each board.")?;
        writeln!(text, "    boards: [")?;
        for (number, board) in floor.boards.iter().enumerate() {
            write_board(board, number, text)?;
        }
        writeln!(text, "    ],")?;
    }
    write_allow(floor, text)?;
    write_sensors(floor, text)?;
    write_maps(floor, text)?;
    write_sound(floor, &usual, text)?;
    writeln!(text, ")")
}

fn write_allow(floor: &Floor, text: &mut String) -> std::fmt::Result {
    if floor.allow.is_empty() {
        return Ok(());
    }
    let networks: Vec<String> = floor.allow.iter().map(|network| format!("\"{network}\"")).collect();
    writeln!(text, "    // Where the boards' packets come from.")?;
    writeln!(text, "    allow: [{}],", networks.join(", "))
}

fn write_board(board: &Board, number: usize, text: &mut String) -> std::fmt::Result {
    write!(text, "        (")?;
    if board.address != usual_address(number) {
        write!(text, "address: {:?}, ", board.address)?;
    }
    if let Some(tiles) = whole_tiles(&board.channels) {
        let tiles: Vec<String> = tiles.into_iter().map(place).collect();
        writeln!(text, "tiles: [{}]),", tiles.join(", "))
    } else {
        let channels: Vec<String> = board.channels.iter().map(channel).collect();
        writeln!(text, "channels: [{}]),", channels.join(", "))
    }
}

/// The tiles of a board that has all four sensors of each in the usual order.
fn whole_tiles(channels: &[Option<SensorId>]) -> Option<Vec<TileId>> {
    channels
        .chunks(Corner::ALL.len())
        .map(|four| {
            let tile = four.first().copied().flatten()?.tile;
            let usual = Corner::ALL.map(|corner| Some(SensorId { tile, corner }));
            (four == usual).then_some(tile)
        })
        .collect()
}

fn channel(sensor: &Option<SensorId>) -> String {
    match sensor {
        Some(SensorId { tile, corner }) => format!("({}, {}, {})", tile.column, tile.row, variant(*corner)),
        None => "None".into(),
    }
}

fn write_sensors(floor: &Floor, text: &mut String) -> std::fmt::Result {
    if let Some(day) = floor.tared {
        writeln!(text, "    tared: \"{day}\",")?;
    }
    let tiles = floor.calibration.iter().zip(&floor.tare).zip(&floor.calibration_records);
    let measured: Vec<_> = floor
        .geometry
        .tiles()
        .zip(tiles)
        .flat_map(|(tile, ((laws, tares), records))| {
            Corner::ALL.map(|corner| {
                let index = corner.index();
                (tile, corner, laws[index], tares[index], records[index])
            })
        })
        .filter(|(.., law, tare, record)| {
            *law != Calibration::NOMINAL || *tare != Newtons::ZERO || record.is_some()
        })
        .collect();
    if measured.is_empty() {
        return writeln!(text, "    // No sensor has been calibrated: all are taken as nominal parts.");
    }
    writeln!(
        text,
        "    // f = a exp(b v) with v in volts, then the tare is taken off. Sensors that are not listed are nominal."
    )?;
    let kinds: Vec<LawKind> = measured.iter().map(|(_, _, law, ..)| law.kind()).collect();
    write_other_laws(&kinds, text)?;
    writeln!(text, "    sensors: [")?;
    for (tile, corner, law, Newtons(tare), record) in measured {
        let (tile, corner) = (place(tile), variant(corner));
        write!(text, "        (tile: {tile}, corner: {corner}, ")?;
        write_law(law, text)?;
        write!(text, ", tare_n: {tare:?}")?;
        if let Some(record) = record {
            write!(text, ", calibrated: \"{}\", residual: {:?}", record.day, record.residual)?;
        }
        writeln!(text, "),")?;
    }
    writeln!(text, "    ],")
}

/// What the laws other than the paper's mean, of those that the floor has.
fn write_other_laws(kinds: &[LawKind], text: &mut String) -> std::fmt::Result {
    for kind in LawKind::ALL {
        let meaning = match kind {
            LawKind::Exponential => continue,
            LawKind::Power => "Power: f = a_n v^exponent.",
            LawKind::Divider => "Divider: f = a_n v / (supply_v - v).",
            LawKind::Linear => "Linear: f = a_n_per_volt (v - zero_v).",
        };
        if kinds.contains(&kind) {
            writeln!(text, "    // {meaning}")?;
        }
    }
    Ok(())
}

/// The law's name, unless it is the paper's, and its two numbers.
fn write_law(law: Calibration, text: &mut String) -> std::fmt::Result {
    let kind = law.kind();
    if let Some((name, _)) =
        LAWS.into_iter().find(|(_, named)| *named == kind && kind != LawKind::Exponential)
    {
        write!(text, "law: {name}, ")?;
    }
    let ([a, b], [a_number, b_number]) = (kind.parameters(), law.numbers());
    write!(text, "{}: {a_number:?}, {}: {b_number:?}", a.name, b.name)
}

fn write_maps(floor: &Floor, text: &mut String) -> std::fmt::Result {
    let maps = floor.geometry.tiles().zip(floor.position_maps.iter().zip(&floor.map_records));
    let mut mapped = maps.filter_map(|(tile, (map, record))| Some((tile, map.as_ref()?, record))).peekable();
    if mapped.peek().is_none() {
        return Ok(());
    }
    writeln!(
        text,
        "    // What pressed points taught of each tile: a factor per sensor that follows its load,"
    )?;
    writeln!(text, "    // and a shift of the position. Measure them anew rather than edit them.")?;
    writeln!(text, "    maps: [")?;
    for (tile, map, record) in mapped {
        write!(text, "        (tile: {}, ", place(tile))?;
        if let Some(MapRecord { day, residual_m }) = record {
            write!(text, "mapped: \"{day}\", residual_m: {residual_m:?}, ")?;
        }
        writeln!(text, "trims: {:?}, bends: {:?}),", map.trims, map.bends)?;
    }
    writeln!(text, "    ],")
}

fn write_sound(floor: &Floor, usual: &Floor, text: &mut String) -> std::fmt::Result {
    let Drive { full_scale_v, load_ohm, long_term_w } = floor.drive;
    if floor.drive != usual.drive {
        writeln!(
            text,
            "    // What drives the actuators: volts at full scale, and what a coil takes for ever."
        )?;
        writeln!(
            text,
            "    drive: (full_scale_v: {full_scale_v:?}, load_ohm: {load_ohm:?}, long_term_w: {long_term_w:?}),"
        )?;
    }
    let moved = || floor.actuators.iter().zip(&floor.responses).filter(|(actuator, _)| actuator.is_some());
    let first = moved().next().and_then(|(_, response)| response.as_ref());
    let common = first.filter(|first| moved().all(|(_, own)| own.as_ref() == Some(*first)));
    if let Some(common) = common {
        writeln!(text, "    // How strongly the plates move: hertz, and decibels relative to full_scale_n.")?;
        writeln!(text, "    response_db: {:?},", common.points())?;
    }
    let own = |index: usize| floor.responses.get(index).and_then(Option::as_ref).filter(|_| common.is_none());
    if floor.actuators == usual.actuators && (0..floor.responses.len()).all(|index| own(index).is_none()) {
        writeln!(text, "    // Each tile has an actuator, channel by channel in tile order.")?;
    } else {
        writeln!(text, "    // Output channels; tiles that are not listed have no actuator.")?;
        writeln!(text, "    actuators: [")?;
        for (index, (tile, actuator)) in floor.geometry.tiles().zip(&floor.actuators).enumerate() {
            let Some(Actuator { channel, full_scale }) = actuator else { continue };
            let tile = place(tile);
            write!(text, "        (tile: {tile}, channel: {channel}, full_scale_n: {:?}", full_scale.0)?;
            if let Some(response) = own(index) {
                write!(text, ", response_db: {:?}", response.points())?;
            }
            writeln!(text, "),")?;
        }
        writeln!(text, "    ],")?;
    }
    if !floor.loudspeakers.is_empty() {
        writeln!(text, "    // Loudspeakers, by where they stand, in metres from the south-west corner.")?;
        writeln!(text, "    loudspeakers: [")?;
        for Loudspeaker { at, channel, gain_db } in &floor.loudspeakers {
            let (east, north) = (at.x, at.y);
            writeln!(
                text,
                "        (at_m: ({east:?}, {north:?}), channel: {channel}, gain_db: {gain_db:?}),"
            )?;
        }
        writeln!(text, "    ],")?;
    }
    Ok(())
}

fn place(tile: TileId) -> String {
    format!("({}, {})", tile.column, tile.row)
}

fn variant(corner: Corner) -> &'static str {
    match corner {
        Corner::SouthWest => "Sw",
        Corner::SouthEast => "Se",
        Corner::NorthWest => "Nw",
        Corner::NorthEast => "Ne",
    }
}
