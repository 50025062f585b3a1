//! `underfoot experiment`: the paper's figures and the accuracy tables.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use clap::Subcommand;
use serde::Serialize;
use underfoot::ground::IceSpec;
use underfoot_lab::experiment::{
    BesideTable, ExperimentError, Figure, IntentEffort, IntentSweep, IntentTable, Orientation, PeopleTable,
    PlaceTable, PondLaws, PondWalk, SceneTable, SeamObject, SeamTable, SeatedTable, SpotTable, StandTable,
    TapTable, TileScan, TwoFeet,
};
use underfoot_scene::picture;
use underfoot_sim::{FloorQuality, SceneKind};

use super::failure::Failure;
use super::fonts::fonts;
use super::output::print_json;
use super::progress::ProgressLine;
use super::quality_arg::{QualityArg, quality};

/// Options of `underfoot experiment`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Measured orientation of lines, ellipses and a disc across a seam (the paper's figure 7).
    Figure7(FigureArgs),
    /// Estimated against true positions of a point load over one tile (the paper's figure 8).
    Figure8(FigureArgs),
    /// An object of 51 N over the seam of two tiles at several angles (the paper's figure 9).
    Figure9(FigureArgs),
    /// Two feet on 2 x 2 tiles, before and after they are separated (the paper's figure 11).
    Figure11(FigureArgs),
    /// Accuracy of one contact, over a whole tile and at its seams.
    Spot(SpotArgs),
    /// Accuracy of one foot by its force and its distance from a seam: the basis of the predictions of `underfoot
    /// check`.
    Place(SpotArgs),
    /// Accuracy of both feet of people, and of the cursor of a foot that operates beside a heavy one.
    Feet(FeetArgs),
    /// Accuracy of all contacts in fourteen scenes that are hard to sense, on floors of one quality or of several:
    /// walking, shifting weight, jumping, kneeling, sticks, wheels.
    Scenes(ScenesArgs),
    /// Accuracy after calibration by standing, beside that by a load cell, on floors of each law; by the number of
    /// marks, and with the time that the person needs.
    Calibration(StandArgs),
    /// Rates of unintended activations and of missed presses: people who cross and use every shipped layout, and rows
    /// of buttons of many sizes and thresholds.
    Intent(IntentArgs),
    /// Sliders under the feet of seated people: time to the first answer, and changes of a value at rest; buttons tapped
    /// beside a foot that stands in their region, by its cursor rule.
    Controls(FeetArgs),
    /// Whether the frozen pond follows its model, and the number of cracks for each manner of walking.
    Pond(PondArgs),
}

#[derive(clap::Args, Debug)]
struct FigureArgs {
    /// Folder for the PNG, SVG and CSV files; created if it is missing.
    #[arg(long, value_name = "DIR", default_value = ".")]
    out: PathBuf,
    /// Seed of the parts of the simulated floor.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Width of the PNG, in pixels.
    #[arg(long, value_name = "PX", default_value_t = 1800)]
    width: u32,
}

#[derive(clap::Args, Debug)]
struct SpotArgs {
    /// Number of floors, each of other parts.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    floors: u64,
    #[command(flatten)]
    quality: QualityArg,
    /// Seed of the first floor's parts; the next ones follow.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Print one JSON object instead of tables.
    #[arg(long)]
    json: bool,
}

/// The floors of a calibration by standing have parts of their own spread and noise.
#[derive(clap::Args, Debug)]
struct StandArgs {
    /// Number of floors, each of other parts.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    floors: u64,
    /// Seed of the first floor's parts; the next ones follow.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Print one JSON object instead of tables.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args, Debug)]
struct FeetArgs {
    /// Number of people, each on a floor of other parts.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    people: u64,
    #[command(flatten)]
    quality: QualityArg,
    /// Seed of the first person; the next ones follow.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Print one JSON object instead of tables.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args, Debug)]
struct ScenesArgs {
    /// Number of people, each on floors of other parts.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    people: u64,
    /// Seed of the first person; the next ones follow.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Qualities of the simulated floors, separated by commas; each scene is played on a floor of each.
    #[arg(long, value_name = "QUALITY", value_delimiter = ',', default_values_t = [FloorQuality::default()], value_parser = quality())]
    quality: Vec<FloorQuality>,
    /// Print one JSON object instead of tables.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args, Debug)]
struct IntentArgs {
    /// Number of people, each on a floor of other parts.
    #[arg(long, value_name = "N", default_value_t = 120, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    people: u64,
    /// Number of steps of each person over a shipped layout; 167 of 120 people are 20,000.
    #[arg(long, value_name = "N", default_value_t = 167, value_parser = clap::value_parser!(u64).range(0..=1_000_000))]
    steps: u64,
    /// Number of intended presses of each person on a shipped layout.
    #[arg(long, value_name = "N", default_value_t = 167, value_parser = clap::value_parser!(u64).range(0..=1_000_000))]
    presses: u64,
    #[command(flatten)]
    quality: QualityArg,
    /// Seed of the first person; the next ones follow.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Folder for the tables as CSV and the plot as PNG and SVG; created if it is missing.
    #[arg(long, value_name = "DIR", default_value = ".")]
    out: PathBuf,
    /// Width of the PNG, in pixels.
    #[arg(long, value_name = "PX", default_value_t = 1800)]
    width: u32,
    /// Print one JSON object instead of tables; no files.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args, Debug)]
struct PondArgs {
    /// Number of crack events.
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(1000..=10_000_000))]
    events: u64,
    /// Number of steps for each manner of walking.
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    steps: u64,
    /// Seed of the random numbers.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u32,
    /// Folder for the pictures of the pond (PNG) and the table of walking (CSV); created if it is missing.
    #[arg(long, value_name = "DIR", default_value = ".")]
    out: PathBuf,
    /// Width of the pictures, in pixels.
    #[arg(long, value_name = "PX", default_value_t = 1400)]
    width: u32,
    /// Print one JSON object instead of tables; no files.
    #[arg(long)]
    json: bool,
}

/// Runs the experiment.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match &args.what {
        What::Figure7(args) => args.make("figure7", &Orientation::measure(args.seed)?),
        What::Figure8(args) => args.make("figure8", &TileScan::measure(args.seed)?),
        What::Figure9(args) => args.make("figure9", &SeamObject::measure(args.seed)?),
        What::Figure11(args) => args.make("figure11", &TwoFeet::measure(args.seed)?),
        What::Spot(args) => spot(args),
        What::Place(args) => place(args),
        What::Feet(args) => feet(args),
        What::Scenes(args) => scenes(args),
        What::Calibration(args) => calibration(args),
        What::Intent(args) => intent(args),
        What::Controls(args) => controls(args),
        What::Pond(args) => pond(args),
    }
}

fn pond(args: &PondArgs) -> Result<(), Failure> {
    let laws = PondLaws::measure(IceSpec::POND, args.seed, args.events);
    let walk = PondWalk::measure(args.seed.into(), args.steps)?;
    if args.json {
        #[derive(Serialize)]
        struct Tables {
            laws: PondLaws,
            walk: PondWalk,
        }
        return print_json(&Tables { laws, walk });
    }
    outln!("{laws}\n{walk}");
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |error| Failure::File(path, error)
    };
    std::fs::create_dir_all(&args.out).map_err(failed(&args.out))?;
    for (name, scene) in PondWalk::pictures(args.seed.into())? {
        let path = args.out.join(name).with_extension("png");
        picture::write(&scene, fonts(), &path, args.width)?;
        outln!("{}", path.display());
    }
    let path = args.out.join("pond_walk.csv");
    std::fs::write(&path, walk.csv()).map_err(failed(&path))?;
    outln!("{}", path.display());
    Ok(())
}

fn intent(args: &IntentArgs) -> Result<(), Failure> {
    let IntentArgs { people, steps, presses, seed, .. } = *args;
    let quality = args.quality.quality;
    let progress = ProgressLine::of("person", people);
    // Every fourth person also uses the rows of buttons, with as many presses and fewer steps: each crosses all rows.
    let sweepers = people.div_ceil(4);
    let on_rows = IntentEffort { steps: (2 * steps).div_ceil(5), presses };
    let empty = || (IntentTable::on(quality), IntentSweep::on(quality));
    let (mut table, mut sweep) = empty();
    // In the order of people, not of completion: the same seed gives the same table.
    for person in in_parallel(&progress, people, |number| {
        let seed = seed.wrapping_add(number);
        let (mut table, mut sweep) = empty();
        table.add_person(seed, number, IntentEffort { steps, presses })?;
        if number < sweepers {
            sweep.add_person(seed.wrapping_add(people), number, on_rows)?;
        }
        Ok((table, sweep))
    })? {
        table.append(person.0);
        sweep.append(&person.1);
    }
    drop(progress);
    if args.json {
        #[derive(Serialize)]
        struct Tables<L, C> {
            lines: Vec<L>,
            cells: C,
        }
        return print_json(&Tables { lines: table.lines().collect(), cells: sweep.cells() });
    }
    outln!("{table}");
    FigureArgs { out: args.out.clone(), seed: args.seed, width: args.width }.make("intent_sweep", &sweep)?;
    let path = args.out.join("intent.csv");
    std::fs::write(&path, table.csv()).map_err(|error| Failure::File(path.clone(), error))?;
    outln!("{}", path.display());
    Ok(())
}

fn controls(args: &FeetArgs) -> Result<(), Failure> {
    let quality = args.quality.quality;
    let (mut seated, mut beside) = (SeatedTable::on(quality), BesideTable::on(quality));
    let progress = ProgressLine::of("visit", 2 * args.people);
    for visit in in_parallel(&progress, args.people, |number| {
        let mut seated = SeatedTable::on(quality);
        seated.add_person(args.seed.wrapping_add(number))?;
        Ok(seated)
    })? {
        seated.append(visit);
    }
    if !args.json {
        progress.print(&seated);
    }
    for visit in in_parallel(&progress, args.people, |number| {
        let mut beside = BesideTable::on(quality);
        beside.add_person(args.seed.wrapping_add(number))?;
        Ok(beside)
    })? {
        beside.append(&visit);
    }
    if !args.json {
        progress.print(&beside);
        return Ok(());
    }
    #[derive(Serialize)]
    struct Tables<S, B> {
        seated: Vec<S>,
        beside: Vec<B>,
    }
    print_json(&Tables { seated: seated.lines().collect(), beside: beside.lines().collect() })
}

/// Calls `act` `times` times on all processors, and counts each call in `progress`; returns the results in order.
fn in_parallel<T: Send>(
    progress: &ProgressLine,
    times: u64,
    act: impl Fn(u64) -> Result<T, ExperimentError> + Sync,
) -> Result<Vec<T>, Failure> {
    let next = AtomicU64::new(0);
    let done = Mutex::new(Vec::new());
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= times {
                        break;
                    }
                    let result = act(number);
                    let failed = result.is_err();
                    let Ok(mut done) = done.lock() else { break };
                    done.push((number, result));
                    progress.advance();
                    if failed {
                        next.store(times, Ordering::Relaxed);
                    }
                }
            });
        }
    });
    let mut done = done.into_inner().map_err(|_| Failure::Other("a thread of the experiment died".into()))?;
    done.sort_by_key(|(number, _)| *number);
    Ok(done.into_iter().map(|(_, result)| result).collect::<Result<_, _>>()?)
}

impl FigureArgs {
    /// Writes the picture twice and its data, and reports the results and the paths.
    fn make(&self, name: &str, figure: &dyn Figure) -> Result<(), Failure> {
        let failed = |path: &Path| {
            let path = path.to_path_buf();
            move |error| Failure::File(path, error)
        };
        std::fs::create_dir_all(&self.out).map_err(failed(&self.out))?;
        let scene = figure.draw();
        out!("{}", figure.summary());
        for ending in ["png", "svg"] {
            let path = self.out.join(name).with_extension(ending);
            picture::write(&scene, fonts(), &path, self.width)?;
            outln!("{}", path.display());
        }
        let path = self.out.join(name).with_extension("csv");
        std::fs::write(&path, figure.csv()).map_err(failed(&path))?;
        outln!("{}", path.display());
        Ok(())
    }
}

fn spot(args: &SpotArgs) -> Result<(), Failure> {
    let quality = args.quality.quality;
    let (mut tile, mut seam) = (SpotTable::on(quality, 15), SeamTable::on(quality));
    let progress = ProgressLine::of("floor", 2 * args.floors);
    for number in 0..args.floors {
        tile.add_floor(args.seed.wrapping_add(number))?;
        progress.advance();
    }
    if !args.json {
        progress.print(&tile);
    }
    for number in 0..args.floors {
        seam.add_floor(args.seed.wrapping_add(number))?;
        progress.advance();
    }
    if !args.json {
        progress.print(&seam);
        return Ok(());
    }
    #[derive(Serialize)]
    struct Tables<L> {
        lines: Vec<L>,
    }
    print_json(&Tables { lines: tile.lines().chain(seam.lines()).collect() })
}

fn place(args: &SpotArgs) -> Result<(), Failure> {
    let mut table = PlaceTable::on(args.quality.quality, 96);
    let progress = ProgressLine::of("floor", args.floors);
    for number in 0..args.floors {
        table.add_floor(args.seed.wrapping_add(number))?;
        progress.advance();
    }
    if args.json {
        return print_json(&table.lines().collect::<Vec<_>>());
    }
    progress.print(&table);
    Ok(())
}

fn calibration(args: &StandArgs) -> Result<(), Failure> {
    let mut table = StandTable::default();
    let progress = ProgressLine::of("floor", args.floors);
    // In the order of floors, not of completion: the same seed gives the same table.
    for floor in in_parallel(&progress, args.floors, |number| {
        let mut table = StandTable::default();
        table.add_floor(args.seed.wrapping_add(number))?;
        Ok(table)
    })? {
        table.append(floor);
    }
    if args.json {
        return print_json(&table.lines().collect::<Vec<_>>());
    }
    progress.print(&table);
    Ok(())
}

/// Plays scene after scene with all people, and prints the rows of each as soon as it is complete.
fn scenes(args: &ScenesArgs) -> Result<(), Failure> {
    let mut table = SceneTable::on(&args.quality);
    let progress = ProgressLine::of("scene", args.people * SceneKind::ALL.len() as u64);
    if !args.json {
        out!("{}", SceneTable::heading(args.people));
    }
    for kind in SceneKind::ALL {
        // In the order of people, not of completion: the same seed gives the same table.
        for person in in_parallel(&progress, args.people, |number| {
            let mut table = SceneTable::on(&args.quality);
            table.add_scene(kind, args.seed.wrapping_add(number))?;
            Ok(table)
        })? {
            table.append(person);
        }
        if !args.json {
            progress.print(&table.rows(Some(kind)));
        }
    }
    if args.json {
        return print_json(&table.lines().collect::<Vec<_>>());
    }
    progress.print(&table.rows(None));
    Ok(())
}

fn feet(args: &FeetArgs) -> Result<(), Failure> {
    let quality = args.quality.quality;
    let (mut people, mut taps) = (PeopleTable::on(quality), TapTable::on(quality));
    let progress = ProgressLine::of("visit", 2 * args.people);
    for visit in in_parallel(&progress, args.people, |number| {
        let mut people = PeopleTable::on(quality);
        people.add_person(args.seed.wrapping_add(number))?;
        Ok(people)
    })? {
        people.append(visit);
    }
    if !args.json {
        progress.print(&people);
    }
    for tapping in in_parallel(&progress, args.people, |number| {
        let mut taps = TapTable::on(quality);
        taps.add_person(args.seed.wrapping_add(number))?;
        Ok(taps)
    })? {
        taps.append(tapping);
    }
    if !args.json {
        progress.print(&taps);
        return Ok(());
    }
    #[derive(Serialize)]
    struct Tables<P, T> {
        people: Vec<P>,
        taps: Vec<T>,
    }
    print_json(&Tables { people: people.lines().collect(), taps: taps.lines().collect() })
}

impl From<ExperimentError> for Failure {
    fn from(error: ExperimentError) -> Self {
        Self::Other(error.to_string())
    }
}
