//! `underfoot rack`: the walk from tile to tile, the devices, the channel map.

#[cfg(feature = "audio")]
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant as HostInstant};

use underfoot::feel::{Click, Cue, CueSender, Mode, RendererConfig, Spot, SustainedCues, renderer};
use underfoot::floor::{Floor, TileId};
use underfoot::sink::{ActuatorSink, ChannelMap, LatencyStages, WavOptions, WavSink, WhenFull};
use underfoot::units::{HostClock, Instant, Newtons};

use super::actuate::{ActuateArgs, Actuation};
use super::failure::Failure;
use super::floor_args::FloorArgs;
use super::number::{number, tile};
use super::stop::stop_flag;

/// Options of `underfoot rack`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, clap::Subcommand)]
enum Task {
    /// Click tile after tile and print each: for checking the wiring by hand or foot.
    Walk(Walk),
    /// List the devices for playback: hosts, devices, channels, rates.
    Devices(Devices),
    /// Show which output channel moves which tile.
    Map(Map),
}

#[derive(clap::Args, Debug)]
struct Walk {
    #[command(flatten)]
    floor: FloorArgs,
    #[command(flatten)]
    actuate: ActuateArgs,
    /// Time from one click to the next.
    #[arg(long, value_name = "MS", default_value_t = 1000, value_parser = clap::value_parser!(u64).range(50..=60_000))]
    pace_ms: u64,
    /// Only this tile, as column,row; several may be given.
    #[arg(long, value_name = "COL,ROW", value_parser = tile)]
    only: Vec<TileId>,
    /// Clicks on each tile.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    clicks: u32,
    /// Force of a click at the plate.
    #[arg(long, value_name = "N", default_value_t = 15.0, value_parser = level)]
    level_n: f32,
}

#[derive(clap::Args, Debug)]
struct Devices {
    /// Print the list as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args, Debug)]
struct Map {
    #[command(flatten)]
    floor: FloorArgs,
    /// Print the map as JSON.
    #[arg(long)]
    json: bool,
}

fn level(text: &str) -> Result<f32, String> {
    number(text, &(0.1..=40.0), "newtons").map(|level| level as f32)
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match &args.task {
        Task::Walk(walk) => walk.run(),
        Task::Devices(devices) => devices.run(),
        Task::Map(map) => map.run(),
    }
}

/// A click that a hand on a plate feels at once and a microphone hears: short, in the middle of the actuators' band.
const CLICK: [Mode; 2] = [
    Mode { frequency_hz: 160.0, decay_s: 0.03, amplitude: 0.7 },
    Mode { frequency_hz: 320.0, decay_s: 0.015, amplitude: 0.3 },
];

/// Time for the last click to decay.
const TAIL: Duration = Duration::from_millis(300);

impl Walk {
    fn run(&self) -> Result<(), Failure> {
        let floor = self.floor.load()?;
        let steps = self.steps(&floor)?;
        match self.actuate.wav() {
            Some(path) => self.walk_in_file(&floor, &steps, path),
            None => self.walk_on_device(&floor, &steps),
        }
    }

    /// The tiles to click, with their channels.
    fn steps(&self, floor: &Floor) -> Result<Vec<(TileId, u16)>, Failure> {
        let map = ChannelMap::new(floor);
        let mut steps = Vec::new();
        for (tile, channel) in map.entries() {
            if self.only.is_empty() || self.only.contains(&tile) {
                steps.push((tile, channel));
            }
        }
        if let Some(missing) = self.only.iter().find(|tile| !steps.iter().any(|(found, _)| found == *tile)) {
            return Err(Failure::Other(format!(
                "tile {missing} has no actuator on this floor. The channel of each tile, from 0:\n{map}"
            )));
        }
        if steps.is_empty() {
            return Err(Failure::Other("this floor has no actuators: its floor file lists none".into()));
        }
        Ok(steps)
    }

    fn click(&self, floor: &Floor, tile: TileId, at: Instant) -> Cue {
        let click =
            Click { modes: CLICK.into_iter().collect(), level: Newtons(self.level_n), ..Click::default() };
        let index =
            floor.geometry.index(tile).and_then(|index| u16::try_from(index).ok()).unwrap_or(u16::MAX);
        let spots = [Spot { tile: index, weight: 1.0 }].into_iter().collect();
        Cue { at, received: at, spots, click, ..Cue::default() }
    }

    /// Every click of the walk: time, tile and channel.
    fn clicks<'a>(&self, steps: &'a [(TileId, u16)]) -> impl Iterator<Item = (Instant, TileId, u16)> + 'a {
        let (clicks, pace) = (self.clicks as usize, self.pace_ms);
        let repeated = steps.iter().flat_map(move |step| std::iter::repeat_n(*step, clicks));
        (1..)
            .zip(repeated)
            .map(move |(number, (tile, channel))| (Instant::from_millis(number * pace), tile, channel))
    }

    fn walk_in_file(&self, floor: &Floor, steps: &[(TileId, u16)], path: &Path) -> Result<(), Failure> {
        let (mut feel, renderer) = renderer(RendererConfig::of(floor, self.actuate.file_rate()));
        let options = WavOptions::default().with_when_full(WhenFull::Wait);
        let mut wav = WavSink::create(path, renderer, options)?;
        let mut end = Instant::START;
        for (at, tile, channel) in self.clicks(steps) {
            wav.advance(at)?;
            feel.send(&self.click(floor, tile, at));
            say(at, tile, channel);
            end = at;
        }
        wav.advance(end + TAIL)?;
        wav.finish()?;
        errln!("Written to {}, a channel per tile.", path.display());
        Ok(())
    }

    fn walk_on_device(&self, floor: &Floor, steps: &[(TileId, u16)]) -> Result<(), Failure> {
        let begun = HostInstant::now();
        let clock: HostClock = Arc::new(move || Instant::START + begun.elapsed());
        let actuation = self.actuate.for_wiring().start(
            floor,
            Instant::START,
            &clock,
            LatencyStages::default(),
            &Arc::default(),
            |_| {},
        )?;
        let Actuation { mut feel, mut sink, notice, .. } = actuation;
        errln!("{notice} Ctrl-C ends the walk.");
        let stop = stop_flag()?;
        for (at, tile, channel) in self.clicks(steps) {
            if !wait(at, &*clock, &mut feel, sink.as_mut(), &stop)? {
                return Ok(());
            }
            feel.send(&self.click(floor, tile, clock()));
            say(at, tile, channel);
        }
        wait(clock() + TAIL, &*clock, &mut feel, sink.as_mut(), &stop)?;
        Ok(())
    }
}

fn say(at: Instant, tile: TileId, channel: u16) {
    outln!("{:8.2} s  tile {tile}  channel {channel}", at.secs());
}

/// Waits until `at`; false if the walk ends before.
fn wait(
    at: Instant,
    clock: &dyn Fn() -> Instant,
    feel: &mut CueSender,
    sink: &mut dyn ActuatorSink,
    stop: &AtomicBool,
) -> Result<bool, Failure> {
    while clock() < at {
        if stop.load(Ordering::Relaxed) {
            return Ok(false);
        }
        feel.sustain(&SustainedCues::new());
        sink.advance(clock())?;
        thread::sleep(at.since(clock()).min(Duration::from_millis(5)));
    }
    Ok(true)
}

impl Map {
    fn run(&self) -> Result<(), Failure> {
        let floor = self.floor.load()?;
        let map = ChannelMap::new(&floor);
        if self.json {
            let entry = |(tile, channel): (TileId, u16)| serde_json::json!({ "col": tile.column, "row": tile.row, "channel": channel });
            let entries: Vec<_> = map.entries().map(entry).collect();
            outln!("{}", serde_json::Value::from(entries));
            return Ok(());
        }
        let tiles = map.entries().count();
        outln!(
            "{tiles} tiles on {} channels. The channel of each tile, from 0, north at the top:\n{map}",
            floor.channel_count()
        );
        for (channel, tiles) in map.shared() {
            let tiles: Vec<String> = tiles.iter().map(TileId::to_string).collect();
            errln!("Channel {channel} moves several tiles: {}.", tiles.join(", "));
        }
        Ok(())
    }
}

impl Devices {
    #[cfg(not(feature = "audio"))]
    fn run(&self) -> Result<(), Failure> {
        let Self { json: _ } = self;
        Err(Failure::Other("this program was built without sound: build it with the feature `audio`".into()))
    }

    #[cfg(feature = "audio")]
    fn run(&self) -> Result<(), Failure> {
        let devices = underfoot::sink::output_devices();
        if self.json {
            let entry = |device: &underfoot::sink::DeviceEntry| {
                serde_json::json!({
                    "host": device.host,
                    "name": device.name,
                    "id": device.id,
                    "default": device.is_default,
                    "channels": device.channels,
                    "rates": device.rates,
                    "block": device.block,
                    "trouble": device.trouble,
                })
            };
            let entries: Vec<_> = devices.iter().map(entry).collect();
            outln!("{}", serde_json::Value::from(entries));
            return Ok(());
        }
        for device in &devices {
            outln!("{}", line(device));
        }
        errln!("`--device` takes a name, a part of it, or what stands in brackets.");
        Ok(())
    }
}

#[cfg(feature = "audio")]
fn line(device: &underfoot::sink::DeviceEntry) -> String {
    let mut line = format!("{}: {} [{}]", device.host, device.name, device.id);
    // Writing to a string never fails.
    if let Some(trouble) = &device.trouble {
        let _ = write!(line, ", can't be asked: {trouble}");
        return line;
    }
    let rates: Vec<String> = device
        .rates
        .iter()
        .map(|(low, high)| if low == high { low.to_string() } else { format!("{low} to {high}") })
        .collect();
    let _ = write!(line, ", {} channels, {} Hz", device.channels, rates.join(", "));
    if let Some((least, most)) = device.block {
        let _ = write!(line, ", blocks of {least} to {most}");
    }
    if device.is_default {
        line.push_str(", its host's choice");
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_written_as_people_write_them() {
        for text in ["2,3", "(2,3)", "(2, 3)", "2, 3"] {
            assert_eq!(tile(text), Ok(TileId::new(2, 3)), "{text}");
        }
        assert!(tile("2").is_err() && tile("2,x").is_err() && tile("-1,0").is_err());
    }
}
