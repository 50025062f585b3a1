//! `underfoot capacity`: the largest floor that this machine can serve.

use std::num::NonZeroUsize;
use std::time::Duration;

use clap::Args as ClapArgs;
use serde_json::json;
use underfoot::floor::Geometry;
use underfoot::parallel::ThreadPool;
use underfoot_lab::capacity::{
    AssemblyLoad, BankLoad, PacketLoad, RenderLoad, RenderWork, SensingLoad, ServeLoad, modal_error_db,
};

use super::failure::Failure;
use super::meter::{Measured, Meter};
use super::number::{patience, threads};

/// Options of `underfoot capacity`.
///
/// Runs standard loads as fast as possible on one core and reports how many times faster than real time they are: the
/// rendering of 36 tiles at 96 kHz, the reading and assembling of packets, the sensing of three sizes of floor with
/// people walking on them, and a running floor. Also reports the first limit of this machine. Takes about twenty
/// seconds. Other running programs make the result smaller.
#[derive(ClapArgs, Clone, Debug)]
pub(crate) struct Args {
    /// How long each load is measured.
    #[arg(long, value_name = "S", default_value = "1", value_parser = patience)]
    seconds: Duration,
    /// Number of cores that run each load at once, every core a floor of its own; `all` for every core.
    #[arg(long, value_name = "N|all", default_value = "1", value_parser = threads)]
    threads: NonZeroUsize,
    /// Number of cores that sense the feet of a crowd on one floor.
    #[arg(long, value_name = "N|all", default_value = "1", value_parser = threads, conflicts_with = "threads")]
    sensing_threads: NonZeroUsize,
    /// Print the result as JSON on standard output.
    #[arg(long)]
    json: bool,
}

/// Share of the cores that each kind of work may use; the rest is left for everything else.
const HALF: f64 = 0.5;

/// Channels and tiles of the loads that determine the result.
const RENDERED_TILES: f64 = 36.0;
const SENSED_SIDE: u16 = 96;

/// Number of walkers: two per 6 x 6 tiles.
const WALKERS: u16 = SENSED_SIDE * SENSED_SIDE / 18;

/// Size of the served floor: as large as one core may still carry.
const SERVED_SIDE: u16 = 36;
const SERVED_WALKERS: u16 = SERVED_SIDE * SERVED_SIDE / 18;

/// Number of measured loads: six of rendering, three of receiving, four of sensing, one of serving.
const LOADS: u64 = 14;

/// One kind of work, and the number of tiles that half of the cores can process.
struct Limit {
    id: &'static str,
    name: &'static str,
    tiles: f64,
}

/// Measures, and prints the results.
///
/// # Errors
/// [`Failure`] if this machine receives no packet from itself.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if cfg!(debug_assertions) {
        errln!("This is a debug build: a release build is many times faster.");
    }
    let pool = ThreadPool::new(args.sensing_threads)?;
    let meter = Meter::new(args.seconds, args.threads, LOADS);
    let rendering = rendering(&meter);
    let receiving = receiving(&meter)?;
    let sensing = sensing(&meter, &pool);
    let serving = [serving(&meter)];
    drop(meter);
    let errors = [48_000, 96_000].map(|rate| (rate, modal_error_db(rate, 1)));
    let limits = limits(&rendering, &receiving, &sensing);
    let together = together(&limits, &serving);
    let first = first(&limits, together);
    let tiles = first.tiles.min(together);
    let side = tiles.sqrt().floor().min(f64::from(Geometry::MAX_SIDE));
    if args.json {
        let table = |all: &[Measured]| -> serde_json::Map<_, _> {
            all.iter().map(|one| (one.id.to_owned(), json!(one.times_real_time))).collect()
        };
        let errors: serde_json::Map<_, _> =
            errors.iter().map(|(rate, error)| (rate.to_string(), json!(error))).collect();
        let mut tiles: serde_json::Map<_, _> =
            limits.iter().map(|limit| (limit.id.to_owned(), json!(limit.tiles))).collect();
        tiles.insert("one_core".to_owned(), json!(together));
        outln!(
            "{}",
            json!({
                "threads": args.threads,
                "sensing_threads": args.sensing_threads,
                "render_x_real_time": table(&rendering),
                "receive_x_real_time": table(&receiving),
                "sense_x_real_time": table(&sensing),
                "serve_x_real_time": table(&serving),
                "modal_error_db": errors,
                "tiles": tiles,
                "first_limit": first.id,
                "side_tiles": side,
            })
        );
        return Ok(());
    }
    let cores = match args.threads.get() {
        1 => "one core".to_owned(),
        many => format!("{many} cores together"),
    };
    outln!("Rendering 36 tiles at 96 kHz in blocks of 64 frames, on {cores}:");
    rendering.iter().for_each(print);
    outln!("Receiving at 1 kHz, on {cores}:");
    receiving.iter().for_each(print);
    match args.sensing_threads.get() {
        1 => outln!("Sensing at 1 kHz, on {cores}:"),
        many => outln!("Sensing at 1 kHz, crowds on {many} cores:"),
    }
    sensing.iter().for_each(print);
    outln!("A floor at work but for its socket and its sound, on {cores}:");
    serving.iter().for_each(print);
    outln!("Error of modal banks against double precision:");
    for (rate, error) in errors {
        outln!("  {:<52} {error:>7.1} dB", format!("{} kHz", rate / 1000));
    }
    outln!("Tiles for which half of that is enough:");
    for Limit { name, tiles, .. } in &limits {
        outln!("  {name:<52} {tiles:>7.0}");
    }
    outln!("  {:<52} {together:>7.0}", "all but sound, on the one core that they share");
    outln!("First limit of this machine: {}: a floor of {side} x {side} tiles.", first.name);
    Ok(())
}

/// Maximum number of tiles for each kind of work, by its heaviest load on an ordinary floor.
fn limits(rendering: &[Measured], receiving: &[Measured], sensing: &[Measured]) -> [Limit; 4] {
    let factor = |all: &[Measured], id: &str| {
        all.iter().find(|measured| measured.id == id).map_or(0.0, |measured| measured.times_real_time)
    };
    let floor = f64::from(SENSED_SIDE).powi(2);
    let limit =
        |id, name, tiles: f64, factor: f64| Limit { id, name, tiles: (tiles * HALF * factor).floor() };
    [
        limit("packets", "receiving and reading packets", floor, factor(receiving, "96x96_socket")),
        limit("assembling", "assembling frames", floor, factor(receiving, "96x96_frames")),
        limit("sensing", "sensing, two people on each 6 x 6", floor, factor(sensing, "96x96_512_walkers")),
        limit(
            "sound",
            "sound, on tiles in use at once",
            RENDERED_TILES,
            factor(rendering, "modes_8_friction_limiter"),
        ),
    ]
}

/// Number of tiles for one core that receives, assembles and senses, and does all other work of a running floor.
fn together(limits: &[Limit; 4], serving: &[Measured]) -> f64 {
    let [packets, ..] = limits;
    let served = f64::from(SERVED_SIDE).powi(2) * HALF;
    let served: f64 = serving.iter().map(|measured| served * measured.times_real_time).sum();
    // Times add up, and each is the reciprocal of a number of tiles.
    (packets.tiles.recip() + served.recip()).recip().floor()
}

/// The first limit: sound, or the largest part of the work on the core that the others share.
fn first(limits: &[Limit; 4], together: f64) -> &Limit {
    let [packets, assembling, sensing, sound] = limits;
    if sound.tiles <= together {
        return sound;
    }
    let others = [packets, assembling, sensing].into_iter();
    others.fold(sensing, |least, one| if one.tiles < least.tiles { one } else { least })
}

fn print(measured: &Measured) {
    let digits = if measured.times_real_time < 10.0 { 2 } else { 0 };
    outln!("  {:<52} {:>7.digits$} x real time", measured.name, measured.times_real_time);
}

fn rendering(meter: &Meter) -> Vec<Measured> {
    let mut all = Vec::new();
    for (id, modes) in [("banks_8", 8), ("banks_64", 64)] {
        let name = format!("modal banks alone, {modes} modes struck 20 times a second");
        all.push(meter.measure(id, name, || {
            let mut load = BankLoad::new(modes);
            move || load.second()
        }));
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
        all.push(meter.measure(id, name.into(), || {
            let mut load = RenderLoad::new(work);
            move || load.second()
        }));
    }
    all
}

fn receiving(meter: &Meter) -> Result<Vec<Measured>, Failure> {
    let side = SENSED_SIDE;
    let name = format!("packets of {side} x {side} tiles, from the socket on");
    let socket = meter.measure_sockets("96x96_socket", name)?;
    let packets =
        meter.measure("96x96_packets", format!("packets of {side} x {side} tiles in memory"), || {
            let mut load = PacketLoad::new(side);
            move || {
                load.second();
            }
        });
    let frames = meter.measure("96x96_frames", format!("assembling {side} x {side} tiles"), || {
        let mut load = AssemblyLoad::new(side);
        move || {
            load.second();
        }
    });
    Ok(vec![socket, packets, frames])
}

fn sensing(meter: &Meter, pool: &ThreadPool) -> Vec<Measured> {
    let sizes = [
        ("6x6_2_walkers", 6, 2),
        ("24x24_2_walkers", 24, 2),
        ("96x96_2_walkers", SENSED_SIDE, 2),
        ("96x96_512_walkers", SENSED_SIDE, WALKERS),
    ];
    let measured = sizes.into_iter().map(|(id, side, walkers)| {
        meter.measure(id, format!("{side} x {side} tiles, {walkers} walkers"), || {
            let mut load = SensingLoad::new(side, walkers);
            move || {
                pool.run(|| load.second());
            }
        })
    });
    measured.collect()
}

fn serving(meter: &Meter) -> Measured {
    let (side, walkers) = (SERVED_SIDE, SERVED_WALKERS);
    meter.measure("36x36_72_walkers", format!("{side} x {side} tiles, {walkers} walkers"), || {
        let mut load = ServeLoad::new(side, walkers);
        move || {
            load.second();
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_limits_first_is_what_carries_the_fewest_tiles() {
        let measured = |id, times_real_time: f64| Measured { id, name: String::new(), times_real_time };
        let found = limits(
            &[measured("modes_8_friction_limiter", 100.0)],
            &[measured("96x96_socket", 2.0), measured("96x96_frames", 5.0)],
            &[measured("96x96_512_walkers", 0.5)],
        );
        assert_eq!(found.each_ref().map(|limit| limit.tiles), [9216.0, 23_040.0, 2304.0, 1800.0]);
        // Half of a core serves 36 x 36 tiles at twice real time; with their packets, 1296 x 9216 / (1296 + 9216).
        let tiles = together(&found, &[measured("36x36_72_walkers", 2.0)]);
        assert_eq!(tiles, 1136.0);
        assert_eq!(first(&found, tiles).id, "sensing");
        assert_eq!(first(&found, 1801.0).id, "sound");
    }
}
