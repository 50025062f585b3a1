//! `underfoot calibrate stand`: the laws of all sensors from a person who stands on marks.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use underfoot::floor::{Floor, LawKind, TileId};
use underfoot::sense::{StandFit, StandingMark};
use underfoot::serve::{StandNews, StandTask, StandWalk};
use underfoot::source::SensorSource;
use underfoot::units::Newtons;
use underfoot_window::setup::{keep_laws, mark_words};

use super::stand_report::{as_json, more, print, print_marks};
use super::{Out, say_if_unsaved, today};
use crate::failure::Failure;
use crate::floor_args::FloorArgs;
use crate::number::{number, patience, tile};
use crate::senders::ListenArgs;
use crate::stop::stop_flag;

/// Options of `underfoot calibrate stand`.
///
/// A person of known weight stands still on the marks of each tile, its middle and one towards each sensor, both feet
/// together with the middle between them on the mark, for three seconds each, and walks from mark to mark without
/// leaving the floor. No load cell is needed, but the boards must send counts. One least-squares problem finds the law
/// of every sensor: the forces add up to the weight, and the centroid lies at the mark. It reports which sensors need
/// more stands; --tiles and --rounds repeat them. Ctrl-C ends the walk early and uses the stands so far.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Weight of the person in kilograms, in the clothes and shoes of the walk.
    #[arg(long, value_name = "KG", required_unless_present = "marks", value_parser = kilograms)]
    weight_kg: Option<f64>,
    #[command(flatten)]
    floor: FloorArgs,
    #[command(flatten)]
    input: ListenArgs,
    /// The tiles to stand on, as column,row with blanks between them; all without it.
    #[arg(long, value_name = "C,R", num_args = 1.., value_parser = tile)]
    tiles: Vec<TileId>,
    /// How many times to go over all marks; the second time, the person faces the other way.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=20))]
    rounds: u8,
    /// The kind of law of all sensors; without it, the one that fits best.
    #[arg(long, value_name = "LAW", value_parser = law)]
    law: Option<LawKind>,
    /// Only print the marks, to put them on the floor with tape.
    #[arg(long)]
    marks: bool,
    /// How long to wait for a stand on each mark; then the mark is left out.
    #[arg(long, value_name = "S", default_value = "60", value_parser = patience)]
    wait: Duration,
    /// Output file for the calibrated floor; without it, the file given with --floor.
    #[arg(long, value_name = "FLOOR.ron")]
    out: Option<PathBuf>,
    /// Print the result as JSON on standard output.
    #[arg(long)]
    json: bool,
}

fn kilograms(text: &str) -> Result<f64, String> {
    number(text, &(15.0..=300.0), "kilograms")
}

fn law(text: &str) -> Result<LawKind, String> {
    let names = LawKind::ALL.map(LawKind::name);
    let kind = LawKind::ALL.into_iter().find(|kind| kind.name() == text);
    kind.ok_or_else(|| format!("expected {}", names.join(", ")))
}

/// Acceleration of gravity (m/s²), the standard value.
const GRAVITY: f64 = 9.806_65;

/// Walks over the marks, fits the laws, reports them, and saves the floor.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let out = Out::new(args.out.as_deref(), &args.floor);
    let mut floor = if args.marks { args.floor.load()? } else { args.input.boards.load(&args.floor)? };
    let marks = marks(args, &floor)?;
    let Some(weight_kg) = args.weight_kg.filter(|_| !args.marks) else {
        print_marks(&marks, &floor, args.json);
        return Ok(());
    };
    let walk = walk_over(args, &floor, marks)?;
    let weight = Newtons((weight_kg * GRAVITY) as f32);
    let fit = StandFit::of(walk.data(), weight, &floor.geometry, args.law)
        .map_err(|error| Failure::Other(error.to_string()))?;
    keep_laws(&mut floor, &fit, today());
    let saved = out.save(&floor)?;
    if args.json {
        outln!("{}", as_json(&fit, &floor, saved.as_ref()));
    } else {
        print(&fit, &walk, &floor);
        say_if_unsaved(saved.as_ref());
    }
    match more(&fit, &walk, &floor) {
        Some(more) => Err(Failure::Other(more)),
        None => Ok(()),
    }
}

/// The marks of the chosen tiles.
fn marks(args: &Args, floor: &Floor) -> Result<Vec<StandingMark>, Failure> {
    let geometry = &floor.geometry;
    if let Some(tile) = args.tiles.iter().find(|tile| !geometry.has(**tile)) {
        return Err(Failure::Other(format!("this floor has no tile {tile}")));
    }
    let mut tiles = StandingMark::walk(geometry);
    if !args.tiles.is_empty() {
        tiles.retain(|tile| args.tiles.contains(tile));
    }
    Ok(StandingMark::of_tiles(geometry, &tiles, args.rounds.into()))
}

/// Follows a person from mark to mark.
fn walk_over(args: &Args, floor: &Floor, marks: Vec<StandingMark>) -> Result<StandWalk, Failure> {
    let mut source = args.input.open(floor)?.source;
    let stop = stop_flag()?;
    errln!("Listening on {}; keep off the floor for two seconds.", args.input.listen);
    let mut walk = StandWalk::new(floor, marks);
    follow(args.wait, &stop, source.as_mut(), &mut walk, floor)?;
    Ok(walk)
}

fn follow(
    wait: Duration,
    stop: &AtomicBool,
    source: &mut dyn SensorSource,
    walk: &mut StandWalk,
    floor: &Floor,
) -> Result<(), Failure> {
    let (mut shown, mut since) = (None, source.now());
    while walk.task() != StandTask::Nothing && !stop.load(Ordering::Relaxed) {
        if let StandTask::Go(mark) = walk.task()
            && shown != Some(walk.done())
        {
            (shown, since) = (Some(walk.done()), source.now());
            outln!("{:>3} of {}: {}", walk.done() + 1, walk.length(), mark_words(&mark, floor));
        }
        if source.now().since(since) >= wait {
            if let Some(reason) = unheard(walk, source) {
                return Err(Failure::Other(format!("waited {} s: {reason}", wait.as_secs_f64())));
            }
            errln!("  left out: nobody stood there for {} s", wait.as_secs_f64());
            walk.skip();
            since = source.now();
        }
        let Some(packet) = source.next(Duration::from_millis(20))? else { continue };
        if let Some(news) = walk.take(&packet) {
            tell(news);
        }
        if walk.has_newtons() {
            let message = "the boards send newtons, so they calibrate themselves: they must send counts";
            return Err(Failure::Other(message.into()));
        }
    }
    Ok(())
}

/// Reports a stand, with a sound on a terminal: the person looks at the marks.
fn tell(news: StandNews) {
    let bell = if std::io::stdout().is_terminal() { "\u{7}" } else { "" };
    match news {
        StandNews::Kept(_) => outln!("  measured{bell}"),
        StandNews::Saturated(_) => {
            outln!("  measured, but a sensor is at the end of its range there: this stand tells less{bell}");
        }
        StandNews::Moved(_) => outln!("  moved: stand still for three seconds"),
        StandNews::Elsewhere { mark, felt } => {
            outln!("  tile {felt} feels it, not {}: stand on the mark{bell}{bell}", mark.tile);
        }
    }
}

/// The reason for which no stand can be measured, if any.
fn unheard(walk: &StandWalk, source: &dyn SensorSource) -> Option<String> {
    let silent: Vec<&str> = walk.silent(source.now()).collect();
    if !silent.is_empty() {
        return Some(format!("nothing comes from {}", silent.join(", ")));
    }
    if let Some(sensor) = walk.unread().next() {
        return Some(format!("the sensor of {sensor} gives no reading"));
    }
    (walk.task() == StandTask::KeepOff).then(|| "the floor is not empty and quiet".to_owned())
}
