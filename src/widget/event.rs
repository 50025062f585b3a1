//! Events of controls, values and names.

use std::fmt;
use std::sync::Arc;

use arrayvec::ArrayVec;
use glam::Vec2;

use crate::floor::ContactId;
use crate::units::{Instant, Newtons};

/// The name of a widget as written in its layout; cheap to clone.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct WidgetId(Arc<str>);

impl WidgetId {
    /// The id with this name.
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

/// The value of a control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// On or off: the value of a switch, or of a control that acts while it is held.
    Switch(bool),
    /// A finite number in the control's range.
    Number(f32),
    /// Index of a selector's option, from 0.
    Choice(u16),
    /// Two finite numbers, eastwards and northwards.
    Pair(Vec2),
}

impl From<bool> for Value {
    fn from(on: bool) -> Self {
        Self::Switch(on)
    }
}

impl From<f32> for Value {
    fn from(number: f32) -> Self {
        Self::Number(number)
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number as f32)
    }
}

impl From<i32> for Value {
    fn from(number: i32) -> Self {
        Self::Number(number as f32)
    }
}

impl From<Vec2> for Value {
    fn from(pair: Vec2) -> Self {
        Self::Pair(pair)
    }
}

/// The direction of a swipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Away from the user.
    North,
    /// To the right.
    East,
    /// Towards the user.
    South,
    /// To the left.
    West,
}

impl Direction {
    /// All four, clockwise from north.
    pub const ALL: [Self; 4] = [Self::North, Self::East, Self::South, Self::West];

    /// Its name: `north`, `east`, `south` or `west`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::North => "north",
            Self::East => "east",
            Self::South => "south",
            Self::West => "west",
        }
    }
}

/// The events of one step of a control, in order; at most eight.
pub type Emitted = ArrayVec<EventKind, 8>;

/// An event of a control.
///
/// Every `Pressed` is followed by exactly one of `Released` and `Cancelled`, every `Armed` by exactly one `Disarmed`.
/// Only a release commits: `Clicked` (unless the button acts on press), a gesture and a switch's or selector's
/// `Changed` never follow a `Cancelled`. A cancel reverts the changes of its press.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EventKind {
    /// The foot engaged the control.
    Pressed,
    /// The foot let go; the press counts.
    Released,
    /// A button was pressed and released on itself: a tap.
    Clicked,
    /// A button was tapped twice.
    DoubleTapped,
    /// A button has been held for long; its release is not a click.
    LongPressed,
    /// A button was pressed, the foot moved in this direction and let go.
    Swiped(Direction),
    /// The press of a button with two stages reached the second.
    HardPressed,
    /// The press left the second stage; its release is not a click.
    HardReleased,
    /// The press ended without counting: the foot slid off or took a step, sensing was lost, or an app stopped it.
    Cancelled,
    /// The control has a new value.
    Changed(Value),
    /// The foot passed from one choice to the next; nothing has changed yet.
    Ticked,
    /// A first press armed a guarded control: the next one acts.
    Armed,
    /// The control is no longer armed.
    Disarmed,
    /// A control that acts while it is held will soon stop by itself.
    Warned,
    /// A foot pressed a control that an app has locked.
    Refused,
}

impl EventKind {
    /// Its name in OSC addresses and JSON, such as `pressed` or `long_pressed`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pressed => "pressed",
            Self::Released => "released",
            Self::Clicked => "clicked",
            Self::DoubleTapped => "double_tapped",
            Self::LongPressed => "long_pressed",
            Self::Swiped(_) => "swiped",
            Self::HardPressed => "hard_pressed",
            Self::HardReleased => "hard_released",
            Self::Cancelled => "cancelled",
            Self::Changed(_) => "changed",
            Self::Ticked => "ticked",
            Self::Armed => "armed",
            Self::Disarmed => "disarmed",
            Self::Warned => "warned",
            Self::Refused => "refused",
        }
    }
}

/// The content of an event besides its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Detail {
    /// The new value of the control.
    Value(Value),
    /// The direction of the foot.
    Direction(Direction),
}

impl EventKind {
    /// The events without further content.
    pub const PLAIN: [Self; 13] = [
        Self::Pressed,
        Self::Released,
        Self::Clicked,
        Self::DoubleTapped,
        Self::LongPressed,
        Self::HardPressed,
        Self::HardReleased,
        Self::Cancelled,
        Self::Ticked,
        Self::Armed,
        Self::Disarmed,
        Self::Warned,
        Self::Refused,
    ];

    /// The event with this [name](Self::name) and detail; `None` if controls emit no such event.
    #[must_use]
    pub fn of(name: &str, detail: Option<Detail>) -> Option<Self> {
        let with_detail = detail.map(|detail| match detail {
            Detail::Value(value) => Self::Changed(value),
            Detail::Direction(direction) => Self::Swiped(direction),
        });
        Self::PLAIN.into_iter().chain(with_detail).find(|kind| kind.name() == name)
    }

    /// Its content besides the name; `None` for most.
    #[must_use]
    pub const fn detail(self) -> Option<Detail> {
        match self {
            Self::Changed(value) => Some(Detail::Value(value)),
            Self::Swiped(direction) => Some(Detail::Direction(direction)),
            Self::Pressed
            | Self::Released
            | Self::Clicked
            | Self::DoubleTapped
            | Self::LongPressed
            | Self::HardPressed
            | Self::HardReleased
            | Self::Cancelled
            | Self::Ticked
            | Self::Armed
            | Self::Disarmed
            | Self::Warned
            | Self::Refused => None,
        }
    }
}

/// One event of one control, as the engine returns it.
#[derive(Clone, Debug, PartialEq)]
pub struct WidgetEvent {
    /// Its time, on the floor's sample clock.
    pub at: Instant,
    /// The control.
    pub id: WidgetId,
    /// The event.
    pub kind: EventKind,
    /// The contact that caused it; `None` without a foot (an app, a lost floor).
    pub contact: Option<ContactId>,
    /// Last known force of that contact.
    pub force: Newtons,
    /// Last known place of that contact, in floor metres.
    pub position: Vec2,
}
