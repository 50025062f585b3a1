//! DICOM images read with the feet. Without arguments it shows a phantom, on a simulated floor.
//!
//! An example of a user interface, not a medical device.

// An app exports nothing: `pub` stands for what the parts use of each other.
#![allow(unreachable_pub)]

mod app;
mod beam;
mod chart;
mod check;
mod feel;
mod guide;
mod phantom;
mod series;
mod state;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

use clap::{Parser, Subcommand};
use eframe::egui::{self, RawInput, Rect, pos2, vec2};
use underfoot::floor::{self, Floor};
use underfoot::layout::Layout;
use underfoot::runtime::{Session, SessionBuilder};
use underfoot::schema::{self, Kinds};
use underfoot::source::{FaultInjector, LinkFaults};
use underfoot::widget::Guard;
use underfoot_egui::FootInput;
use underfoot_sim::{FloorBuild, FloorQuality, Pace, Scenario, SimulatedSource, feet_by_hand, session_with};

use crate::app::Shelf;
use crate::feel::Feel;
use crate::guide::Guide;
use crate::state::{Sheet, State};

/// The floor of this app.
const CONSOLE: &str = include_str!("../console.ron");

/// The picture's area without a window, in points.
const UNSEEN: Rect = Rect { min: pos2(0.0, 34.0), max: pos2(908.0, 800.0) };

/// DICOM images read with the feet, while both hands are busy. NOT A MEDICAL DEVICE: an example of a user interface.
///
/// Without a folder it shows a phantom. Without a floor, the small one in the window is a simulated one: press it
/// with the mouse.
#[derive(Parser, Debug)]
#[command(args_conflicts_with_subcommands = true)]
struct Args {
    #[command(subcommand)]
    command: Option<Command>,
    /// A DICOM file, or a folder of them: all series in it and below it.
    folder: Option<PathBuf>,
    /// Follow a real floor, or `underfoot simulate`, that sends its packets to this address.
    #[arg(long, value_name = "ADDR", conflicts_with = "scenario")]
    listen: Option<String>,
    /// The real floor's hardware.
    #[arg(long, value_name = "FILE", requires = "listen")]
    floor: Option<PathBuf>,
    /// Run a simulated person by this file, and end with its last step.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Print a line of JSON whenever the viewer comes to rest.
    #[arg(long)]
    print_state: bool,
    /// Record the floor into a file, replacing its content: `underfoot replay` plays it again.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Open no window.
    #[arg(long)]
    no_window: bool,
    #[command(flatten)]
    feel: Feel,
}

/// Commands without a window and a floor.
#[derive(Subcommand, Debug)]
enum Command {
    /// Print a line of JSON for each file: its picture, or the reason why it is not shown. Ends with status 1 if one
    /// is not.
    ///
    /// A folder of this name is opened as `./check`.
    Check {
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Write the pixels of each file's first picture into this folder: grey values as `<number>.f32`,
        /// little-endian, and colours as `<number>.rgb`, by the file's place among the arguments, from 0.
        #[arg(long, value_name = "FOLDER")]
        values: Option<PathBuf>,
    },
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let args = Args::parse();
    if let Some(Command::Check { files, values }) = &args.command {
        let are_all_shown = check::check(files, values.as_deref())?;
        return Ok(if are_all_shown { ExitCode::SUCCESS } else { ExitCode::FAILURE });
    }
    view(args)?;
    Ok(ExitCode::SUCCESS)
}

/// Runs the viewer until its window closes.
fn view(args: Args) -> Result<(), Box<dyn Error>> {
    let shelf = shelf(args.folder.as_deref())?;
    let hardware = match &args.floor {
        Some(path) => schema::load_floor(path)?,
        None => Floor::default(),
    };
    let layout = schema::parse_layout(CONSOLE, "console.ron", &Kinds::builtin(), &hardware.geometry)?.layout;
    let longest_s = longest_s(&layout).ok_or("the floor has no control \"beam\" that is held to run")?;
    let free = layout.regions.iter().find(|region| region.id == "image");
    let free = free.map_or(floor::Rect::default(), |region| region.area);
    let geometry = hardware.geometry;
    let (builder, hand) = match (&args.listen, &args.scenario) {
        (Some(address), _) => (Session::listen(address.as_str()).floor(hardware), None),
        (None, Some(path)) => (played(path, &hardware, &layout)?, None),
        (None, None) => {
            let (hand, driver) = feet_by_hand();
            (session_with(&hardware, FloorQuality::default(), Box::new(driver))?, Some(hand))
        }
    };
    let mut builder = args.feel.attach(builder.layout(layout));
    if let Some(path) = &args.record {
        builder = builder.record(path);
    }
    let state = State::new(shelf.series.iter().map(Sheet::of).collect(), longest_s);
    if args.no_window {
        unseen(Guide::new(builder.start()?, state, args.print_state), FootInput::new(free));
        return Ok(());
    }
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Image console")
            .with_app_id("underfoot-surgical")
            .with_inner_size([1280.0, 800.0]),
        renderer: eframe::Renderer::Glow,
        dithering: false,
        ..Default::default()
    };
    let start = Box::new(move |context: &eframe::CreationContext<'_>| {
        let waker = context.egui_ctx.clone();
        let floor = builder.wake(move || waker.request_repaint()).start()?;
        let guide = Guide::new(floor, state, args.print_state);
        let app = app::App::new(&context.egui_ctx, guide, shelf, geometry, free, hand);
        Ok(Box::new(app) as Box<dyn eframe::App>)
    });
    Ok(eframe::run_native("Image console", native, start)?)
}

/// The series in a folder, or of the phantom.
fn shelf(folder: Option<&Path>) -> Result<Shelf, Box<dyn Error>> {
    let is_phantom = folder.is_none();
    let found = match folder {
        Some(folder) => series::read(folder).map_err(|error| format!("{}: {error}", folder.display()))?,
        None => {
            let folder = tempfile::tempdir()?;
            phantom::write(folder.path())?;
            series::read(folder.path())?
        }
    };
    for told in &found.left_out {
        eprintln!("{told}");
    }
    match folder {
        Some(folder) if found.series.is_empty() => {
            let name = folder.display();
            Err(format!("{name}: no picture that can be shown; without a folder, a phantom is shown").into())
        }
        _ => Ok(Shelf { series: found.series, left_out: found.left_out, is_phantom }),
    }
}

/// The longest time of the beam, in seconds.
fn longest_s(layout: &Layout) -> Option<f64> {
    let beam = layout.widgets.get(layout.widget_index("beam")?)?;
    match beam.behaviour.thresholds().guard {
        Guard::HoldToRun(run) => Some(run.max.as_secs_f64()),
        Guard::Free | Guard::Confirm(_) => None,
    }
}

/// A simulated floor with the people and faults of a scenario file.
fn played(path: &Path, wired: &Floor, layout: &Layout) -> Result<SessionBuilder, Box<dyn Error>> {
    /// Seed of the simulated floor.
    const SEED: u64 = 1;
    let scenario = Scenario::load(path)?;
    let mut faults = LinkFaults::default();
    for fault in scenario.faults() {
        faults = faults.and(fault.parse().map_err(|error| format!("{}: {error}", path.display()))?);
    }
    let feet = scenario.resolve(layout, &wired.geometry)?;
    let (sim, floor) = FloorBuild::of(FloorQuality::default(), SEED).in_use(wired)?;
    let source = SimulatedSource::new(sim, Box::new(feet), Pace::RealTime);
    let source = FaultInjector::new(source, faults, SEED);
    let begun = Instant::now();
    let clock = Arc::new(move || underfoot::units::Instant::START + begun.elapsed());
    Ok(Session::source(source, clock).floor(floor))
}

/// Without a window: the same feet, as touches on an invisible picture.
fn unseen(mut guide: Guide, mut feet: FootInput) {
    let context = egui::Context::default();
    FootInput::tune(&context);
    let begun = Instant::now();
    let screen = Rect::from_min_size(pos2(0.0, 0.0), vec2(1280.0, 800.0));
    while !guide.has_ended {
        let time = Some(begun.elapsed().as_secs_f64());
        let mut raw = RawInput { screen_rect: Some(screen), time, ..RawInput::default() };
        feet.follow(&context, &guide.floor, &mut raw);
        let mut drag = [0.0; 2];
        let seen = context.run_ui(raw, |ui| drag = app::dragged(ui, &mut feet, UNSEEN, &guide, [0.0; 2]));
        seen.drop_without_applying_deltas();
        guide.turn(drag);
        std::thread::sleep(Duration::from_millis(8));
    }
}
