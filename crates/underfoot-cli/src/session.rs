//! `underfoot session`: plays a scenario without a window.

use std::fs::File;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use underfoot::engine::Snapshot;
use underfoot::feel::{RendererConfig, renderer};
use underfoot::layout::Layout;
use underfoot::recording::{Recorded, Recorder, WhenBehind};
use underfoot::schema;
use underfoot::sense::Method;
use underfoot::serve::{Ended, Server};
use underfoot::sink::{Fanout, JsonSink, OscSink, WavOptions, WavSink, WhenFull};
use underfoot::units::Instant;
use underfoot::widget::Value;
use underfoot_scene::picture;
use underfoot_scene::scene::{self, Scene, Shoe, Show, Theme, View};
use underfoot_sim::{Pace, Script, SimulatedSource};

use super::failure::Failure;
use super::fault_args::FaultArgs;
use super::floor_args::FloorArgs;
use super::fonts::fonts;
use super::layout_args::LayoutArgs;
use super::output::Results;
use super::outputs::{PrefixArg, TuioArgs, osc_target};
use super::play::{self, SimArgs};
use super::run::whole;
use super::stop::stop_flag;

/// Options of `underfoot session`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    layout: LayoutArgs,
    #[command(flatten)]
    floor: FloorArgs,
    #[command(flatten)]
    sim: SimArgs,
    #[command(flatten)]
    faults: FaultArgs,
    #[command(flatten)]
    tuio: TuioArgs,
    #[command(flatten)]
    prefix: PrefixArg,
    /// Send events and contacts as OSC as well; may be given several times.
    #[arg(long, value_name = "HOST:PORT", value_parser = osc_target)]
    osc: Vec<SocketAddr>,
    /// Scenario file; without it, the built-in session.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Also write the floor file of the simulated floor, calibrated as in a lab, beside the picture.
    #[arg(long)]
    calibrate: bool,
    /// Folder for the picture, the sound file and the event log.
    #[arg(short, long, value_name = "DIR", default_value = DEFAULT_OUT)]
    out: PathBuf,
    /// Record everything that determines the events into this file, for `underfoot replay`; an existing file is
    /// replaced.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Samples per second and actuator channel.
    #[arg(long, value_name = "HZ", default_value_t = SAMPLE_RATE, value_parser = clap::value_parser!(u32).range(8000..=384_000))]
    rate: u32,
}

const DEFAULT_OUT: &str = "underfoot-session";
const SAMPLE_RATE: u32 = 48_000;

/// Width of the picture, in pixels.
const PICTURE_WIDTH: u32 = 1400;

impl Default for Args {
    fn default() -> Self {
        Self {
            layout: LayoutArgs::default(),
            floor: FloorArgs::default(),
            sim: SimArgs::default(),
            tuio: TuioArgs::default(),
            prefix: PrefixArg::default(),
            faults: FaultArgs::default(),
            osc: Vec::new(),
            scenario: None,
            calibrate: false,
            out: DEFAULT_OUT.into(),
            record: None,
            rate: SAMPLE_RATE,
        }
    }
}

/// Plays a scenario on a simulated floor, faster than in real time, and writes a picture, the sound of the actuators
/// and the events.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let stop = stop_flag()?;
    let floor = args.floor.load()?;
    let geometry = floor.geometry;
    let layout = args.layout.load(&geometry)?;
    let (script, rehearsed) = play::script(args.scenario.as_deref(), &layout, &geometry)?;
    std::fs::create_dir_all(&args.out).map_err(|error| Failure::File(args.out.clone(), error))?;
    let file = |name: &str| args.out.join(name);
    let (sim, floor) = args.sim.build().in_use(&floor)?;
    if args.calibrate {
        let described = file("floor.ron");
        std::fs::write(&described, schema::write_floor(&floor))
            .map_err(|error| Failure::File(described, error))?;
    }
    let (picture, sound, log) = (file("floor.png"), file("actuators.wav"), file("events.jsonl"));

    let source = SimulatedSource::new(sim, Box::new(script.clone()), Pace::FreeRunning);
    let input = args.faults.wrap(source, rehearsed);
    let path = args.record.as_deref();
    let Recorded { recorder, input, floor, layout } =
        Recorder::around(path, input, floor, layout, Method::default(), WhenBehind::Wait)?;
    let (feel, renderer) = renderer(RendererConfig::of(&floor, args.rate));
    let lost = Arc::<AtomicU64>::default();
    let options = WavOptions::default().with_when_full(WhenFull::Wait).with_lost(Arc::clone(&lost));
    let wav = WavSink::create(&sound, renderer, options)?;
    let events = File::create(&log).map_err(|error| Failure::File(log.clone(), error))?;
    let mut told = Fanout::new().with(JsonSink::new(Results(events))?);
    for &osc in &args.osc {
        told.push(OscSink::under(osc, args.prefix.osc_prefix.clone())?);
    }
    args.tuio.open(&geometry, &mut told)?;
    if let Some(recorder) = &recorder {
        told.push(recorder.events()?.waiting());
    }
    let mut server = Server::new(&floor, layout, Method::default(), input)
        .with_feel(feel, Box::new(wav))
        .with_events(Box::new(told));
    let mut camera = Camera::default();
    let mut is_stopped = false;
    while !is_stopped && server.turn()? == Ended::No {
        camera.look(&server);
        is_stopped = stop.load(Ordering::Relaxed);
    }
    let played = server.engine().now();
    let layout = server.engine().layout().clone();
    drop(server);
    let unrecorded = recorder.map(|recorder| recorder.lost());
    camera.develop(&geometry, &layout, &script, &picture)?;
    whole(&lost, "frames")?;
    unrecorded.map_or(Ok(()), |lost| whole(&lost, "entries"))?;
    if is_stopped {
        return Err(Failure::Other(format!(
            "stopped after {:.1} s; the files hold everything up to there",
            played.secs()
        )));
    }
    outln!(
        "Played {:.1} s. What the floor looked like: {}\nWhat its actuators did, a channel per tile: {}\n\
         What its controls did: {}",
        script.duration().as_secs_f64(),
        picture.display(),
        sound.display(),
        log.display()
    );
    Ok(())
}

/// Keeps the snapshot of the most informative moment of a session.
#[derive(Default)]
struct Camera {
    now: Snapshot,
    seen: Option<Instant>,
    best: Option<(u32, Snapshot)>,
    pressed_since: Option<Instant>,
}

/// Interval between two snapshots.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// Duration of an informative press: the foot has settled or slides.
const SETTLED: Duration = Duration::from_millis(500);

impl Camera {
    fn look(&mut self, server: &Server) {
        let at = server.engine().now();
        if self.seen.is_some_and(|seen| at.since(seen) < LOOK_EVERY) {
            return;
        }
        self.seen = Some(at);
        server.snapshot(&mut self.now);
        // On a floor without controls, the ground shows the steps: the last one has most of them.
        if self.now.widgets.is_empty() && !self.now.contacts.is_empty() {
            self.best = Some((0, self.now.clone()));
            return;
        }
        let pressed = self.now.widgets.iter().filter(|widget| widget.pressed);
        // A slider in motion is more informative than a held button.
        let worth =
            pressed.map(|widget| if matches!(widget.value, Some(Value::Number(_))) { 3 } else { 2 }).max();
        let Some(mut worth) = worth else {
            self.pressed_since = None;
            if self.best.is_none() && !self.now.contacts.is_empty() {
                self.best = Some((0, self.now.clone()));
            }
            return;
        };
        let since = *self.pressed_since.get_or_insert(at);
        if at.since(since) < SETTLED {
            worth -= 1;
        }
        if self.best.as_ref().is_none_or(|(best, _)| worth > *best) {
            self.best = Some((worth, self.now.clone()));
        }
    }

    fn develop(
        self,
        geometry: &underfoot::floor::Geometry,
        layout: &Layout,
        script: &Script,
        path: &Path,
    ) -> Result<(), Failure> {
        let snapshot = self.best.map_or(self.now, |(_, snapshot)| snapshot);
        let mut feet = Vec::new();
        script.feet_at(snapshot.at, &mut feet);
        let shoes: Vec<Shoe> = feet.iter().map(Shoe::from).collect();
        let mut scene = Scene::new();
        let view = View {
            show: Show::PICTURE,
            shoes: &shoes,
            ..View::new(geometry, layout, &snapshot, &Theme::LIGHT)
        };
        scene::draw(&mut scene, &view);
        Ok(picture::write(&scene, fonts(), path, PICTURE_WIDTH)?)
    }
}
