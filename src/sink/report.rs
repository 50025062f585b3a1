//! What other programs are told.

use super::crack_rate::{CrackNews, CrackRateLimiter};
use super::{AreaNews, HeldReport};
use crate::engine::{ControlState, PageShown};
use crate::feel::{DeviceStatus, Muted};
use crate::ground::GroundEvent;
use crate::sense::{Contact, SensorHealth};
use crate::units::Instant;
use crate::widget::WidgetEvent;
use crate::wire::{LinkCause, LinkState};

/// One thing that other programs are told; times are on the floor's sample clock.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Report<'a> {
    /// Something happened to a control.
    Event(&'a WidgetEvent),
    /// The contacts of one frame; told for every frame, so a sink thins them out itself.
    Contacts(Instant, &'a [Contact]),
    /// A page has taken the place of another, or somebody has asked which one is shown.
    Page(&'a PageShown),
    /// A ground gave way under a foot.
    Ground(&'a GroundEvent),
    /// The floor's link has changed its state.
    Link(Instant, LinkState),
    /// The cause for which something is sent and no frame can be used has changed; `None` when it is gone.
    LinkCause(Instant, Option<&'a LinkCause>),
    /// How the sensors are doing has changed; told once a second at most.
    Health(Instant, &'a SensorHealth),
    /// How the device that moves the actuators is doing has changed; told once a second at most.
    Device(Instant, &'a DeviceStatus),
    /// Which controls are held: at once when that changes, and 50 times a second while any is.
    Held(&'a HeldReport),
    /// A sign of life, numbered from 1; told ten times a second, also while no packets come.
    Alive(Instant, u32),
    /// What is muted has changed, or somebody has asked.
    Muted(Instant, &'a Muted),
    /// How a control is now: an app has changed it or asked for it, or it has the guard `HoldToRun` and has gone off or
    /// on.
    Control(Instant, &'a ControlState),
    /// How one area of a floor that several computers serve stands has changed.
    Area(&'a AreaNews),
}

/// A report on its way to another thread.
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

impl OwnedReport {
    /// A copy of `report`; of ground events only those that `cracks` lets through.
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

    /// When it was so.
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
