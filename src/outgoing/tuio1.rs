//! TUIO 1.1: cursors and blobs.

use std::f32::consts::FRAC_PI_4;

use rosc::{OscPacket, OscType};

use super::tuio::{Memory, SHOE_M, Surface, Told, heaviest, message, send_frame, session};
use crate::floor::Geometry;
use crate::sense::{Contact, ContactId};
use crate::units::Instant;

const CURSOR: &str = "/tuio/2Dcur";
const BLOB: &str = "/tuio/2Dblb";

/// Contacts as TUIO 1.1 cursors (`2Dcur`) and blobs (`2Dblb`).
///
/// Positions run from 0 to 1, from the floor's north-west corner, y towards the
/// south; speeds are in floors per second. A blob has the size of a shoe, for
/// the floor feels no outlines, and points along the foot where two tiles hint
/// at it (half a turn at most: heel and toe look alike); that it turns is not measured.
///
/// # Source
/// TUIO 1.1 protocol specification (tuio.org).
#[derive(Debug)]
pub struct Tuio1 {
    surface: Surface,
    memory: Memory,
    source: String,
    frame: i32,
}

impl Tuio1 {
    /// An encoder for a floor of this geometry, that calls itself `source`, such as `underfoot@10.0.0.5`.
    #[must_use]
    pub fn new(geometry: &Geometry, source: &str) -> Self {
        let surface = Surface::of(geometry);
        Self { surface, memory: Memory::of(surface), source: source.into(), frame: 0 }
    }

    /// Gives each datagram of one frame to `send`, none larger than [`super::TUIO_DATAGRAM`];
    /// gives back how many contacts had no room.
    ///
    /// A bundle per profile holds `source`, `alive` with all contacts, `set` with those that have
    /// changed (all of them once a second) and `fseq`; a frame that is too large takes several
    /// bundles with the same `source`, `alive` and `fseq`. Without contacts `alive` is empty:
    /// that is also the goodbye.
    pub fn write(&mut self, at: Instant, contacts: &[Contact], mut send: impl FnMut(&[u8])) -> usize {
        self.frame = if self.frame == i32::MAX { 1 } else { self.frame + 1 };
        let (contacts, left_out) = heaviest(contacts);
        let news = self.memory.news(at, &contacts);
        for (profile, set) in [(CURSOR, cursor as fn(&Surface, ContactId, &Told) -> OscPacket), (BLOB, blob)]
        {
            let word = |word: &str| OscType::String(word.into());
            let mut alive = vec![word("alive")];
            alive.extend(contacts.iter().map(|contact| session(contact.id)));
            let first = [message(profile, vec![word("source"), word(&self.source)]), message(profile, alive)];
            let sets = news.iter().map(|(id, told)| set(&self.surface, *id, told)).collect();
            let last = [message(profile, vec![word("fseq"), OscType::Int(self.frame)])];
            send_frame(&first, sets, &last, &mut send);
        }
        left_out
    }
}

fn set(profile: &str, id: ContactId, floats: impl IntoIterator<Item = f32>) -> OscPacket {
    let mut args = vec![OscType::String("set".into()), session(id)];
    args.extend(floats.into_iter().map(OscType::Float));
    message(profile, args)
}

/// `set s x y X Y m`.
fn cursor(_: &Surface, id: ContactId, told: &Told) -> OscPacket {
    let Told { place, velocity, acceleration, .. } = *told;
    set(CURSOR, id, [place.x, place.y, velocity.x, velocity.y, acceleration])
}

/// `set s x y a w h f X Y A m r`.
fn blob(surface: &Surface, id: ContactId, told: &Told) -> OscPacket {
    let Told { place, velocity, acceleration, angle, .. } = *told;
    let size = SHOE_M / surface.size();
    let area = FRAC_PI_4 * size.x * size.y;
    let (turning, turning_change) = (0.0, 0.0);
    let floats = [
        place.x,
        place.y,
        angle,
        size.x,
        size.y,
        area,
        velocity.x,
        velocity.y,
        turning,
        acceleration,
        turning_change,
    ];
    set(BLOB, id, floats)
}
