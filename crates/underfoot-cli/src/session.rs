//! `underfoot session`: plays a scenario without a window.

use std::fs::File;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use underfoot::engine::Snapshot;
use underfoot::feel::{RendererConfig, renderer};
use underfoot::floor::Floor;
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
use underfoot_sim::{Pace, SimulatedSource};

use super::failure::Failure;
use super::fault_args::FaultArgs;
use super::floor_args::FloorArgs;
use super::fonts::fonts;
use super::layout_args::LayoutArgs;
use super::output::Results;
use super::outputs::{PrefixArg, TuioArgs, osc_target};
use super::people::{People, Scenery, link_in};
use super::play::SimArgs;
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
    /// Scenario file; without it, the built-in session, or the visit of a link in the place of the layout.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Print every event as a line of JSON on standard output, and leave no files but that of `--record`.
    #[arg(long, conflicts_with_all = ["calibrate", "out", "rate"])]
    json: bool,
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
            json: false,
            calibrate: false,
            out: DEFAULT_OUT.into(),
            record: None,
            rate: SAMPLE_RATE,
        }
    }
}

/// Plays a scenario or a visit on a simulated floor, faster than in real time, and writes a picture, the sound of the
/// actuators and the events, or prints the events.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let stop = stop_flag()?;
    let Scenery { floor: wired, layout, people, build, faults } = args.scenery()?;
    let geometry = wired.geometry;
    let (sim, floor) = build.in_use(&wired)?;
    let files = if args.json { None } else { Some(args.files(&floor)?) };

    let source = SimulatedSource::new(sim, people.driver(), Pace::FreeRunning);
    let input = args.faults.wrap(source, faults);
    let path = args.record.as_deref();
    let Recorded { recorder, input, floor, layout } =
        Recorder::around(path, input, floor, layout, Method::default(), WhenBehind::Wait)?;
    let mut told = Fanout::new();
    if args.json {
        told.push(JsonSink::new(Results(std::io::stdout()))?.waiting());
    }
    for &osc in &args.osc {
        told.push(OscSink::under(osc, args.prefix.osc_prefix.clone())?);
    }
    args.tuio.open(&geometry, &mut told)?;
    if let Some(recorder) = &recorder {
        told.push(recorder.events()?.waiting());
    }
    let lost = Arc::<AtomicU64>::default();
    let mut wav = None;
    if let Some(files) = &files {
        let (feel, renderer) = renderer(RendererConfig::of(&floor, args.rate));
        let options = WavOptions::default().with_when_full(WhenFull::Wait).with_lost(Arc::clone(&lost));
        wav = Some((feel, WavSink::create(&files.sound, renderer, options)?));
        let log = File::create(&files.log).map_err(|error| Failure::File(files.log.clone(), error))?;
        told.push(JsonSink::new(Results(log))?.waiting());
    }
    let mut server = Server::new(&floor, layout, Method::default(), input).with_events(Box::new(told));
    if let Some((feel, wav)) = wav {
        server = server.with_feel(feel, Box::new(wav));
    }
    let mut camera = Camera::default();
    let mut is_stopped = false;
    while !is_stopped && server.turn()? == Ended::No {
        if files.is_some() {
            camera.look(&server);
        }
        is_stopped = stop.load(Ordering::Relaxed);
    }
    let played = server.engine().now();
    let layout = server.engine().layout().clone();
    drop(server);
    let unrecorded = recorder.map(|recorder| recorder.lost());
    if let Some(files) = &files {
        camera.develop(&geometry, &layout, &people, &files.picture)?;
    }
    whole(&lost, "frames")?;
    unrecorded.map_or(Ok(()), |lost| whole(&lost, "entries"))?;
    if is_stopped {
        return Err(Failure::Other(format!(
            "stopped after {:.1} s; the files hold everything up to there",
            played.secs()
        )));
    }
    if let Some(SessionFiles { picture, sound, log }) = &files {
        outln!(
            "Played {:.1} s. What the floor looked like: {}\nWhat its actuators did, a channel per tile: {}\n\
             What its controls did: {}",
            people.duration().as_secs_f64(),
            picture.display(),
            sound.display(),
            log.display()
        );
    }
    Ok(())
}

/// The files that a session leaves.
struct SessionFiles {
    picture: PathBuf,
    sound: PathBuf,
    log: PathBuf,
}

impl Args {
    /// The layout, its floor and the people: of a link, or of the options.
    fn scenery(&self) -> Result<Scenery, Failure> {
        let (scenario, build) = (self.scenario.as_deref(), self.sim.build());
        if let Some(link) = link_in(self.layout.layout.as_deref()) {
            if self.floor.floor.is_some() || self.floor.grid.is_some() {
                return Err(Failure::Other(
                    "the link has its own floor: leave out --floor and --grid".into(),
                ));
            }
            return Scenery::of_link(link, scenario, build);
        }
        let floor = self.floor.load()?;
        let layout = self.layout.load(&floor.geometry)?;
        Scenery::of_scenario(floor, layout, scenario, build)
    }

    /// Makes the folder, and writes the floor file into it if it is wanted.
    fn files(&self, floor: &Floor) -> Result<SessionFiles, Failure> {
        std::fs::create_dir_all(&self.out).map_err(|error| Failure::File(self.out.clone(), error))?;
        let file = |name: &str| self.out.join(name);
        if self.calibrate {
            let described = file("floor.ron");
            std::fs::write(&described, schema::write_floor(floor))
                .map_err(|error| Failure::File(described, error))?;
        }
        Ok(SessionFiles {
            picture: file("floor.png"),
            sound: file("actuators.wav"),
            log: file("events.jsonl"),
        })
    }
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
        people: &People,
        path: &Path,
    ) -> Result<(), Failure> {
        let snapshot = self.best.map_or(self.now, |(_, snapshot)| snapshot);
        let mut feet = Vec::new();
        people.feet_at(snapshot.at, &mut feet);
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
