//! `underfoot wiring`: a walk from board to board that finds which board reads which tiles; the wiring as pictures.

mod picture;
mod pins;
mod plan;
mod schematic;
mod sheet;

use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

use underfoot::floor::Floor;
use underfoot::serve::{WiringStep, WiringTask, WiringWalk};
use underfoot::source::SensorSource;

use super::failure::Failure;
use super::floor_args::{FloorArgs, FloorOut};
use super::number::patience;
use super::senders::ListenArgs;
use super::stop::stop_flag;
use picture::PictureArgs;

/// Options of `underfoot wiring`.
///
/// For each board the floor file names a tile that it should read. Step on that tile when it is shown, and off again:
/// the board that senses the step is the one at that tile. If boards are swapped, the floor file written with --out
/// has their addresses exchanged.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    floor: FloorArgs,
    #[command(flatten)]
    input: ListenArgs,
    /// How long to wait for a step on each tile.
    #[arg(long, value_name = "S", default_value = "60", value_parser = patience)]
    wait: Duration,
    /// Output file for the floor with the wiring that was found; with --picture, for the plan: PNG, or SVG if the name
    /// ends in .svg. Table and circuit stand beside it.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    picture: PictureArgs,
}

/// Walks from board to board, or draws the wiring.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if let Some(floor) = &args.picture.picture {
        return args.picture.write(floor, args.out.as_deref());
    }
    let out = args.out.as_deref().map(FloorOut::new);
    let floor = args.input.boards.load(&args.floor)?;
    let source = args.input.open(&floor)?.source;
    let stop = stop_flag()?;
    errln!("Listening on {}; keep off the floor for a moment.", args.input.listen);
    let (mut source, mut walk) = (source, WiringWalk::new(&floor));
    let (mut task, mut since) = (walk.task(), source.now());
    loop {
        let now = walk.task();
        if now != task {
            (task, since) = (now, source.now());
            if let WiringTask::Step(tile) = task {
                outln!("Step on tile {tile}, and off again.");
            }
        }
        if task == WiringTask::Nothing {
            break;
        }
        if stop.load(Ordering::Relaxed) {
            return Err(Failure::Other("the walk was ended".into()));
        }
        if source.now().since(since) >= args.wait {
            return Err(Failure::Other(waited(args.wait, task, &walk, &floor)));
        }
        if let Some(packet) = source.next(Duration::from_millis(20))?
            && let Some(step) = walk.take(&packet)
        {
            outln!("  {}", felt(&step, &floor));
        }
    }
    conclude(out.as_ref(), &walk, &floor)
}

/// Describes the board that sensed a step.
fn felt(step: &WiringStep, floor: &Floor) -> String {
    let address = floor.boards.get(step.found).map_or("?", |board| board.address.as_str());
    if step.felt == step.tile || step.found != step.board {
        return format!("{address} feels it.");
    }
    let felt = step.felt;
    format!("{address} feels it where the floor file has its tile {felt}: its channels are in another order.")
}

/// The message after a time-out.
fn waited(wait: Duration, task: WiringTask, walk: &WiringWalk, floor: &Floor) -> String {
    let what = match task {
        WiringTask::KeepOff => "packets of every board".to_owned(),
        WiringTask::Step(tile) => format!("a step on tile {tile}"),
        WiringTask::StepOff | WiringTask::Nothing => "the floor to be empty again".to_owned(),
    };
    let missing: Vec<&str> = walk
        .unheard()
        .filter_map(|number| floor.boards.get(number))
        .map(|board| board.address.as_str())
        .collect();
    let unheard = if missing.is_empty() {
        String::new()
    } else {
        format!("; nothing has come from {}", missing.join(", "))
    };
    format!("waited {} s for {what}{unheard}", wait.as_secs_f64())
}

/// Reports the wiring that was found, and saves it if requested.
fn conclude(out: Option<&FloorOut<'_>>, walk: &WiringWalk, floor: &Floor) -> Result<(), Failure> {
    let Some(found) = walk.outcome(floor) else { return Ok(()) };
    let found = found.map_err(|twice| Failure::Other(twice.to_string()))?;
    let moved = &found.moved;
    outln!(
        "{} boards where the floor file has them, {} elsewhere.",
        floor.boards.len() - moved.len(),
        moved.len()
    );
    for &(place, found) in moved {
        if let (Some(place), Some(found)) = (floor.boards.get(place), floor.boards.get(found)) {
            outln!("  {} is where {} should be.", found.address, place.address);
        }
    }
    match out {
        Some(out) => out.save(&found.floor).map(|_| ()),
        None if moved.is_empty() => Ok(()),
        None => {
            errln!(
                "Nothing is kept: exchange their cables, or say where to keep the new floor file with --out."
            );
            Ok(())
        }
    }
}
