//! `underfoot wiring --picture`: plan, circuit and table of a floor's wires.

use std::path::{Path, PathBuf};

use underfoot::floor::{Board, Floor};
use underfoot_scene::picture;

use super::pins::Pins;
use super::plan::Plan;
use super::schematic;
use crate::failure::Failure;
use crate::floor_args::load_floor;
use crate::fonts::fonts;

/// Width of a PNG file, in pixels.
const WIDTH_PX: u32 = 2400;

/// Options of the pictures.
#[derive(clap::Args, Debug)]
pub(crate) struct PictureArgs {
    /// Instead of a walk, draw the wiring of this floor: a floor file, or a shipped one such as `dance_pad`. Writes
    /// which sensor goes to which input of which board as a picture and a table (CSV), and the circuit around the
    /// boards of firmware/.
    #[arg(long, value_name = "FLOOR", conflicts_with_all = ["floor", "grid", "serial", "pin", "allow"])]
    pub(crate) picture: Option<PathBuf>,
    /// The boards of the picture. Without it: a Pico where a serial port carries OSC, an Arduino where it carries lines
    /// of text, and channels by their numbers where boards send over a network.
    #[arg(long, value_name = "BOARD", requires = "picture")]
    pins: Option<Pins>,
}

impl PictureArgs {
    /// Writes the wiring of the floor at `path` to `out`, or to this folder.
    pub(super) fn write(&self, path: &Path, out: Option<&Path>) -> Result<(), Failure> {
        // Ports that are not plugged in can be drawn.
        let floor = load_floor(path, &|_| None)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let pins =
            (0..floor.boards.len()).map(|board| self.pins.unwrap_or_else(|| Pins::guessed(&floor, board)));
        let pins: Vec<Pins> = pins.collect();
        check(&floor, &pins)?;
        let plan = Plan::new(&floor, pins.clone());
        let out = out.map_or_else(|| format!("{name}-wiring.svg").into(), Path::to_path_buf);
        picture::write(&plan.draw(&name), fonts(), &out, WIDTH_PX)?;
        outln!("{}", out.display());
        let table = out.with_extension("csv");
        std::fs::write(&table, plan.table()).map_err(|error| Failure::File(table.clone(), error))?;
        outln!("{}", table.display());
        let mut kinds = pins.clone();
        kinds.sort_unstable();
        kinds.dedup();
        let several = kinds.len() > 1;
        for kind in kinds {
            if let Some(scene) = schematic::draw(kind, &inputs(&floor, &pins, kind)) {
                let path = beside(&out, if several { kind.word() } else { "" });
                picture::write(&scene, fonts(), &path, WIDTH_PX)?;
                outln!("{}", path.display());
            }
        }
        Ok(())
    }
}

/// The file of a circuit beside `out`.
fn beside(out: &Path, word: &str) -> PathBuf {
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    let end = out.extension().unwrap_or_default().to_string_lossy();
    let word = if word.is_empty() { String::new() } else { format!("-{word}") };
    out.with_file_name(format!("{stem}-circuit{word}.{end}"))
}

/// Fails for a board with more channels than inputs.
fn check(floor: &Floor, pins: &[Pins]) -> Result<(), Failure> {
    for (board, pins) in floor.boards.iter().zip(pins) {
        let channels = board.channels.len();
        if channels > pins.inputs() {
            return Err(Failure::Other(format!(
                "{} has {channels} channels, and each {} has {} inputs: give it fewer tiles, or draw it with --pins channels",
                board.address,
                pins.name(),
                pins.inputs()
            )));
        }
    }
    Ok(())
}

/// The inputs in use of the fullest board of this kind.
fn inputs(floor: &Floor, pins: &[Pins], kind: Pins) -> Vec<String> {
    let boards = floor.boards.iter().zip(pins).enumerate().filter(|(_, (_, pins))| **pins == kind);
    let fullest = boards.max_by_key(|(_, (board, _))| board.channels.len());
    let used = |(number, (board, _)): (usize, (&Board, &Pins))| {
        let channels = board.channels.iter().enumerate().filter(|(_, sensor)| sensor.is_some());
        channels.map(|(channel, _)| kind.input(floor, number, channel)).collect()
    };
    fullest.map(used).unwrap_or_default()
}
