//! A map of the world, operated with the feet. Without arguments it runs on a simulated floor.

// An app exports nothing: `pub` stands for what the parts use of each other.
#![allow(unreachable_pub)]

mod app;
mod chart;
mod guide;
mod inset;
mod mercator;
mod names;
mod state;
mod tiles;
mod world;

use std::error::Error;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Parser;
use eframe::egui::{self, RawInput, Rect, Vec2, pos2};
use underfoot::floor::{self, Floor};
use underfoot::runtime::Session;
use underfoot::schema::{self, Kinds};
use underfoot_egui::FootInput;
use underfoot_sim::{FloorQuality, FootHandle, Scenario, feet_by_hand, session_with};

use crate::app::Picture;
use crate::guide::Guide;
use crate::state::State;
use crate::tiles::Tiles;
use crate::world::World;

/// The floor of this app.
const ATLAS: &str = include_str!("../atlas.ron");

/// The map's area without a window, in points.
const UNSEEN: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(1280.0, 800.0) };

/// A map of the world, operated with the feet.
///
/// Without a floor, the small one in the window is a simulated one: press it with the mouse.
#[derive(Parser, Debug)]
struct Args {
    /// Follow a real floor, or `underfoot simulate`, that sends its packets to this address.
    #[arg(long, value_name = "ADDR", conflicts_with = "scenario")]
    listen: Option<String>,
    /// The real floor's hardware.
    #[arg(long, value_name = "FILE", requires = "listen")]
    floor: Option<PathBuf>,
    /// Run a simulated person by this file, and end with its last step.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Print a line of JSON whenever the map comes to rest.
    #[arg(long)]
    print_state: bool,
    /// Record the floor into a file, replacing its content: `underfoot replay` plays it again.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Open no window.
    #[arg(long)]
    no_window: bool,
    /// Show pictures in Web Mercator over the map's own shapes: those of a folder, `level/x/y.png`, or of a server,
    /// such as `http://127.0.0.1:8080/{z}/{x}/{y}.png`.
    #[arg(long, value_name = "FOLDER|URL")]
    tiles: Option<String>,
    /// The owner of the pictures, shown at the map's edge.
    #[arg(long, value_name = "TEXT", requires = "tiles")]
    attribution: Option<String>,
    /// Also open a window for a projector above the floor; the key P does the same.
    #[arg(long)]
    project: bool,
    /// Seconds without feet after which the map goes home.
    #[arg(long, value_name = "S", default_value_t = state::HOME_AFTER_S, value_parser = seconds)]
    home_after: f64,
}

fn seconds(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| format!("{text} is not a number"))?;
    if (1.0..=86_400.0).contains(&number) { Ok(number) } else { Err("1 to 86400 seconds".into()) }
}

fn main() -> Result<(), Box<dyn Error>> {
    let args = Args::parse();
    let hardware = match &args.floor {
        Some(path) => schema::load_floor(path)?,
        None => Floor::default(),
    };
    let geometry = hardware.geometry;
    let layout = schema::parse_layout(ATLAS, "atlas.ron", &Kinds::builtin(), &geometry)?.layout;
    let free =
        layout.regions.iter().find(|region| region.id == "map").map_or(floor::Rect::default(), |it| it.area);
    let (builder, hand) = match (&args.listen, &args.scenario) {
        (Some(address), _) => (Session::listen(address.as_str()).floor(hardware), None),
        (None, Some(path)) => {
            let feet = Scenario::load(path)?.resolve(&layout, &geometry)?;
            (session_with(&hardware, FloorQuality::default(), Box::new(feet))?, None)
        }
        (None, None) => {
            let (hand, driver): (FootHandle, _) = feet_by_hand();
            (session_with(&hardware, FloorQuality::default(), Box::new(driver))?, Some(hand))
        }
    };
    let mut builder = builder.layout(layout);
    if let Some(path) = &args.record {
        builder = builder.record(path);
    }
    let tiles = args.tiles.as_deref().map(Tiles::open).transpose()?;
    let (world, state) = (World::shipped()?, State::new(args.home_after));
    if args.no_window {
        unseen(Guide::new(builder.start()?, world, state, args.print_state), FootInput::new(free));
        return Ok(());
    }
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Atlas")
            .with_app_id("underfoot-map")
            .with_inner_size([1280.0, 800.0]),
        renderer: eframe::Renderer::Glow,
        dithering: false,
        ..Default::default()
    };
    let start = Box::new(move |context: &eframe::CreationContext<'_>| {
        let waker = context.egui_ctx.clone();
        let floor = builder.wake(move || waker.request_repaint()).start()?;
        let guide = Guide::new(floor, world, state, args.print_state);
        let picture = Picture { tiles, attribution: args.attribution.unwrap_or_default() };
        let app = app::App::new(&context.egui_ctx, guide, geometry, free, hand, picture, args.project);
        Ok(Box::new(app) as Box<dyn eframe::App>)
    });
    Ok(eframe::run_native("Atlas", native, start)?)
}

/// Without a window: the same feet, as touches on an invisible map.
fn unseen(mut guide: Guide, mut feet: FootInput) {
    let context = egui::Context::default();
    FootInput::tune(&context);
    let begun = Instant::now();
    while !guide.has_ended {
        let time = Some(begun.elapsed().as_secs_f64());
        let mut raw = RawInput { screen_rect: Some(UNSEEN), time, ..RawInput::default() };
        feet.follow(&context, &guide.floor, &mut raw);
        let mut drag = Vec2::ZERO;
        let seen = context.run_ui(raw, |ui| drag = app::dragged(ui, &mut feet, UNSEEN).drag_delta());
        seen.drop_without_applying_deltas();
        guide.turn(drag, 0.0);
        std::thread::sleep(Duration::from_millis(8));
    }
}
