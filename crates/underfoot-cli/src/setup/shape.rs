//! The shape of the floor, by questions.

use underfoot::floor::{
    Board, CountRange, CountSign, Floor, Geometry, PortName, SensorId, SerialWire, TextLines, TextNumbers,
};
use underfoot::schema;
use underfoot::serve::{FoundBoard, SentNumbers};

use super::ask::{Left, ask, choice, number};
use super::boards::HeardBoards;
use crate::floor_args::grid;

/// The floors to choose from, with the shipped floor file of each; the last two are asked for.
const SHAPES: [(&str, Option<&str>); 5] = [
    ("a dance pad, 3 x 3 panels with sensors at the middles of their edges", Some("dance_pad")),
    ("a balance board, one plate with four sensors", Some("balance_board")),
    ("a plate on four load cells", Some("load_cells")),
    ("the paper's tiles of 30.4 cm, with sensors near their corners", None),
    ("other tiles with sensors near their corners", None),
];

/// Asks for the shape, and assigns the boards that were found to its sensors.
pub(super) fn ask_floor(found: &HeardBoards) -> Result<Floor, Left> {
    for (position, (shape, _)) in SHAPES.iter().enumerate() {
        outln!("  {}  {shape}", position + 1);
    }
    loop {
        let chosen = ask("The floor is", Some("4"), choice(SHAPES.len()))?;
        let shipped = SHAPES.get(chosen).and_then(|(_, name)| *name);
        let read = shipped.and_then(|name| schema::parse_floor(schema::builtin_floor(name)?, name).ok());
        let mut floor = match read {
            Some(floor) => floor,
            None if chosen + 1 < SHAPES.len() => {
                Floor::of(ask("Columns x rows, from the south-west", Some("2x2"), grid)?)
            }
            None => match tiles()? {
                Ok(geometry) => Floor::of(geometry),
                Err(why) => {
                    outln!("  {why}");
                    continue;
                }
            },
        };
        assign(&mut floor, found);
        return Ok(floor);
    }
}

/// Asks for the measures of square tiles.
fn tiles() -> Result<Result<Geometry, String>, Left> {
    let whole = |text: &str| number(1.0..=1024.0, "tiles")(text).map(|count| count.round() as u16);
    let columns = ask("Columns, west to east", None, whole)?;
    let rows = ask("Rows, south to north", None, whole)?;
    let cm = |question: &str, usual: Option<&str>| ask(question, usual, number(0.5..=500.0, "cm"));
    let tile = cm("Side of a plate in cm", None)?;
    let pitch = cm("Distance between the middles of two plates in cm", Some(&format!("{tile}")))?;
    let inset = cm("Distance of each sensor from both edges of its corner in cm", Some("2"))?;
    let metres = |cm: f64| (cm * 0.01) as f32;
    let made = Geometry::new(columns, rows, metres(tile), metres(pitch), metres(inset));
    Ok(made.map_err(|error| error.to_string()))
}

/// Gives the sensors, tile by tile, to the channels of the boards in the order of their addresses. Without boards, the
/// floor keeps its usual ones.
fn assign(floor: &mut Floor, all: &HeardBoards) {
    let found: Vec<&FoundBoard> = all.survey.boards();
    let geometry = floor.geometry;
    let mut sensors = geometry
        .tiles()
        .flat_map(|tile| geometry.sensors(tile).iter().map(move |&corner| SensorId { tile, corner }));
    if found.is_empty() {
        outln!(
            "No board was found: the file gets the usual ones. Look for boards, then choose the floor again."
        );
        return;
    }
    let boards = found.iter().enumerate().map(|(number, board)| {
        let channels = (0..board.channels()).map(|_| sensors.next()).collect();
        Board { range: range(board), ..Board::new(address(board, number, &found), channels) }
    });
    floor.boards = boards.collect();
    floor.serial = wires(&found, |port| all.baud(port));
    let left = sensors.count();
    let channels: usize = found.iter().map(|board| board.channels()).sum();
    if left > 0 {
        outln!(
            "{left} sensors have no channel: the boards have {channels} in all. Switch on the others and look again."
        );
    }
    let spare =
        floor.boards.iter().flat_map(|board| &board.channels).filter(|sensor| sensor.is_none()).count();
    if spare > 0 {
        outln!("{spare} of {channels} channels are left over: the last ones.");
    }
    outln!(
        "Channels go tile by tile from the south-west, sw se nw ne each; step 3 finds boards that are swapped."
    );
}

/// The counts of a board, as far as its readings tell.
fn range(board: &FoundBoard) -> CountRange {
    let full_scale = board.full_scale().map_or(CountRange::WHOLE.full_scale, |(full, _)| full);
    CountRange { full_scale, sign: CountSign::Unsigned }
}

/// The OSC address of the board with this number; one that no other board has for lines of text.
fn address(board: &FoundBoard, number: usize, found: &[&FoundBoard]) -> String {
    if !board.address.is_empty() {
        return board.address.clone();
    }
    let free = |number: &usize| {
        let address = format!("/underfoot/board/{number}");
        !found.iter().any(|other| other.address == address)
    };
    // Lines come first, so the numbers from here on are free of theirs.
    let number = (0..).filter(free).nth(number).unwrap_or(number);
    format!("/underfoot/board/{number}")
}

/// The serial ports of these boards.
fn wires(found: &[&FoundBoard], baud: impl Fn(&PortName) -> u32) -> Vec<SerialWire> {
    let mut wires: Vec<SerialWire> = Vec::new();
    for (number, board) in (0..).zip(found) {
        let Some(port) = &board.port else { continue };
        let is_text = board.numbers == SentNumbers::Text;
        if !is_text && wires.iter().any(|wire| wire.port.as_ref() == Some(port)) {
            continue;
        }
        let CountRange { full_scale, sign } = range(board);
        let columns: Vec<u8> = board.columns().filter_map(|column| u8::try_from(column).ok()).collect();
        let lines = is_text.then(|| TextLines {
            board: number,
            request: Vec::new(),
            separators: " ,".to_owned(),
            width: columns.last().copied().unwrap_or(1),
            columns,
            numbers: TextNumbers::Counts { full_scale: full_scale as f32, sign },
        });
        wires.push(SerialWire { port: Some(port.clone()), baud: baud(port), lines });
    }
    wires
}

/// The text of a first layout: a button on each tile.
pub(super) fn first_layout(geometry: &Geometry) -> String {
    let widgets: String = geometry
        .tiles()
        .filter(|tile| geometry.has(*tile))
        .map(|tile| {
            let (column, row) = (tile.column, tile.row);
            format!(
                "        (id: \"tile_{column}_{row}\", kind: \"button\", at: ({column}.1, {row}.1), size: (0.8, 0.8)),\n"
            )
        })
        .collect();
    format!(
        "// A button on each tile: a first layout, to try the floor.\nLayout(\n    version: 1,\n    regions: [(id: \
         \"all\", at: (0, 0), size: ({}, {}))],\n    widgets: [\n{widgets}    ],\n)\n",
        geometry.columns(),
        geometry.rows()
    )
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use underfoot::schema::{Kinds, parse_layout};

    #[test]
    fn the_first_layout_fits_every_floor_that_can_be_chosen() {
        let shipped = SHAPES.iter().filter_map(|(_, name)| *name);
        let shipped = shipped
            .map(|name| schema::parse_floor(schema::builtin_floor(name).unwrap(), name).unwrap().geometry);
        for geometry in shipped.chain([Geometry::default(), grid("1x3").unwrap()]) {
            let text = first_layout(&geometry);
            let layout = parse_layout(&text, "first", &Kinds::builtin(), &geometry);
            let tiles = geometry.tiles().filter(|tile| geometry.has(*tile)).count();
            assert_eq!(layout.unwrap_or_else(|problems| panic!("{problems}")).layout.widgets.len(), tiles);
        }
    }
}
