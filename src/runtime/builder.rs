//! The builder of a session.

use std::net::ToSocketAddrs;
#[cfg(feature = "threads")]
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::sync_channel;
use std::sync::{Arc, Mutex};
use std::thread::Builder as ThreadBuilder;

use thiserror::Error;
use triple_buffer::triple_buffer;

use super::app_sink::{AppSink, HeldNow, Waker};
use super::held::HeldWatch;
use super::queue::{EventQueue, QueueInput};
use super::session::{Inner, Session};
use super::snapshot::Shown;
use super::thread::{self, Actuators, EndWatchers, OpenActuators, SensingThread};
use crate::engine;
use crate::floor::{Floor, Geometry};
use crate::layout::Layout;
#[cfg(feature = "threads")]
use crate::parallel::ThreadPool;
#[cfg(feature = "record")]
use crate::recording::{Recorded, Recorder, RecordingSwitch, WhenBehind};
use crate::schema::{self, Diagnostics};
use crate::sense::Method;
use crate::serve::Neighbours;
use crate::sink::{CrackRateLimiter, EventSink, Fanout, LatencyStages, SinkError, wait_free_shared};
use crate::source::{FloorInput, SourceError, UdpSource};
use crate::units::{HostClock, Instant};
use crate::wire::Prefix;

/// Maximum number of commands that wait for the sensing thread: one second of a person at a window with a mouse.
const COMMANDS_WAITING: usize = 256;

/// Builds a session: collects its parts before it starts.
pub struct SessionBuilder {
    feed: Feed,
    floor: Floor,
    layout: Option<(Layout, Geometry)>,
    method: Method,
    prefix: Prefix,
    sinks: Fanout,
    actuators: Option<OpenActuators>,
    neighbours: Option<Box<dyn Neighbours>>,
    latency: Option<LatencyStages>,
    wake: Option<Box<dyn FnMut() + Send>>,
    every_change: bool,
    realtime: bool,
    noiseless: bool,
    stop: Arc<AtomicBool>,
    #[cfg(feature = "threads")]
    sensing_threads: NonZeroUsize,
    #[cfg(feature = "record")]
    record: Option<std::path::PathBuf>,
    #[cfg(feature = "record")]
    switch: Option<RecordingSwitch>,
}

/// Origin of the packets.
enum Feed {
    Listen(String),
    Given(FloorInput, HostClock),
}

/// Why a session can't start.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StartError {
    /// The text is not an address of this machine with a port.
    #[error("can't listen on {address}: write it like 127.0.0.1:9000 ({source})")]
    Address {
        /// The text as given.
        address: String,
        /// The error of the address lookup.
        source: std::io::Error,
    },
    /// The source of packets does not open.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// The actuators do not open.
    #[error(transparent)]
    Sink(#[from] SinkError),
    /// The layout is missing, or was checked for a different floor than the final one.
    #[error("name the layout, after the floor that it lies on")]
    NoLayout,
    /// The floor can't be recorded.
    #[cfg(feature = "record")]
    #[error(transparent)]
    Recording(#[from] crate::recording::RecordingError),
    /// The system failed to start the threads that share the feet of a crowd.
    #[cfg(feature = "threads")]
    #[error(transparent)]
    ThreadPool(#[from] crate::parallel::ThreadPoolError),
    /// The system failed to start the thread.
    #[error("the system gives no thread: {0}")]
    Thread(std::io::Error),
}

impl SessionBuilder {
    fn new(feed: Feed) -> Self {
        Self {
            feed,
            floor: Floor::default(),
            layout: None,
            method: Method::default(),
            prefix: Prefix::default(),
            sinks: Fanout::new(),
            actuators: None,
            neighbours: None,
            latency: None,
            wake: None,
            every_change: false,
            realtime: false,
            noiseless: false,
            stop: Arc::default(),
            #[cfg(feature = "threads")]
            sensing_threads: NonZeroUsize::MIN,
            #[cfg(feature = "record")]
            record: None,
            #[cfg(feature = "record")]
            switch: None,
        }
    }

    pub(super) fn listening(address: String) -> Self {
        Self::new(Feed::Listen(address))
    }

    pub(super) fn fed_by(input: FloorInput, clock: HostClock) -> Self {
        Self::new(Feed::Given(input, clock))
    }

    /// Sets the floor's hardware; the default is the paper's 6 x 6 tiles. Call it before the layout is set.
    #[must_use]
    pub fn floor(mut self, floor: Floor) -> Self {
        self.floor = floor;
        self
    }

    /// Sets the floor's hardware from a file. Call it before the layout is set.
    ///
    /// # Errors
    /// Every error in the file.
    pub fn floor_file(self, path: impl AsRef<Path>) -> Result<Self, Diagnostics> {
        Ok(self.floor(schema::load_floor(path.as_ref())?))
    }

    /// Sets the page of controls from a file, with the kinds and effects in the folders `widgets` and `effects`
    /// beside the file or beside its folder. Logs warnings.
    ///
    /// # Errors
    /// Every error in the file, its kinds and its effects.
    pub fn layout_file(self, path: impl AsRef<Path>) -> Result<Self, Diagnostics> {
        let loaded = schema::load_layout_and_kinds(path.as_ref(), &self.floor.geometry)?;
        Ok(self.layout(loaded.log_warnings()))
    }

    /// Sets the page of controls, which must have been checked for the floor set before.
    #[must_use]
    pub fn layout(mut self, layout: Layout) -> Self {
        self.layout = Some((layout, self.floor.geometry));
        self
    }

    /// Sets the method that makes contacts from tile forces.
    #[must_use]
    pub fn method(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// Sets the prefix of OSC addresses in requests and answers; sinks have prefixes of their own.
    #[must_use]
    pub fn prefix(mut self, prefix: Prefix) -> Self {
        self.prefix = prefix;
        self
    }

    /// Also sends reports to `sink`, such as [`crate::sink::OscSink`] or [`crate::sink::JsonSink`]; may be called
    /// several times.
    #[must_use]
    pub fn sink(mut self, sink: impl EventSink + 'static) -> Self {
        self.sinks.push(sink);
        self
    }

    /// Adds haptic output. The sensing thread calls `open` and keeps the actuators; `open` gets the floor, the
    /// present on its sample clock, and that clock.
    #[must_use]
    pub fn actuators(
        mut self,
        open: impl FnOnce(&Floor, Instant, &HostClock) -> Result<Actuators, SinkError> + Send + 'static,
    ) -> Self {
        self.actuators = Some(Box::new(open));
        self
    }

    /// Sends cues for tiles of other computers and plays the cues received from them; without actuators it does
    /// neither.
    #[must_use]
    pub fn neighbours(mut self, neighbours: impl Neighbours + 'static) -> Self {
        self.neighbours = Some(Box::new(neighbours));
        self
    }

    /// Measures in `stages` the latency from a packet to its cues.
    #[must_use]
    pub fn latency(mut self, stages: LatencyStages) -> Self {
        self.latency = Some(stages);
        self
    }

    /// Calls `wake` when there are new events, for apps that sleep until something happens, such as
    /// `move || context.request_repaint()`.
    ///
    /// The callback runs on a thread of its own; several events may share one call. If it panics, the session logs
    /// the panic, cancels all presses, since the app may no longer notice their ends, and continues to sense. The end
    /// of the session waits for a running call, for two seconds at most. The callback must not own a [`Session`],
    /// which then would never be dropped.
    #[must_use]
    pub fn wake(mut self, wake: impl FnMut() + Send + 'static) -> Self {
        self.wake = Some(Box::new(wake));
        self
    }

    /// Keeps every change of a value while the app takes no events; without it, only the latest of each control.
    #[must_use]
    pub fn every_change(mut self) -> Self {
        self.every_change = true;
        self
    }

    /// Records the floor into a file and replaces an existing one: see [`crate::recording`]. If the disk is too slow,
    /// the recording has gaps and a warning is logged; the floor continues to work.
    #[cfg(feature = "record")]
    #[must_use]
    pub fn record(mut self, path: impl AsRef<Path>) -> Self {
        self.record = Some(path.as_ref().into());
        self
    }

    /// Lets `switch` begin and end recordings while the floor runs.
    #[cfg(feature = "record")]
    #[must_use]
    pub fn recording_switch(mut self, switch: RecordingSwitch) -> Self {
        self.switch = Some(switch);
        self
    }

    /// Declares that the source's readings have no noise, as those that an app generates. Repeated readings are then
    /// normal, and controls with the guard `HoldToRun` work all the same. Equivalent to `noiseless` in the floor
    /// file.
    ///
    /// Without it, readings that repeat under a foot end its presses, and sensors that always repeat can't hold such
    /// a control.
    #[must_use]
    pub fn noiseless(mut self) -> Self {
        self.noiseless = true;
        self
    }

    /// Requests a raised scheduling priority for the sensing thread, as `underfoot run` does.
    #[must_use]
    pub fn realtime(mut self) -> Self {
        self.realtime = true;
        self
    }

    /// Distributes the feet of a crowd over this many threads; without it, one thread does all. The results are the
    /// same.
    ///
    /// Threads beyond the first sleep while fewer than a hundred feet are on the floor, and keep a core busy each
    /// while there are more: give no more than there are cores to spare.
    #[cfg(feature = "threads")]
    #[must_use]
    pub fn sensing_threads(mut self, threads: NonZeroUsize) -> Self {
        self.sensing_threads = threads;
        self
    }

    /// Also ends the session when `stop` is set, for example by a signal handler.
    #[must_use]
    pub fn stop_flag(mut self, stop: Arc<AtomicBool>) -> Self {
        self.stop = stop;
        self
    }

    /// Starts the floor; snapshots are available when this returns.
    ///
    /// # Errors
    /// [`StartError`] names the missing or failed part; nothing runs then.
    pub fn start(mut self) -> Result<Session, StartError> {
        let given = self.layout.take().filter(|(_, geometry)| *geometry == self.floor.geometry);
        let (layout, _) = given.ok_or(StartError::NoLayout)?;
        self.floor.noiseless |= self.noiseless;
        let (input, clock, floor) = self.feed.open(self.floor, &self.prefix)?;
        let local_addr = input.port.as_ref().and_then(|port| port.local_addr());
        let geometry = floor.geometry;
        #[cfg(feature = "record")]
        let Recorded { recorder, input, floor, layout } = {
            let path = self.record.as_deref();
            Recorder::around(path, input, floor, layout, self.method, WhenBehind::LeaveOut)?
        };
        #[cfg(feature = "record")]
        if let Some(recorder) = recorder {
            self.sinks.push(recorder.events()?);
        }
        #[cfg(feature = "record")]
        let input = match &self.switch {
            Some(switch) => {
                self.sinks.push(switch.events()?);
                switch.wrap(input, &floor, &layout, self.method)
            }
            None => input,
        };
        let queue = Arc::new(EventQueue::new(self.every_change));
        let (held_input, held) = triple_buffer(&HeldNow::default());
        let held = Arc::new(HeldWatch::new(held));
        let (snapshots, latest) = triple_buffer(&engine::Snapshot::default());
        let shown = Arc::new(Shown::new(latest, layout.clone()));
        let (commands, received) = wait_free_shared(COMMANDS_WAITING);
        let waker = self.wake.map(|wake| Waker::start(wake, commands.clone())).transpose();
        let waker = waker.map_err(StartError::Thread)?.map(Arc::new);
        // The app gets reports first, even if another sink fails.
        let sinks = Fanout::new().with(AppSink {
            events: QueueInput::new(Arc::clone(&queue), self.every_change),
            held: held_input,
            waker: waker.clone(),
            cracks: CrackRateLimiter::default(),
        });
        let sinks = sinks.with(self.sinks);
        let plan = SensingThread {
            floor,
            layout,
            method: self.method,
            input,
            clock,
            prefix: self.prefix,
            sinks,
            actuators: self.actuators,
            neighbours: self.neighbours,
            latency: self.latency,
            realtime: self.realtime,
            #[cfg(feature = "threads")]
            pool: (self.sensing_threads.get() > 1)
                .then(|| ThreadPool::new(self.sensing_threads))
                .transpose()?,
            commands: received,
            snapshots,
            stop: Arc::clone(&self.stop),
        };
        let watchers = EndWatchers { queue: Arc::clone(&queue), held: Arc::clone(&held), waker };
        let (ready, is_ready) = sync_channel(1);
        let sensing = ThreadBuilder::new()
            .name("sensing".into())
            .spawn(move || thread::run(plan, &watchers, &ready))
            .map_err(StartError::Thread)?;
        let thread = Mutex::new(Some(sensing));
        let session = Session::new(Inner {
            queue,
            held,
            shown,
            commands,
            local_addr,
            geometry,
            stop: self.stop,
            thread,
        });
        match is_ready.recv() {
            // A thread that panicked before it was ready reports the panic in its last event.
            Ok(Ok(())) | Err(_) => Ok(session),
            Ok(Err(error)) => Err(error),
        }
    }
}

impl Feed {
    /// Opens the input. Returns it with the clock that stamps its packets, and the floor, calibrated if it is
    /// simulated.
    fn open(self, floor: Floor, prefix: &Prefix) -> Result<(FloorInput, HostClock, Floor), StartError> {
        match self {
            Self::Listen(address) => {
                let unknown = |source| StartError::Address { address: address.clone(), source };
                let none = || std::io::Error::from(std::io::ErrorKind::AddrNotAvailable);
                let found = address.to_socket_addrs().map_err(unknown)?.next();
                let source = UdpSource::bind(found.ok_or_else(|| unknown(none()))?, &floor)?;
                let source = source.with_prefix(prefix.clone());
                let clock = source.clock();
                Ok((source.into(), clock, floor))
            }
            Self::Given(input, clock) => Ok((input, clock, floor)),
        }
    }
}
