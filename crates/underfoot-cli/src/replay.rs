//! `underfoot replay`: replays a recorded floor.

use std::path::PathBuf;

use underfoot::feel::{RendererConfig, renderer};
use underfoot::recording::{Progress, Recording, Speed};
use underfoot::serve::Server;
use underfoot::sink::{ActuatorSink, Since, SinkError};
use underfoot::units::Instant;

use super::failure::Failure;
use super::outputs::OutputArgs;
use super::stop::stop_flag;

/// Options of `underfoot replay`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The recording, as `underfoot run --record` writes it.
    file: PathBuf,
    /// Speed as a multiple of the recorded one, or `max`.
    #[arg(long, value_name = "N|max", default_value = "1", value_parser = speed)]
    speed: Speed,
    #[command(flatten)]
    outputs: OutputArgs,
}

/// Replays a recording; fails at the end if it is incomplete.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let stop = stop_flag()?;
    let recording = Recording::open(&args.file)?;
    let floor = recording.floor().clone();
    let (layout, method) = (recording.layout().clone(), recording.method());
    let begins = recording.begins();
    let source = recording.source(args.speed);
    let progress = source.progress();
    let outputs = args.outputs.open_patiently(&floor.geometry)?;
    let outputs = Since::new(outputs, begins.unwrap_or(Instant::START));
    source.transport().hurry_to(begins.unwrap_or(Instant::START));
    // The renderer only repeats the reports of the mute state; its samples are not used.
    let (feel, _renderer) = renderer(RendererConfig::of(&floor, RATE));
    let mut server = Server::new(&floor, layout, method, source)
        .with_prefix(args.outputs.prefix.osc_prefix.clone())
        .with_feel(feel, Box::new(Unplayed))
        .with_events(Box::new(outputs));
    server.run(&stop)?;
    drop(server);
    errln!("Replayed {:.1} s, {} packets.", progress.now().secs(), progress.packets());
    whole(&progress)
}

/// Sample rate of the renderer, whose samples are not used.
const RATE: u32 = 48_000;

/// Fails if the recording is cut off or damaged; reports its gaps.
pub(crate) fn whole(progress: &Progress) -> Result<(), Failure> {
    if progress.left_out() > 0 {
        errln!(
            "{} entries were left out of the recording: what follows them may differ.",
            progress.left_out()
        );
    }
    if progress.foreign() > 0 {
        errln!("{} messages on topics of other programs were passed over.", progress.foreign());
    }
    match progress.broken() {
        Some(why) => Err(Failure::Other(format!(
            "the recording breaks off or is damaged after {} packets ({:.1} s); all up to there was read ({why})",
            progress.packets(),
            progress.now().secs(),
        ))),
        None => Ok(()),
    }
}

fn speed(text: &str) -> Result<Speed, String> {
    if text == "max" {
        return Ok(Speed::Max);
    }
    let times = text.parse().ok().filter(|times| (0.01..=1000.0).contains(times));
    times.map(Speed::Times).ok_or_else(|| "write a number from 0.01 to 1000, or max".into())
}

/// A sink without actuators.
struct Unplayed;

impl ActuatorSink for Unplayed {
    fn advance(&mut self, _now: Instant) -> Result<(), SinkError> {
        Ok(())
    }
}
