//! Those who are told what happens, and how often.

use super::heartbeat::Heartbeat;
use crate::engine::Step;
use crate::serve::changes::ChangeLimiter;
use crate::sink::{EventSink, Report};
use crate::units::Instant;
use crate::widget::{WidgetEvent, WidgetId};

/// What is told to other programs; without a sink nobody is.
#[derive(Default)]
pub(super) struct Outputs {
    pub(super) sink: Option<Box<dyn EventSink>>,
    changes: ChangeLimiter,
    heartbeat: Heartbeat,
}

impl Outputs {
    /// Tells one thing.
    pub(super) fn report(&mut self, report: Report<'_>) {
        if let Some(sink) = &mut self.sink {
            sink.report(report);
        }
    }

    /// Tells what a frame of time `at` led to.
    pub(super) fn step(&mut self, step: &Step<'_>, at: Instant) {
        let Some(sink) = &mut self.sink else { return };
        let events = self.changes.thin(step.events, at).iter().map(Report::Event);
        let page = step.page.into_iter().map(Report::Page);
        let grounds = step.grounds.iter().map(Report::Ground);
        let contacts = [Report::Contacts(at, step.contacts)];
        events.chain(page).chain(grounds).chain(contacts).for_each(|report| sink.report(report));
    }

    /// Tells what must not wait.
    pub(super) fn events(&mut self, events: &[WidgetEvent]) {
        events.iter().for_each(|event| self.report(Report::Event(event)));
    }

    /// Tells what is held, if that has changed or is due, and that the server lives.
    pub(super) fn beat<'a>(
        &mut self,
        held: impl Iterator<Item = &'a WidgetId> + Clone,
        seen: Instant,
        now: Instant,
    ) {
        if let Some(sink) = &mut self.sink {
            self.heartbeat.beat(held, seen, now, |report| sink.report(report));
        }
    }

    /// Tells what had to wait, also while no frames come.
    pub(super) fn poll(&mut self, floor_is_lost: bool, now: Instant) {
        let Some(sink) = &mut self.sink else { return };
        // Otherwise frames give the time, so that the same frames tell the same.
        if floor_is_lost {
            self.changes.thin(&[], now).iter().for_each(|event| sink.report(Report::Event(event)));
        }
        sink.poll(now);
    }

    /// Reports that could not be passed on so far.
    pub(super) fn dropped(&self) -> u64 {
        self.sink.as_ref().map_or(0, |sink| sink.dropped())
    }
}
