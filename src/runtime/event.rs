//! What an app hears.

use std::fmt;

use glam::Vec2;

use crate::sense::ContactId;
use crate::sink::OwnedReport;
use crate::units::{Instant, Newtons};
use crate::widget::{EventKind, WidgetEvent, WidgetId};
use crate::wire::LinkState;

/// One thing that happened on a floor.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    /// When, on the floor's sample clock.
    pub at: Instant,
    /// What.
    pub kind: Kind,
    /// The contact that did it; `None` if no foot did.
    pub contact: Option<ContactId>,
    /// Force of that contact, last known; 0 without one.
    pub force: Newtons,
    /// Where it happened, in floor metres; the floor's origin where it has no place.
    pub position: Vec2,
    id: Option<WidgetId>,
    message: String,
}

/// What happened. Of states it says that they are others now: [`super::Session::snapshot`] has them within 5 ms.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Kind {
    /// A foot did something to the control [`Event::id`].
    Control(EventKind),
    /// The control [`Event::id`] is in another state: an app has changed or asked for it (also this app), or it has the
    /// guard `HoldToRun` and has gone off or on ([`crate::engine::ControlState::off`]).
    State,
    /// The page [`Event::id`] is shown.
    Page,
    /// Whether sensor packets arrive. [`LinkState::Lost`] has cancelled what was held.
    Link(LinkState),
    /// Why something is sent and no frame can be used, or no load was ever seen: [`Event::message`] has its name and a
    /// sentence, and is empty when it is over; [`crate::engine::Snapshot::link_cause`] has it as a type.
    LinkCause,
    /// How the sensors are doing, once a second at most.
    Health,
    /// How the device that moves the actuators is doing, once a second at most.
    Device,
    /// What is muted.
    Muted,
    /// A ground cracked at [`Event::position`]; 200 a second at most are told.
    Crack {
        /// The seed of its cracks.
        seed: u32,
        /// The energy it took, in joules.
        energy_j: f32,
    },
    /// The session is over: nothing is held, and nothing more will come.
    Ended(EndReason),
}

impl Kind {
    /// The word for it, as in JSON lines: of a control what happened to it, such as `pressed`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Control(kind) => kind.name(),
            Self::State => "state",
            Self::Page => "page",
            Self::Link(_) => "link",
            Self::LinkCause => "link_cause",
            Self::Health => "health",
            Self::Device => "device",
            Self::Muted => "mute",
            Self::Crack { .. } => "crack",
            Self::Ended(_) => "ended",
        }
    }
}

impl EndReason {
    /// The word for it in other languages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stopped => "stopped",
            Self::SourceEnded => "source_ended",
            Self::Failed => "failed",
            Self::Panicked => "panicked",
        }
    }
}

/// Why a session is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum EndReason {
    /// It was asked to stop.
    Stopped,
    /// The simulated floor's feet, or the recording, have come to their end.
    SourceEnded,
    /// The source failed; [`Event::message`] says what it said.
    Failed,
    /// The sensing thread panicked; [`Event::message`] says what it said.
    Panicked,
}

impl fmt::Display for EndReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stopped => "stopped",
            Self::SourceEnded => "the source has ended",
            Self::Failed => "the source has failed",
            Self::Panicked => "sensing has failed",
        })
    }
}

impl Event {
    /// The control or page it is about; empty where it is about the floor.
    #[must_use]
    pub fn id(&self) -> &str {
        self.id.as_ref().map_or("", WidgetId::as_str)
    }

    /// The reason of an end that is a failure, and the cause of [`Kind::LinkCause`]; empty otherwise.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// What there is to hear of `told`; `None` for what [`super::Session::held`] and snapshots show.
    pub(super) fn of(told: OwnedReport) -> Option<Self> {
        let at = told.at();
        let (id, kind) = match told {
            OwnedReport::Event(WidgetEvent { id, kind, contact, force, position, .. }) => {
                let event = Self::new(at, Some(id), Kind::Control(kind));
                return Some(Self { contact, force, position, ..event });
            }
            OwnedReport::Control(_, state) => (Some(state.id.clone()), Kind::State),
            OwnedReport::Page(shown) => (Some(shown.page), Kind::Page),
            OwnedReport::Link(_, state) => (None, Kind::Link(state)),
            OwnedReport::LinkCause(_, cause) => {
                let message = cause.map(|cause| format!("{}: {cause}", cause.name())).unwrap_or_default();
                return Some(Self { message, ..Self::new(at, None, Kind::LinkCause) });
            }
            OwnedReport::Health(..) => (None, Kind::Health),
            OwnedReport::Device(..) => (None, Kind::Device),
            OwnedReport::Muted(..) => (None, Kind::Muted),
            OwnedReport::Crack(news) => {
                let kind = Kind::Crack { seed: news.seed, energy_j: news.energy_j };
                return Some(Self { position: Vec2::new(news.x_m, news.y_m), ..Self::new(at, None, kind) });
            }
            OwnedReport::Contacts(..) | OwnedReport::Held(_) | OwnedReport::Alive(..) => return None,
            // A session serves one area at most: a gateway tells of several.
            OwnedReport::Area(_) => return None,
        };
        Some(Self::new(at, id, kind))
    }

    pub(super) fn ended(at: Instant, reason: EndReason, message: String) -> Self {
        Self { message, ..Self::new(at, None, Kind::Ended(reason)) }
    }

    fn new(at: Instant, id: Option<WidgetId>, kind: Kind) -> Self {
        let (force, position, message) = (Newtons::ZERO, Vec2::ZERO, String::new());
        Self { at, kind, contact: None, force, position, id, message }
    }

    /// Whether it is the new value of a control.
    pub(super) const fn is_change(&self) -> bool {
        matches!(self.kind, Kind::Control(EventKind::Changed(_)))
    }

    /// Whether an app that misses it may believe something that is no longer so: the end of a press, and every state.
    pub(super) const fn must_be_known(&self) -> bool {
        match self.kind {
            Kind::Control(kind) => {
                matches!(kind, EventKind::Released | EventKind::Cancelled | EventKind::Disarmed)
            }
            Kind::Crack { .. } => false,
            _ => true,
        }
    }

    /// Whether `later` says all that this one says.
    pub(super) fn is_outdated_by(&self, later: &Self) -> bool {
        let kinds = match (&self.kind, &later.kind) {
            (Kind::Control(kind), Kind::Control(later)) => kind.name() == later.name(),
            (kind, later) => std::mem::discriminant(kind) == std::mem::discriminant(later),
        };
        kinds && self.id == later.id
    }
}
