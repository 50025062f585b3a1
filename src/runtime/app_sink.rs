//! Output of the sensing thread to the app: events, the held controls and wake-up calls.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant as HostInstant;

use triple_buffer::Input;

use super::event::Event;
use super::queue::QueueInput;
use crate::serve::FloorCommand;
use crate::sink::{CrackRateLimiter, EventSink, Report, SharedSender, Worker};
use crate::units::Instant;
use crate::widget::WidgetId;
use crate::wire::ControlMessage;

/// The held controls, as the sensing thread last reported them.
#[derive(Clone, Debug, Default)]
pub(super) struct HeldNow {
    /// Time of the report; `None` before the first one.
    pub(super) said: Option<HostInstant>,
    pub(super) held: Vec<WidgetId>,
}

/// Calls the app's callback on a thread of its own, where it may take long and may panic.
#[derive(Debug)]
pub(super) struct Waker {
    worker: Worker<()>,
    /// Whether a call is queued that has not begun.
    due: Arc<AtomicBool>,
}

impl Waker {
    /// If the callback panics, the app may miss the end of a press: the waker then sends `CancelAll` through
    /// `commands`.
    pub(super) fn start(
        mut wake: Box<dyn FnMut() + Send>,
        commands: SharedSender<FloorCommand>,
    ) -> std::io::Result<Self> {
        let due = Arc::new(AtomicBool::new(false));
        let begun = Arc::clone(&due);
        let worker = Worker::spawn("wake", move |calls| {
            for () in calls.iter() {
                begun.store(false, Ordering::Release);
                if catch_unwind(AssertUnwindSafe(&mut wake)).is_err() {
                    tracing::warn!(
                        "the app's wake callback panicked: what is held is cancelled, sensing goes on"
                    );
                    // This fails only after the session has ended, and then nothing is held.
                    let _ = commands.send(FloorCommand::Control(ControlMessage::CancelAll));
                }
            }
        })?;
        Ok(Self { worker, due })
    }

    /// Requests one call of the callback; joins a request that has not begun yet.
    pub(super) fn wake(&self) {
        if !self.due.swap(true, Ordering::AcqRel) && !self.worker.try_offer(()) {
            self.due.store(false, Ordering::Release);
        }
    }
}

/// Event sink that passes reports to the app.
pub(super) struct AppSink {
    pub(super) events: QueueInput,
    pub(super) held: Input<HeldNow>,
    pub(super) waker: Option<Arc<Waker>>,
    pub(super) cracks: CrackRateLimiter,
}

impl AppSink {
    fn put(&mut self, event: Option<Event>) {
        if let Some(event) = event {
            self.events.put(event);
            self.wake();
        }
    }

    fn wake(&self) {
        if let Some(waker) = &self.waker {
            waker.wake();
        }
    }
}

impl EventSink for AppSink {
    fn report(&mut self, report: &Report<'_>) {
        match report {
            Report::Held(report) => {
                let now = self.held.input_buffer_mut();
                now.said = Some(HostInstant::now());
                now.held.clone_from(&report.held);
                self.held.publish();
            }
            // The snapshot contains these.
            Report::Contacts(..) | Report::Alive(..) => {}
            Report::Ground(event) => {
                let crack = self.cracks.news(event).map(Report::Crack);
                self.put(crack.as_ref().and_then(Event::of));
            }
            report => self.put(Event::of(report)),
        }
    }

    fn poll(&mut self, _now: Instant) {
        self.events.flush();
    }
}
