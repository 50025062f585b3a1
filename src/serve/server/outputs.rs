//! Reports to other programs, and their rates.

use std::borrow::Cow;

use super::heartbeat::Heartbeat;
use super::messages::MessageDesk;
use crate::engine::FrameResults;
use crate::layout::Layout;
use crate::serve::changes::ChangeLimiter;
use crate::sink::{EventSink, Report};
use crate::units::Instant;
use crate::widget::{WidgetEvent, WidgetId};

/// Sends reports to the event sink, if any.
#[derive(Default)]
pub(super) struct Outputs {
    pub(super) sink: Option<Box<dyn EventSink>>,
    changes: ChangeLimiter,
    heartbeat: Heartbeat,
    messages: MessageDesk,
}

impl Outputs {
    /// Sends one report.
    pub(super) fn report(&mut self, report: &Report<'_>) {
        if let Some(sink) = &mut self.sink {
            self.messages.report(report, sink.as_mut());
        }
    }

    /// Reports the results of a frame of time `at`.
    pub(super) fn step(&mut self, step: &FrameResults<'_>, at: Instant) {
        let Some(sink) = &mut self.sink else { return };
        let events = self.changes.thin(step.events, at).iter().map(lent(Report::Event));
        let ignored = step.ignored.iter().map(lent(Report::Ignored));
        let page = step.page.into_iter().map(lent(Report::Page));
        let grounds = step.grounds.iter().map(lent(Report::Ground));
        let contacts = [Report::Contacts(at, Cow::Borrowed(step.contacts))];
        let all = events.chain(ignored).chain(page).chain(grounds).chain(contacts);
        all.for_each(|report| self.messages.report(&report, sink.as_mut()));
    }

    /// Reports the messages of `layout` from now on, if its `revision` is new.
    pub(super) fn follow(&mut self, layout: &Layout, revision: u64, now: Instant) {
        if let Some(sink) = &mut self.sink {
            self.messages.follow(layout, revision, now, sink.as_mut());
        }
    }

    /// Reports that all that messages hold comes up.
    pub(super) fn release(&mut self, now: Instant) {
        if let Some(sink) = &mut self.sink {
            self.messages.release(now, sink.as_mut());
        }
    }

    /// Reports events that must not wait.
    pub(super) fn events(&mut self, events: &[WidgetEvent]) {
        events.iter().map(lent(Report::Event)).for_each(|report| self.report(&report));
    }

    /// Reports the held controls if they have changed or the report is due, and sends the alive report.
    pub(super) fn beat<'a>(
        &mut self,
        held: impl Iterator<Item = &'a WidgetId> + Clone,
        seen: Instant,
        now: Instant,
    ) {
        if let Some(sink) = &mut self.sink {
            self.heartbeat.beat(held, seen, now, |report| self.messages.report(report, sink.as_mut()));
        }
    }

    /// Sends delayed reports, also while no frames come.
    pub(super) fn poll(&mut self, floor_is_lost: bool, now: Instant) {
        let Some(sink) = &mut self.sink else { return };
        // Otherwise the frames provide the time, so that the same frames give the same reports.
        if floor_is_lost {
            self.changes
                .thin(&[], now)
                .iter()
                .map(lent(Report::Event))
                .for_each(|report| self.messages.report(&report, sink.as_mut()));
        }
        self.messages.advance(now, sink.as_mut());
        sink.poll(now);
    }

    /// Returns the number of reports that could not be sent so far.
    pub(super) fn dropped(&self) -> u64 {
        self.sink.as_ref().map_or(0, |sink| sink.dropped()) + self.messages.unsent()
    }
}

/// Makes a report of borrowed content.
fn lent<'a, T: Clone + 'a>(report: impl Fn(Cow<'a, T>) -> Report<'a>) -> impl Fn(&'a T) -> Report<'a> {
    move |content| report(Cow::Borrowed(content))
}
