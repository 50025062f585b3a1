//! The event sink of a node's floor.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use underfoot::sink::{EventSink, Report, WaitFreeSender};
use underfoot::units::Instant;

use super::draft::Draft;

/// Interval between two messages while frames come and no event occurs.
const EVERY: Duration = Duration::from_millis(2);

/// Interval between two messages while no frames come.
const QUIET: Duration = Duration::from_millis(20);

/// Passes the reports of a floor to the sending thread, without ever waiting for it.
#[derive(Debug)]
pub struct NodeSink {
    out: WaitFreeSender<Draft>,
    draft: Draft,
    has_frame: bool,
    sent: Instant,
    held_up: Arc<AtomicU64>,
}

impl NodeSink {
    /// A sink that passes drafts to `out`. If `out` is full, the next draft includes the content of this one.
    #[must_use]
    pub fn new(out: WaitFreeSender<Draft>) -> Self {
        let (draft, held_up) = (Draft::default(), Arc::default());
        Self { out, draft, has_frame: false, sent: Instant::START, held_up }
    }

    /// Number of times that the sending thread was too slow, which delays events and leaves out contacts.
    #[must_use]
    pub fn held_up(&self) -> Arc<AtomicU64> {
        Arc::clone(&self.held_up)
    }
}

impl EventSink for NodeSink {
    fn report(&mut self, report: &Report<'_>) {
        self.has_frame |= self.draft.note(report);
    }

    /// Called after each packet, when the holds are known as well.
    fn poll(&mut self, now: Instant) {
        let since = now.since(self.sent);
        let is_due = (self.has_frame && since >= EVERY) || since >= QUIET;
        if !is_due && !self.draft.has_events() {
            return;
        }
        (self.sent, self.has_frame) = (now, false);
        if self.out.try_send(self.draft.clone()).is_ok() {
            self.draft.sent();
        } else {
            self.held_up.fetch_add(1, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use underfoot::sense::Contact;
    use underfoot::sink::wait_free;

    use super::*;
    use crate::message::NodeMessage;

    #[test]
    fn frames_are_told_every_2_ms_and_silence_every_20() {
        let (out, mut drafts) = wait_free(100);
        let mut sink = NodeSink::new(out);
        for ms in 1000..1010 {
            let contacts = vec![Contact::default()];
            sink.report(&Report::Contacts(Instant::from_millis(ms), contacts.into()));
            sink.poll(Instant::from_millis(ms));
        }
        (1010..=1070).for_each(|ms| sink.poll(Instant::from_millis(ms)));
        let frames: Vec<_> = drafts
            .try_iter()
            .map(|draft| draft.message(NodeMessage::default()).frame.unwrap() / 1000)
            .collect();
        assert_eq!(frames, [1000, 1002, 1004, 1006, 1008, 1009, 1009, 1009, 1009]);
    }
}
