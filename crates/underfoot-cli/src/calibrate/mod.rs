//! `underfoot calibrate`: laws of sensors, tare and position maps, stored in the floor file.

mod curves;
mod map;
mod plot;
mod stand;
mod stand_report;
mod tare;

use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use clap::Subcommand;
use underfoot::floor::{Day, Floor};

use super::failure::Failure;
use super::floor_args::{FloorArgs, FloorOut, saved_json};

/// Options of `underfoot calibrate`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Find each sensor's law, exponential or another, from load-cell measurements.
    Curves(curves::Args),
    /// Find each sensor's law from a person of known weight who stands on marks; no load cell is needed.
    Stand(stand::Args),
    /// Measure the sensors' readings on the empty floor.
    Tare(tare::Args),
    /// Learn each tile's distortion of positions from presses at known points.
    Map(map::Args),
}

/// Runs the chosen calibration.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match &args.what {
        What::Curves(args) => curves::run(args),
        What::Stand(args) => stand::run(args),
        What::Tare(args) => tare::run(args),
        What::Map(args) => map::run(args),
    }
}

/// Maximum size of a table in bytes: an hour of one sensor at 1 kHz.
const MOST_BYTES: u64 = 256 << 20;

/// Today, in UTC.
pub(crate) fn today() -> Day {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    Day::of_unix_seconds(since.as_secs())
}

/// `1 sensor`, `2 sensors`.
fn count(number: usize, what: &str) -> String {
    if number == 1 { format!("1 {what}") } else { format!("{number} {what}s") }
}

/// The floor file for the result of a calibration, if one is named.
struct Out<'p>(Option<FloorOut<'p>>);

impl<'p> Out<'p> {
    /// The file of `--out`, or else the file of `floor`; call it before the work begins.
    fn new(out: Option<&'p Path>, floor: &'p FloorArgs) -> Self {
        Self(out.or(floor.floor.as_deref()).map(FloorOut::new))
    }

    /// Saves `floor`; returns the paths of the floor and its backup for programs, `None` without a file.
    fn save(&self, floor: &Floor) -> Result<Option<serde_json::Value>, Failure> {
        self.0.as_ref().map(|out| Ok(saved_json(out.path(), &out.save(floor)?))).transpose()
    }
}

/// Says that a result is not kept, if it was not `saved`.
fn say_if_unsaved(saved: Option<&serde_json::Value>) {
    if saved.is_none() {
        errln!("Nothing is kept: say where with --out FLOOR.ron.");
    }
}
