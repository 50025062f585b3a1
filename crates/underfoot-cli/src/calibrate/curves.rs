//! `underfoot calibrate curves`: each sensor's law from load-cell measurements.
use super::super::fonts::fonts;

use std::path::PathBuf;

use serde_json::{Value, json};
use underfoot::floor::{Calibration, CalibrationRecord, Floor, LawKind};
use underfoot::sense::{Candidate, Fit, FitError, Judgement, LoadTable, SensorLoads, Verdict};
use underfoot_scene::picture;

use super::{MOST_BYTES, Out, count, plot, say_if_unsaved, today};
use crate::failure::Failure;
use crate::floor_args::FloorArgs;
use crate::table;

/// Options of `underfoot calibrate curves`.
///
/// Four laws are fitted to each sensor, v in volts and f in newtons: exponential f = a exp(b v), power f = a v^b,
/// divider f = a v / (s - v), linear f = a (v - z). An information criterion chooses the law of the sensor; the
/// exponential law stays if no other is clearly better. A fit needs three loads, a comparison of laws five, and a
/// reliable comparison ten or more from light to heavy.
///
/// A residual up to 8 % of full scale is `good`, up to 15 % `poor`; above, or if no law of a force sensor fits, the
/// verdict is `replace`: the part keeps the nominal law, and the exit status is 1. Sensors that are not in the table
/// keep the values in the floor file. A line that cannot be read is skipped and reported; the others count, and the
/// exit status is 1.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// CSV with the columns `col,row,corner,volts,newtons` or `col,row,corner,counts,newtons`.
    table: PathBuf,
    #[command(flatten)]
    floor: FloorArgs,
    /// Output file for the calibrated floor; without it, the file given with --floor.
    #[arg(long, value_name = "FLOOR.ron")]
    out: Option<PathBuf>,
    /// Also draw measurements and curves, tile by tile: PNG, or SVG if the name ends in .svg.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Also print a line for each sensor: its law, the residual, the verdict.
    #[arg(long)]
    sensors: bool,
    /// As --sensors, and also print the fit of every law to each sensor: its residual, the excess of its information
    /// criterion over the least one, or the reason why it doesn't fit.
    #[arg(long)]
    laws: bool,
    /// Print the result as JSON on standard output.
    #[arg(long)]
    json: bool,
}

/// Width of the plot, in pixels.
const PLOT_PX: u32 = 1800;

/// Fits the laws, reports them, and saves the floor.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let out = Out::new(args.out.as_deref(), &args.floor);
    let mut floor = args.floor.load()?;
    let loads = LoadTable::read(table::open(&args.table, MOST_BYTES)?, &floor.geometry)
        .map_err(|error| table::refused(&args.table, "table of sensors", &error))?;
    table::warn_of_unread(&args.table, &loads.notes.unread);
    let left_out = table::left_out(&args.table, &loads.notes.problems);
    if loads.sensors.is_empty() {
        let empty = format!("{} holds no measurements that can be used", args.table.display());
        return table::conclude(&left_out.into_iter().chain([empty]).collect::<Vec<_>>());
    }
    let judged: Vec<_> = loads.sensors.iter().map(|loads| (loads, loads.judge())).collect();
    let mapped = maps(&floor);
    keep(&mut floor, &judged);
    let dropped = mapped - maps(&floor);
    if let Some(path) = &args.plot {
        let scene = plot::draw(&judged);
        picture::write(&scene, fonts(), path, PLOT_PX)?;
    }
    let saved = out.save(&floor)?;
    if args.json {
        let sensors: Vec<_> = judged.iter().map(|(loads, judgement)| as_json(loads, judgement)).collect();
        outln!("{}", json!({ "sensors": sensors, "maps_dropped": dropped, "saved": saved }));
    } else {
        outln!("{}", summary(&judged));
        if args.sensors || args.laws {
            print(&judged, args.laws);
        }
        say_saturated(&judged);
        say_if_unsaved(saved.as_ref());
    }
    if dropped > 0 {
        let maps = count(dropped, "position map");
        errln!("{maps} made through the old curves were taken away: measure them anew.");
    }
    table::conclude(&failures(&judged).chain(left_out).collect::<Vec<_>>())
}

fn maps(floor: &Floor) -> usize {
    floor.position_maps.iter().flatten().count()
}

/// Stores the new laws in the floor.
fn keep(floor: &mut Floor, judged: &[(&SensorLoads, Judgement)]) {
    let day = today();
    for (loads, judgement) in judged {
        match (judgement.verdict, judgement.fit) {
            (Verdict::Good | Verdict::Poor, Ok(fit)) => {
                let record = CalibrationRecord::rounded(day, fit.residual);
                floor.recalibrate(loads.sensor, fit.calibration, Some(record));
            }
            (Verdict::Replace, _) => {
                floor.recalibrate(loads.sensor, Calibration::NOMINAL, None);
            }
            _ => {}
        }
    }
}

/// Numbers of parts with each verdict.
fn summary(judged: &[(&SensorLoads, Judgement)]) -> String {
    let number =
        |verdict: Verdict| judged.iter().filter(|(_, judgement)| judgement.verdict == verdict).count();
    let mut parts = vec![format!("{} good", number(Verdict::Good))];
    for (verdict, words) in [(Verdict::Poor, "poor"), (Verdict::Unmeasured, "measured too little")] {
        let number = number(verdict);
        if number > 0 {
            parts.push(format!("{number} {words}"));
        }
    }
    parts.push(format!("{} to replace", number(Verdict::Replace)));
    parts.join(", ")
}

fn print(judged: &[(&SensorLoads, Judgement)], all_laws: bool) {
    let formula = |fit: &Result<Fit, FitError>| fit.map_or("-".to_owned(), |fit| fit.calibration.to_string());
    let shown = judged.iter().flat_map(|(_, judgement)| {
        let others =
            judgement.laws.candidates.iter().filter(|_| all_laws).map(|candidate| formula(&candidate.fit));
        others.chain([formula(&judgement.fit)])
    });
    let wide = shown.map(|formula| formula.len()).max().unwrap_or(0).max("f in N, v in V".len());
    outln!("tile      corner  law          {:<wide$}  residual  points  verdict", "f in N, v in V");
    for (loads, judgement) in judged {
        let tile = loads.sensor.tile.to_string();
        let corner = loads.name;
        let law = judgement.fit.map_or("-", |fit| fit.calibration.kind().name());
        let (formula, residual) = (formula(&judgement.fit), residual(&judgement.fit));
        let (points, verdict) = (loads.points.len(), verdict(judgement));
        outln!("{tile:<9} {corner:<6}  {law:<11}  {formula:<wide$}  {residual:>8}  {points:>6}  {verdict}");
        for candidate in judgement.laws.candidates.iter().filter(|_| all_laws) {
            print_law(candidate, wide);
        }
    }
}

fn say_saturated(judged: &[(&SensorLoads, Judgement)]) {
    let saturated: usize = judged.iter().map(|(loads, _)| loads.saturated).sum();
    if saturated > 0 {
        let readings = count(saturated, "reading");
        outln!("{readings} at 98 % of the converter's range or above were left out.");
    }
}

/// Prints the fit of one law to a sensor, below the sensor's own line.
fn print_law(candidate: &Candidate, wide: usize) {
    let law = candidate.kind.name();
    match candidate.fit {
        Ok(fit) => {
            let (formula, residual) = (fit.calibration.to_string(), residual(&candidate.fit));
            let excess = if candidate.excess.is_finite() {
                format!("criterion {:+.1}", candidate.excess)
            } else {
                "too few measurements to compare".to_owned()
            };
            outln!("{:18}{law:<11}  {formula:<wide$}  {residual:>8}  {:6}  {excess}", "", "");
        }
        Err(error) => outln!("{:18}{law:<11}  {error}", ""),
    }
}

fn residual(fit: &Result<Fit, FitError>) -> String {
    fit.map_or("-".to_owned(), |fit| percent(fit.residual))
}

/// A share of full scale in percent, with one decimal below 10 %.
fn percent(share: f32) -> String {
    let percent = 100.0 * share;
    if percent < 9.95 { format!("{percent:.1} %") } else { format!("{percent:.0} %") }
}

/// The verdict; for a part with another law than the paper's, also that law and the error of the paper's law.
fn verdict(judgement: &Judgement) -> String {
    let verdict = judgement.verdict.name();
    match judgement.laws.chosen {
        None | Some(LawKind::Exponential) => verdict.to_owned(),
        Some(other) => {
            let exponential = match judgement.laws.candidate(LawKind::Exponential).fit {
                Ok(fit) => format!("exponential would be off by {}", percent(fit.residual)),
                Err(_) => "no exponential law fits".to_owned(),
            };
            format!("{verdict}: follows a {} law; {exponential}", other.name())
        }
    }
}

fn as_json(loads: &SensorLoads, judgement: &Judgement) -> Value {
    let mut sensor = json!({
        "col": loads.sensor.tile.column,
        "row": loads.sensor.tile.row,
        "corner": loads.name,
        "law": judgement.laws.chosen.map(LawKind::name),
        "a_n": null,
        "b_per_volt": null,
        "residual": judgement.fit.ok().map(|fit| fit.residual),
        "points": loads.points.len(),
        "saturated": loads.saturated,
        "verdict": judgement.verdict.name(),
        "problem": judgement.fit.err().map(|error| error.to_string()),
        "laws": judgement.laws.candidates.iter().map(law_as_json).collect::<Vec<_>>(),
    });
    add_numbers(&mut sensor, judgement.fit.ok());
    sensor
}

fn law_as_json(candidate: &Candidate) -> Value {
    let mut law = json!({
        "law": candidate.kind.name(),
        "residual": candidate.fit.ok().map(|fit| fit.residual),
        "excess": candidate.excess.is_finite().then_some(candidate.excess),
        "problem": candidate.fit.err().map(|error| error.to_string()),
    });
    add_numbers(&mut law, candidate.fit.ok());
    law
}

/// Adds a law's numbers under their names in floor files.
fn add_numbers(value: &mut Value, fit: Option<Fit>) {
    let (Some(fit), Some(fields)) = (fit, value.as_object_mut()) else { return };
    let law = fit.calibration;
    for (name, number) in law.kind().number_names().into_iter().zip(law.numbers()) {
        fields.insert(name.to_owned(), json!(number));
    }
}

/// Messages about the sensors that remain uncalibrated.
fn failures(judged: &[(&SensorLoads, Judgement)]) -> impl Iterator<Item = String> {
    judged.iter().filter_map(|(loads, judgement)| {
        let advice = match judgement.verdict {
            Verdict::Good | Verdict::Poor => return None,
            Verdict::Unmeasured => "measure it again; it keeps what it had",
            Verdict::Replace => "replace it; until then it counts as a nominal part",
        };
        let reason = match judgement.fit {
            Ok(fit) => {
                let law = fit.calibration.kind().name();
                format!("it misses its law, {law}, by {} of the greatest force", percent(fit.residual))
            }
            Err(error) => error.to_string(),
        };
        Some(format!("the sensor of tile {} {}: {reason}: {advice}", loads.sensor.tile, loads.name))
    })
}
