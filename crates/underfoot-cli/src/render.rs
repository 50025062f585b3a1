//! `underfoot render`: a layout as a picture.

use std::path::PathBuf;

use underfoot::engine::{Engine, Snapshot};
use underfoot::sense::{ForceFrame, Method};
use underfoot::units::Instant;
use underfoot_scene::picture;
use underfoot_scene::scene::{self, Scene, Show, Theme, View};

use super::failure::Failure;
use super::floor_args::FloorArgs;
use super::fonts::fonts;
use super::layout_args::LayoutArgs;

/// Time for which the floor is empty before the picture is drawn, in milliseconds: longer than any control requires.
const EMPTY_MS: u64 = 100;

/// Options of `underfoot render`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    layout: LayoutArgs,
    #[command(flatten)]
    floor: FloorArgs,
    /// The picture: PNG, or SVG if the name ends in .svg.
    #[arg(short, long, value_name = "FILE", default_value = "layout.png")]
    out: PathBuf,
    /// Width of a PNG, in pixels.
    #[arg(long, value_name = "PX", default_value_t = 1200)]
    width: u32,
    /// Only the picture of a projector: no title, no ruler.
    #[arg(long)]
    bare: bool,
}

/// Draws the layout at rest.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let geometry = args.floor.load()?.geometry;
    let layout = args.layout.load_drawn(&geometry)?;
    let mut snapshot = Snapshot::default();
    let mut engine = Engine::new(geometry, layout, Method::default());
    // The floor has been empty for a while: no control waits for a foot to lift.
    let mut frame = ForceFrame::empty(&geometry);
    for millis in 1..=EMPTY_MS {
        frame.at = Instant::from_millis(millis);
        engine.step(&frame);
    }
    engine.snapshot(&mut snapshot);
    let show = if args.bare { Show::PROJECTOR } else { Show::LAYOUT };
    let mut scene = Scene::new();
    let view = View { show, ..View::new(&geometry, engine.layout(), &snapshot, &Theme::LIGHT) };
    scene::draw(&mut scene, &view);
    picture::write(&scene, fonts(), &args.out, args.width)?;
    outln!("{}", args.out.display());
    Ok(())
}
