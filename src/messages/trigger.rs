//! The events of controls that messages answer.

use underfoot_format::Named;

use crate::widget::{Behaviour, Direction, EventKind, Value, possible_events};

/// An event of a control as layouts name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trigger(&'static str);

impl Trigger {
    /// A tap.
    pub const CLICKED: Self = Self("clicked");
    /// The foot engaged the control.
    pub const PRESSED: Self = Self("pressed");

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.0
    }

    /// Whether `event` is this one.
    #[must_use]
    pub fn matches(self, event: EventKind) -> bool {
        match event {
            EventKind::Swiped(direction) => {
                self.0 == "swiped"
                    || self.0.strip_prefix("swiped_").is_some_and(|way| way == direction.name())
            }
            EventKind::Changed(Value::Switch(on)) => {
                self.0 == "changed" || self.0 == if on { "switched_on" } else { "switched_off" }
            }
            event => self.0 == event.name(),
        }
    }

    /// Whether a control with this `behaviour` can give the event.
    #[must_use]
    pub fn is_given_by(self, behaviour: &Behaviour) -> bool {
        let switched = [true, false].map(|on| EventKind::Changed(Value::Switch(on)));
        possible_events(behaviour, behaviour.initial()).into_iter().any(|(event, _)| match event {
            EventKind::Swiped(_) => Direction::ALL.map(EventKind::Swiped).iter().any(|it| self.matches(*it)),
            EventKind::Changed(Value::Switch(_)) => switched.iter().any(|it| self.matches(*it)),
            event => self.matches(event),
        })
    }
}

impl Named for Trigger {
    const ALL: &'static [(&'static str, Self)] = &[
        ("pressed", Self("pressed")),
        ("released", Self("released")),
        ("clicked", Self("clicked")),
        ("double_tapped", Self("double_tapped")),
        ("long_pressed", Self("long_pressed")),
        ("swiped", Self("swiped")),
        ("swiped_north", Self("swiped_north")),
        ("swiped_east", Self("swiped_east")),
        ("swiped_south", Self("swiped_south")),
        ("swiped_west", Self("swiped_west")),
        ("hard_pressed", Self("hard_pressed")),
        ("hard_released", Self("hard_released")),
        ("cancelled", Self("cancelled")),
        ("changed", Self("changed")),
        ("switched_on", Self("switched_on")),
        ("switched_off", Self("switched_off")),
        ("ticked", Self("ticked")),
        ("armed", Self("armed")),
        ("disarmed", Self("disarmed")),
        ("warned", Self("warned")),
        ("refused", Self("refused")),
    ];
}
