//! A contact on its way to the gateway.

use glam::Vec2;
use serde::{Deserialize, Serialize};
use underfoot::sense::{Contact, ContactId};
use underfoot::units::Newtons;

/// What a node tells of one contact, in floor metres and newtons.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NodeContact {
    /// The node's name for it.
    pub id: u32,
    /// Where it is.
    pub at: [f32; 2],
    /// What it presses.
    pub force: f32,
    /// How fast it moves, in metres per second.
    pub velocity: [f32; 2],
    /// Where the foot points, as far as that is known: see [`Contact::difference`].
    pub difference: Option<[f32; 2]>,
    /// Whether it may be two feet.
    pub ambiguous: bool,
}

impl NodeContact {
    /// What is told of `contact`.
    #[must_use]
    pub fn of(contact: &Contact) -> Self {
        Self {
            id: contact.id.0,
            at: contact.centroid.into(),
            force: contact.force.0,
            velocity: contact.velocity.into(),
            difference: contact.difference.map(Into::into),
            ambiguous: contact.ambiguous,
        }
    }

    /// Where it is.
    #[must_use]
    pub fn place(&self) -> Vec2 {
        self.at.into()
    }

    /// Whether all its numbers are ones that a contact can have.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let difference = self.difference.unwrap_or_default();
        let all = [self.at, self.velocity, difference, [self.force, 0.0]];
        all.as_flattened().iter().all(|number| number.is_finite())
    }

    /// The same contact as outputs take it, called `id`. What they don't tell is missing.
    #[must_use]
    pub fn contact(&self, id: u32) -> Contact {
        Contact {
            id: ContactId(id),
            centroid: self.place(),
            force: Newtons(self.force),
            velocity: self.velocity.into(),
            difference: self.difference.map(Into::into),
            ambiguous: self.ambiguous,
            ..Contact::default()
        }
    }

    /// How it was `share` (0 to 1) of the way from `self` to `later`.
    #[must_use]
    pub fn towards(&self, later: &Self, share: f32) -> Self {
        let between = |from: f32, to: f32| from + (to - from) * share;
        let pair = |from: [f32; 2], to: [f32; 2]| [between(from[0], to[0]), between(from[1], to[1])];
        Self {
            at: pair(self.at, later.at),
            force: between(self.force, later.force),
            velocity: pair(self.velocity, later.velocity),
            ..*later
        }
    }
}
