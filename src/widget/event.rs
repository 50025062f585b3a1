//! Events of controls, values and names.

use std::fmt;
use std::sync::Arc;

use arrayvec::ArrayVec;
use glam::Vec2;
use serde::{Serialize, Serializer};

use crate::floor::ContactId;
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

/// What a control holds; as JSON true or false, a number, or two numbers in a list.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// Something that is on or off: a switch, or a control that acts while it is held.
    Switch(bool),
    /// A finite number in the control's range.
    Number(f32),
    /// Which of a selector's options, from 0.
    Choice(u16),
    /// Two finite numbers, eastwards and northwards.
    Pair(#[serde(serialize_with = "as_list")] Vec2),
}

fn as_list<S: Serializer>(pair: &Vec2, serializer: S) -> Result<S::Ok, S::Error> {
    pair.to_array().serialize(serializer)
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

/// Where a foot went.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
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

    /// The word for it: `north`, `east`, `south` or `west`.
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

/// What one step of a control gave, in order; at most eight events.
pub type Emitted = ArrayVec<EventKind, 8>;

/// What happened to a control.
///
/// Every `Pressed` is followed by exactly one of `Released` and `Cancelled`,
/// every `Armed` by exactly one `Disarmed`. Only a release commits: `Clicked`
/// (unless the button acts on press), a gesture and a switch's or selector's
/// `Changed` never follow a `Cancelled`. What a foot had changed during a
/// press that is cancelled changes back.
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
    /// A button was pressed, the foot went this way and let go.
    Swiped(Direction),
    /// The press of a button with two stages reached the second.
    HardPressed,
    /// The press came back from the second stage; its release is not a click.
    HardReleased,
    /// The press ended without counting: the foot slid off or took a step, sensing was lost, or an app stopped it.
    Cancelled,
    /// The control holds a new value.
    Changed(Value),
    /// The foot passed from one choice to the next; nothing has changed yet.
    Ticked,
    /// A first press armed a guarded control: the next one acts.
    Armed,
    /// It is armed no longer.
    Disarmed,
    /// A control that acts while it is held will soon stop by itself.
    Warned,
    /// A foot pressed a control that an app has locked.
    Refused,
}

impl EventKind {
    /// The word for it in OSC addresses and JSON, such as `pressed` or `long_pressed`.
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

/// What an event says besides its name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Detail {
    /// The value that the control now holds.
    Value(Value),
    /// Where the foot went.
    Direction(Direction),
}

impl EventKind {
    /// Those that say nothing besides their name.
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

    /// What happened, by its [name](Self::name) and what is said besides; `None` if that is nothing a control does.
    #[must_use]
    pub fn of(name: &str, detail: Option<Detail>) -> Option<Self> {
        let with_detail = detail.map(|detail| match detail {
            Detail::Value(value) => Self::Changed(value),
            Detail::Direction(direction) => Self::Swiped(direction),
        });
        Self::PLAIN.into_iter().chain(with_detail).find(|kind| kind.name() == name)
    }

    /// What it says besides its name; `None` for most.
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
