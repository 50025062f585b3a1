//! Reports to other programs.

#[cfg(feature = "net")]
use super::crack_rate::{CrackNews, CrackRateLimiter};
use super::{AreaNews, HeldReport};
use crate::engine::{ControlState, PageShown};
use crate::feel::{DeviceStatus, Muted};
use crate::ground::GroundEvent;
use crate::sense::{Contact, SensorHealth};
use crate::units::Instant;
use crate::widget::WidgetEvent;
use crate::wire::{LinkCause, LinkState};

/// One report to other programs; times are on the floor's sample clock.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Report<'a> {
    /// An event of a control.
    Event(&'a WidgetEvent),
    /// The contacts of one frame; reported for every frame, so a sink limits the rate itself.
    Contacts(Instant, &'a [Contact]),
    /// Another page is shown, or an app has asked for the current one.
    Page(&'a PageShown),
    /// A ground event under a foot.
    Ground(&'a GroundEvent),
    /// The floor's link has changed its state.
    Link(Instant, LinkState),
    /// The cause of unusable frames has changed; `None` when it is gone.
    LinkCause(Instant, Option<&'a LinkCause>),
    /// The state of the sensors has changed; reported at most once a second.
    Health(Instant, &'a SensorHealth),
    /// The state of the device that drives the actuators has changed; reported at most once a second.
    Device(Instant, &'a DeviceStatus),
    /// The held controls: at once when they change, and 50 times a second while there are any.
    Held(&'a HeldReport),
    /// An alive message, numbered from 1; sent ten times a second, also while no packets come.
    Alive(Instant, u32),
    /// The mute state has changed, or an app has asked for it.
    Muted(Instant, &'a Muted),
    /// The state of a control: an app has changed it or asked for it, or it has the guard `HoldToRun` and has gone
    /// off or on.
    Control(Instant, &'a ControlState),
    /// The state of one area of a floor that several computers serve has changed.
    Area(&'a AreaNews),
}

/// A report on its way to another thread.
#[cfg(feature = "net")]
#[derive(Debug)]
pub(crate) enum OwnedReport {
    Event(WidgetEvent),
    Contacts(Instant, Vec<Contact>),
    Page(PageShown),
    Crack(CrackNews),
    Link(Instant, LinkState),
    LinkCause(Instant, Option<LinkCause>),
    Health(Instant, SensorHealth),
    Device(Instant, DeviceStatus),
    Held(HeldReport),
    Alive(Instant, u32),
    Muted(Instant, Muted),
    Control(Instant, Box<ControlState>),
    Area(AreaNews),
}

#[cfg(feature = "net")]
impl OwnedReport {
    /// Copies `report`; `None` for ground events that `cracks` drops.
    pub(crate) fn of(report: Report<'_>, cracks: &mut CrackRateLimiter) -> Option<Self> {
        Some(match report {
            Report::Event(event) => Self::Event(event.clone()),
            Report::Contacts(at, contacts) => Self::Contacts(at, contacts.to_vec()),
            Report::Page(page) => Self::Page(page.clone()),
            Report::Ground(event) => Self::Crack(cracks.news(event)?),
            Report::Link(at, state) => Self::Link(at, state),
            Report::LinkCause(at, cause) => Self::LinkCause(at, cause.cloned()),
            Report::Health(at, health) => Self::Health(at, health.clone()),
            Report::Device(at, status) => Self::Device(at, status.clone()),
            Report::Held(report) => Self::Held(report.clone()),
            Report::Alive(at, sequence) => Self::Alive(at, sequence),
            Report::Muted(at, muted) => Self::Muted(at, muted.clone()),
            Report::Control(at, state) => Self::Control(at, Box::new(state.clone())),
            Report::Area(news) => Self::Area(news.clone()),
        })
    }

    /// Returns the time of the report.
    pub(crate) const fn at(&self) -> Instant {
        match self {
            Self::Event(event) => event.at,
            Self::Page(page) => page.at,
            Self::Crack(news) => news.at,
            Self::Held(report) => report.at,
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
