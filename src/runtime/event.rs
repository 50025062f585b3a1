//! Events for apps.

use std::fmt;

use glam::Vec2;

use crate::engine::Ignored;
use crate::sense::ContactId;
use crate::sink::Report;
use crate::units::{Instant, Newtons};
use crate::widget::{EventKind, WidgetId};
use crate::wire::LinkState;

/// An event on a floor.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    /// Time of the event on the floor's sample clock.
    pub at: Instant,
    /// The kind of event.
    pub kind: Kind,
    /// The contact that caused it; `None` if no foot did.
    pub contact: Option<ContactId>,
    /// Last known force of that contact; 0 without one.
    pub force: Newtons,
    /// Position in floor metres; the floor's origin if the event has no position.
    pub position: Vec2,
    id: Option<WidgetId>,
    message: String,
}

/// The kind of an event. Events about states only report a change: [`super::Session::snapshot`] has the new state
/// within 5 ms.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Kind {
    /// A foot acted on the control [`Event::id`].
    Control(EventKind),
    /// The control [`Event::id`] ignored a foot, which has left it now: [`Event::force`] is the greatest force, and
    /// [`Event::message`] has the reason in a sentence.
    Ignored(Ignored),
    /// The state of the control [`Event::id`] changed or was requested: by an app (also this app), or because a
    /// control with the guard `HoldToRun` switched off or on ([`crate::engine::ControlState::off`]).
    State,
    /// The page [`Event::id`] is shown.
    Page,
    /// Whether sensor packets arrive. At [`LinkState::Lost`] all presses have been cancelled.
    Link(LinkState),
    /// Why packets arrive without a usable frame, or why no load was ever measured: [`Event::message`] has the name
    /// of the cause and a sentence, and is empty once the cause is over; [`crate::engine::Snapshot::link_cause`] has
    /// it as a type.
    LinkCause,
    /// State of the sensors, at most once a second.
    Health,
    /// State of the device that drives the actuators, at most once a second.
    Device,
    /// The mute state changed or was requested.
    Muted,
    /// A ground cracked at [`Event::position`]; at most 200 are reported per second.
    Crack {
        /// The seed of its cracks.
        seed: u32,
        /// Energy of the crack, in joules.
        energy_j: f32,
    },
    /// The control or region [`Event::id`] gives a message to another program, which the session itself does not send:
    /// [`Event::message`] has the name of its target and its content.
    Message,
    /// The session has ended: nothing is held, and no more events follow.
    Ended(EndReason),
}

impl Kind {
    /// Its name, as in JSON lines; for a control, the name of its event, such as `pressed`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Control(kind) => kind.name(),
            Self::Ignored(_) => "ignored",
            Self::State => "state",
            Self::Page => "page",
            Self::Link(_) => "link",
            Self::LinkCause => "link_cause",
            Self::Health => "health",
            Self::Device => "device",
            Self::Muted => "mute",
            Self::Crack { .. } => "crack",
            Self::Message => "sent",
            Self::Ended(_) => "ended",
        }
    }
}

impl EndReason {
    /// Its name for bindings of other languages.
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

/// Reason why a session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum EndReason {
    /// The program requested a stop.
    Stopped,
    /// The simulated feet or the recording came to their end.
    SourceEnded,
    /// The source failed; [`Event::message`] has its error.
    Failed,
    /// The sensing thread panicked; [`Event::message`] has the panic message.
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
    /// The control or page of the event; empty if the event concerns the whole floor.
    #[must_use]
    pub fn id(&self) -> &str {
        self.id.as_ref().map_or("", WidgetId::as_str)
    }

    /// The error if the session ended with a failure, the reason of [`Kind::Ignored`], the cause of
    /// [`Kind::LinkCause`], or the target and content of [`Kind::Message`]; empty otherwise.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The event for a report; `None` for reports that [`super::Session::held`] and snapshots cover.
    pub(super) fn of(report: &Report<'_>) -> Option<Self> {
        let at = report.at();
        let (id, kind) = match report {
            Report::Event(event) => {
                let (contact, force, position) = (event.contact, event.force, event.position);
                let event = Self::new(at, Some(event.id.clone()), Kind::Control(event.kind));
                return Some(Self { contact, force, position, ..event });
            }
            Report::Ignored(press) => {
                let (contact, force, message) = (Some(press.contact), press.force, press.why.to_string());
                let event = Self::new(at, Some(press.id.clone()), Kind::Ignored(press.why));
                return Some(Self { contact, force, message, ..event });
            }
            Report::Control(_, state) => (Some(state.id.clone()), Kind::State),
            Report::Page(shown) => (Some(shown.page.clone()), Kind::Page),
            Report::Link(_, state) => (None, Kind::Link(*state)),
            Report::LinkCause(_, cause) => {
                let message =
                    cause.as_ref().map(|cause| format!("{}: {cause}", cause.name())).unwrap_or_default();
                return Some(Self { message, ..Self::new(at, None, Kind::LinkCause) });
            }
            Report::Health(..) => (None, Kind::Health),
            Report::Device(..) => (None, Kind::Device),
            Report::Muted(..) => (None, Kind::Muted),
            Report::Crack(news) => {
                let kind = Kind::Crack { seed: news.seed, energy_j: news.energy_j };
                return Some(Self { position: Vec2::new(news.x_m, news.y_m), ..Self::new(at, None, kind) });
            }
            Report::Message(news) => {
                let id = Some(news.order.control.clone());
                return Some(Self { message: news.to_string(), ..Self::new(at, id, Kind::Message) });
            }
            Report::Contacts(..) | Report::Held(_) | Report::Alive(..) => return None,
            // The sink makes cracks of these.
            Report::Ground(_) => return None,
            // A session serves at most one area: only a gateway reports several.
            Report::Area(_) => return None,
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

    /// Whether it is a new value of a control.
    pub(super) const fn is_change(&self) -> bool {
        matches!(self.kind, Kind::Control(EventKind::Changed(_)))
    }

    /// Whether an app that misses it may act on an outdated state: the end of a press, and every change of a state.
    pub(super) const fn must_be_known(&self) -> bool {
        match self.kind {
            Kind::Control(kind) => {
                matches!(kind, EventKind::Released | EventKind::Cancelled | EventKind::Disarmed)
            }
            Kind::Crack { .. } | Kind::Ignored(_) => false,
            _ => true,
        }
    }

    /// Whether `later` replaces this event.
    pub(super) fn is_outdated_by(&self, later: &Self) -> bool {
        let kinds = match (&self.kind, &later.kind) {
            (Kind::Control(kind), Kind::Control(later)) => kind.name() == later.name(),
            (kind, later) => std::mem::discriminant(kind) == std::mem::discriminant(later),
        };
        kinds && self.id == later.id
    }
}
