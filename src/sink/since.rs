//! Leaves out what happens before a moment.

use crate::sink::{EventSink, Report};
use crate::units::Instant;

/// Passes on reports from a moment on: a trimmed recording has more before it than it shows.
///
/// Reports of states, such as that of the link, pass at all times, since none may follow them.
pub struct Since<S> {
    inner: S,
    from: Instant,
}

impl<S: EventSink> Since<S> {
    /// Reports to `inner` the events, messages, contacts, cracks and held controls from `from` on, and all states.
    pub const fn new(inner: S, from: Instant) -> Self {
        Self { inner, from }
    }
}

impl<S: EventSink> EventSink for Since<S> {
    fn report(&mut self, report: &Report<'_>) {
        let happens = matches!(
            report,
            Report::Event(_)
                | Report::Contacts(..)
                | Report::Ground(_)
                | Report::Crack(_)
                | Report::Held(_)
                | Report::Message(_)
        );
        if !happens || report.at() >= self.from {
            self.inner.report(report);
        }
    }

    fn poll(&mut self, now: Instant) {
        self.inner.poll(now);
    }

    fn dropped(&self) -> u64 {
        self.inner.dropped()
    }
}

impl<S> std::fmt::Debug for Since<S> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Since").field("from", &self.from).finish_non_exhaustive()
    }
}
