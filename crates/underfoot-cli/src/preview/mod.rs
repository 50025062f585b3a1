//! `underfoot preview`: the window, with its floor served on a thread of its own.

mod commands;
mod followed;
mod joined;
mod layers;
mod links;
mod played;
mod player;
mod set_up;
mod visits;

use std::net::SocketAddr;
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use clap::Args as _;
use underfoot::feel::Renderer;
use underfoot::floor::{Floor, read_address};
use underfoot::layout::Layout;
use underfoot::recording::{Recording, RecordingSwitch};
use underfoot::runtime::{EndReason, Kind, Session};
use underfoot::schema;
use underfoot::sense::Method;
use underfoot::sink::{LatencyStages, Since};
use underfoot::source::{FloorInput, LinkFaults, TappedPackets};
use underfoot::units::{HostClock, Instant};
use underfoot_scene::scene::Show;
use underfoot_sim::{
    ArrivalHandle, FaultSwitch, FeetTape, FloorBuild, FootDriver, LoopingScript, Pace, RehearsalSource,
    SimulatedSource, arrivals, feet_by_hand, go_on_from, taped, watched,
};
use underfoot_window::preview::{
    self, DesignInput, FootSink, Mouse, Notice, PreviewError, PreviewInput, PreviewOptions, ProgramChannels,
    ProjectionOptions, ScopeFeed, ShareDesk, ShoeFeed, SignalScopes, ToWindow, Warnings, channels, shoes,
};

use self::commands::{CommandHandler, Desk};
use self::followed::FollowedFeed;
use self::joined::Joined;
use self::layers::read_layers;
use self::links::ProgramLinks;
use self::player::ShownRecording;
use self::visits::Visits;
use super::actuate::ActuateArgs;
use super::failure::Failure;
use super::fault_args::say_what_is_rehearsed;
use super::floor_args::FloorArgs;
use super::layout_args::{DEFAULT_LAYOUT, LayoutArgs};
use super::linked::{LinkedVisit, is_link};
use super::output;
use super::outputs::OutputArgs;
use super::play::{self, SimArgs};
use super::run::LISTEN;
use super::run::end;
use super::senders::{BoardArgs, CommandArgs};
use super::share::{self, Unpacked};
use super::stop::stop_flag;

/// Options of `underfoot preview`.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct Args {
    #[command(flatten)]
    layout: LayoutArgs,
    #[command(flatten)]
    floor: FloorArgs,
    /// Show a real floor, whose packets arrive here.
    #[arg(long, value_name = "ADDR", value_parser = read_address, conflicts_with_all = ["scenario", "session"])]
    listen: Option<SocketAddr>,
    /// Show the floor that `underfoot run --web ADDR` serves at this address, with its layout. The window then sends
    /// nothing to outputs or actuators.
    #[arg(long, value_name = "ADDR", value_parser = read_address, conflicts_with_all = served_here(), conflicts_with_all = ["floor", "grid"])]
    join: Option<SocketAddr>,
    /// Show a floor from the JSON lines in this file, `-` for standard input: the output of `underfoot-cluster
    /// gateway --json --json-contacts` or `underfoot run --json --json-contacts`, with the same layout and floor. The
    /// window then sends nothing to outputs or actuators.
    #[arg(long, value_name = "FILE", conflicts_with_all = served_here(), conflicts_with = "join")]
    follow: Option<PathBuf>,
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
    /// Record the floor into this file and replace an existing one; `underfoot preview FILE` shows it again.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Open the window for a projector at once, over the whole screen: the controls alone, laid onto the floor.
    #[arg(long)]
    project: bool,
    /// The screen that the projection fills, counted from 0; `1,2` for two projectors.
    #[arg(long, value_name = "NUMBER[,NUMBER]", requires = "project", value_parser = read_monitors)]
    monitor: Option<[Option<usize>; 2]>,
    /// File that remembers corners, brightness and screens of the projectors, in place of the usual one.
    #[arg(long, value_name = "FILE")]
    corners: Option<PathBuf>,
    /// Layers over the floor at the start, separated by commas, as the menu *Layers* names them: `contacts,tile-forces`.
    /// Also `usual`, `all` and `none`.
    #[arg(long, value_name = "NAMES", value_parser = read_layers)]
    layers: Option<Show>,
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

/// Reads the screens of one or two projectors.
fn read_monitors(text: &str) -> Result<[Option<usize>; 2], String> {
    let number = |text: &str| text.trim().parse::<usize>().map_err(|error| format!("`{text}`: {error}"));
    match text.split_once(',') {
        None => Ok([Some(number(text)?), None]),
        Some((first, second)) if number(first)? == number(second)? => {
            Err("both projectors would fill the same screen".into())
        }
        Some((first, second)) => Ok([Some(number(first)?), Some(number(second)?)]),
    }
}

/// Options of a floor that is served and felt here; a floor served elsewhere is only shown.
fn served_here() -> Vec<clap::Id> {
    let groups = [
        SimArgs::augment_args,
        BoardArgs::augment_args,
        CommandArgs::augment_args,
        OutputArgs::augment_args,
        ActuateArgs::augment_args,
    ];
    let command = groups.into_iter().fold(clap::Command::new(""), |command, add| add(command));
    let own = ["listen", "scenario", "session", "record", "eq4"].map(clap::Id::from);
    own.into_iter().chain(command.get_arguments().map(|option| option.get_id().clone())).collect()
}

/// Interval between two updates of the window's data: half of a frame.
const LOOK: Duration = Duration::from_millis(8);

/// Whether a window can probably be opened.
pub(crate) fn has_display() -> bool {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(target_os = "linux") || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")
}

/// Seed that determines the packets affected by the faults of a scenario.
const FAULT_SEED: u64 = 1;

/// Time for which the floor stays empty before the scenario starts again.
const PAUSE: Duration = Duration::from_secs(3);

/// Opens the window and serves its floor on a thread of its own until the window is closed.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if !has_display() {
        return Err(Failure::NoWindow("there is no display".into()));
    }
    if let Some(path) = args.recording() {
        return replayed(args, path);
    }
    if let Some((of_link, visit)) = args.of_link()? {
        return match visit {
            Some(visit) => played::run(of_link, visit),
            None => run(&of_link),
        };
    }
    if let Some(address) = args.join {
        return joined(args, address);
    }
    if let Some(path) = &args.follow {
        return followed(args, path);
    }
    let (live, input) = LiveFloor::start(args, None)?;
    // The floor ends in order, even after a failure of the window.
    let options = args.window();
    let shown = panic::catch_unwind(AssertUnwindSafe(|| preview::run(input, &options)));
    live.end(shown)
}

/// A floor at work behind the window.
struct LiveFloor {
    session: Session,
    switch: RecordingSwitch,
    signals: SignalWatch,
}

impl LiveFloor {
    /// Starts the floor of `args`, after a visit to it if there is one; also returns the input of its window.
    fn start(args: &Args, after: Option<&AfterVisit>) -> Result<(Self, PreviewInput), Failure> {
        let floor = match args.real() {
            Some(_) => args.boards.load(&args.floor)?,
            None => args.floor.load()?,
        };
        let (layout, warnings) = args.layout.reviewed(&floor)?;
        super::send_args::tell_off(&layout, "only `underfoot run` sends");
        let stage = args.stage(&floor, &layout, after)?;
        // Nobody gets the events of the visit once more.
        let begins = after.map_or(Instant::START, |after| after.at);

        let (window, ProgramChannels { events, layouts, notices, commands }) = channels();
        let (scope_sender, scopes) = mpsc::channel();

        // If several sound cards are tried, the last one plays.
        let watch_renderer = move |renderer: &mut Renderer| drop(scope_sender.send(renderer.scope()));
        let latency = LatencyStages::default();
        let told = notices.clone();
        // The window may be closed.
        let notice = move |text| drop(told.try_send(Notice::Sound(text)));
        let actuators = args.actuate.opener(latency.clone(), Arc::default(), watch_renderer, notice);
        let (tap, packets) = TappedPackets::new();
        let input = tap.wrap(stage.input);
        let mut session = Session::source(input, stage.clock)
            .floor(stage.floor.clone())
            .layout(layout.clone())
            .method(if args.eq4 { Method::Eq4 } else { Method::default() })
            .prefix(args.outputs.prefix.osc_prefix.clone())
            .sink(Since::new(args.outputs.open(&floor.geometry)?, begins))
            .sink(Since::new(ToWindow::new(events), begins))
            .actuators(actuators)
            .latency(latency.clone());
        let switch = RecordingSwitch::default();
        session = match &args.record {
            Some(path) => session.record(path),
            None => session.recording_switch(switch.clone()),
        };
        let session = session.start()?;
        let tape = stage.tape.as_ref().map(|(tape, _)| tape.clone());
        let visits = match &args.record {
            Some(_) => Visits::off("All is recorded, because the program was started with --record"),
            None => Visits::of_floor(session.clone(), switch.clone(), stage.tape),
        };
        let signals = SignalWatch::start(&session)?;

        let desk = Desk { session: session.clone(), layouts, tape };
        let watch = desk.watch(&args.layout)?;
        let choices = args.choices();
        let handler = CommandHandler {
            files: args.layout.clone(),
            watch,
            choices: choices.clone(),
            floor,
            desk,
            controls_off: None,
        };
        handler.process_commands(commands, notices);

        let scopes = scopes.try_iter().last().flatten();
        let scopes = scopes.map(|reader| Box::new(SignalScopes::new(reader)) as Box<dyn ScopeFeed>);
        let (floor, layout) = (Arc::new(stage.floor), Arc::new(layout));
        let links = ProgramLinks::new(&args.layout, floor.geometry);
        let input = PreviewInput {
            warnings: Warnings::from(&warnings),
            scopes,
            visit: Some(Box::new(visits)),
            share: stage.feet.is_some().then(|| Box::new(links) as Box<dyn ShareDesk>),
            latency: Some(latency),
            feet: stage.feet,
            faults: stage.faults,
            people: stage.people,
            packets: Some(packets),
            shoes: stage.shoes,
            choices,
            effects: args.layout.kinds()?.effects().iter().cloned().collect(),
            design: args.design()?,
            ..PreviewInput::new(floor, layout, stage.name, session.take_snapshots(), window)
        };
        Ok((Self { session, switch, signals }, input))
    }

    /// Ends the floor after its window, which ended so.
    fn end(self, shown: thread::Result<Result<(), PreviewError>>) -> Result<(), Failure> {
        let Self { session, switch, signals } = self;
        switch.end();
        session.stop();
        let end = end(&session);
        drop(signals);
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
}

/// The moment of a visit at which the window's feet take over.
struct AfterVisit {
    visit: LinkedVisit,
    at: Instant,
}

/// Stops a floor and waits until it has ended, so that no more reports come from it.
fn stop_and_wait(session: &Session) {
    session.stop();
    while !session.has_ended() {
        thread::sleep(Duration::from_millis(1));
    }
}

/// Ends the floor and its recording in order when a signal ends the program: the window itself could not, since it
/// does not draw while another covers it.
struct SignalWatch {
    is_over: Arc<AtomicBool>,
}

impl SignalWatch {
    fn start(session: &Session) -> Result<Self, Failure> {
        /// Interval between two checks of the flag.
        const EVERY: Duration = Duration::from_millis(50);
        let (stop, session, is_over) = (stop_flag()?, session.clone(), Arc::<AtomicBool>::default());
        let watch = Self { is_over: Arc::clone(&is_over) };
        thread::spawn(move || {
            while !stop.load(Ordering::Relaxed) {
                if is_over.load(Ordering::Relaxed) {
                    return;
                }
                thread::sleep(EVERY);
            }
            stop_and_wait(&session);
            std::process::exit(i32::from(!output::finish()));
        });
        Ok(watch)
    }
}

impl Drop for SignalWatch {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
    }
}

/// Shows a recording; its events go to no other program.
fn replayed(args: &Args, path: &Path) -> Result<(), Failure> {
    let (window, program) = channels();
    let (player, floor, layout, snapshots) = ShownRecording::start(path, program)?;
    let name = path.file_name().unwrap_or(path.as_os_str()).display().to_string();
    let input = PreviewInput {
        playback: Some(Box::new(player)),
        visit: Some(Box::new(Visits::of_recording(path))),
        ..PreviewInput::new(Arc::new(floor), layout, name, snapshots, window)
    };
    preview::run(input, &args.window()).map_err(|PreviewError::NoWindow(reason)| Failure::NoWindow(reason))
}

/// Shows a server's floor.
fn joined(args: &Args, address: SocketAddr) -> Result<(), Failure> {
    let (window, program) = channels();
    let joined = Joined::start(address, program, args.layout.clone())?;
    let server = Some(joined.feed);
    let design = match args.layout.layout {
        Some(_) => args.design()?,
        None => Some(args.design_of("the server’s layout", joined.layout_text, None)),
    };
    let floor = Arc::new(joined.floor);
    let input = PreviewInput {
        server,
        packets: Some(joined.packets),
        design,
        ..PreviewInput::new(floor, joined.layout, address.to_string(), joined.snapshots, window)
    };
    preview::run(input, &args.window()).map_err(|PreviewError::NoWindow(reason)| Failure::NoWindow(reason))
}

/// Shows a floor from JSON lines.
fn followed(args: &Args, path: &Path) -> Result<(), Failure> {
    let floor = args.floor.load()?;
    let (layout, warnings) = args.layout.reviewed(&floor)?;
    let (window, program) = channels();
    let followed = FollowedFeed::start(path, program, &args.layout, &floor, layout.clone())?;
    let input = PreviewInput {
        warnings: Warnings::from(&warnings),
        server: Some(followed.feed),
        ..PreviewInput::new(Arc::new(floor), Arc::new(layout), followed.name, followed.snapshots, window)
    };
    preview::run(input, &args.window()).map_err(|PreviewError::NoWindow(reason)| Failure::NoWindow(reason))
}

/// The input of the floor, with its description.
struct Stage {
    floor: Floor,
    input: FloorInput,
    clock: HostClock,
    name: String,
    feet: Option<Box<dyn FootSink>>,
    shoes: Option<ShoeFeed>,
    faults: Option<FaultSwitch>,
    people: Option<ArrivalHandle>,
    /// Records the feet of a simulated floor, which was built so.
    tape: Option<(FeetTape, FloorBuild)>,
}

impl Args {
    /// The same options with the files of a link in place of the link, and the visit of the link; `None` without a link.
    fn of_link(&self) -> Result<Option<(Self, Option<LinkedVisit>)>, Failure> {
        let Some(link) = self.layout.layout.as_deref().filter(|layout| is_link(layout)) else {
            return Ok(None);
        };
        let Unpacked { layout, geometry, visit } =
            share::unpack(&link.to_string_lossy(), &preview::usual_state())?;
        errln!("The layout of the link is in {}.", layout.display());
        let mut args = self.clone();
        args.layout.layout = Some(layout);
        let has_floor = args.floor.floor.is_some() || args.floor.grid.is_some();
        if !has_floor {
            args.floor.grid = geometry;
        }
        let plays = args.real().is_none() && args.scenario.is_none() && !args.session;
        if visit.is_some() && (has_floor || !plays) {
            errln!("The link has a visit to another floor: its layout is shown without it.");
        }
        Ok(Some((args, visit.filter(|_| plays && !has_floor))))
    }

    /// The recording, if one is given in place of a layout.
    fn recording(&self) -> Option<&Path> {
        self.layout.path().filter(|path| Recording::is_at(path))
    }

    /// Initial options of the window.
    fn window(&self) -> PreviewOptions {
        let projection = ProjectionOptions {
            open: self.project,
            keeps_awake: true,
            monitors: self.monitor.unwrap_or_default(),
            corners: self.corners.clone(),
        };
        let settings = Some(preview::usual_state().join("window"));
        let usual = PreviewOptions::default();
        let layers = self.layers.unwrap_or(usual.layers);
        PreviewOptions { projection, settings, layers, set_up: Some(set_up::open), ..usual }
    }

    /// The address for the packets of a real floor; `None` for a simulated one.
    fn real(&self) -> Option<SocketAddr> {
        self.listen.or_else(|| self.boards.have_ports().then_some(LISTEN))
    }

    fn stage(&self, floor: &Floor, layout: &Layout, after: Option<&AfterVisit>) -> Result<Stage, Failure> {
        if let Some(address) = self.real() {
            if self.session || self.scenario.is_some() {
                let why = "--serial shows a real floor, and a scenario plays on a simulated one";
                return Err(Failure::Other(why.into()));
            }
            let prefix = self.outputs.prefix.osc_prefix.clone();
            let source = self.commands.open(self.boards.bind(address, floor)?.with_prefix(prefix))?;
            let clock = source.clock();
            return Ok(Stage {
                floor: floor.clone(),
                input: self.boards.beside(source, floor, clock.clone())?,
                clock,
                name: format!("floor on port {}", address.port()),
                feet: None,
                shoes: None,
                faults: None,
                people: None,
                tape: None,
            });
        }
        let mut faults = LinkFaults::default();
        let (driver, name, feet): (Box<dyn FootDriver>, _, Option<Box<dyn FootSink>>) =
            if self.session || self.scenario.is_some() {
                let (script, rehearsed) = play::script(self.scenario.as_deref(), layout, &floor.geometry)?;
                faults = rehearsed;
                (Box::new(LoopingScript::new(script, PAUSE)), "scenario on a simulated floor", None)
            } else {
                let (handle, driver) = feet_by_hand();
                (Box::new(driver), "simulated floor", Some(Box::new(Mouse(handle))))
            };
        let (driver, build, begins) = match after {
            Some(AfterVisit { visit, at }) => {
                let (take_over, driver) = go_on_from(Arc::clone(&visit.feet), driver);
                take_over.at(*at);
                (driver, visit.build, *at)
            }
            None => (driver, self.sim.build(), Instant::START),
        };
        let (people, driver) = arrivals(driver);
        let (tape, driver) = taped(Box::new(driver));
        let (driver, seen) = watched(driver);
        let (sim, floor) = build.in_use(floor)?;
        let driver = Box::new(driver);
        let source = SimulatedSource::new(sim, driver, Pace::RealTime).hurrying_to(begins);
        let clock = source.clock();
        say_what_is_rehearsed(&faults);
        let (source, switch) = RehearsalSource::new(source, faults, FAULT_SEED);
        Ok(Stage {
            floor,
            clock,
            input: source.into(),
            faults: Some(switch),
            people: Some(people),
            name: name.into(),
            feet,
            shoes: Some(shoes(seen)),
            // A floor with position maps is not in a link.
            tape: (!build.is_mapped).then_some((tape, build)),
        })
    }

    /// The text of the layout, for the designer.
    fn design(&self) -> Result<Option<DesignInput>, Failure> {
        let path = self.layout.path().map(std::path::Path::to_path_buf);
        let name = self.layout.layout.as_deref().and_then(std::path::Path::to_str).unwrap_or(DEFAULT_LAYOUT);
        let text = match &path {
            Some(_) if self.layout.begun().is_some() => Some(String::new()),
            Some(path) => std::fs::read_to_string(path).ok(),
            None => schema::builtin_layout(name).map(str::to_owned),
        };
        Ok(text.map(|text| self.design_of(name, text, path)))
    }

    /// A layout with this name, text and file, for the designer.
    fn design_of(&self, name: &str, text: String, path: Option<PathBuf>) -> DesignInput {
        let files = self.layout.clone();
        let kinds_of = Box::new(move |path: Option<&std::path::Path>| {
            let layout = path.map(std::path::Path::to_path_buf);
            LayoutArgs { layout, ..files.clone() }.kinds().map(Arc::new)
        });
        let state = preview::usual_state();
        DesignInput { name: name.to_owned(), text, path, kinds_of, state }
    }

    /// The layout given and the built-in ones.
    fn choices(&self) -> Vec<String> {
        let given = self.layout.path().map(|path| path.display().to_string());
        given.into_iter().chain(schema::builtin_layouts().map(String::from)).collect()
    }
}

#[cfg(test)]
mod tests {
    use clap::Args as _;

    use super::{Args, read_monitors, served_here};

    /// Options of the view, for a floor served here or elsewhere, and the hidden one that explains where a layout stands.
    const SHOWN: [&str; 12] = [
        "_option", "layout", "widgets", "effects", "floor", "grid", "join", "follow", "project", "monitor",
        "corners", "layers",
    ];

    #[test]
    fn one_or_two_different_screens_are_read() {
        assert_eq!(read_monitors("1"), Ok([Some(1), None]));
        assert_eq!(read_monitors("1,2"), Ok([Some(1), Some(2)]));
        for bad in ["", "one", "1,", "1,2,3", "-1", "1,1"] {
            assert!(read_monitors(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn every_option_is_of_a_floor_served_here_or_of_any() {
        let command = Args::augment_args(clap::Command::new("preview"));
        let mut options: Vec<&str> = command.get_arguments().map(|option| option.get_id().as_str()).collect();
        let served = served_here();
        let mut known: Vec<&str> = served.iter().map(clap::Id::as_str).chain(SHOWN).collect();
        options.sort_unstable();
        known.sort_unstable();
        assert_eq!(options, known);
    }
}
