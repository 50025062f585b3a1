use std::fmt;
use std::sync::Arc;

use glam::Vec2;

use crate::sense::ContactId;
use crate::units::{Instant, Newtons};

/// The name of a widget as written in its layout; cheap to clone.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct WidgetId(Arc<str>);

impl WidgetId {
    /// The id written as `name`.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self(name.into())
    }

    /// The name as written.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for WidgetId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl PartialEq<str> for WidgetId {
    fn eq(&self, name: &str) -> bool {
        &*self.0 == name
    }
}

impl PartialEq<&str> for WidgetId {
    fn eq(&self, name: &&str) -> bool {
        &*self.0 == *name
    }
}

/// What a control holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A switch: on or off.
    Switch(bool),
    /// A slider: a finite number in the slider's range.
    Number(f32),
}

/// What happened to a control.
///
/// Every `Pressed` is followed by exactly one of `Released` and `Cancelled`.
/// Only a release commits: `Clicked` and a switch's `Changed` never follow a
/// `Cancelled`, and a cancelled slider changes back to where it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EventKind {
    /// The foot engaged the control.
    Pressed,
    /// The foot let go; the press counts.
    Released,
    /// A button was pressed and released on itself.
    Clicked,
    /// The press ended without counting: the foot slid off, sensing was lost, or an app disabled the control.
    Cancelled,
    /// The control holds a new value.
    Changed(Value),
}

impl EventKind {
    /// The word for it in OSC addresses and JSON: `pressed`, `released`, `clicked`, `cancelled` or `changed`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pressed => "pressed",
            Self::Released => "released",
            Self::Clicked => "clicked",
            Self::Cancelled => "cancelled",
            Self::Changed(_) => "changed",
        }
    }
}

/// One event of one control, as it leaves the engine.
#[derive(Clone, Debug, PartialEq)]
pub struct WidgetEvent {
    /// When it happened, on the floor's sample clock.
    pub at: Instant,
    /// Which control.
    pub id: WidgetId,
    /// What happened.
    pub kind: EventKind,
    /// The contact that did it; `None` if no foot did (an app, a lost floor).
    pub contact: Option<ContactId>,
    /// Force of that contact, last known.
    pub force: Newtons,
    /// Where the contact was, in floor metres, last known.
    pub position: Vec2,
}
