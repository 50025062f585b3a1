//! The server: one turn per packet, with all its consequences.

mod end;
mod haptics;
mod heartbeat;
mod inbox;
mod limited;
mod link;
mod messages;
mod off;
mod outputs;
mod requests;
mod sensors;

use std::borrow::Cow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::SyncSender;
use std::time::Duration;

use tracing::debug;
use triple_buffer::Input;

use self::haptics::Haptics;
use self::inbox::Inbox;
use self::link::LinkWatch;
use self::off::OffWatch;
use self::outputs::Outputs;
use self::requests::Answers;
use self::sensors::SensorWatch;
use super::cause::{CauseWatch, Facts};
use super::trial::EffectTrial;
use crate::engine::{Engine, Snapshot};
use crate::feel::{CueSender, Effect, FeelCounters, Gesture};
use crate::floor::Floor;
use crate::layout::Layout;
use crate::sense::{Assembler, BoardStatus, Method, Tare, TareOutcome};
use crate::serve::{Neighbours, Refusal};
use crate::sink::{ActuatorSink, EventSink, LatencyStages, Report, WaitFreeReceiver};
use crate::source::{FloorInput, Incoming, SensorSource, SourceError};
use crate::units::{Instant, Newtons};
use crate::wire::{ControlMessage, LinkCounters, Prefix};

/// Maximum wait for a packet before the server does its other work; well within the 100 ms of a lost floor.
const PATIENCE: Duration = Duration::from_millis(5);

/// Time from one frame to the next: the cues of a frame are played within it.
const FRAME: Duration = Duration::from_millis(1);

/// Maximum number of requests processed before the next packet, and of commands per millisecond: about 5 us each, so
/// that packets never wait for long.
const MOST_AT_ONCE: usize = 16;

/// Interval between two snapshots: shorter than that of any screen.
const SNAPSHOT_EVERY: Duration = Duration::from_millis(5);

/// Delay of lockstep samples behind the clock while no frames come.
const IDLE_LAG: Duration = Duration::from_millis(20);

/// Time played after the last frame, so that the last click can ring out.
const TAIL: Duration = Duration::from_millis(300);

/// A command from an app or a window to a running floor.
#[derive(Clone, Debug)]
pub enum FloorCommand {
    /// Replaces the layout (delayed while a foot is on a control that both layouts have).
    SetLayout(Box<Layout>),
    /// A request that an app may also send over OSC.
    Control(ControlMessage),
    /// Carries out a request that an app may also send over OSC, except mute, and answers.
    Ask(ControlMessage, SyncSender<Result<(), Refusal>>),
    /// Returns the tare in use, per tile and corner as in [`Floor::tare`]; `None` if it is the floor's own, or
    /// unknown.
    GiveTare(SyncSender<Option<Vec<[Newtons; 4]>>>),
    /// Returns the state of each board, in the order of the floor file.
    GiveBoards(SyncSender<Vec<BoardStatus>>),
    /// Plays an effect on one tile under a simulated foot; replaces an effect that is still playing.
    Audition {
        /// The effect.
        effect: Arc<Effect>,
        /// The movement of the foot.
        gesture: Box<Gesture>,
        /// Index of the tile.
        tile: u16,
    },
}

/// Whether the server continues after a turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// Call again.
    No,
    /// The source has ended; everything is released and reported.
    Yes,
}

/// A running floor.
pub struct Server {
    source: Box<dyn SensorSource>,
    inbox: Inbox,
    assembler: Assembler,
    engine: Engine,
    commands: Option<WaitFreeReceiver<FloorCommand>>,
    /// Time at which commands were last polled.
    commands_looked: Instant,
    haptics: Haptics,
    outputs: Outputs,
    answers: Answers,
    link: LinkWatch,
    /// Time at which the link state of the boards was last checked.
    link_checked: Instant,
    causes: CauseWatch,
    sensors: SensorWatch,
    off: OffWatch,
    snapshots: Option<Input<Snapshot>>,
    /// Looks at the load of the thread; returns the number of overruns so far.
    load: Option<Box<dyn FnMut() -> u64 + Send>>,
    overruns: u64,
    /// Time of the last frame.
    seen: Instant,
    /// Time of the last snapshot.
    shown: Instant,
    /// Whether the snapshot must be renewed without a new frame.
    is_stale: bool,
}

impl Server {
    /// A server for the controls of `layout` on `floor`, fed by `input`, without any outputs yet.
    ///
    /// The tare is the floor's own, or measured at the start if it has none.
    #[must_use]
    pub fn new(floor: &Floor, layout: Layout, method: Method, input: impl Into<FloorInput>) -> Self {
        let FloorInput { source, port, replay, journals } = input.into();
        Self {
            source,
            inbox: Inbox { port, replay, journals },
            assembler: Assembler::with_tare(floor, Tare::suited_to(floor)),
            engine: Engine::new(floor.geometry, layout, method)
                .with_maps(&floor.position_maps)
                .with_floor_file(floor.file.clone()),
            commands: None,
            commands_looked: Instant::START,
            haptics: Haptics::default(),
            outputs: Outputs::default(),
            answers: Answers::default(),
            link: LinkWatch::default(),
            link_checked: Instant::START,
            causes: CauseWatch::new(&floor.boards),
            sensors: SensorWatch::default(),
            off: OffWatch::default(),
            snapshots: None,
            load: None,
            overruns: 0,
            seen: Instant::START,
            shown: Instant::START,
            is_stale: false,
        }
    }

    /// Sets `prefix` for the addresses of its answers; its input and sinks have prefixes of their own.
    #[must_use]
    pub fn with_prefix(mut self, prefix: Prefix) -> Self {
        self.answers.prefix = prefix;
        self
    }

    /// Sends cues that are felt on tiles of other computers, and plays theirs.
    #[must_use]
    pub fn with_neighbours(mut self, neighbours: Box<dyn Neighbours>) -> Self {
        self.haptics.neighbours = Some(neighbours);
        self
    }

    /// Sends cues through `feel` to the renderer that `actuators` plays.
    #[must_use]
    pub fn with_feel(mut self, feel: CueSender, actuators: Box<dyn ActuatorSink>) -> Self {
        self.haptics.feel = Some(feel);
        self.haptics.actuators = Some(actuators);
        self
    }

    /// Records in `stages` how long packets take to become cues; the sink measures the rest.
    #[must_use]
    pub fn with_latency(mut self, stages: LatencyStages) -> Self {
        self.haptics.latency = Some((stages, Instant::START));
        self
    }

    /// Reports events to `events`.
    #[must_use]
    pub fn with_events(mut self, events: Box<dyn EventSink>) -> Self {
        self.outputs.sink = Some(events);
        self
    }

    /// Keeps `snapshots` up to date.
    #[must_use]
    pub fn with_snapshots(mut self, snapshots: Input<Snapshot>) -> Self {
        self.snapshots = Some(snapshots);
        self
    }

    /// Receives commands from `commands`.
    #[must_use]
    pub fn with_commands(mut self, commands: WaitFreeReceiver<FloorCommand>) -> Self {
        self.commands = Some(commands);
        self
    }

    /// Calls `load` ten times a second on the thread that runs the server: it looks at the load of that thread and
    /// returns how often the thread has been too slow so far ([`LinkCounters::overruns`]).
    pub fn watch_load(&mut self, load: impl FnMut() -> u64 + Send + 'static) {
        self.load = Some(Box::new(load));
    }

    /// Returns the engine for inspection.
    #[must_use]
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// Returns the counts of received and rejected packets, from the socket to the frames.
    #[must_use]
    pub fn counters(&self) -> LinkCounters {
        let Answers { denied, cleaned, .. } = self.answers;
        let own = LinkCounters { denied, cleaned, overruns: self.overruns, ..LinkCounters::default() };
        self.source.counters() + self.assembler.counters() + own
    }

    /// Returns the counts of cues that were lost, altered or muted so far.
    #[must_use]
    pub fn feel_counters(&self) -> FeelCounters {
        self.haptics.counters()
    }

    /// Returns the number of events that could not be reported so far.
    #[must_use]
    pub fn unsent_events(&self) -> u64 {
        self.outputs.dropped()
    }

    /// Writes the visible state into `snapshot`.
    pub fn snapshot(&self, snapshot: &mut Snapshot) {
        self.engine.snapshot(snapshot);
        snapshot.held.clear();
        snapshot.held.extend(self.engine.held().cloned());
        snapshot.link = self.link.state();
        snapshot.link_cause = self.causes.cause().cloned();
        (snapshot.boards_live, snapshot.boards) = self.assembler.boards_live();
        snapshot.counters = self.counters();
        self.assembler.health(&mut snapshot.health);
        snapshot.device = self.haptics.device().cloned();
        snapshot.muted.clone_from(self.haptics.muted());
        snapshot.feel = self.feel_counters();
        snapshot.unsent_events = self.unsent_events();
    }

    /// Runs until the source ends or fails or `stop` is set, which takes effect within some milliseconds; then
    /// cancels everything held and reports that.
    ///
    /// # Errors
    /// Those of [`Server::turn`].
    pub fn run(&mut self, stop: &AtomicBool) -> Result<(), SourceError> {
        self.haptics.update_mute(self.link.is_lost());
        let served = loop {
            if stop.load(Ordering::Relaxed) {
                break Ok(());
            }
            match self.turn() {
                Ok(Ended::No) => {}
                Ok(Ended::Yes) => break Ok(()),
                Err(error) => break Err(error),
            }
        };
        self.end();
        served
    }

    /// Takes one packet, or notes that none came, and processes all its consequences.
    ///
    /// # Errors
    /// [`SourceError`] if the source fails. A failing sink is dropped with a warning, so that the controls keep
    /// working without it.
    pub fn turn(&mut self) -> Result<Ended, SourceError> {
        self.process_commands();
        self.outputs.follow(self.engine.layout(), self.engine.layout_revision(), self.source.now());
        let mut is_silent = false;
        // Frames by the clock come even where no packet does.
        let patience = if self.assembler.follows_clock() { FRAME } else { PATIENCE };
        match self.source.next(patience) {
            Ok(Some(packet)) => {
                self.haptics.note_packet(self.source.now());
                self.causes.note(&packet);
                self.assembler.take(&packet);
            }
            Ok(None) => {
                let now = self.source.now();
                self.assembler.poll(now);
                self.haptics.play_until(now.before(IDLE_LAG));
                is_silent = true;
            }
            Err(SourceError::Ended) => {
                self.cancel_all();
                self.haptics.play_until(self.source.now() + TAIL);
                return Ok(Ended::Yes);
            }
            Err(error) => return Err(error),
        }
        self.haptics.poll_neighbours(self.source.now());
        self.note_link(is_silent);
        while self.step() {}
        // Changes caused by silence appear in no later frame.
        if self.is_stale || is_silent {
            self.show_now();
        }
        self.beat();
        self.outputs.poll(self.link.is_lost(), self.source.now());
        self.note_sensors();
        Ok(Ended::No)
    }

    /// Processes one frame; false if none is complete.
    fn step(&mut self) -> bool {
        let Some(frame) = self.assembler.ready() else { return false };
        let at = frame.at;
        self.seen = frame.received;
        let step = self.engine.step(frame);
        self.causes.note_frame(frame, !step.contacts.is_empty(), self.source.now());
        self.haptics.send(&step, at, self.source.now());
        for press in step.ignored {
            debug!("{press}");
        }
        self.outputs.step(&step, at);
        self.haptics.play_until(at + FRAME);
        self.show(at);
        true
    }

    /// Reports when the floor is lost or back, and silences the actuators while it is lost.
    ///
    /// This examines every board. It runs per frame and per millisecond instead of per packet; otherwise the cost
    /// would grow with the square of the number of boards.
    fn note_link(&mut self, is_silent: bool) {
        let now = self.source.now();
        if !is_silent && !self.assembler.is_due() && now.since(self.link_checked) < FRAME {
            return;
        }
        self.link_checked = now;
        let Some(state) = self.link.update(&self.assembler, self.engine.floor_file(), now) else { return };
        self.haptics.update_mute(self.link.is_lost());
        self.outputs.report(&Report::Link(now, state));
        self.is_stale = true;
    }

    /// Reports the state of sensors and device where it has changed.
    fn note_sensors(&mut self) {
        let now = self.source.now();
        self.sensors.note_troubles(&self.assembler, now);
        if !self.sensors.is_due(now) {
            return;
        }
        if let Some(load) = &mut self.load {
            self.overruns = load();
        }
        if let Some(status) = self.haptics.device_news(now) {
            self.outputs.report(&Report::Device(now, Cow::Borrowed(status)));
        }
        self.link.note_timings(&self.assembler, now);
        self.tell_everything();
        let (counters, link) = (self.counters(), self.link.state());
        self.note_cause(&counters, now);
        if let Some(health) = self.sensors.health_news(&self.assembler, link, now) {
            self.outputs.report(&Report::Health(now, Cow::Borrowed(health)));
        }
        self.note_off();
    }

    /// Reports for held controls whether they are off, and the reason, where that has changed.
    fn note_off(&mut self) {
        let news = self.off.news(&self.engine, self.engine.layout_revision());
        if !news.is_empty() {
            // An app that receives the report finds the same state in the snapshot.
            self.show_now();
        }
        for index in news {
            let id = self.engine.layout().widgets.get(index).map(|widget| widget.id.clone());
            if let Some(state) = id.and_then(|id| self.engine.control_state(id.as_str())) {
                self.outputs.report(&Report::Control(self.source.now(), Cow::Owned(state)));
            }
        }
    }

    /// Reports the cause of unusable frames where it has changed.
    fn note_cause(&mut self, counters: &LinkCounters, now: Instant) {
        let (link, refused) = (self.link.state(), self.inbox.last_refused());
        let facts = Facts { assembler: &self.assembler, link, counters, refused };
        if self.causes.update(&facts, now) {
            let cause = self.causes.cause();
            self.link.note_cause(cause, now);
            self.outputs.report(&Report::LinkCause(now, cause.map(Cow::Borrowed)));
            self.is_stale = true;
        }
    }

    /// Reports the held controls if they have changed or the report is due, and sends the alive report.
    fn beat(&mut self) {
        self.outputs.beat(self.engine.held(), self.seen, self.source.now());
    }

    /// Renews the snapshot regardless of its age.
    pub(crate) fn show_now(&mut self) {
        self.is_stale = true;
        self.show(self.source.now());
    }

    fn show(&mut self, at: Instant) {
        if !self.is_stale && at.since(self.shown) < SNAPSHOT_EVERY {
            return;
        }
        (self.shown, self.is_stale) = (at, false);
        let mut snapshots = self.snapshots.take();
        if let Some(snapshots) = &mut snapshots {
            self.snapshot(snapshots.input_buffer_mut());
            snapshots.publish();
        }
        self.snapshots = snapshots;
    }

    fn set_layout(&mut self, layout: Layout) {
        self.engine.set_layout(layout);
        self.is_stale = true;
    }

    /// Processes commands up to the limit of a turn; the end of the turn shows their effects.
    fn process_commands(&mut self) {
        for _ in 0..MOST_AT_ONCE {
            match self.inbox.take() {
                Some(Incoming::Request(request)) => self.process_request(request),
                Some(Incoming::Layout(layout)) => self.set_layout(*layout),
                None => break,
            }
        }
        let now = self.source.now();
        if now.since(self.commands_looked) < FRAME && self.commands_looked != Instant::START {
            return;
        }
        self.commands_looked = now;
        for _ in 0..MOST_AT_ONCE {
            let Some(command) = self.commands.as_mut().and_then(WaitFreeReceiver::try_recv) else {
                break;
            };
            match command {
                FloorCommand::SetLayout(mut layout) => {
                    self.inbox.note_layout(&mut layout);
                    self.set_layout(*layout);
                }
                FloorCommand::Control(message) => {
                    let request = message.into();
                    self.inbox.note_request(&request);
                    self.process_request(request);
                }
                FloorCommand::Ask(message, answer) => {
                    self.inbox.note_request(&message.clone().into());
                    self.answer(message, &answer);
                }
                FloorCommand::GiveTare(to) => {
                    let is_measured = self.assembler.tare_outcome() == TareOutcome::Taken;
                    // A caller that has stopped waiting needs no answer.
                    let _ = to.try_send(is_measured.then(|| self.assembler.tare()));
                }
                FloorCommand::GiveBoards(to) => {
                    let boards = (0..).map_while(|number| self.assembler.board(number));
                    // As above.
                    let _ = to.try_send(boards.collect());
                }
                FloorCommand::Audition { effect, gesture, tile } => {
                    self.haptics.trial = Some(EffectTrial::new(effect, *gesture, tile));
                }
            }
        }
    }
}
