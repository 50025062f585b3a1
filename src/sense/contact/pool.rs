//! Contacts in reused objects.

use smallvec::SmallVec;

use super::{Contact, ContactId, Covariance, TileLoad};
use crate::sense::Quality;

/// The contacts of one frame, in reused objects.
///
/// A contact on many tiles keeps its list on the heap; reuse of the objects keeps those lists too, so that nothing is
/// allocated once the floor has been at its fullest.
#[derive(Clone, Debug, Default)]
pub(in crate::sense) struct ContactPool {
    contacts: Vec<Contact>,
    used: usize,
}

impl ContactPool {
    /// A pool of `contacts` contacts at first, each with room for [`ROOM`] tiles.
    pub(in crate::sense) fn with_capacity(contacts: usize) -> Self {
        let mut pool = Self { contacts: Vec::with_capacity(contacts), used: 0 };
        pool.contacts.resize_with(contacts, roomy);
        pool
    }

    pub(in crate::sense) fn clear(&mut self) {
        self.used = 0;
    }

    /// A contact with the identifier `id` and default values.
    #[inline]
    pub(in crate::sense) fn add(&mut self, id: ContactId) -> &mut Contact {
        if self.used == self.contacts.len() {
            self.contacts.push(roomy());
        }
        self.used += 1;
        let contact = &mut self.contacts[self.used - 1];
        contact.id = id;
        contact.tiles.clear();
        contact.covariance = Covariance::default();
        contact.ambiguous = false;
        contact.split = false;
        contact.quality = Quality::Live;
        contact.difference = None;
        contact
    }

    pub(in crate::sense) fn contacts_mut(&mut self) -> &mut [Contact] {
        self.contacts.get_mut(..self.used).unwrap_or_default()
    }

    pub(in crate::sense) fn contacts(&self) -> &[Contact] {
        self.contacts.get(..self.used).unwrap_or_default()
    }
}

/// Number of tiles that a contact of the pool holds without allocation: two feet on four tiles each, and a few more.
const ROOM: usize = 12;

fn roomy() -> Contact {
    Contact { tiles: SmallVec::with_capacity(ROOM), ..Contact::default() }
}

impl Contact {
    /// Sorts the tiles, heaviest first, and derives the difference vector from them.
    pub(in crate::sense) fn finish(&mut self) {
        let order = |a: &TileLoad, b: &TileLoad| b.force.0.total_cmp(&a.force.0).then(a.index.cmp(&b.index));
        match &mut self.tiles[..] {
            [] | [_] => {}
            // The usual case of several tiles.
            [first, second] => {
                if order(first, second).is_gt() {
                    std::mem::swap(first, second);
                }
            }
            tiles => tiles.sort_unstable_by(order),
        }
        self.difference = Self::difference_of(&self.tiles);
    }
}
