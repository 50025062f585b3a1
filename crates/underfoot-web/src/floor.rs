//! The simulated floor of the page: one thread does all, a few milliseconds of the floor in each frame.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender};
use std::time::Duration;

use triple_buffer::triple_buffer;
use underfoot::engine::Snapshot;
use underfoot::feel::{RendererConfig, renderer};
use underfoot::recording::{Progress, Recording, Speed};
use underfoot::schema;
use underfoot::sense::Method;
use underfoot::serve::{Ended, Server};
use underfoot::sink::{Fanout, Since, StereoSink, wait_free_shared};
use underfoot::source::{LinkFaults, SensorSource, TappedPackets};
use underfoot::units::Instant;
use underfoot_sim::{
    FootDriver, FootHandle, Host, Pace, RecordedFeet, RehearsalSource, SimFloor, SimulatedSource, TakeOver,
    arrivals, feet_by_hand, go_on_from, taped, watched,
};
use underfoot_window::link::{SharedLayout, VisitTape};
use underfoot_window::preview::{
    DesignInput, LayoutCause, Mouse, Notice, PreviewInput, ProgramChannels, ScopeFeed, SignalScopes,
    ToWindow, announced, channels, shoes, usual_state,
};

use super::clicks::ClickWatch;
use super::clock::{PageClock, Ticks};
use super::desk::PageDesk;
use super::kinds::OwnTexts;
use super::lines::EventLines;
use super::plan::{FloorPlan, NoFloor, SEED};
use super::tape::TapeDesk;

/// Samples per second and side of the sound.
pub const RATE: u32 = 48_000;

/// Maximum number of commands that wait for the floor.
const COMMANDS_WAITING: usize = 256;

/// Maximum time that a frame of the page adds to the floor, beside the 50 ms that it catches up. After a longer pause,
/// as of a hidden page, the floor stands still for the rest; a machine that is too slow has a slow floor and a page that
/// answers.
const MOST_AT_ONCE: Duration = Duration::from_millis(16);

/// The simulated floor of the page.
pub struct PageFloor {
    server: Server,
    pace: FloorPace,
    /// `None` for a recording, which takes no commands.
    desk: Option<PageDesk>,
    notices: SyncSender<Notice>,
    clicks: ClickWatch,
    lines: Receiver<String>,
    /// Whether the floor has ended: a recording at its end, any other through a fault alone.
    is_over: bool,
}

/// The time of a floor.
enum FloorPace {
    /// It runs with the time of the page.
    Clock(Arc<PageClock>),
    /// It runs from millisecond to millisecond, as its caller asks: the same packets at the same moments in every
    /// browser.
    Steps(Ticks),
    /// It is replayed, and began at this moment of its own clock.
    Replay(Arc<Progress>, Instant),
}

impl PageFloor {
    /// A floor with the layout of `shared`, and the input of the window that shows it. `play` gets the sound of each
    /// frame: left and right in turn, [`RATE`] samples per second and side.
    ///
    /// # Errors
    /// [`NoFloor::Layout`] with all problems of the texts; [`NoFloor::Size`] for a floor that a page cannot simulate.
    pub fn new(
        shared: &SharedLayout,
        play: impl FnMut(&[f32]) + 'static,
    ) -> Result<(Self, PreviewInput), NoFloor> {
        let plan = FloorPlan::of(shared)?;
        let (hand, driver) = feet_by_hand();
        let clock = Arc::<PageClock>::default();
        let begun = Begun {
            hand,
            driver: Box::new(driver),
            source: &|sim, driver| {
                SimulatedSource::on(sim, driver, Pace::RealTime, Arc::clone(&clock) as Arc<dyn Host>)
            },
        };
        Ok(Self::begin(&plan, begun, FloorPace::Clock(Arc::clone(&clock)), play))
    }

    /// A floor on which the feet of a visit act until the window's feet take over.
    pub(crate) fn of_visit(
        plan: &FloorPlan,
        feet: Arc<RecordedFeet>,
        play: impl FnMut(&[f32]) + 'static,
    ) -> (Self, PreviewInput, TakeOver) {
        let (hand, driver) = feet_by_hand();
        let (take_over, driver) = go_on_from(feet, Box::new(driver));
        let (ticks, driver) = Ticks::of(driver);
        let begun = Begun {
            hand,
            driver,
            source: &|sim, driver| SimulatedSource::new(sim, driver, Pace::FreeRunning),
        };
        let (floor, input) = Self::begin(plan, begun, FloorPace::Steps(ticks), play);
        (floor, input, take_over)
    }

    fn begin(
        plan: &FloorPlan,
        begun: Begun<'_>,
        pace: FloorPace,
        play: impl FnMut(&[f32]) + 'static,
    ) -> (Self, PreviewInput) {
        let floor = Arc::clone(&plan.floor);
        let (people, driver) = arrivals(begun.driver);
        let (tape, driver) = taped(Box::new(driver));
        let (driver, seen) = watched(driver);
        let source = (begun.source)(plan.sim.clone(), Box::new(driver));
        let (source, faults) = RehearsalSource::new(source, LinkFaults::default(), SEED);
        let start = source.now();
        let (tap, packets) = TappedPackets::new();

        let (window, ProgramChannels { events, layouts, notices, commands }) = channels();
        let (feel, mut renderer) = renderer(RendererConfig::of(&floor, RATE));
        let scopes = renderer.scope().map(|scope| Box::new(SignalScopes::new(scope)) as Box<dyn ScopeFeed>);
        let (written, shown) = triple_buffer(&Snapshot::default());
        let (to_floor, received) = wait_free_shared(COMMANDS_WAITING);
        let (layout, clicks) = (plan.layout.clone(), ClickWatch::default());
        let (reported, lines) = EventLines::new();
        let told = Fanout::new().with(ToWindow::new(events)).with(clicks.clone()).with(reported);
        let mut server = Server::new(&floor, layout.clone(), Method::default(), tap.wrap(source))
            .with_events(Box::new(told))
            .with_feel(feel, Box::new(StereoSink::new(renderer, &floor, start, play)))
            .with_snapshots(written)
            .with_commands(received);
        // The first snapshot, before the window asks for it.
        let _ = server.turn();

        let choices: Vec<String> = schema::builtin_layouts().map(String::from).collect();
        let kinds_of = plan.own.clone();
        let design = DesignInput {
            name: plan.name.clone(),
            text: plan.text.clone(),
            path: None,
            kinds_of: Box::new(move |path| Ok(kinds_of.read(path))),
            state: usual_state(),
        };
        let input = PreviewInput {
            warnings: plan.warnings.clone(),
            scopes,
            feet: Some(Box::new(Mouse(begun.hand))),
            visit: Some(Box::new(TapeDesk::new(VisitTape::new(tape.clone(), plan.build)))),
            faults: Some(faults),
            people: Some(people),
            packets: Some(packets),
            shoes: Some(shoes(seen)),
            choices: choices.clone(),
            effects: plan.kinds.effects().iter().cloned().collect(),
            design: Some(design),
            ..PreviewInput::new(Arc::clone(&floor), Arc::new(layout), "simulated floor", shown, window)
        };
        let desk = PageDesk {
            floor,
            choices,
            own: plan.own.clone(),
            asked: commands,
            to_floor,
            layouts,
            notices: notices.clone(),
            late: Vec::new(),
            revision: 0,
            off: Vec::new(),
            tape,
        };
        (Self { server, pace, desk: Some(desk), notices, clicks, lines, is_over: false }, input)
    }

    /// A recorded floor, and the input of the window that shows it.
    pub(crate) fn of_recording(recording: Recording) -> (Self, PreviewInput) {
        let (floor, layout) = (Arc::new(recording.floor().clone()), recording.layout().clone());
        let (method, begins) = (recording.method(), recording.begins());
        // It waits for nobody: the page asks for as much as is due.
        let source = recording.source(Speed::Max);
        let first = begins.unwrap_or(Instant::START).max(source.now());
        let progress = source.progress();
        let (window, ProgramChannels { events, layouts, notices, commands: _ }) = channels();
        let (written, shown) = triple_buffer(&Snapshot::default());
        let (clicks, (reported, lines)) = (ClickWatch::default(), EventLines::new());
        let told = Fanout::new().with(ToWindow::new(events)).with(clicks.clone()).with(reported);
        let input = announced(source, layouts, LayoutCause::Recorded);
        let server = Server::new(&floor, layout.clone(), method, input)
            .with_events(Box::new(Since::new(told, first)))
            .with_snapshots(written);
        let input = PreviewInput::new(floor, Arc::new(layout), "a recording", shown, window);
        let pace = FloorPace::Replay(progress, first);
        (Self { server, pace, desk: None, notices, clicks, lines, is_over: false }, input)
    }

    /// The user's kinds and effects, for links.
    #[must_use]
    pub fn own_texts(&self) -> OwnTexts {
        self.desk.as_ref().map(|desk| desk.own.clone()).unwrap_or_default()
    }

    /// Whether a control clicked under a foot since the last call.
    #[must_use]
    pub fn has_clicked(&self) -> bool {
        self.clicks.take()
    }

    /// The events since the last call, as lines of JSON.
    pub fn event_lines(&self) -> impl Iterator<Item = String> {
        self.lines.try_iter()
    }

    /// Describes the sound, or why there is none, once there is something to hear.
    pub fn tell_sound(&self, text: impl Into<String>) {
        let _ = self.notices.try_send(Notice::Sound(text.into()));
    }

    /// Shows a message in the window.
    pub fn tell(&self, text: impl Into<String>) {
        let _ = self.notices.try_send(Notice::Text(text.into()));
    }

    /// Carries out the commands of the window and advances the floor to `now`: for the usual floor, the time of the page
    /// since some fixed moment; for that of a visit or a recording, its own time.
    pub fn run_until(&mut self, now: Duration) {
        if self.is_over {
            return;
        }
        if let Some(desk) = &mut self.desk {
            desk.work(&self.server);
        }
        if let FloorPace::Clock(clock) = &self.pace {
            clock.set(now.saturating_sub(MOST_AT_ONCE));
        }
        while self.now() < now {
            match self.server.turn() {
                Ok(Ended::No) => {}
                Ok(Ended::Yes) if self.desk.is_none() => return self.is_over = true,
                Ok(Ended::Yes) => return self.end("The floor has ended: load the page again."),
                Err(error) => return self.end(&error.to_string()),
            }
        }
    }

    fn now(&self) -> Duration {
        match &self.pace {
            FloorPace::Clock(clock) => clock.elapsed(),
            FloorPace::Steps(ticks) => ticks.done(),
            FloorPace::Replay(progress, first) => progress.now().since(*first),
        }
    }

    fn end(&mut self, why: &str) {
        self.is_over = true;
        self.tell(why);
    }
}

/// The feet of a floor that begins, and the way to its packets.
struct Begun<'a> {
    hand: FootHandle,
    driver: Box<dyn FootDriver>,
    source: &'a dyn Fn(SimFloor, Box<dyn FootDriver>) -> SimulatedSource,
}
