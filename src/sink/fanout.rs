//! Several event sinks as one.

use super::{EventSink, Report};
use crate::units::Instant;

/// Several event sinks as one; each gets everything, in the order they were added.
#[derive(Default)]
pub struct Fanout {
    sinks: Vec<Box<dyn EventSink>>,
}

impl Fanout {
    /// A fanout without sinks.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a sink.
    pub fn push(&mut self, sink: impl EventSink + 'static) {
        self.sinks.push(Box::new(sink));
    }

    /// Adds a sink and returns the fanout.
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
    fn report(&mut self, report: &Report<'_>) {
        self.sinks.iter_mut().for_each(|sink| sink.report(report));
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
    use crate::wire::LinkState;

    struct Tell(&'static str, Sender<String>);

    impl EventSink for Tell {
        fn report(&mut self, report: &Report<'_>) {
            self.1.send(format!("{} {report:?}", self.0)).unwrap();
        }

        fn poll(&mut self, now: Instant) {
            self.1.send(format!("{} polled at {}", self.0, now.micros())).unwrap();
        }

        fn dropped(&self) -> u64 {
            3
        }
    }

    #[test]
    fn everybody_hears_everything_in_order() {
        let (tell, received) = channel();
        let mut fanout = Fanout::new().with(Tell("a", tell.clone())).with(Tell("b", tell));
        let reports = [Report::Link(Instant::START, LinkState::Live), Report::Alive(Instant::START, 8)];
        reports.iter().for_each(|report| fanout.report(report));
        fanout.poll(Instant::from_micros(5));
        assert_eq!(fanout.dropped(), 6);
        drop(fanout);
        let told = reports.iter().map(|report| format!("{report:?}"));
        let told =
            told.chain(["polled at 5".into()]).flat_map(|what| ["a", "b"].map(|to| format!("{to} {what}")));
        assert_eq!(received.iter().collect::<Vec<_>>(), told.collect::<Vec<_>>());
    }
}
