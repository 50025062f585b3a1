//! The messages of the layout on the floor: decided here, once, for all who show or send them.

use std::borrow::Cow;
use std::sync::Arc;

use tracing::warn;

use crate::layout::Layout;
use crate::messages::{MessageNews, MessageOrder, Messenger, Unsent};
use crate::sink::{EventSink, Report};
use crate::units::Instant;
use crate::wire::LinkState;

/// Runs the messages of the layout on the floor.
#[derive(Default)]
pub(super) struct MessageDesk {
    /// `None` while nothing on the floor sends anything.
    messenger: Option<Messenger>,
    /// The revision of the layout that it runs.
    revision: Option<u64>,
    orders: Vec<MessageOrder>,
    /// Messages that earlier layouts did not send, and all that were reported.
    before: Unsent,
    told: bool,
}

impl MessageDesk {
    /// Changes to the messages of `layout` if its `revision` is new; what the last one held comes up first.
    pub(super) fn follow(&mut self, layout: &Layout, revision: u64, now: Instant, sink: &mut dyn EventSink) {
        if self.revision.replace(revision) == Some(revision) {
            return;
        }
        self.release(now, sink);
        if let Some(messenger) = self.messenger.take() {
            self.before = self.before + messenger.unsent();
        }
        self.messenger = layout.sends().then(|| Messenger::new(layout.plan()));
    }

    /// Passes `report` on, and the messages that it causes.
    pub(super) fn report(&mut self, report: &Report<'_>, sink: &mut dyn EventSink) {
        sink.report(report);
        let Some(messenger) = &mut self.messenger else { return };
        match report {
            Report::Event(event) => messenger.event(event, &mut self.orders),
            Report::Held(held) => messenger.held(held.at, &held.held, &mut self.orders),
            Report::Contacts(at, contacts) => messenger.contacts(*at, contacts, &mut self.orders),
            Report::Link(_, LinkState::Lost | LinkState::Waiting) => messenger.lost(&mut self.orders),
            _ => return,
        }
        self.give(report.at(), sink);
    }

    /// Passes the time.
    pub(super) fn advance(&mut self, now: Instant, sink: &mut dyn EventSink) {
        let Some(messenger) = &mut self.messenger else { return };
        messenger.advance(now, &mut self.orders);
        if messenger.unsent().limited > 0 && !std::mem::replace(&mut self.told, true) {
            warn!("messages come faster than their target may get them; the rest is left out and counted");
        }
        self.give(now, sink);
    }

    /// Lets everything come up.
    pub(super) fn release(&mut self, now: Instant, sink: &mut dyn EventSink) {
        if let Some(messenger) = &mut self.messenger {
            messenger.release_all(&mut self.orders);
            self.give(now, sink);
        }
    }

    /// Number of messages that were left out: too many for the rate, or feet beyond the most.
    pub(super) fn unsent(&self) -> u64 {
        let now = self.messenger.as_ref().map(Messenger::unsent).unwrap_or_default();
        let Unsent { limited, crowded, .. } = self.before + now;
        limited + crowded
    }

    fn give(&mut self, at: Instant, sink: &mut dyn EventSink) {
        let Some(messenger) = &self.messenger else { return };
        for order in self.orders.drain(..) {
            let news = MessageNews { at, order, plan: Arc::clone(messenger.plan()) };
            sink.report(&Report::Message(Cow::Owned(news)));
        }
    }
}
