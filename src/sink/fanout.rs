//! Several event sinks as one.

use super::{EventSink, HeldReport};
use crate::engine::{ControlState, PageShown};
use crate::feel::{DeviceStatus, Muted};
use crate::ground::GroundEvent;
use crate::sense::{Contact, SensorHealth};
use crate::units::Instant;
use crate::widget::WidgetEvent;
use crate::wire::LinkState;

/// Several event sinks as one; each gets everything, in the order they were added.
#[derive(Default)]
pub struct Fanout {
    sinks: Vec<Box<dyn EventSink>>,
}

impl Fanout {
    /// A fanout that reaches nobody yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a sink.
    pub fn push(&mut self, sink: impl EventSink + 'static) {
        self.sinks.push(Box::new(sink));
    }

    /// The same fanout with one sink more.
    #[must_use]
    pub fn with(mut self, sink: impl EventSink + 'static) -> Self {
        self.push(sink);
        self
    }
}

impl std::fmt::Debug for Fanout {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Fanout({} sinks)", self.sinks.len())
    }
}

impl EventSink for Fanout {
    fn events(&mut self, events: &[WidgetEvent]) {
        self.sinks.iter_mut().for_each(|sink| sink.events(events));
    }

    fn contacts(&mut self, at: Instant, contacts: &[Contact]) {
        self.sinks.iter_mut().for_each(|sink| sink.contacts(at, contacts));
    }

    fn page(&mut self, page: &PageShown) {
        self.sinks.iter_mut().for_each(|sink| sink.page(page));
    }

    fn ground(&mut self, events: &[GroundEvent]) {
        self.sinks.iter_mut().for_each(|sink| sink.ground(events));
    }

    fn link(&mut self, at: Instant, state: LinkState) {
        self.sinks.iter_mut().for_each(|sink| sink.link(at, state));
    }

    fn health(&mut self, at: Instant, health: &SensorHealth) {
        self.sinks.iter_mut().for_each(|sink| sink.health(at, health));
    }

    fn device(&mut self, at: Instant, status: &DeviceStatus) {
        self.sinks.iter_mut().for_each(|sink| sink.device(at, status));
    }

    fn held(&mut self, report: &HeldReport) {
        self.sinks.iter_mut().for_each(|sink| sink.held(report));
    }

    fn alive(&mut self, sequence: u32) {
        self.sinks.iter_mut().for_each(|sink| sink.alive(sequence));
    }

    fn muted(&mut self, at: Instant, muted: &Muted) {
        self.sinks.iter_mut().for_each(|sink| sink.muted(at, muted));
    }

    fn control(&mut self, at: Instant, state: &ControlState) {
        self.sinks.iter_mut().for_each(|sink| sink.control(at, state));
    }

    fn poll(&mut self, now: Instant) {
        self.sinks.iter_mut().for_each(|sink| sink.poll(now));
    }

    fn dropped(&self) -> u64 {
        self.sinks.iter().map(|sink| sink.dropped()).sum()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Sender, channel};

    use super::*;

    struct Tell(&'static str, Sender<String>);

    impl EventSink for Tell {
        fn events(&mut self, events: &[WidgetEvent]) {
            self.1.send(format!("{} {} events", self.0, events.len())).unwrap();
        }

        fn contacts(&mut self, at: Instant, _: &[Contact]) {
            self.1.send(format!("{} contacts at {}", self.0, at.micros())).unwrap();
        }

        fn link(&mut self, _: Instant, state: LinkState) {
            self.1.send(format!("{} {state:?}", self.0)).unwrap();
        }

        fn health(&mut self, _: Instant, health: &SensorHealth) {
            self.1.send(format!("{} {health}", self.0)).unwrap();
        }

        fn held(&mut self, report: &HeldReport) {
            self.1.send(format!("{} held {}", self.0, report.sequence)).unwrap();
        }

        fn alive(&mut self, sequence: u32) {
            self.1.send(format!("{} alive {sequence}", self.0)).unwrap();
        }

        fn dropped(&self) -> u64 {
            3
        }
    }

    #[test]
    fn everybody_hears_everything() {
        let (tell, received) = channel();
        let mut fanout = Fanout::new().with(Tell("a", tell.clone())).with(Tell("b", tell));
        fanout.events(&[]);
        fanout.contacts(Instant::from_micros(5), &[]);
        fanout.link(Instant::START, LinkState::Live);
        fanout.health(Instant::START, &SensorHealth { counts: [3, 0, 0, 1], ..SensorHealth::default() });
        fanout.held(&HeldReport { sequence: 7, ..HeldReport::default() });
        fanout.alive(8);
        assert_eq!(fanout.dropped(), 6);
        drop(fanout);
        let expected = ["a 0 events", "b 0 events", "a contacts at 5", "b contacts at 5", "a Live", "b Live"];
        let sick = ["a 1 faulty, 3 live", "b 1 faulty, 3 live"];
        let beats = ["a held 7", "b held 7", "a alive 8", "b alive 8"];
        assert_eq!(received.iter().collect::<Vec<_>>(), [&expected[..], &sick, &beats].concat());
    }
}
