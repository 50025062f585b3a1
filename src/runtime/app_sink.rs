//! What the sensing thread hands to the app: events, what is held, and that there is something new.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::SyncSender;
use std::time::Instant as HostInstant;

use triple_buffer::Input;

use super::event::Event;
use super::queue::QueueInput;
use crate::serve::Command;
use crate::sink::{CrackRateLimiter, EventSink, OwnedReport, Report, Worker};
use crate::units::Instant;
use crate::widget::WidgetId;
use crate::wire::ControlMessage;

/// What is held, as far as the sensing thread has said.
#[derive(Clone, Debug, Default)]
pub(super) struct HeldNow {
    /// When it was said; `None` before the first time.
    pub(super) said: Option<HostInstant>,
    pub(super) held: Vec<WidgetId>,
}

/// Calls the app's callback on a thread of its own, where it may take its time and may fail.
#[derive(Debug)]
pub(super) struct Waker {
    worker: Worker<()>,
    /// Whether a call is on its way that has not begun.
    due: Arc<AtomicBool>,
}

impl Waker {
    /// A callback that panics leaves an app that may not notice when a foot lets go: `commands` then cancel what is
    /// held.
    pub(super) fn start(
        mut wake: Box<dyn FnMut() + Send>,
        commands: SyncSender<Command>,
    ) -> std::io::Result<Self> {
        let due = Arc::new(AtomicBool::new(false));
        let begun = Arc::clone(&due);
        let worker = Worker::spawn("wake", move |calls| {
            for () in calls {
                begun.store(false, Ordering::Release);
                if catch_unwind(AssertUnwindSafe(&mut wake)).is_err() {
                    tracing::warn!(
                        "the app's wake callback panicked: what is held is cancelled, sensing goes on"
                    );
                    // A floor that has ended holds nothing.
                    let _ = commands.send(Command::Control(ControlMessage::CancelAll));
                }
            }
        })?;
        Ok(Self { worker, due })
    }

    /// Sees to it that the callback is called once from now on.
    pub(super) fn wake(&self) {
        if !self.due.swap(true, Ordering::AcqRel) && !self.worker.try_offer(()) {
            self.due.store(false, Ordering::Release);
        }
    }
}

/// The app as one that is told what happens.
pub(super) struct AppSink {
    pub(super) events: QueueInput,
    pub(super) held: Input<HeldNow>,
    pub(super) waker: Option<Arc<Waker>>,
    pub(super) cracks: CrackRateLimiter,
}

impl AppSink {
    fn wake(&self) {
        if let Some(waker) = &self.waker {
            waker.wake();
        }
    }
}

impl EventSink for AppSink {
    fn report(&mut self, report: Report<'_>) {
        match report {
            Report::Held(report) => {
                let now = self.held.input_buffer_mut();
                now.said = Some(HostInstant::now());
                now.held.clone_from(&report.held);
                self.held.publish();
            }
            // In the snapshot.
            Report::Contacts(..) | Report::Alive(..) => {}
            report => {
                if let Some(event) = OwnedReport::of(report, &mut self.cracks).and_then(Event::of) {
                    self.events.put(event);
                    self.wake();
                }
            }
        }
    }

    fn poll(&mut self, _now: Instant) {
        self.events.flush();
    }
}
