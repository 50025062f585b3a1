//! `underfoot measure`: forces on the floor, for choosing thresholds.

use std::io::IsTerminal;
use std::sync::atomic::Ordering;
use std::time::Duration;

use serde_json::json;
use underfoot::floor::{Corner, Geometry};
use underfoot::layout::{Layout, Widget};
use underfoot::sense::{Assembler, Quality, Tare, TareOutcome};
use underfoot::serve::{ForceRange, ForceWatch, TileRange};
use underfoot::source::SensorSource;
use underfoot::units::Instant;

use super::failure::Failure;
use super::floor_args::FloorArgs;
use super::layout_args::LayoutArgs;
use super::number::patience;
use super::senders::ListenArgs;
use super::stop::stop_flag;

/// Options of `underfoot measure`.
///
/// Stand, step and press as people will, and see the forces on the tiles. With a layout, the forces on each control's
/// tiles are shown beside its thresholds. Ctrl-C ends it early with the results so far.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    layout: LayoutArgs,
    #[command(flatten)]
    floor: FloorArgs,
    #[command(flatten)]
    input: ListenArgs,
    /// How long to measure.
    #[arg(long, value_name = "S", default_value = "10", value_parser = patience)]
    seconds: Duration,
    /// Print the result as JSON on standard output.
    #[arg(long)]
    json: bool,
}

/// Measures the floor and prints the forces.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let floor = args.input.boards.load(&args.floor)?;
    let layout = match &args.layout.layout {
        Some(_) => Some(args.layout.load(&floor.geometry)?),
        None => None,
    };
    let mut source = args.input.open(&floor)?.source;
    let tare = Tare::suited_to(&floor);
    errln!("Listening on {} for {} s; Ctrl-C ends it.", args.input.listen, args.seconds.as_secs_f64());
    if tare != Tare::FromFloor {
        errln!("The floor has no tare: keep off it for the first second.");
    }
    let mut assembler = Assembler::with_tare(&floor, tare);
    let mut watch = ForceWatch::new(&floor);
    watch_floor(args, &mut source, &mut assembler, &mut watch)?;
    if let TareOutcome::Refused { sensor, mean, .. } = assembler.tare_outcome() {
        errln!("The floor was never empty: {sensor} read {:.0} N. Forces are not tared.", mean.0);
    }
    if watch.frames() == 0 {
        return Err(Failure::Other(format!(
            "no packets of this floor came to {} within {} s; is it switched on, and does it send here?",
            args.input.listen,
            args.seconds.as_secs_f64()
        )));
    }
    let ranges: Vec<TileRange> = watch.ranges().filter(|range| floor.geometry.has(range.tile)).collect();
    let controls: Vec<_> =
        layout.iter().flat_map(|layout| controls(layout, &floor.geometry, &ranges)).collect();
    if args.json {
        let tiles: Vec<_> = ranges.iter().map(|range| tile_json(range, &floor.geometry)).collect();
        let controls: Vec<_> = controls.iter().map(|(widget, range)| control_json(widget, range)).collect();
        outln!("{}", json!({ "frames": watch.frames(), "tiles": tiles, "controls": controls }));
    } else {
        print(&ranges, &floor.geometry);
        print_controls(&controls);
    }
    Ok(())
}

fn watch_floor(
    args: &Args,
    source: &mut dyn SensorSource,
    assembler: &mut Assembler,
    watch: &mut ForceWatch,
) -> Result<(), Failure> {
    let stop = stop_flag()?;
    let until = source.now() + args.seconds;
    let live = std::io::stderr().is_terminal();
    let mut shown = Instant::START;
    while !stop.load(Ordering::Relaxed) && source.now() < until {
        match source.next(Duration::from_millis(5))? {
            Some(packet) => assembler.take(&packet),
            None => assembler.poll(source.now()),
        }
        while let Some(frame) = assembler.ready() {
            watch.take(frame);
        }
        if live && source.now().since(shown) >= Duration::from_millis(200) {
            shown = source.now();
            if let Some((tile, force)) = watch.heaviest() {
                let left = until.since(shown).as_secs_f32();
                err!("\r{left:5.1} s left, most on tile {tile}: {:6.1} N   ", force.0);
            }
        }
    }
    if live {
        errln!();
    }
    Ok(())
}

/// Each control, with the forces on the tile under it that carried most.
fn controls<'a>(
    layout: &'a Layout,
    geometry: &Geometry,
    ranges: &[TileRange],
) -> Vec<(&'a Widget, ForceRange)> {
    let felt = |widget: &Widget| {
        let under = ranges.iter().filter(|range| geometry.plate(range.tile).overlaps(widget.area));
        under
            .map(|range| range.force)
            .max_by(|a, b| a.greatest_n.total_cmp(&b.greatest_n))
            .unwrap_or_default()
    };
    layout.widgets.iter().map(|widget| (widget, felt(widget))).collect()
}

fn print(ranges: &[TileRange], geometry: &Geometry) {
    let columns = ["whole tile"].into_iter().chain(Corner::ALL.map(|corner| geometry.sensor_name(corner)));
    let columns: Vec<&str> = columns.collect();
    let heads: String = columns.iter().map(|name| format!("  {name:^20}")).collect();
    let units: String =
        columns.iter().map(|_| format!("  {:>6} {:>6} {:>6}", "least", "median", "most")).collect();
    outln!("newtons   {}", heads.trim_end());
    outln!("tile      {units}");
    for range in ranges {
        let tile = range.tile.to_string();
        let sensors = range.sensors.iter().take(geometry.sensors(range.tile).len());
        let forces: String = std::iter::once(&range.force).chain(sensors).map(shown).collect();
        let note = match range.quality {
            Quality::Live => String::new(),
            quality => format!("  {}", quality_name(quality)),
        };
        outln!("{tile:<10}{forces}{note}");
    }
}

fn shown(range: &ForceRange) -> String {
    // Adding zero removes the sign of a zero.
    let tenths = |force: f32| (10.0 * force).round() / 10.0 + 0.0;
    let [least, median, most] = [range.least_n, range.median_n, range.greatest_n].map(tenths);
    format!("  {least:>6.1} {median:>6.1} {most:>6.1}")
}

fn quality_name(quality: Quality) -> &'static str {
    match quality {
        Quality::Live => "live",
        Quality::Degraded => "degraded at times",
        Quality::Stale => "missing at times",
        Quality::Faulty => "faulty at times",
    }
}

fn print_controls(controls: &[(&Widget, ForceRange)]) {
    if controls.is_empty() {
        return;
    }
    outln!();
    outln!("control            presses at  lets go at   least median   most on its heaviest tile");
    for (widget, range) in controls {
        let at = widget.behaviour.thresholds();
        let note = if range.greatest_n < at.press.0 { "  never pressed" } else { "" };
        outln!(
            "{:<18} {:>8.0} N  {:>8.0} N{}{note}",
            widget.id.as_str(),
            at.press.0,
            at.release.0,
            shown(range)
        );
    }
}

fn tile_json(range: &TileRange, geometry: &Geometry) -> serde_json::Value {
    let sensors: serde_json::Map<String, serde_json::Value> = geometry
        .sensors(range.tile)
        .iter()
        .map(|&corner| (geometry.sensor_name(corner).to_owned(), json!(range.sensors[corner.index()])))
        .collect();
    json!({
        "col": range.tile.column,
        "row": range.tile.row,
        "quality": range.quality,
        "force": range.force,
        "sensors": sensors,
    })
}

fn control_json(widget: &Widget, range: &ForceRange) -> serde_json::Value {
    let at = widget.behaviour.thresholds();
    json!({ "id": widget.id.as_str(), "press_n": at.press, "release_n": at.release, "force": range })
}
