//! `underfoot setup`: from boards that send to a floor file and a first layout, step by step.

mod ask;
mod boards;
mod shape;
mod steps;
#[cfg(feature = "preview")]
mod window;

use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::Duration;

use underfoot::floor::{Geometry, PortName, read_address};
use underfoot::schema::load_layout_and_kinds;
use underfoot_window::setup::{HeardBoards, first_layout};

use super::failure::Failure;
use super::floor_args::{load_floor, save_floor};
use super::number::patience;
use ask::{Left, ask, choice, number};
use steps::FloorCommands;

/// Options of `underfoot setup`.
///
/// Asks questions and runs the commands for each step; every step can be repeated, left out and run alone. With --window,
/// a window guides instead. An existing floor file is kept as a backup.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Args {
    /// Guide in a window, with the floor drawn and the tile to step on lit, instead of by questions.
    #[cfg(feature = "preview")]
    #[arg(long)]
    window: bool,
    /// Floor file to write and to go on with.
    #[arg(long, value_name = "FILE", default_value = "floor.ron")]
    floor: PathBuf,
    /// Where the boards' packets arrive.
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1:9000", value_parser = read_address)]
    listen: SocketAddr,
    /// Also look for boards on this serial port; USB ports are found without it. Several may be given.
    #[arg(long, value_name = "PORT")]
    serial: Vec<PortName>,
    /// How long to look for boards.
    #[arg(long, value_name = "S", default_value = "4", value_parser = patience)]
    seconds: Duration,
    /// Layout to open at the end; without it, one with a button on each tile, written beside the floor file.
    #[arg(long, value_name = "LAYOUT")]
    layout: Option<PathBuf>,
}

/// The steps, in their usual order.
const STEPS: [&str; 8] = [
    "look for boards",
    "choose the floor's shape, and write its file",
    "find boards that are swapped, by stepping",
    "look at the readings, and at their noise on the empty floor",
    "calibrate by standing on the floor (takes the tare too)",
    "take the tare of the empty floor",
    "open a first layout on the floor",
    "leave",
];

/// Guides through the steps.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    #[cfg(feature = "preview")]
    if args.window {
        return window::run(args);
    }
    let steps = FloorCommands::new(args.listen.to_string())?;
    outln!("Set-up of the floor in {}. Ctrl-C ends a step; Ctrl-D leaves.", args.floor.display());
    let mut found = HeardBoards::default();
    let mut next = 0;
    loop {
        outln!();
        STEPS.iter().enumerate().for_each(|(position, step)| outln!("{}  {step}", position + 1));
        let Ok(step) = ask("Step", Some(&(next + 1).to_string()), choice(STEPS.len())) else { break };
        if step + 1 == STEPS.len() {
            break;
        }
        match take(step, args, &steps, &mut found)? {
            Ok(true) => next = (step + 1).min(STEPS.len() - 1),
            Ok(false) => next = step,
            Err(Left) => break,
        }
    }
    if args.floor.exists() {
        outln!("The floor is in {}.", args.floor.display());
    }
    Ok(())
}

/// Takes a step; returns whether it is done.
fn take(
    step: usize,
    args: &Args,
    steps: &FloorCommands,
    found: &mut HeardBoards,
) -> Result<Result<bool, Left>, Failure> {
    let floor = args.floor.as_path();
    let file = floor.to_string_lossy();
    if step > 1 && !floor.exists() {
        outln!("There is no {} yet: choose the floor's shape first.", floor.display());
        return Ok(Ok(false));
    }
    Ok(match step {
        0 => {
            outln!("Listening on {} for {} s.", args.listen, args.seconds.as_secs_f64());
            match boards::listen(args.listen, &args.serial, args.seconds) {
                Ok(heard) => *found = heard,
                Err(failure) => {
                    outln!("{failure}");
                    return Ok(Ok(false));
                }
            }
            boards::describe(found, args.listen);
            Ok(!found.boards().is_empty())
        }
        1 => match shape::ask_floor(found) {
            Ok(made) => {
                save_floor(&made, floor)?;
                Ok(true)
            }
            Err(left) => Err(left),
        },
        2 => Ok(steps.run(&["wiring"], floor, &["--out", &file])),
        3 => Ok(steps.run(&["measure"], floor, &["--seconds", "5"])),
        4 => {
            outln!(
                "A person stands on the marks of each tile: `underfoot calibrate stand --marks --floor {file}`"
            );
            outln!("prints them. With a load cell, `underfoot calibrate curves` reads a table instead.");
            let question = "Weight of the person in kg, with clothes and shoes";
            ask(question, None, number(15.0..=300.0, "kilograms")).map(|weight| {
                steps.run(&["calibrate", "stand"], floor, &["--weight-kg", &weight.to_string()])
            })
        }
        5 => Ok(steps.run(&["calibrate", "tare"], floor, &["--accept-change"])),
        _ => Ok(open(args, steps)?),
    })
}

/// Opens a layout in the window, or serves it where there is no display.
fn open(args: &Args, steps: &FloorCommands) -> Result<bool, Failure> {
    let layout = layout_to_open(args)?;
    let layout = layout.to_string_lossy();
    #[cfg(feature = "preview")]
    if super::preview::has_display() {
        return Ok(steps.run(&["preview", &layout], &args.floor, &[]));
    }
    Ok(steps.run(&["run", &layout], &args.floor, &["--json"]))
}

/// The layout to open: the chosen one, or the first layout beside the floor file, which is written unless it is there.
fn layout_to_open(args: &Args) -> Result<PathBuf, Failure> {
    if let Some(layout) = &args.layout {
        return Ok(layout.clone());
    }
    let geometry = load_floor(&args.floor, &|_| None)?.geometry;
    let usual = args.floor.with_file_name("first_layout.ron");
    // One of another shape stays as it is.
    let of_shape = format!("first_layout_{}x{}.ron", geometry.columns(), geometry.rows());
    let path =
        if is_for_another_floor(&usual, &geometry) { args.floor.with_file_name(of_shape) } else { usual };
    if !path.exists() || is_for_another_floor(&path, &geometry) {
        std::fs::write(&path, first_layout(&geometry)).map_err(|error| Failure::File(path.clone(), error))?;
        outln!("Written: {}, a button on each tile.", path.display());
    }
    Ok(path)
}

/// Whether there is a layout that does not fit this floor.
fn is_for_another_floor(path: &Path, geometry: &Geometry) -> bool {
    path.exists() && load_layout_and_kinds(path, geometry).is_err()
}
