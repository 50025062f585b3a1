//! `underfoot capacity`: how large a floor this machine carries.

use std::time::{Duration, Instant};

use clap::Args as ClapArgs;
use serde_json::json;
use underfoot::capacity::{BankLoad, RenderLoad, RenderWork, SensingLoad, modal_error_db};
use underfoot::floor::Geometry;

use super::failure::Failure;
use super::number::patience;
use super::progress::Progress;

/// What `underfoot capacity` is asked to do.
///
/// Does standard work as fast as it can, on one core, and says how much faster than real time that was: the
/// rendering of 36 tiles at 96 kHz, and the sensing of three sizes of floor with people walking on them. Takes about
/// ten seconds. Other programs at work make the answer smaller.
#[derive(ClapArgs, Clone, Debug)]
pub(crate) struct Args {
    /// How long each load is measured.
    #[arg(long, value_name = "S", default_value = "1", value_parser = patience)]
    seconds: Duration,
    /// Print the result as JSON on standard output.
    #[arg(long)]
    json: bool,
}

/// Share of a core that either half of the work may take, so that there is room for everything else.
const HALF_A_CORE: f64 = 0.5;

/// Channels and tiles of the loads that the floor is judged by.
const RENDERED_TILES: f64 = 36.0;
const SENSED_SIDE: u16 = 96;

/// Walkers per tile: two on 6 x 6.
const WALKERS: u16 = SENSED_SIDE * SENSED_SIDE / 18;

/// Loads that are measured: six of rendering, four of sensing.
const LOADS: u64 = 10;

/// One line of the answer.
struct Measured {
    id: &'static str,
    name: String,
    /// Seconds of floor per second of work.
    times_real_time: f64,
}

/// Measures, and prints what was found.
///
/// # Errors
/// None; the type is every command's.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if cfg!(debug_assertions) {
        errln!("This is a debug build: a release build is many times faster.");
    }
    let length = args.seconds;
    let progress = Progress::of("load", LOADS);
    let rendering = rendering(length, &progress);
    let sensing = sensing(length, &progress);
    drop(progress);
    let errors = [48_000, 96_000].map(|rate| (rate, modal_error_db(rate, 1)));
    let factor = |all: &[Measured]| all.last().map_or(0.0, |measured| measured.times_real_time);
    let felt_tiles = (RENDERED_TILES * HALF_A_CORE * factor(&rendering)).floor();
    let sensed_tiles = (f64::from(SENSED_SIDE).powi(2) * HALF_A_CORE * factor(&sensing)).floor();
    let side = felt_tiles.min(sensed_tiles).sqrt().floor().min(f64::from(Geometry::MAX_SIDE));
    if args.json {
        let table = |all: &[Measured]| -> serde_json::Map<_, _> {
            all.iter().map(|one| (one.id.to_owned(), json!(one.times_real_time))).collect()
        };
        let errors: serde_json::Map<_, _> =
            errors.iter().map(|(rate, error)| (rate.to_string(), json!(error))).collect();
        outln!(
            "{}",
            json!({
                "render_x_real_time": table(&rendering),
                "sense_x_real_time": table(&sensing),
                "modal_error_db": errors,
                "felt_tiles": felt_tiles,
                "sensed_tiles": sensed_tiles,
                "side_tiles": side,
            })
        );
        return Ok(());
    }
    outln!("Rendering 36 tiles at 96 kHz in blocks of 64 frames, on one core:");
    rendering.iter().for_each(print);
    outln!("Sensing at 1 kHz, on one core:");
    sensing.iter().for_each(print);
    outln!("Error of modal banks against double precision:");
    for (rate, error) in errors {
        outln!("  {:<52} {error:>7.1} dB", format!("{} kHz", rate / 1000));
    }
    outln!(
        "With half a core for either, this machine feels {felt_tiles} tiles in use at once and senses at least \
         {sensed_tiles} with two people on each 6 x 6: a floor of {side} x {side} tiles."
    );
    Ok(())
}

fn print(measured: &Measured) {
    let digits = if measured.times_real_time < 10.0 { 2 } else { 0 };
    outln!("  {:<52} {:>7.digits$} x real time", measured.name, measured.times_real_time);
}

fn rendering(length: Duration, progress: &Progress) -> Vec<Measured> {
    let mut all = Vec::new();
    for (id, modes) in [("banks_8", 8), ("banks_64", 64)] {
        let mut load = BankLoad::new(modes);
        let name = format!("modal banks alone, {modes} modes struck 20 times a second");
        all.push(Measured { id, name, times_real_time: measure(length, || load.second()) });
        progress.advance();
    }
    for (id, name, work) in [
        ("modes_8", "8 modes struck 20 times a second", RenderWork::of_modes(8)),
        ("modes_64", "64 modes struck 20 times a second", RenderWork::of_modes(64)),
        ("silence", "silence", RenderWork::of_modes(0)),
        (
            "modes_8_friction_limiter",
            "8 modes, friction and limiter",
            RenderWork::with_friction_and_limiter(),
        ),
    ] {
        let mut load = RenderLoad::new(work);
        all.push(Measured { id, name: name.into(), times_real_time: measure(length, || load.second()) });
        progress.advance();
    }
    all
}

fn sensing(length: Duration, progress: &Progress) -> Vec<Measured> {
    let sizes = [
        ("6x6_2_walkers", 6, 2),
        ("24x24_2_walkers", 24, 2),
        ("96x96_2_walkers", SENSED_SIDE, 2),
        ("96x96_512_walkers", SENSED_SIDE, WALKERS),
    ];
    sizes
        .into_iter()
        .map(|(id, side, walkers)| {
            let mut load = SensingLoad::new(side, walkers);
            let name = format!("{side} x {side} tiles, {walkers} walkers");
            let times_real_time = measure(length, || {
                load.second();
            });
            progress.advance();
            Measured { id, name, times_real_time }
        })
        .collect()
}

/// How many seconds of floor go into a second of work: the median of as many as are done in `length`, three at least.
fn measure(length: Duration, mut second: impl FnMut()) -> f64 {
    // Tables, caches and the processor's clock warm up first.
    second();
    let mut factors = Vec::new();
    let begun = Instant::now();
    while factors.len() < 3 || begun.elapsed() < length {
        let start = Instant::now();
        second();
        factors.push(start.elapsed().as_secs_f64().recip());
    }
    factors.sort_unstable_by(f64::total_cmp);
    factors[factors.len() / 2]
}
