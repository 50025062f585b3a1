//! A contact on its way to the gateway.

use glam::Vec2;
use serde::{Deserialize, Serialize};
use underfoot::sense::{Contact, ContactId};
use underfoot::units::Newtons;

/// One contact as a node reports it, in floor metres and newtons.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NodeContact {
    /// The node's number for it.
    pub id: u32,
    /// The centroid.
    pub at: [f32; 2],
    /// The force.
    pub force: f32,
    /// Its velocity, in metres per second.
    pub velocity: [f32; 2],
    /// The paper's difference vector between its two heaviest tiles, if known: see [`Contact::difference`].
    pub difference: Option<[f32; 2]>,
    /// Whether it may be two feet.
    pub ambiguous: bool,
}

impl NodeContact {
    /// The message form of `contact`.
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

    /// The centroid.
    #[must_use]
    pub fn place(&self) -> Vec2 {
        self.at.into()
    }

    /// Whether all its numbers are finite.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let difference = self.difference.unwrap_or_default();
        let all = [self.at, self.velocity, difference, [self.force, 0.0]];
        all.as_flattened().iter().all(|number| number.is_finite())
    }

    /// The same contact as outputs take it, with the number `id`. Fields that the message lacks keep their defaults.
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

    /// The contact interpolated at `share` (0 to 1) of the way from `self` to `later`.
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
