//! Reports to other programs.

use std::borrow::Cow;

use super::crack_rate::{CrackNews, CrackRateLimiter};
use super::{AreaNews, HeldReport};
use crate::engine::{ControlState, IgnoredPress, PageShown};
use crate::feel::{DeviceStatus, Muted};
use crate::ground::GroundEvent;
use crate::messages::MessageNews;
use crate::sense::{Contact, SensorHealth};
use crate::units::Instant;
use crate::widget::WidgetEvent;
use crate::wire::{LinkCause, LinkState};

/// One report to other programs; times are on the floor's sample clock.
///
/// The sensing thread lends the content to its sinks; [`Report::owned`] copies it for another thread.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Report<'a> {
    /// An event of a control.
    Event(Cow<'a, WidgetEvent>),
    /// A control ignored a foot, which has left it now.
    Ignored(Cow<'a, IgnoredPress>),
    /// The contacts of one frame; reported for every frame, so a sink limits the rate itself.
    Contacts(Instant, Cow<'a, [Contact]>),
    /// Another page is shown, or an app has asked for the current one.
    Page(Cow<'a, PageShown>),
    /// A ground event under a foot.
    Ground(Cow<'a, GroundEvent>),
    /// A crack: [`Report::limited`] makes it of ground events, at a rate that other programs can follow.
    Crack(CrackNews),
    /// The floor's link has changed its state.
    Link(Instant, LinkState),
    /// The cause of unusable frames has changed; `None` when it is gone.
    LinkCause(Instant, Option<Cow<'a, LinkCause>>),
    /// The state of the sensors has changed; reported at most once a second.
    Health(Instant, Cow<'a, SensorHealth>),
    /// The state of the device that drives the actuators has changed; reported at most once a second.
    Device(Instant, Cow<'a, DeviceStatus>),
    /// The held controls: at once when they change, and 50 times a second while there are any.
    Held(Cow<'a, HeldReport>),
    /// An alive message, numbered from 1; sent ten times a second, also while no packets come.
    Alive(Instant, u32),
    /// The mute state has changed, or an app has asked for it.
    Muted(Instant, Cow<'a, Muted>),
    /// The state of a control: an app has changed it or asked for it, or it has the guard `HoldToRun` and has gone
    /// off or on.
    Control(Instant, Cow<'a, ControlState>),
    /// A message of the layout to another program; what a control or a foot gives, whether or not somebody sends it.
    Message(Cow<'a, MessageNews>),
    /// The state of one area of a floor that several computers serve has changed.
    Area(Cow<'a, AreaNews>),
}

impl Report<'_> {
    /// Returns the same report with a copy of all that it borrows.
    #[must_use]
    pub fn owned(&self) -> Report<'static> {
        match self {
            Self::Event(event) => Report::Event(owned(event.as_ref())),
            Self::Ignored(press) => Report::Ignored(owned(press.as_ref())),
            Self::Contacts(at, contacts) => Report::Contacts(*at, Cow::Owned(contacts.to_vec())),
            Self::Page(page) => Report::Page(owned(page.as_ref())),
            Self::Ground(event) => Report::Ground(owned(event.as_ref())),
            Self::Crack(news) => Report::Crack(*news),
            Self::Link(at, state) => Report::Link(*at, *state),
            Self::LinkCause(at, cause) => Report::LinkCause(*at, cause.as_deref().map(owned)),
            Self::Health(at, health) => Report::Health(*at, owned(health.as_ref())),
            Self::Device(at, status) => Report::Device(*at, owned(status.as_ref())),
            Self::Held(report) => Report::Held(owned(report.as_ref())),
            Self::Alive(at, sequence) => Report::Alive(*at, *sequence),
            Self::Muted(at, muted) => Report::Muted(*at, owned(muted.as_ref())),
            Self::Control(at, state) => Report::Control(*at, owned(state.as_ref())),
            Self::Message(news) => Report::Message(owned(news.as_ref())),
            Self::Area(news) => Report::Area(owned(news.as_ref())),
        }
    }

    /// Returns an owned report for other programs: a crack in the place of a ground event, and `None` for a ground
    /// event that `cracks` drops.
    pub fn limited(&self, cracks: &mut CrackRateLimiter) -> Option<Report<'static>> {
        match self {
            Self::Ground(event) => cracks.news(event).map(Report::Crack),
            report => Some(report.owned()),
        }
    }

    /// Returns the time of the report.
    #[must_use]
    pub fn at(&self) -> Instant {
        match self {
            Self::Event(event) => event.at,
            Self::Ignored(press) => press.at,
            Self::Page(page) => page.at,
            Self::Ground(event) => event.at,
            Self::Crack(news) => news.at,
            Self::Held(report) => report.at,
            Self::Message(news) => news.at,
            Self::Area(news) => news.at,
            Self::Contacts(at, _)
            | Self::Link(at, _)
            | Self::LinkCause(at, _)
            | Self::Health(at, _)
            | Self::Device(at, _)
            | Self::Alive(at, _)
            | Self::Muted(at, _)
            | Self::Control(at, _) => *at,
        }
    }
}

/// Returns a copy of `content`.
fn owned<T: Clone>(content: &T) -> Cow<'static, T> {
    Cow::Owned(content.clone())
}
