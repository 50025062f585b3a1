//! The reports of the gateway, and its counters.

use std::net::SocketAddr;

use underfoot::engine::{ControlState, PageShown};
use underfoot::feel::Muted;
use underfoot::sense::Contact;
use underfoot::sink::{AreaNews, HeldReport, Report};
use underfoot::units::Instant;
use underfoot::widget::WidgetEvent;
use underfoot::wire::LinkState;

use super::ask::RequestAnswer;

/// One report of the gateway; times are on its clock.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum GatewayReport {
    /// An event of a control; contacts have their joint numbers.
    Event(WidgetEvent),
    /// The contacts on the whole floor at one time; once a millisecond at most.
    Contacts(Instant, Vec<Contact>),
    /// The held controls: at once when they change, and 50 times a second while there are any.
    Held(HeldReport),
    /// Whether all areas are live, some or none: as for the boards of a single floor.
    Link(Instant, LinkState),
    /// The standing of an area has changed.
    Area(AreaNews),
    /// An alive report, numbered from 1; ten times a second.
    Alive(Instant, u32),
    /// The state of a control after an app has changed it or asked for it.
    Control(Instant, Box<ControlState>),
    /// The page has changed, or an app has asked for it.
    Page(PageShown),
    /// The muted set has changed, or an app has asked for it.
    Muted(Instant, Muted),
    /// The answer to the app that asked.
    Answer(SocketAddr, RequestAnswer),
    /// A notice for the operator.
    Notice(String),
}

impl GatewayReport {
    /// The same report for the outputs of a single floor; `None` for one that only the operator or one app receives.
    #[must_use]
    pub fn report(&self) -> Option<Report<'_>> {
        match self {
            Self::Event(event) => Some(Report::Event(event)),
            Self::Contacts(at, contacts) => Some(Report::Contacts(*at, contacts)),
            Self::Held(report) => Some(Report::Held(report)),
            Self::Link(at, state) => Some(Report::Link(*at, *state)),
            Self::Alive(at, sequence) => Some(Report::Alive(*at, *sequence)),
            Self::Area(news) => Some(Report::Area(news)),
            Self::Control(at, state) => Some(Report::Control(*at, state)),
            Self::Page(page) => Some(Report::Page(page)),
            Self::Muted(at, muted) => Some(Report::Muted(*at, muted)),
            Self::Answer(..) | Self::Notice(_) => None,
        }
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
