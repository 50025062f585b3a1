//! The program `underfoot`: its command line, one file per subcommand. See `underfoot --help`.
//!
//! Exit status 0: success; 1: the work failed (standard error has the next step), or output could not be written; 2:
//! wrong usage.

#[macro_use]
mod output;

mod actuate;
mod addresses;
mod area_args;
mod calibrate;
#[cfg(feature = "lab")]
mod capacity;
mod check;
mod console;
#[cfg(feature = "lab")]
mod experiment;
mod export;
mod failure;
mod fault_args;
#[cfg(feature = "lab")]
mod feel;
mod fitted_floor;
mod floor_args;
mod fonts;
mod guardian;
mod latency;
mod layout_args;
mod linked;
mod man;
mod measure;
#[cfg(feature = "lab")]
mod meter;
mod number;
mod outputs;
mod own_program;
mod people;
#[cfg(feature = "lab")]
mod plan;
mod play;
#[cfg(feature = "preview")]
mod preview;
#[cfg(feature = "lab")]
mod progress;
mod quality_arg;
mod rack;
mod reference;
mod render;
mod replay;
mod run;
mod send_args;
mod senders;
mod sense;
mod session;
mod setup;
mod share;
mod simulate;
mod stop;
mod table;
mod watch;
mod web;
mod wiring;

use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use tracing_subscriber::EnvFilter;

use failure::Failure;

/// User interfaces on the floor: force-sensing tiles in, foot controls and tactile feedback out.
///
/// Without a command: opens a window with a simulated floor on the built-in map layout, where the mouse
/// is a foot. Without a display: plays a built-in session and leaves a picture, a sound file and an event log.
#[derive(Debug, Parser)]
#[command(name = "underfoot", version, propagate_version = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// Log more on standard error (-v: more, -vv: everything).
    #[arg(short, long, action = clap::ArgAction::Count, global = true)]
    verbose: u8,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Open the window on a layout: a simulated floor with the mouse as a foot, a scenario, or a real floor.
    #[cfg(feature = "preview")]
    Preview(Box<preview::Args>),
    /// Serve a floor: sensor packets in, events and actuator samples out.
    Run(Box<run::Args>),
    /// Play a scenario on a simulated floor in a process of its own, sending real packets.
    Simulate(simulate::Args),
    /// Play the built-in session, or the visit in a link, without a window and leave a picture, a sound file and an event
    /// log.
    Session(session::Args),
    /// Replay a recorded floor: the same events, at any speed.
    Replay(replay::Args),
    /// Write a recorded floor's forces, contacts and events as tables.
    Export(export::Args),
    /// Read layouts and report all their problems.
    Check(check::Args),
    /// List every OSC address of a layout, in and out, with its arguments.
    Addresses(addresses::Args),
    /// List the fields of layouts, kinds and effects: each with its unit, range and default.
    Reference(reference::Args),
    /// Render an effect: sound, picture, figures; read and write Apple's haptic patterns.
    #[cfg(feature = "lab")]
    Feel(feel::Args),
    /// Print a link that opens the layout in a browser, or in `underfoot preview`: the layout is in the link itself.
    Share(share::Args),
    /// Draw a layout to a PNG or SVG file; needs no display.
    Render(render::Args),
    /// Check the actuators and their sound device: a walk from tile to tile, the devices, the channel map.
    Rack(rack::Args),
    /// Set up a new floor, step by step: boards, shape, wiring, calibration, a first layout.
    Setup(setup::Args),
    /// Find which board reads which tiles, by stepping from board to board; or draw the wiring.
    Wiring(wiring::Args),
    /// Contacts and cursor from a force table, one JSON line per instant.
    Sense(sense::SenseArgs),
    /// Calibrate a floor: sensor curves, by load cell or by standing on it; tare, position maps.
    Calibrate(calibrate::Args),
    /// Least, median and greatest force of each tile and sensor, for choosing thresholds.
    Measure(measure::Args),
    /// Measure the largest floor for this machine: rendering and sensing, in times real time.
    #[cfg(feature = "lab")]
    Capacity(capacity::Args),
    /// Plan the computers for a floor and its people: areas, links, packets, megabits and cores.
    #[cfg(feature = "lab")]
    Plan(plan::Args),
    /// Make the paper's figures and the accuracy tables on a simulated floor.
    #[cfg(feature = "lab")]
    Experiment(experiment::Args),
    /// Hold what a server holds down, and release it when the server fails; the server starts it.
    #[command(hide = true)]
    Guardian,
    /// Print the page for `man`, or write one of each command.
    Man(man::Args),
    /// Print completions for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
}

fn main() -> ExitCode {
    let status = match Cli::try_parse() {
        Ok(cli) => {
            start_logging(cli.verbose);
            dispatch(cli.command).map_or_else(
                |failure| {
                    errln!("{failure}");
                    1
                },
                |()| 0,
            )
        }
        Err(asked) => {
            // Help and version arrive here, too.
            if let Err(error) = asked.print() {
                output::note_failure(error);
            }
            u8::try_from(asked.exit_code()).unwrap_or(2)
        }
    };
    let is_whole = output::finish();
    ExitCode::from(if status == 0 && !is_whole { 1 } else { status })
}

fn dispatch(command: Option<Command>) -> Result<(), Failure> {
    match command {
        None => by_default(),
        #[cfg(feature = "preview")]
        Some(Command::Preview(args)) => preview::run(&args),
        Some(Command::Run(args)) => run::run(&args),
        Some(Command::Simulate(args)) => simulate::run(&args),
        Some(Command::Session(args)) => session::run(&args),
        Some(Command::Replay(args)) => replay::run(&args),
        Some(Command::Export(args)) => export::run(&args),
        Some(Command::Addresses(args)) => addresses::run(&args),
        Some(Command::Check(args)) => check::run(&args),
        Some(Command::Reference(args)) => reference::run(&args),
        #[cfg(feature = "lab")]
        Some(Command::Feel(args)) => feel::run(&args),
        Some(Command::Share(args)) => share::run(&args),
        Some(Command::Render(args)) => render::run(&args),
        Some(Command::Rack(args)) => rack::run(&args),
        Some(Command::Setup(args)) => setup::run(&args),
        Some(Command::Wiring(args)) => wiring::run(&args),
        Some(Command::Sense(args)) => sense::run(&args),
        Some(Command::Calibrate(args)) => calibrate::run(&args),
        Some(Command::Measure(args)) => measure::run(&args),
        #[cfg(feature = "lab")]
        Some(Command::Capacity(args)) => capacity::run(&args),
        #[cfg(feature = "lab")]
        Some(Command::Plan(args)) => plan::run(&args),
        #[cfg(feature = "lab")]
        Some(Command::Experiment(args)) => experiment::run(&args),
        Some(Command::Guardian) => guardian::run(),
        Some(Command::Man(args)) => man::run(&args, Cli::command()),
        Some(Command::Completions { shell }) => {
            // A direct write to standard output would panic after the reader has gone.
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "underfoot", &mut script);
            out!("{}", String::from_utf8_lossy(&script));
            Ok(())
        }
    }
}

/// Runs the program without a command: the window if there is a display, the built-in session otherwise.
fn by_default() -> Result<(), Failure> {
    #[cfg(feature = "preview")]
    if preview::has_display() {
        match preview::run(&preview::Args::default()) {
            Err(Failure::NoWindow(reason)) => {
                errln!("No window: {reason}. Playing the built-in session instead.");
            }
            done => return done,
        }
    }
    session::run(&session::Args::default())
}

/// Logs warnings and errors by default; `RUST_LOG` overrides that.
fn start_logging(verbose: u8) {
    let level = match verbose {
        // JACK's library complains about absent servers, which this program reports itself if they matter.
        0 => "warn,jack=off",
        1 => "info,underfoot=debug,jack=off",
        _ => "trace",
    };
    let filter = EnvFilter::try_from_default_env().unwrap_or_else(|_| EnvFilter::new(level));
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(output::Logs)
        .with_ansi(output::colours())
        .with_target(false)
        .init();
}
