//! `underfoot calibrate map`: position maps from presses at known points.

use std::path::PathBuf;

use serde_json::json;
use underfoot::floor::{Floor, MapRecord, TileId};
use underfoot::sense::{Errors, MapError, MapFit, PressTable};

use super::{MOST_BYTES, Out, count, say_if_unsaved, today};
use crate::failure::Failure;
use crate::floor_args::FloorArgs;
use crate::table;

/// Options of `underfoot calibrate map`.
///
/// Press at least 16 known points on a tile, up to its edges, each with several forces from a light foot's to a
/// person's weight. `underfoot measure --json` prints the sensors' readings meanwhile. Press with known weights, or
/// with a tool with a load cell: the total force on a tile determines the position of a foot that stands on two.
/// Errors with the map are those of points that were not used for it. A line that cannot be read is skipped and
/// reported; the others count, and the exit status is 1.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// CSV with the columns `x_m,y_m,col,row,f_sw,f_se,f_nw,f_ne` (and `force_n`, if it is known),
    /// or `true_x_m,true_y_m,est_x_m,est_y_m`.
    table: PathBuf,
    #[command(flatten)]
    floor: FloorArgs,
    /// Output file for the floor with its maps; without it, the file given with --floor.
    #[arg(long, value_name = "FLOOR.ron")]
    out: Option<PathBuf>,
    /// Print the result as JSON on standard output.
    #[arg(long)]
    json: bool,
}

/// Fits the maps, reports them, and saves the floor.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let out = Out::new(args.out.as_deref(), &args.floor);
    let mut floor = args.floor.load()?;
    let pressed = PressTable::read(table::open(&args.table, MOST_BYTES)?, &floor)
        .map_err(|error| table::refused(&args.table, "table of points", &error))?;
    table::warn_of_unread(&args.table, &pressed.notes.unread);
    let left_out = table::left_out(&args.table, &pressed.notes.problems);
    if pressed.tiles.is_empty() {
        let empty = format!("{} holds no points that can be used", args.table.display());
        return table::conclude(&left_out.into_iter().chain([empty]).collect::<Vec<_>>());
    }
    let fits: Vec<_> = pressed.tiles.iter().map(|points| (points.tile, points.fit(&floor))).collect();
    keep(&mut floor, &fits);
    let saved = out.save(&floor)?;
    if args.json {
        let tiles: Vec<_> = fits.iter().map(|(tile, fit)| as_json(*tile, fit)).collect();
        outln!("{}", json!({ "tiles": tiles, "saturated": pressed.saturated, "saved": saved }));
    } else {
        print(&fits);
        if pressed.saturated > 0 {
            let points = count(pressed.saturated, "point");
            outln!("{points} with a sensor at 98 % of its range or above left out.");
        }
        say_if_unsaved(saved.as_ref());
    }
    table::conclude(&failures(&fits).chain(left_out).collect::<Vec<_>>())
}

type Fits = [(TileId, Result<MapFit, MapError>)];

/// Stores the maps in the floor.
fn keep(floor: &mut Floor, fits: &Fits) {
    let day = today();
    for (tile, fit) in fits {
        let Some(index) = floor.geometry.index(*tile) else { continue };
        if let (Ok(fit), Some(map), Some(record)) =
            (fit, floor.position_maps.get_mut(index), floor.map_records.get_mut(index))
        {
            *map = Some(fit.map);
            *record = Some(MapRecord::rounded(day, fit.after.p95_m));
        }
    }
}

fn print(fits: &Fits) {
    outln!("                   without map, cm         with map, cm");
    outln!("tile      points   median   95 %  worst    median   95 %  worst");
    let shown = |Errors { median_m, p95_m, worst_m }: Errors| {
        format!("{:>6.2} {:>6.2} {:>6.2}", 100.0 * median_m, 100.0 * p95_m, 100.0 * worst_m)
    };
    for (tile, fit) in fits {
        let tile = tile.to_string();
        match fit {
            Ok(fit) => {
                let (before, after) = (shown(fit.before), shown(fit.after));
                outln!("{tile:<9} {:>6}   {before}    {after}", fit.points);
            }
            Err(error) => outln!("{tile:<9} {error}"),
        }
    }
}

fn as_json(tile: TileId, fit: &Result<MapFit, MapError>) -> serde_json::Value {
    let errors = |errors: Errors| json!({ "median_m": errors.median_m, "p95_m": errors.p95_m, "worst_m": errors.worst_m });
    json!({
        "col": tile.column,
        "row": tile.row,
        "points": fit.as_ref().ok().map(|fit| fit.points),
        "before": fit.as_ref().ok().map(|fit| errors(fit.before)),
        "after": fit.as_ref().ok().map(|fit| errors(fit.after)),
        "problem": fit.as_ref().err().map(ToString::to_string),
    })
}

/// The tiles that must be pressed again.
fn failures(fits: &Fits) -> impl Iterator<Item = String> {
    fits.iter().filter_map(|(tile, fit)| match fit {
        // A tile that a map can't improve is not a failure.
        Ok(_) | Err(MapError::NoBetter { .. }) => None,
        Err(error) => Some(format!("tile {tile}: {error}; it keeps what it had")),
    })
}
