//! The shape of the floor, by questions at the terminal.

use underfoot::floor::Floor;
use underfoot_window::setup::{FloorShape, GridShape, HeardBoards, SHIPPED_SHAPES, assign};

use super::ask::{Left, ask, choice, number};
use crate::floor_args::grid;

/// The shapes beside the shipped ones.
const GRIDS: [&str; 2] = [
    "the paper's tiles of 30.4 cm, with sensors near their corners",
    "other tiles with sensors near their corners",
];

/// Asks for the shape, and assigns the boards that were found to its sensors.
pub(super) fn ask_floor(heard: &HeardBoards) -> Result<Floor, Left> {
    let shapes: Vec<&str> = SHIPPED_SHAPES.iter().map(|(_, words)| *words).chain(GRIDS).collect();
    for (position, shape) in shapes.iter().enumerate() {
        outln!("  {}  {shape}", position + 1);
    }
    loop {
        let chosen = ask("The floor is", Some("4"), choice(shapes.len()))?;
        let made = match SHIPPED_SHAPES.get(chosen) {
            Some((name, _)) => FloorShape::Shipped((*name).to_owned()).floor(),
            None if chosen + 1 < shapes.len() => {
                Ok(Floor::of(ask("Columns x rows, from the south-west", Some("2x2"), grid)?))
            }
            None => FloorShape::Grid(tiles()?).floor(),
        };
        match made {
            Ok(mut floor) => {
                let wires = assign(&mut floor, heard);
                wires.words().iter().for_each(|words| outln!("{words}"));
                return Ok(floor);
            }
            Err(why) => outln!("  {why}"),
        }
    }
}

/// Asks for the measures of square tiles.
fn tiles() -> Result<GridShape, Left> {
    let whole = |text: &str| number(1.0..=1024.0, "tiles")(text).map(|count| count.round() as u16);
    let columns = ask("Columns, west to east", None, whole)?;
    let rows = ask("Rows, south to north", None, whole)?;
    let cm = |question: &str, usual: Option<&str>| ask(question, usual, number(0.5..=500.0, "cm"));
    let tile = cm("Side of a plate in cm", None)?;
    let pitch = cm("Distance between the middles of two plates in cm", Some(&format!("{tile}")))?;
    let inset = cm("Distance of each sensor from both edges of its corner in cm", Some("2"))?;
    let metres = |cm: f64| (cm * 0.01) as f32;
    Ok(GridShape { columns, rows, tile_m: metres(tile), pitch_m: metres(pitch), inset_m: metres(inset) })
}
