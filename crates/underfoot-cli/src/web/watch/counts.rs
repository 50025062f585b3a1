//! Counts of events since the start, as the sensing thread reports them.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use underfoot::engine::Ignored;
use underfoot::sink::{EventSink, Report};
use underfoot::widget::{Direction, EventKind, Value};
use underfoot::wire::LinkState;

/// Counts by name; the names are fixed.
#[derive(Debug)]
struct NamedCounts(Vec<(&'static str, AtomicU64)>);

impl NamedCounts {
    fn of(names: impl Iterator<Item = &'static str>) -> Self {
        Self(names.map(|name| (name, AtomicU64::new(0))).collect())
    }

    fn add(&self, name: &str) {
        if let Some((_, count)) = self.0.iter().find(|(other, _)| *other == name) {
            count.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn read(&self) -> Vec<(&'static str, u64)> {
        self.0.iter().map(|(name, count)| (*name, count.load(Ordering::Relaxed))).collect()
    }
}

/// Counts of events since the start; each number can be read while another thread counts.
#[derive(Debug)]
pub(in super::super) struct EventCounts {
    kinds: NamedCounts,
    ignored: NamedCounts,
    losses: AtomicU64,
}

impl Default for EventCounts {
    fn default() -> Self {
        let with_detail = [EventKind::Changed(Value::Switch(false)), EventKind::Swiped(Direction::North)];
        Self {
            kinds: NamedCounts::of(EventKind::PLAIN.into_iter().chain(with_detail).map(EventKind::name)),
            ignored: NamedCounts::of(Ignored::all().map(Ignored::name)),
            losses: AtomicU64::new(0),
        }
    }
}

impl EventCounts {
    /// The number of events of controls, by the name of their kind.
    pub(super) fn kinds(&self) -> Vec<(&'static str, u64)> {
        self.kinds.read()
    }

    /// The number of ignored presses, by the name of the reason.
    pub(super) fn ignored(&self) -> Vec<(&'static str, u64)> {
        self.ignored.read()
    }

    /// The number of times that the floor was lost.
    pub(super) fn losses(&self) -> u64 {
        self.losses.load(Ordering::Relaxed)
    }
}

/// Counts the reports of a floor.
pub(in super::super) struct CountingSink(Arc<EventCounts>);

impl CountingSink {
    pub(in super::super) fn new(counts: Arc<EventCounts>) -> Self {
        Self(counts)
    }
}

impl EventSink for CountingSink {
    fn report(&mut self, report: &Report<'_>) {
        match report {
            Report::Event(event) => self.0.kinds.add(event.kind.name()),
            Report::Ignored(press) => self.0.ignored.add(press.why.name()),
            Report::Link(_, LinkState::Lost) => {
                self.0.losses.fetch_add(1, Ordering::Relaxed);
            }
            _ => {}
        }
    }
}
