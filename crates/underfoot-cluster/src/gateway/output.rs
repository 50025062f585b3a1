//! The outputs of the gateway, and its counters.

use std::borrow::Cow;
use std::net::SocketAddr;

use underfoot::sink::Report;
use underfoot::widget::WidgetEvent;

use super::ask::RequestAnswer;

/// One output of the gateway; times are on its clock, and contacts have their joint numbers.
#[derive(Clone, Debug, PartialEq)]
pub enum Output {
    /// A report about the whole floor, as of a floor of one computer. Contacts come once a millisecond at most.
    Report(Report<'static>),
    /// The answer to the app that asked.
    Answer(SocketAddr, RequestAnswer),
    /// A notice for the operator.
    Notice(String),
}

impl Output {
    /// Returns the report for the outputs of a single floor; `None` for what only the operator or one app receives.
    #[must_use]
    pub const fn report(&self) -> Option<&Report<'static>> {
        match self {
            Self::Report(report) => Some(report),
            Self::Answer(..) | Self::Notice(_) => None,
        }
    }
}

impl From<WidgetEvent> for Output {
    fn from(event: WidgetEvent) -> Self {
        Self::Report(Report::Event(Cow::Owned(event)))
    }
}

/// Counts of received messages and of unreported events, since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Messages of nodes that were authentic and new.
    pub messages: u64,
    /// Messages of another version, another floor, an unknown area, or with invalid numbers.
    pub refused: u64,
    /// Messages with a newest frame more than 100 ms old, or in the future.
    pub stale: u64,
    /// Events from times at which their area was not live, or of presses already reported as cancelled.
    pub withheld: u64,
    /// Holds that a node reported without a press before, and that the gateway refused.
    pub unpressed: u64,
    /// Events that came too late for the time order; they were reported nevertheless.
    pub late: u64,
    /// Events that never arrived.
    pub lost: u64,
    /// Refused requests of apps.
    pub denied: u64,
}
