use std::path::PathBuf;

use serde_json::json;
use underfoot::floor::{Calibration, CalibrationRecord, Floor};
use underfoot::picture;
use underfoot::sense::{Judgement, LoadTable, SensorLoads, Verdict};

use super::{count, plot, read_table, rounded, today};
use crate::cli::failure::Failure;
use crate::cli::floor_args::{FloorArgs, save_floor, saved_json};

/// What `underfoot calibrate curves` is asked to do.
///
/// A residual up to 8 % of full scale is `good`, up to 15 % `poor`; beyond, or where no law
/// of a force sensor fits, the part is to be `replace`d, keeps the nominal law, and the exit status is 1.
/// Sensors that are not in the table keep what the floor file has.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// CSV with the header `col,row,corner,volts,newtons` or `col,row,corner,counts,newtons`.
    table: PathBuf,
    #[command(flatten)]
    floor: FloorArgs,
    /// Where to keep the calibrated floor; without it, in the file given with --floor.
    #[arg(long, value_name = "FLOOR.ron")]
    out: Option<PathBuf>,
    /// Also draw measurements and curves, tile by tile: PNG, or SVG if the name ends in .svg.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Print the result as JSON on standard output.
    #[arg(long)]
    json: bool,
}

/// Width of the plot, in pixels.
const PLOT_PX: u32 = 1800;

/// Fits, reports, keeps.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let mut floor = args.floor.load()?;
    let text = read_table(&args.table)?;
    let name = args.table.display();
    let table = LoadTable::parse(&text, &floor.geometry).map_err(|problems| {
        Failure::Other(format!("{name} is no table of this floor's sensors:\n{problems}"))
    })?;
    if table.sensors.is_empty() {
        return Err(Failure::Other(format!("{name} holds no measurements")));
    }
    let judged: Vec<_> = table.sensors.iter().map(|loads| (loads, loads.judge())).collect();
    let mapped = maps(&floor);
    keep(&mut floor, &judged);
    let dropped = mapped - maps(&floor);
    if let Some(path) = &args.plot {
        let scene = plot::draw(&judged);
        picture::write(&scene, path, PLOT_PX)?;
    }
    let saved = match args.out.as_ref().or(args.floor.floor.as_ref()) {
        Some(path) => Some((path, save_floor(&floor, path)?)),
        None => None,
    };
    if args.json {
        let sensors: Vec<_> = judged.iter().map(|(loads, judgement)| as_json(loads, judgement)).collect();
        let saved = saved.as_ref().map(|(path, saved)| saved_json(path, saved));
        anstream::println!("{}", json!({ "sensors": sensors, "maps_dropped": dropped, "saved": saved }));
    } else {
        print(&judged);
        if saved.is_none() {
            anstream::eprintln!("Nothing is kept: say where with --out FLOOR.ron.");
        }
    }
    if dropped > 0 {
        let maps = count(dropped, "position map");
        anstream::eprintln!("{maps} made through the old curves were taken away: measure them anew.");
    }
    outcome(&judged)
}

fn maps(floor: &Floor) -> usize {
    floor.position_maps.iter().flatten().count()
}

/// Takes the new laws into the floor.
fn keep(floor: &mut Floor, judged: &[(&SensorLoads, Judgement)]) {
    let day = today();
    for (loads, judgement) in judged {
        match (judgement.verdict, judgement.fit) {
            (Verdict::Good | Verdict::Poor, Ok(fit)) => {
                let record = CalibrationRecord { day, residual: rounded(fit.residual) };
                floor.recalibrate(loads.sensor, fit.calibration, Some(record));
            }
            (Verdict::Replace, _) => {
                floor.recalibrate(loads.sensor, Calibration::NOMINAL, None);
            }
            _ => {}
        }
    }
}

fn print(judged: &[(&SensorLoads, Judgement)]) {
    anstream::println!("tile      corner       a N   b 1/V  residual  points  verdict");
    for (loads, judgement) in judged {
        let tile = loads.sensor.tile.to_string();
        let law = match judgement.fit {
            Ok(fit) => {
                let Calibration { a_n, b_per_volt } = fit.calibration;
                format!("{a_n:>8.4}  {b_per_volt:>6.3}  {:>6.1} %", 100.0 * fit.residual)
            }
            Err(_) => format!("{:>8}  {:>6}  {:>8}", "-", "-", "-"),
        };
        anstream::println!(
            "{tile:<9} {:<6}  {law}  {:>6}  {}",
            loads.sensor.corner.name(),
            loads.points.len(),
            judgement.verdict.name()
        );
    }
    let saturated: usize = judged.iter().map(|(loads, _)| loads.saturated).sum();
    if saturated > 0 {
        let readings = count(saturated, "reading");
        anstream::println!("{readings} at 98 % of the converter's range or above were left out.");
    }
}

fn as_json(loads: &SensorLoads, judgement: &Judgement) -> serde_json::Value {
    let fit = judgement.fit.ok();
    json!({
        "col": loads.sensor.tile.column,
        "row": loads.sensor.tile.row,
        "corner": loads.sensor.corner.name(),
        "a_n": fit.map(|fit| fit.calibration.a_n),
        "b_per_volt": fit.map(|fit| fit.calibration.b_per_volt),
        "residual": fit.map(|fit| fit.residual),
        "points": loads.points.len(),
        "saturated": loads.saturated,
        "verdict": judgement.verdict.name(),
        "problem": judgement.fit.err().map(|error| error.to_string()),
    })
}

/// A failure that names the sensors with which the work is not done.
fn outcome(judged: &[(&SensorLoads, Judgement)]) -> Result<(), Failure> {
    let mut lines = Vec::new();
    for (loads, judgement) in judged {
        let advice = match judgement.verdict {
            Verdict::Good | Verdict::Poor => continue,
            Verdict::Unmeasured => "measure it again; it keeps what it had",
            Verdict::Replace => "replace it; until then it counts as a nominal part",
        };
        let reason = match judgement.fit {
            Ok(fit) => format!("it misses its law by {:.0} % of full scale", 100.0 * fit.residual),
            Err(error) => error.to_string(),
        };
        lines.push(format!("the sensor of {}: {reason}: {advice}", loads.sensor));
    }
    if lines.is_empty() { Ok(()) } else { Err(Failure::Other(lines.join("\nerror: "))) }
}
