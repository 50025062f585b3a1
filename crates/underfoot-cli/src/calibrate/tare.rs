//! `underfoot calibrate tare`: the sensors' readings on the empty floor.

use std::path::PathBuf;
use std::time::Duration;

use serde_json::json;
use underfoot::serve::{TareFailure, take_tare};

use super::today;
use crate::failure::Failure;
use crate::floor_args::{FloorOut, saved_json};
use crate::number::patience;
use crate::senders::ListenArgs;

/// Options of `underfoot calibrate tare`.
///
/// The floor must be empty: the tare is only taken if every sensor is quiet (0.5 N of scatter over half a second),
/// carries no more than the weight of a plate (60 N), and the weight of each tile is that at the last tare.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Floor file to which the tare is written.
    #[arg(long, value_name = "FILE")]
    floor: PathBuf,
    #[command(flatten)]
    input: ListenArgs,
    /// How long to wait for the floor to be quiet.
    #[arg(long, value_name = "S", default_value = "5", value_parser = patience)]
    seconds: Duration,
    /// Take the tare although the weight of a tile differs from the last one, because the floor was changed.
    #[arg(long)]
    accept_change: bool,
    /// Print the result as JSON on standard output.
    #[arg(long)]
    json: bool,
}

/// Takes and saves the tare, or reports why it can't.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let out = FloorOut::new(&args.floor);
    let mut floor = args.input.boards.load_file(&args.floor)?;
    let mut input = args.input.open(&floor)?;
    errln!("Listening on {}; keep off the floor.", args.input.listen);
    floor.tare =
        take_tare(&mut input.source, &floor, args.seconds, args.accept_change).map_err(|failure| {
            match failure {
                TareFailure::Changed { .. } => Failure::Other(format!("{failure} with --accept-change")),
                failure => Failure::Other(failure.to_string()),
            }
        })?;
    floor.tared = Some(today());
    let saved = out.save(&floor)?;
    let weights = floor.tare.iter().map(|tare| tare.iter().map(|tare| tare.0).sum::<f32>());
    let (least, most) = weights.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, m), w| (l.min(w), m.max(w)));
    if args.json {
        let tiles: Vec<_> = floor
            .geometry
            .tiles()
            .zip(&floor.tare)
            .map(|(tile, tare)| json!({ "col": tile.column, "row": tile.row, "tare_n": tare }))
            .collect();
        outln!("{}", json!({ "tiles": tiles, "saved": saved_json(&args.floor, &saved) }));
    } else {
        let sensors = 4 * floor.tare.len();
        outln!("Tared {sensors} sensors; the tiles weigh {least:.1} to {most:.1} N.");
    }
    Ok(())
}
