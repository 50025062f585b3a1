//! `underfoot preview`: the window, with its floor served on a thread of its own.

mod player;

use std::net::SocketAddr;
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, Sender, SyncSender, TrySendError};
use std::thread;
use std::time::Duration;

use underfoot::edit;
use underfoot::feel::{Renderer, ScopeReader};
use underfoot::floor::Floor;
use underfoot::glam::Vec2;
use underfoot::layout::Layout;
use underfoot::preview::{
    self, DesignInput, EventNews, FootSink, LayoutCause, LayoutNews, PreviewCommand, PreviewError,
    PreviewFoot, PreviewInput, PreviewOptions, ProjectionOptions, ScopeFeed, ShoeFeed, Warnings,
};
use underfoot::recording::Recording;
use underfoot::runtime::{EndReason, Kind, Session};
use underfoot::schema::{self, Diagnostics};
use underfoot::sense::Method;
use underfoot::serve::Command;
use underfoot::sim::{
    ArrivalHandle, Foot, FootDriver, FootHandle, LoopingScript, arrivals, feet_by_hand, watched,
};
use underfoot::sink::{EventSink, LatencyStages, Report};
use underfoot::source::{FaultSwitch, Faults, Pace, RehearsalSource, SensorSource, SimulatedSource};
use underfoot::units::HostClock;
use underfoot::wire::ControlMessage;

use self::player::{Player, Window};
use super::actuate::ActuateArgs;
use super::doors::{BoardArgs, CommandArgs};
use super::failure::Failure;
use super::fault_args::say_what_is_rehearsed;
use super::floor_args::FloorArgs;
use super::layout_args::{DEFAULT_LAYOUT, LayoutArgs};
use super::outputs::OutputArgs;
use super::play::{self, SimArgs};
use super::run::end;
use super::watch::Watch;

/// What `underfoot preview` is asked to do.
#[derive(clap::Args, Debug, Default)]
pub(crate) struct Args {
    #[command(flatten)]
    layout: LayoutArgs,
    #[command(flatten)]
    floor: FloorArgs,
    /// Show a real floor, whose packets arrive here.
    #[arg(long, value_name = "ADDR", conflicts_with_all = ["scenario", "session"])]
    listen: Option<SocketAddr>,
    #[command(flatten)]
    boards: BoardArgs,
    #[command(flatten)]
    commands: CommandArgs,
    /// Show a scenario played on the simulated floor, instead of the mouse's feet.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Show the built-in session played on the simulated floor.
    #[arg(long, conflicts_with = "scenario")]
    session: bool,
    /// Record the floor into this file, in place of what was there; `underfoot preview FILE` shows it again.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Open the window for a projector at once, over the whole screen: the controls alone, laid onto the floor.
    #[arg(long)]
    project: bool,
    /// The screen that the projection fills, counted from 0.
    #[arg(long, value_name = "NUMBER", requires = "project")]
    monitor: Option<usize>,
    /// File that remembers where the floor's corners are on the projection, in place of the usual one.
    #[arg(long, value_name = "FILE")]
    corners: Option<PathBuf>,
    #[command(flatten)]
    sim: SimArgs,
    #[command(flatten)]
    outputs: OutputArgs,
    #[command(flatten)]
    actuate: ActuateArgs,
    /// The paper's plain sensing: one contact per group of connected tiles.
    #[arg(long)]
    eq4: bool,
}

/// Whether a window can be hoped for.
pub(crate) fn has_display() -> bool {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(target_os = "linux") || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")
}

/// Events that may wait for the window; it takes them 60 times a second.
const EVENTS_WAITING: usize = 4096;

/// Which packets the faults of a scenario hit.
const FAULT_SEED: u64 = 1;

/// How long the floor stays empty before what is played begins anew.
const PAUSE: Duration = Duration::from_secs(3);

/// Opens the window and serves its floor on a thread of its own until the window is closed.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if !has_display() {
        return Err(Failure::NoWindow("there is no display".into()));
    }
    if let Some(path) = args.recording() {
        return replayed(args, path);
    }
    let floor = args.floor.load()?;
    let (layout, warnings) = args.layout.reviewed(&floor)?;
    let stage = args.stage(&floor, &layout)?;

    let (event_sender, events) = mpsc::sync_channel(EVENTS_WAITING);
    let (news, layouts) = mpsc::channel();
    let (notice_sender, notices) = mpsc::channel();
    let (scope_sender, scopes) = mpsc::channel();
    let (wishes, wished) = mpsc::channel();

    // Of several sound cards that are tried, the last one plays.
    let watch_renderer = move |renderer: &mut Renderer| drop(scope_sender.send(renderer.scope()));
    let latency = LatencyStages::default();
    let actuators =
        args.actuate.opener(latency.clone(), Arc::default(), watch_renderer, notice_sender.clone());
    let mut session = Session::source(stage.source, stage.clock)
        .floor(stage.floor.clone())
        .layout(layout.clone())
        .method(if args.eq4 { Method::Eq4 } else { Method::default() })
        .prefix(args.outputs.prefix.osc_prefix.clone())
        .sink(args.outputs.open(&floor.geometry)?)
        .sink(ToWindow { events: event_sender, missed: 0 })
        .actuators(actuators)
        .latency(latency.clone());
    if let Some(path) = &args.record {
        session = session.record(path);
    }
    let session = session.start()?;

    let desk = Desk { session: session.clone(), news };
    let watch = desk.watch(&args.layout)?;
    let choices = args.choices();
    let told = Obeyed { files: args.layout.clone(), watch, choices: choices.clone(), floor, desk };
    told.process_commands(wished, notice_sender);

    let scopes = scopes.try_iter().last().flatten();
    let scopes = scopes.map(|reader| Box::new(Scopes::new(reader)) as Box<dyn ScopeFeed>);
    let input = PreviewInput {
        floor: Arc::new(stage.floor),
        layout: Arc::new(layout),
        warnings: Warnings::from(&warnings),
        source: stage.name,
        snapshots: session.take_snapshots(),
        events,
        layouts,
        notices,
        scopes,
        latency: Some(latency),
        feet: stage.feet,
        playback: None,
        faults: stage.faults,
        people: stage.people,
        shoes: stage.shoes,
        choices,
        effects: args.layout.kinds()?.effects().iter().cloned().collect(),
        design: args.design()?,
        commands: wishes,
    };
    // Also when the window fails, the floor ends in order first.
    let options = args.window();
    let shown = panic::catch_unwind(AssertUnwindSafe(|| preview::run(input, &options)));
    session.stop();
    let end = end(&session);
    match shown.unwrap_or_else(|reason| panic::resume_unwind(reason)) {
        Ok(()) => match end.kind {
            Kind::Ended(EndReason::Failed) => Err(Failure::Other(end.message().into())),
            Kind::Ended(EndReason::Panicked) => {
                Err(Failure::Other("sensing failed; please report it".into()))
            }
            _ => Ok(()),
        },
        Err(PreviewError::NoWindow(reason)) => Err(Failure::NoWindow(reason)),
    }
}

/// Shows a recording; nobody else is told of what happens in it.
fn replayed(args: &Args, path: &Path) -> Result<(), Failure> {
    let (event_sender, events) = mpsc::sync_channel(EVENTS_WAITING);
    let (news, layouts) = mpsc::channel();
    let (_, notices) = mpsc::channel();
    let (commands, _) = mpsc::channel();
    let window = Window { events: event_sender, layouts: news };
    let (player, floor, layout, snapshots) = Player::start(path, window)?;
    let name = path.file_name().unwrap_or(path.as_os_str()).display().to_string();
    let input = PreviewInput {
        floor: Arc::new(floor),
        layout,
        warnings: Warnings::default(),
        source: name,
        snapshots,
        events,
        layouts,
        notices,
        scopes: None,
        latency: None,
        feet: None,
        playback: Some(Box::new(player)),
        faults: None,
        people: None,
        shoes: None,
        choices: Vec::new(),
        effects: Vec::new(),
        design: None,
        commands,
    };
    preview::run(input, &args.window()).map_err(|PreviewError::NoWindow(reason)| Failure::NoWindow(reason))
}

/// Where packets come from, and what is known of them.
struct Stage {
    floor: Floor,
    source: Box<dyn SensorSource>,
    clock: HostClock,
    name: String,
    feet: Option<Box<dyn FootSink>>,
    shoes: Option<ShoeFeed>,
    faults: Option<FaultSwitch>,
    people: Option<ArrivalHandle>,
}

impl Args {
    /// The recording that is named in place of a layout.
    fn recording(&self) -> Option<&Path> {
        self.layout.path().filter(|path| Recording::is_at(path))
    }

    /// How the window looks at first.
    fn window(&self) -> PreviewOptions {
        let projection = ProjectionOptions {
            open: self.project,
            keeps_awake: true,
            monitor: self.monitor,
            corners: self.corners.clone(),
        };
        let settings = Some(preview::usual_state().join("window"));
        PreviewOptions { projection, settings, ..PreviewOptions::default() }
    }

    fn stage(&self, floor: &Floor, layout: &Layout) -> Result<Stage, Failure> {
        if let Some(address) = self.listen {
            let prefix = self.outputs.prefix.osc_prefix.clone();
            let source = self.commands.open(self.boards.bind(address, floor)?.with_prefix(prefix))?;
            return Ok(Stage {
                floor: floor.clone(),
                clock: source.clock(),
                source: Box::new(source),
                name: format!("floor on port {}", address.port()),
                feet: None,
                shoes: None,
                faults: None,
                people: None,
            });
        }
        let mut faults = Faults::default();
        let (driver, name, feet): (Box<dyn FootDriver>, _, Option<Box<dyn FootSink>>) =
            if self.session || self.scenario.is_some() {
                let (script, rehearsed) = play::script(self.scenario.as_deref(), layout, &floor.geometry)?;
                faults = rehearsed;
                (Box::new(LoopingScript::new(script, PAUSE)), "scenario on a simulated floor", None)
            } else {
                let (handle, driver) = feet_by_hand();
                (Box::new(driver), "simulated floor", Some(Box::new(Mouse(handle))))
            };
        let (people, driver) = arrivals(driver);
        let (driver, mut seen) = watched(Box::new(driver));
        let is_led = feet.is_some();
        let shoes: ShoeFeed = Box::new(move |shoes| {
            shoes.clear();
            shoes
                .extend(seen.read().iter().enumerate().map(|(index, foot)| shoe(foot, is_led && index == 1)));
        });
        let (sim, floor) = self.sim.calibrated(floor)?;
        let driver = Box::new(driver);
        let source = SimulatedSource::new(sim, driver, Pace::RealTime);
        let clock = source.clock();
        say_what_is_rehearsed(&faults);
        let (source, switch) = RehearsalSource::new(source, faults, FAULT_SEED);
        Ok(Stage {
            floor,
            clock,
            source: Box::new(source),
            faults: Some(switch),
            people: Some(people),
            name: name.into(),
            feet,
            shoes: Some(shoes),
        })
    }

    /// The layout as text, to be designed.
    fn design(&self) -> Result<Option<DesignInput>, Failure> {
        let path = self.layout.path().map(std::path::Path::to_path_buf);
        let name = self.layout.layout.as_deref().and_then(std::path::Path::to_str).unwrap_or(DEFAULT_LAYOUT);
        let text = match &path {
            Some(path) => std::fs::read_to_string(path).ok(),
            None => schema::builtin_layout(name).map(str::to_owned),
        };
        let files = self.layout.clone();
        let kinds_of = Box::new(move |path: Option<&std::path::Path>| {
            let layout = path.map(std::path::Path::to_path_buf);
            LayoutArgs { layout, ..files.clone() }.kinds().map(Arc::new)
        });
        let state = preview::usual_state();
        Ok(text.map(|text| DesignInput { name: name.to_owned(), text, path, kinds_of, state }))
    }

    /// The layout given and the built-in ones.
    fn choices(&self) -> Vec<String> {
        let given = self.layout.path().map(|path| path.display().to_string());
        given.into_iter().chain(schema::builtin_layouts().map(String::from)).collect()
    }
}

/// Gives layouts to the floor and tells the window which.
#[derive(Clone)]
struct Desk {
    session: Session,
    news: Sender<LayoutNews>,
}

impl Desk {
    /// Puts what was read on the floor, or tells why that can't be.
    fn take(&self, name: &str, cause: LayoutCause, read: Result<(Layout, Diagnostics), String>) {
        match read {
            Ok((layout, warnings)) => self.put(name, cause, layout, Warnings::from(&warnings)),
            Err(diagnostics) => {
                let _ = self.news.send(LayoutNews::Refused { name: name.to_owned(), diagnostics });
            }
        }
    }

    fn put(&self, name: &str, cause: LayoutCause, layout: Layout, warnings: Warnings) {
        let loaded = Arc::new(layout.clone());
        let revision = self.session.set_layout(layout);
        let name = name.to_owned();
        let _ = self.news.send(LayoutNews::Loaded { layout: loaded, revision, name, cause, warnings });
    }

    /// Tells the window, which has the text, of each change of the files.
    fn watch(&self, files: &LayoutArgs) -> Result<Option<Watch>, Failure> {
        let news = self.news.clone();
        Watch::on_change(files, move || {
            let _ = news.send(LayoutNews::Changed);
        })
    }
}

/// What the wishes of the person at the window need.
struct Obeyed {
    files: LayoutArgs,
    /// Ends with the next one.
    watch: Option<Watch>,
    choices: Vec<String>,
    floor: Floor,
    desk: Desk,
}

impl Obeyed {
    /// Does what the person at the window wants, on a thread that ends with the window.
    fn process_commands(mut self, wished: Receiver<PreviewCommand>, notices: Sender<String>) {
        thread::spawn(move || {
            for wish in wished {
                let command = match wish {
                    PreviewCommand::Open(choice) => {
                        self.open(choice);
                        continue;
                    }
                    PreviewCommand::Watch(path) => {
                        self.files.layout = path;
                        match self.desk.watch(&self.files) {
                            Ok(watch) => self.watch = watch,
                            Err(failure) => drop(notices.send(failure.to_string())),
                        }
                        continue;
                    }
                    PreviewCommand::Try { layout, name, warnings, cause } => {
                        self.desk.put(&name, cause, Arc::unwrap_or_clone(layout), warnings);
                        continue;
                    }
                    PreviewCommand::SaveEffect { name, text } => {
                        // A window that is closed already need not know.
                        let _ = notices.send(self.save(&name, &text));
                        continue;
                    }
                    PreviewCommand::Enable { id, enabled: true } => {
                        Command::Control(ControlMessage::Enable { id })
                    }
                    PreviewCommand::Enable { id, enabled: false } => {
                        Command::Control(ControlMessage::Disable { id })
                    }
                    PreviewCommand::Mute(on) => Command::Control(ControlMessage::Mute { on }),
                    PreviewCommand::MuteTile { tile, on } => {
                        Command::Control(ControlMessage::MuteTile { tile, on })
                    }
                    PreviewCommand::Set { id, value } => Command::Control(ControlMessage::Set { id, value }),
                    PreviewCommand::Feel { effect, gesture, tile } => {
                        let tile = u16::try_from(tile).unwrap_or(u16::MAX);
                        Command::Audition { effect, gesture: Box::new(gesture), tile }
                    }
                };
                if !self.desk.session.send(command) {
                    break;
                }
            }
        });
    }

    fn open(&mut self, choice: usize) {
        let name = self.choices.get(choice).map_or(DEFAULT_LAYOUT, String::as_str).to_owned();
        self.files.layout = Some(PathBuf::from(&name));
        let read = self.files.reviewed(&self.floor).map_err(|failure| failure.to_string());
        self.desk.take(&name, LayoutCause::Opened, read);
    }

    /// Keeps an effect where layouts find it, and shows the layout with it; the answer is what to say.
    fn save(&self, name: &str, text: &str) -> String {
        let folder = self.files.effects_folder().unwrap_or_else(|| {
            let beside = self.files.path().and_then(std::path::Path::parent);
            beside.map_or_else(|| PathBuf::from("effects"), |folder| folder.join("effects"))
        });
        let path = folder.join(format!("{name}.ron"));
        if let Err(error) = std::fs::create_dir_all(&folder) {
            return format!("{} can't be made: {error}", folder.display());
        }
        // What somebody has written beside the numbers stays.
        let old = std::fs::read_to_string(&path).unwrap_or_default();
        let text = edit::refit(&old, text);
        match schema::save_text(&text, &path) {
            Ok(_) => {
                let _ = self.desk.news.send(LayoutNews::Changed);
                format!("Saved in {}: write \"{name}\" where it shall be felt.", path.display())
            }
            Err(error) => error.to_string(),
        }
    }
}

/// Passes events on to the window.
struct ToWindow {
    events: SyncSender<EventNews>,
    missed: u64,
}

impl EventSink for ToWindow {
    fn report(&mut self, report: Report<'_>) {
        if let Report::Event(event) = report
            && let Err(TrySendError::Full(_)) = self.events.try_send(EventNews::Event(event.clone()))
        {
            self.missed += 1;
        }
    }

    fn dropped(&self) -> u64 {
        self.missed
    }
}

/// The mouse's feet on the simulated floor.
struct Mouse(FootHandle);

impl FootSink for Mouse {
    fn lead(&mut self, over_s: f32, paths: &[Vec<PreviewFoot>]) {
        self.0.lead(over_s, paths.iter().map(|path| path.iter().map(foot).collect()).collect());
    }

    fn centre_of_pressure(&self, shoe: &PreviewFoot) -> Vec2 {
        foot(shoe).centre_of_pressure()
    }
}

/// A centimetre of shoe around the foot's length.
const SHOE_M: f32 = 0.01;

fn foot(shoe: &PreviewFoot) -> Foot {
    Foot {
        position: shoe.position,
        heading: shoe.heading_rad,
        length_m: shoe.length_m - SHOE_M,
        force: shoe.force,
        roll: shoe.roll,
    }
}

/// The shoe around a foot; a foot of a scenario has no side, the mouse's second one is the left.
fn shoe(foot: &Foot, left: bool) -> PreviewFoot {
    PreviewFoot { length_m: foot.length_m + SHOE_M, left, ..PreviewFoot::from(foot) }
}

/// What the actuators did, as the window draws it.
struct Scopes {
    reader: ScopeReader,
    points: Vec<(f32, f32)>,
}

impl Scopes {
    fn new(reader: ScopeReader) -> Self {
        Self { reader, points: Vec::new() }
    }
}

impl ScopeFeed for Scopes {
    fn update(&mut self) {
        self.reader.update();
    }

    fn scope(&mut self, channel: usize) -> &[(f32, f32)] {
        self.points.clear();
        self.points.extend(self.reader.channel(channel).iter().map(|point| (point.min, point.max)));
        &self.points
    }
}
