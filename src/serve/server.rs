//! The server: one turn per packet, and all that follows from it.

mod end;
mod heartbeat;
mod limited;
mod mute;
mod notices;
mod requests;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::time::Duration;

use tracing::warn;
use triple_buffer::Input;

use self::heartbeat::Heartbeat;
use self::limited::Notices;
use super::changes::ChangeLimiter;
use super::trial::Trial;
use crate::engine::{Engine, Snapshot};
use crate::feel::{CueSender, DeviceStatus, Effect, FeelCounters, Gesture, Muted};
use crate::floor::{Floor, SensorId};
use crate::layout::Layout;
use crate::sense::{Assembler, Method, SensorHealth, Tare, TareOutcome, Trouble};
use crate::sink::{ActuatorSink, EventSink, LatencyStages};
use crate::source::{SensorSource, SourceError};
use crate::units::Instant;
use crate::wire::{ControlMessage, LinkCounters, LinkState, Prefix};

/// How long to wait for a packet before looking after everything else; well within the 100 ms of a lost floor.
const PATIENCE: Duration = Duration::from_millis(5);

/// Time from one frame to the next: what a frame causes is played within it.
const FRAME: Duration = Duration::from_millis(1);

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
    feel: Option<CueSender>,
    /// What somebody has muted.
    muted: Muted,
    /// An effect that somebody tries.
    trial: Option<Trial>,
    actuators: Option<Box<dyn ActuatorSink>>,
    events: Option<Box<dyn EventSink>>,
    changes: ChangeLimiter,
    snapshots: Option<Input<Snapshot>>,
    commands: Option<Receiver<Command>>,
    link: LinkState,
    /// Since when only some boards have reported.
    partial_since: Option<Instant>,
    tare: TareOutcome,
    /// Sensors known to be in trouble, and how often that had changed.
    troubles: Vec<(SensorId, Trouble)>,
    trouble_changes: u64,
    /// Sensors without calibration, as far as that has been said.
    uncalibrated: usize,
    /// Boards that stood still and loads that jumped, as far as that has been said.
    frozen: u64,
    jumps: u64,
    next_jumps: Instant,
    /// What was last told of the sensors, and when; `None` before the first time.
    told: Option<(Instant, SensorHealth)>,
    /// How they are, for comparing.
    health: SensorHealth,
    /// How the device is doing, if there is one, and what was last told of it.
    device: Option<DeviceStatus>,
    device_told: Option<(Instant, DeviceStatus)>,
    /// Measures latency, if wanted, and when the last packet was taken.
    latency: Option<(LatencyStages, Instant)>,
    /// Until when nothing new is reported.
    next_check: Instant,
    /// Whether it has been said that this seems to be another floor.
    said_foreign: bool,
    shown: Instant,
    /// What addresses in answers begin with.
    prefix: Prefix,
    /// The answer being written.
    answer: Vec<u8>,
    /// Requests that could not be met.
    denied: u64,
    heartbeat: Heartbeat,
    /// How often notices are repeated.
    notices: Notices,
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
            engine: Engine::new(floor.geometry, layout, method).with_maps(&floor.position_maps),
            feel: None,
            muted: Muted::default(),
            trial: None,
            actuators: None,
            events: None,
            changes: ChangeLimiter::default(),
            snapshots: None,
            commands: None,
            link: LinkState::Waiting,
            partial_since: None,
            tare: TareOutcome::FromFloor,
            troubles: Vec::new(),
            trouble_changes: 0,
            uncalibrated: 0,
            frozen: 0,
            jumps: 0,
            next_jumps: Instant::START,
            told: None,
            health: SensorHealth::default(),
            device: None,
            device_told: None,
            latency: None,
            next_check: Instant::START,
            said_foreign: false,
            shown: Instant::START,
            prefix: Prefix::default(),
            answer: Vec::new(),
            denied: 0,
            heartbeat: Heartbeat::default(),
            notices: Notices::default(),
        }
    }

    /// Begins the addresses of its answers with `prefix`; its source and sinks have prefixes of their own.
    #[must_use]
    pub fn with_prefix(mut self, prefix: Prefix) -> Self {
        self.prefix = prefix;
        self
    }

    /// Sends cues through `feel` to the renderer that `actuators` plays.
    #[must_use]
    pub fn with_feel(mut self, feel: CueSender, actuators: Box<dyn ActuatorSink>) -> Self {
        self.feel = Some(feel);
        self.actuators = Some(actuators);
        self
    }

    /// Measures in `stages` how long packets take to become cues; what follows is the sink's to measure.
    #[must_use]
    pub fn with_latency(mut self, stages: LatencyStages) -> Self {
        self.latency = Some((stages, Instant::START));
        self
    }

    /// Tells `events` what happens.
    #[must_use]
    pub fn with_events(mut self, events: Box<dyn EventSink>) -> Self {
        self.events = Some(events);
        self
    }

    /// Keeps `snapshots` up to date.
    #[must_use]
    pub fn with_snapshots(mut self, snapshots: Input<Snapshot>) -> Self {
        self.snapshots = Some(snapshots);
        self
    }

    /// Obeys `commands`.
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
        let own = LinkCounters { denied: self.denied, ..LinkCounters::default() };
        self.source.counters() + self.assembler.counters() + own
    }

    /// What could not be felt as it should so far, or was not to be.
    #[must_use]
    pub fn feel_counters(&self) -> FeelCounters {
        self.feel.as_ref().map(CueSender::counters).unwrap_or_default()
    }

    /// Events that other programs could not be told so far.
    #[must_use]
    pub fn unsent_events(&self) -> u64 {
        self.events.as_ref().map_or(0, |events| events.dropped())
    }

    /// Writes everything there is to see into `snapshot`.
    pub fn snapshot(&self, snapshot: &mut Snapshot) {
        self.engine.snapshot(snapshot);
        snapshot.link = self.link;
        snapshot.counters = self.counters();
        self.assembler.health(&mut snapshot.health);
        snapshot.device.clone_from(&self.device);
        snapshot.muted.clone_from(&self.muted);
        snapshot.feel = self.feel_counters();
        snapshot.unsent_events = self.unsent_events();
    }

    /// Works until the source ends or fails or `stop` is set, which is noticed within some milliseconds;
    /// then cancels what feet still hold and tells so.
    ///
    /// # Errors
    /// What [`Server::turn`] gives.
    pub fn run(&mut self, stop: &AtomicBool) -> Result<(), SourceError> {
        self.update_mute();
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
        match self.source.next(PATIENCE) {
            Ok(Some(packet)) => {
                if let Some((_, taken)) = &mut self.latency {
                    *taken = self.source.now();
                }
                self.assembler.take(&packet);
            }
            Ok(None) => {
                let now = self.source.now();
                self.assembler.poll(now);
                self.play_until(now.before(IDLE_LAG));
            }
            Err(SourceError::Ended) => {
                self.cancel_all();
                self.play_until(self.source.now() + TAIL);
                return Ok(Ended::Yes);
            }
            Err(error) => return Err(error),
        }
        self.note_link();
        while self.step() {}
        self.beat();
        self.poll();
        self.note_troubles();
        self.note_health();
        Ok(Ended::No)
    }

    /// Works off one frame; false if none is complete.
    fn step(&mut self) -> bool {
        let Some(frame) = self.assembler.ready() else { return false };
        let at = frame.at;
        let step = self.engine.step(frame);
        if let Some(feel) = &mut self.feel {
            if let Some((stages, taken)) = self.latency.as_ref().filter(|_| !step.cues.is_empty()) {
                let now = self.source.now();
                feel.note_time(now);
                for cue in step.cues {
                    stages.link.record(taken.since(cue.received));
                    stages.engine.record(now.since(*taken));
                }
            }
            for cue in step.cues {
                // What could not be sent is counted by the sender.
                feel.send(cue);
            }
            match &mut self.trial {
                Some(trial) => {
                    if !trial.step(at, step.sustained, feel) {
                        self.trial = None;
                    }
                }
                None => feel.sustain(step.sustained),
            }
        }
        if let Some(events) = &mut self.events {
            events.events(self.changes.thin(step.events, at));
            if let Some(page) = step.page {
                events.page(page);
            }
            if !step.grounds.is_empty() {
                events.ground(step.grounds);
            }
            events.contacts(at, step.contacts);
        }
        self.play_until(at + FRAME);
        self.show(at);
        true
    }

    /// Tells what had to wait, also while no frames come.
    fn poll(&mut self) {
        let now = self.source.now();
        if let Some(events) = &mut self.events {
            // Otherwise frames give the time, so that the same frames tell the same.
            if self.link == LinkState::Lost {
                events.events(self.changes.thin(&[], now));
            }
            events.poll(now);
        }
    }

    fn play_until(&mut self, now: Instant) {
        if let Some(actuators) = &mut self.actuators
            && let Err(error) = actuators.advance(now)
        {
            warn!("the actuators are dropped: {error}");
            self.actuators = None;
        }
    }

    fn show(&mut self, at: Instant) {
        if at.since(self.shown) < SNAPSHOT_EVERY {
            return;
        }
        self.shown = at;
        let mut snapshots = self.snapshots.take();
        if let Some(snapshots) = &mut snapshots {
            self.snapshot(snapshots.input_buffer_mut());
            snapshots.publish();
        }
        self.snapshots = snapshots;
    }

    fn process_commands(&mut self) {
        while let Some(request) = self.source.take_request() {
            self.process_request(request);
        }
        while let Some(command) = self.commands.as_ref().and_then(|commands| commands.try_recv().ok()) {
            match command {
                Command::SetLayout(layout) => self.engine.set_layout(*layout),
                Command::Control(message) => self.process_request(message.into()),
                Command::Audition { effect, gesture, tile } => {
                    self.trial = Some(Trial::new(effect, *gesture, tile));
                }
            }
        }
    }
}
