//! What the gateway tells, and what it counts.

use std::net::SocketAddr;

use underfoot::engine::{ControlState, PageShown};
use underfoot::feel::Muted;
use underfoot::sense::Contact;
use underfoot::sink::{AreaNews, HeldReport, Report};
use underfoot::units::Instant;
use underfoot::widget::WidgetEvent;
use underfoot::wire::LinkState;

use super::ask::Answer;

/// One thing that the gateway tells; times are on its clock.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Told {
    /// Something happened to a control; contacts have their joint names.
    Event(WidgetEvent),
    /// The contacts on the whole floor at one moment; for each millisecond at most.
    Contacts(Instant, Vec<Contact>),
    /// Which controls are held: at once when that changes, and 50 times a second while any is.
    Held(HeldReport),
    /// Whether all areas live, some or none: as of the boards of a single floor.
    Link(Instant, LinkState),
    /// How an area stands has changed.
    Area(AreaNews),
    /// A sign of life, numbered from 1; ten times a second.
    Alive(Instant, u32),
    /// An app has changed a control or asked for it: how it is now.
    Control(Instant, Box<ControlState>),
    /// A page has taken the place of another, or somebody has asked which one is shown.
    Page(PageShown),
    /// What is muted has changed, or somebody has asked.
    Muted(Instant, Muted),
    /// What the app that asked is answered.
    Answer(SocketAddr, Answer),
    /// Something that a person has to look after.
    Notice(String),
}

impl Told {
    /// The same for the outputs of a single floor; `None` for what only a person or one app is told.
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

/// What came in and what was not told, since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Messages of nodes that were authentic and new.
    pub messages: u64,
    /// Messages of another version, another floor, an unknown area, or with numbers that mean nothing.
    pub refused: u64,
    /// Messages whose newest frame was more than 100 ms old, or of a moment that had not come yet.
    pub stale: u64,
    /// Events of the time in which their area was not believed, or of presses that apps were told are cancelled.
    pub withheld: u64,
    /// Holds that a node reported without a press before, and that were refused.
    pub unpressed: u64,
    /// Events that came too late to be told in order, and were told all the same.
    pub late: u64,
    /// Events that never came.
    pub lost: u64,
    /// Requests of apps that were not done.
    pub denied: u64,
}
