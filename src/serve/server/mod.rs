//! The server: one turn per packet, and all that follows from it.

mod end;
mod haptics;
mod heartbeat;
mod limited;
mod link;
mod off;
mod outputs;
mod requests;
mod sensors;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender};
use std::time::Duration;

use tracing::debug;
use triple_buffer::Input;

use self::haptics::Haptics;
use self::link::LinkWatch;
use self::off::OffWatch;
use self::outputs::Outputs;
use self::requests::Answers;
use self::sensors::SensorWatch;
use super::cause::{CauseWatch, Facts};
use super::trial::Trial;
use crate::engine::{Engine, Snapshot};
use crate::feel::{CueSender, Effect, FeelCounters, Gesture};
use crate::floor::Floor;
use crate::layout::Layout;
use crate::sense::{Assembler, Method, Tare, TareOutcome};
use crate::serve::{Neighbours, Refusal};
use crate::sink::{ActuatorSink, EventSink, LatencyStages, Report};
use crate::source::{SensorSource, SourceError};
use crate::units::{Instant, Newtons};
use crate::wire::{ControlMessage, LinkCounters, Prefix};

/// How long to wait for a packet before looking after everything else; well within the 100 ms of a lost floor.
const PATIENCE: Duration = Duration::from_millis(5);

/// Time from one frame to the next: what a frame causes is played within it.
const FRAME: Duration = Duration::from_millis(1);

/// Most requests that are met before the next packet is taken, and most commands in a millisecond: some 5 us each, so
/// that packets never wait for long.
const MOST_AT_ONCE: usize = 16;

/// How often the snapshot is renewed: more often than any screen.
const SNAPSHOT_EVERY: Duration = Duration::from_millis(5);

/// How far lockstep samples stay behind the clock while no frames come.
const IDLE_LAG: Duration = Duration::from_millis(20);

/// What is played after the last frame, so that the last click can ring out.
const TAIL: Duration = Duration::from_millis(300);

/// Something an app or a window asks of a floor at work.
#[derive(Clone, Debug)]
pub enum Command {
    /// Take another layout (kept back while a foot is on a control that both have).
    SetLayout(Box<Layout>),
    /// What an app may also ask over OSC.
    Control(ControlMessage),
    /// Do what an app may also ask over OSC, but mute, and answer.
    Ask(ControlMessage, SyncSender<Result<(), Refusal>>),
    /// Give the tare in use, per tile and corner as in [`Floor::tare`]; `None` where it is the floor's own, or not
    /// known.
    GiveTare(SyncSender<Option<Vec<[Newtons; 4]>>>),
    /// Play an effect on one tile as an imagined foot would, in place of what was being played so.
    Audition {
        /// What is felt.
        effect: Arc<Effect>,
        /// What the foot does.
        gesture: Box<Gesture>,
        /// Index of the tile.
        tile: u16,
    },
}

/// Whether there is more to come after a turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// Call again.
    No,
    /// The source has ended; everything is released and handed out.
    Yes,
}

/// One floor at work.
pub struct Server {
    source: Box<dyn SensorSource>,
    assembler: Assembler,
    engine: Engine,
    commands: Option<Receiver<Command>>,
    /// When commands were last looked for.
    commands_looked: Instant,
    haptics: Haptics,
    outputs: Outputs,
    answers: Answers,
    link: LinkWatch,
    /// When the boards were last looked at for it.
    link_checked: Instant,
    causes: CauseWatch,
    sensors: SensorWatch,
    off: OffWatch,
    snapshots: Option<Input<Snapshot>>,
    /// When the last frame came in.
    seen: Instant,
    /// When the snapshot was last renewed.
    shown: Instant,
    /// Whether it must be, although no frame may come.
    is_stale: bool,
}

impl Server {
    /// A server for the controls of `layout` on `floor`, fed by `source`, which so far tells nobody.
    ///
    /// The tare is the floor's own, or measured at the start if it has none.
    #[must_use]
    pub fn new(floor: &Floor, layout: Layout, method: Method, source: Box<dyn SensorSource>) -> Self {
        Self {
            source,
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
            causes: CauseWatch::new(floor.boards.iter().map(|board| board.address.clone())),
            sensors: SensorWatch::default(),
            off: OffWatch::default(),
            snapshots: None,
            seen: Instant::START,
            shown: Instant::START,
            is_stale: false,
        }
    }

    /// Begins the addresses of its answers with `prefix`; its source and sinks have prefixes of their own.
    #[must_use]
    pub fn with_prefix(mut self, prefix: Prefix) -> Self {
        self.answers.prefix = prefix;
        self
    }

    /// Hands on cues that are felt on tiles of other computers, and plays theirs.
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

    /// Measures in `stages` how long packets take to become cues; what follows is the sink's to measure.
    #[must_use]
    pub fn with_latency(mut self, stages: LatencyStages) -> Self {
        self.haptics.latency = Some((stages, Instant::START));
        self
    }

    /// Tells `events` what happens.
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

    /// Carries out `commands`.
    #[must_use]
    pub fn with_commands(mut self, commands: Receiver<Command>) -> Self {
        self.commands = Some(commands);
        self
    }

    /// The engine, to look at.
    #[must_use]
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// What came in and what was refused, from the socket to the frames.
    #[must_use]
    pub fn counters(&self) -> LinkCounters {
        let Answers { denied, cleaned, .. } = self.answers;
        let own = LinkCounters { denied, cleaned, ..LinkCounters::default() };
        self.source.counters() + self.assembler.counters() + own
    }

    /// What could not be felt as it should so far, or was not to be.
    #[must_use]
    pub fn feel_counters(&self) -> FeelCounters {
        self.haptics.counters()
    }

    /// Events that other programs could not be told so far.
    #[must_use]
    pub fn unsent_events(&self) -> u64 {
        self.outputs.dropped()
    }

    /// Writes everything there is to see into `snapshot`.
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

    /// Works until the source ends or fails or `stop` is set, which is noticed within some milliseconds;
    /// then cancels what feet still hold and tells so.
    ///
    /// # Errors
    /// What [`Server::turn`] gives.
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

    /// Takes one packet, or notices that none came, and does everything that follows from it.
    ///
    /// # Errors
    /// [`SourceError`] if the source fails. A sink that fails is dropped with a
    /// warning, for the controls go on working without it.
    pub fn turn(&mut self) -> Result<Ended, SourceError> {
        self.process_commands();
        let mut is_silent = false;
        match self.source.next(PATIENCE) {
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
        // What silence changes no later frame would show.
        if self.is_stale || is_silent {
            self.show_now();
        }
        self.beat();
        self.outputs.poll(self.link.is_lost(), self.source.now());
        self.note_sensors();
        Ok(Ended::No)
    }

    /// Works off one frame; false if none is complete.
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

    /// Says so when the floor is lost or back, and lets no actuator move while it is lost.
    ///
    /// That takes a look at every board. It is done for each frame and each millisecond and not for each packet, or it
    /// would grow with the square of the boards.
    fn note_link(&mut self, is_silent: bool) {
        let now = self.source.now();
        if !is_silent && !self.assembler.is_due() && now.since(self.link_checked) < FRAME {
            return;
        }
        self.link_checked = now;
        let Some(state) = self.link.update(&self.assembler, self.engine.floor_file(), now) else { return };
        self.haptics.update_mute(self.link.is_lost());
        self.outputs.report(Report::Link(now, state));
        self.is_stale = true;
    }

    /// Says how sensors and device are doing, where that has changed.
    fn note_sensors(&mut self) {
        let now = self.source.now();
        self.sensors.note_troubles(&self.assembler, now);
        if !self.sensors.is_due(now) {
            return;
        }
        if let Some(status) = self.haptics.device_news(now) {
            self.outputs.report(Report::Device(now, status));
        }
        self.tell_everything();
        let (counters, link) = (self.counters(), self.link.state());
        self.note_cause(&counters, now);
        if let Some(health) = self.sensors.health_news(&self.assembler, link, now) {
            self.outputs.report(Report::Health(now, health));
        }
        self.note_off();
    }

    /// Reports which controls that act while they are held are off, and why, where that has changed.
    fn note_off(&mut self) {
        let news = self.off.news(&self.engine, self.engine.layout_revision());
        if !news.is_empty() {
            // An app that hears of it finds it in the snapshot.
            self.show_now();
        }
        for index in news {
            let id = self.engine.layout().widgets.get(index).map(|widget| widget.id.clone());
            if let Some(state) = id.and_then(|id| self.engine.control_state(id.as_str())) {
                self.outputs.report(Report::Control(self.source.now(), &state));
            }
        }
    }

    /// Reports the cause for which no frame can be used, where that has changed.
    fn note_cause(&mut self, counters: &LinkCounters, now: Instant) {
        let (link, refused) = (self.link.state(), self.source.last_refused());
        let facts = Facts { assembler: &self.assembler, link, counters, refused };
        if self.causes.update(&facts, now) {
            let cause = self.causes.cause();
            self.link.note_cause(cause, now);
            self.outputs.report(Report::LinkCause(now, cause));
            self.is_stale = true;
        }
    }

    /// Reports what is held if that has changed or is due, and that the server lives.
    fn beat(&mut self) {
        self.outputs.beat(self.engine.held(), self.seen, self.source.now());
    }

    /// Renews the snapshot whatever its age.
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

    /// Does what is asked, as much as a turn has time for; what that changes is shown at the end of the turn.
    fn process_commands(&mut self) {
        for _ in 0..MOST_AT_ONCE {
            if let Some(request) = self.source.take_request() {
                self.process_request(request);
            } else if let Some(layout) = self.source.take_layout() {
                self.set_layout(layout);
            } else {
                break;
            }
        }
        let now = self.source.now();
        if now.since(self.commands_looked) < FRAME && self.commands_looked != Instant::START {
            return;
        }
        self.commands_looked = now;
        for _ in 0..MOST_AT_ONCE {
            let Some(command) = self.commands.as_ref().and_then(|commands| commands.try_recv().ok()) else {
                break;
            };
            match command {
                Command::SetLayout(mut layout) => {
                    self.source.note_layout(&mut layout);
                    self.set_layout(*layout);
                }
                Command::Control(message) => {
                    let request = message.into();
                    self.source.note_request(&request);
                    self.process_request(request);
                }
                Command::Ask(message, answer) => {
                    self.source.note_request(&message.clone().into());
                    self.answer(message, &answer);
                }
                Command::GiveTare(to) => {
                    let is_measured = self.assembler.tare_outcome() == TareOutcome::Taken;
                    // Who no longer waits for it need not know.
                    let _ = to.try_send(is_measured.then(|| self.assembler.tare()));
                }
                Command::Audition { effect, gesture, tile } => {
                    self.haptics.trial = Some(Trial::new(effect, *gesture, tile));
                }
            }
        }
    }
}
