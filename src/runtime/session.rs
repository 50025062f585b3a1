//! The handle to a running floor.

use std::fmt;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use super::builder::SessionBuilder;
use super::control::ControlHandle;
use super::event::Event;
use super::events::Events;
use super::held::{Held, HeldWatch};
use super::queue::EventQueue;
use super::snapshot::{SessionSnapshot, Shown};
use crate::floor::Geometry;
use crate::layout::Layout;
use crate::serve::{FloorCommand, Refusal};
use crate::sink::SharedSender;
use crate::source::FloorInput;
use crate::units::HostClock;
use crate::widget::WidgetId;
use crate::wire::ControlMessage;

/// Maximum time to wait for an answer of the sensing thread.
const PATIENCE: Duration = Duration::from_millis(200);

/// A running floor on a thread of its own; see [the module](super).
///
/// Clones are handles to the same floor: each event goes to the first handle that takes it.
#[derive(Clone)]
pub struct Session(Arc<Inner>);

pub(super) struct Inner {
    pub(super) queue: Arc<EventQueue>,
    pub(super) held: Arc<HeldWatch>,
    pub(super) shown: Arc<Shown>,
    pub(super) commands: SharedSender<FloorCommand>,
    /// Address on which the source listens.
    pub(super) local_addr: Option<SocketAddr>,
    pub(super) geometry: Geometry,
    pub(super) stop: Arc<AtomicBool>,
    pub(super) thread: Mutex<Option<JoinHandle<()>>>,
}

impl Drop for Inner {
    fn drop(&mut self) {
        self.held.end();
        self.stop.store(true, Ordering::Relaxed);
        let thread = self.thread.lock().unwrap_or_else(PoisonError::into_inner).take();
        // A sink that holds the last handle is dropped by the sensing thread, which can't wait for itself.
        if let Some(thread) = thread.filter(|thread| thread.thread().id() != std::thread::current().id()) {
            // The last event has reported how it ended.
            let _ = thread.join();
        }
    }
}

impl fmt::Debug for Session {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Session").field("ended", &self.has_ended()).finish_non_exhaustive()
    }
}

impl Session {
    /// A session whose boards send their packets to `address`, such as `127.0.0.1:9000`; port 0 takes a free one.
    #[must_use]
    pub fn listen(address: impl Into<String>) -> SessionBuilder {
        SessionBuilder::listening(address.into())
    }

    /// A session fed by any [`SensorSource`](crate::source::SensorSource), or by an input with more than packets.
    /// `clock` stamps its packets and is the time base of the actuators.
    #[must_use]
    pub fn source(input: impl Into<FloorInput>, clock: HostClock) -> SessionBuilder {
        SessionBuilder::fed_by(input.into(), clock)
    }

    /// A session that replays a recording with its floor, its layout and its method of making contacts:
    /// `Session::replay("visit.mcap", Speed::Times(1.0))?.start()?`. It ends with the recording, even if the
    /// recording is incomplete. The [progress](crate::recording::ReplaySource::progress) of the recording's source
    /// has the reason for the end, for apps that open the source themselves.
    ///
    /// # Errors
    /// [`crate::recording::RecordingError`] if the recording is not readable.
    #[cfg(feature = "record")]
    pub fn replay(
        path: impl AsRef<std::path::Path>,
        speed: crate::recording::Speed,
    ) -> Result<SessionBuilder, crate::recording::RecordingError> {
        let recording = crate::recording::Recording::open(path.as_ref())?;
        let (floor, layout, method) =
            (recording.floor().clone(), recording.layout().clone(), recording.method());
        let source = recording.source(speed);
        let clock = source.clock();
        Ok(Self::source(source, clock).floor(floor).layout(layout).method(method))
    }

    pub(super) fn new(inner: Inner) -> Self {
        Self(Arc::new(inner))
    }

    /// The next event, if any; never waits.
    ///
    /// The last event is [`super::Kind::Ended`] for every kind of end, also after a panic of the sensing thread. A
    /// newer value of a control replaces one that still waits ([`SessionBuilder::every_change`]). Beyond 1024 waiting
    /// events, the queue drops and counts ([`Session::dropped`]) the oldest that the app need not know, never the
    /// last end of a press.
    #[must_use]
    pub fn next_event(&self) -> Option<Event> {
        self.0.queue.next()
    }

    /// The next event, if one arrives within `patience`; `None` at once after the last event.
    #[must_use]
    pub fn next_event_timeout(&self, patience: Duration) -> Option<Event> {
        self.0.queue.next_timeout(patience)
    }

    /// Iterates over all events to come and waits for each; ends after [`super::Kind::Ended`]. A loop `for event in
    /// &floor` does the same.
    #[must_use]
    pub fn events(&self) -> Events<'_> {
        Events::new(self)
    }

    pub(super) fn is_drained(&self) -> bool {
        self.0.queue.is_drained()
    }

    /// The address that boards send to, with the port that the system chose for port 0; `None` for a source without a
    /// network, such as a simulation or a recording.
    #[must_use]
    pub fn local_addr(&self) -> Option<SocketAddr> {
        self.0.local_addr
    }

    /// Positions of the floor's tiles and sensors.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.0.geometry
    }

    /// Number of events dropped because the app did not take them; values that newer ones replaced do not count.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.0.queue.dropped()
    }

    /// A handle for polling whether the control named `id` is held; see [`Held::is_fresh`].
    ///
    /// # Errors
    /// [`Refusal::UnknownControl`] if the layout has no such control: a misspelt name would never be held.
    pub fn held(&self, id: &str) -> Result<Held, Refusal> {
        Ok(Held::new(Arc::clone(&self.0.held), self.known(id)?))
    }

    /// The state of the floor: at first as in the layout, later at most 5 ms old.
    #[must_use]
    pub fn snapshot(&self) -> SessionSnapshot {
        self.0.shown.read()
    }

    /// Takes the end of the buffer that [`Session::snapshot`] reads, for one reader that polls continuously; from
    /// then on that method returns the last snapshot before this call.
    #[must_use]
    pub fn take_snapshots(&self) -> triple_buffer::Output<crate::engine::Snapshot> {
        self.0.shown.take()
    }

    /// The control named `id`.
    ///
    /// # Errors
    /// [`Refusal::UnknownControl`] if the layout has no such control.
    pub fn control(&self, id: &str) -> Result<ControlHandle<'_>, Refusal> {
        Ok(ControlHandle::new(self, self.known(id)?))
    }

    /// All controls, in the order of the layout.
    #[must_use]
    pub fn controls(&self) -> Vec<ControlHandle<'_>> {
        let layout = self.0.shown.layout();
        layout.widgets.iter().map(|widget| ControlHandle::new(self, widget.id.clone())).collect()
    }

    fn known(&self, id: &str) -> Result<WidgetId, Refusal> {
        let layout = self.0.shown.layout();
        let widget = layout.widget_index(id).and_then(|index| layout.widgets.get(index));
        widget.map(|widget| widget.id.clone()).ok_or_else(|| Refusal::unknown_control(id, &layout))
    }

    /// Shows another page as soon as no foot is engaged; an event reports it.
    ///
    /// # Errors
    /// [`Refusal::UnknownPage`] names the pages if the layout has no such page.
    pub fn set_page(&self, id: &str) -> Result<(), Refusal> {
        self.ask(ControlMessage::ShowPage { page: WidgetId::new(id) })
    }

    /// Replaces the layout of the floor by one that has been checked for its geometry; values stay.
    ///
    /// With a foot on a control, the change waits until the foot lets go. Returns the
    /// [`crate::engine::Snapshot::layout_revision`] of the first snapshot with this layout.
    pub fn set_layout(&self, layout: Layout) -> u64 {
        self.0.shown.give(layout, |layout| {
            self.insist(FloorCommand::SetLayout(Box::new(layout)));
        })
    }

    /// Sends any other command, without an answer; never waits. Returns false and does nothing if the floor has
    /// ended, or if 256 commands already wait.
    pub fn send(&self, command: FloorCommand) -> bool {
        self.0.commands.try_send(command).is_ok()
    }

    /// Sends a command that must be executed, and waits for room: the sensing thread takes commands every 5 ms.
    pub(super) fn insist(&self, command: FloorCommand) {
        // A floor that has ended executes nothing.
        let _ = self.0.commands.send(command);
    }

    /// Ends the floor: it cancels all presses, and [`super::Kind::Ended`] follows. Does not wait for the end.
    pub fn stop(&self) {
        self.0.stop.store(true, Ordering::Relaxed);
    }

    /// Whether the floor has ended; events may still wait.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.0.held.has_ended()
    }

    /// Sends a request that apps may also send over the wire, and waits for the answer as a [`ControlHandle`] does. Mute
    /// requests go through [`Session::send`].
    ///
    /// # Errors
    /// [`Refusal`] says why nothing has changed.
    pub fn ask(&self, message: ControlMessage) -> Result<(), Refusal> {
        let (answer, answered) = sync_channel(1);
        if !self.send(FloorCommand::Ask(message, answer)) {
            return Err(if self.has_ended() { Refusal::Ended } else { Refusal::NoAnswer });
        }
        match answered.recv_timeout(PATIENCE) {
            Ok(done) => done,
            Err(RecvTimeoutError::Timeout) => Err(Refusal::NoAnswer),
            Err(RecvTimeoutError::Disconnected) => Err(Refusal::Ended),
        }
    }
}
