//! TUIO 1.1: cursors and blobs.

use std::f32::consts::FRAC_PI_4;

use rosc::{OscPacket, OscType};

use super::tuio::{
    LastContacts, News, ReportedContact, SHOE_M, Surface, heaviest, message, send_frame, session,
};
use crate::floor::Geometry;
use crate::sense::{Contact, ContactId};
use crate::units::Instant;

const CURSOR: &str = "/tuio/2Dcur";
const BLOB: &str = "/tuio/2Dblb";

/// Makes a `set` message of a profile.
type Set = fn(&Surface, &News) -> OscPacket;

/// Contacts as TUIO 1.1 cursors (`2Dcur`) and blobs (`2Dblb`).
///
/// Positions run from 0 to 1, from the floor's north-west corner, y towards the south; speeds are in floors per
/// second. A blob has the size of a shoe, since the floor does not measure outlines. It points along the foot if the
/// foot is on two tiles (half a turn at most: heel and toe look alike); its rotation speed is not measured.
///
/// # Source
/// TUIO 1.1 protocol specification (tuio.org).
#[derive(Debug)]
pub struct Tuio1 {
    surface: Surface,
    memory: LastContacts,
    source: String,
    /// The number of the next bundle.
    next: i32,
    profiles: TuioProfiles,
}

/// TUIO 1.1 profiles that represent a foot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TuioProfiles {
    /// `2Dcur` only: for clients that treat a blob as a second touch.
    Cursors,
    /// `2Dblb` only.
    Blobs,
    /// Each foot is a cursor and a blob.
    #[default]
    Both,
}

impl Tuio1 {
    /// An encoder for a floor of this geometry. `source` is its name, such as `underfoot@10.0.0.5`; its bundles are
    /// numbered from `first` on ([`super::tuio_first_frame`]).
    #[must_use]
    pub fn new(geometry: &Geometry, source: &str, first: i32) -> Self {
        let surface = Surface::of(geometry);
        let profiles = TuioProfiles::default();
        Self { surface, memory: LastContacts::of(surface), source: source.into(), next: first, profiles }
    }

    /// Sets the profiles.
    #[must_use]
    pub fn with_profiles(mut self, profiles: TuioProfiles) -> Self {
        self.profiles = profiles;
        self
    }

    /// Passes each datagram of one frame to `send`, none larger than [`super::TUIO_DATAGRAM`]; returns the number of
    /// contacts left out.
    ///
    /// A bundle per profile holds `source`, `alive` with all contacts, `set` with those that have changed (all of
    /// them once a second) and `fseq`; a frame that is too large takes several bundles, each with its own `fseq` and
    /// an `alive` without the new contacts that are still to be set. Without contacts `alive` is empty, which is also
    /// the goodbye.
    pub fn write(&mut self, at: Instant, contacts: &[Contact], mut send: impl FnMut(&[u8])) -> usize {
        let (contacts, left_out) = heaviest(contacts);
        let news = self.memory.news(at, &contacts);
        let both: [(&str, Set); 2] = [(CURSOR, cursor), (BLOB, blob)];
        let wanted = match self.profiles {
            TuioProfiles::Cursors => 0..1,
            TuioProfiles::Blobs => 1..2,
            TuioProfiles::Both => 0..2,
        };
        for &(profile, set) in both.get(wanted).unwrap_or_default() {
            let word = |word: &str| OscType::String(word.into());
            let bundle = |number, ids, sets| {
                let alive = std::iter::once(word("alive")).chain::<Vec<OscType>>(ids).collect();
                let source = message(profile, vec![word("source"), word(&self.source)]);
                let mut content = vec![source, message(profile, alive)];
                content.extend::<Vec<OscPacket>>(sets);
                content.push(message(profile, vec![word("fseq"), OscType::Int(number)]));
                content
            };
            let set = |news: &News| set(&self.surface, news);
            send_frame(&mut self.next, &contacts, &news, set, bundle, &mut send);
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
fn cursor(_: &Surface, news: &News) -> OscPacket {
    let ReportedContact { place, velocity, acceleration, .. } = news.told;
    set(CURSOR, news.id, [place.x, place.y, velocity.x, velocity.y, acceleration])
}

/// `set s x y a w h f X Y A m r`.
fn blob(surface: &Surface, news: &News) -> OscPacket {
    let ReportedContact { place, velocity, acceleration, angle, .. } = news.told;
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
    set(BLOB, news.id, floats)
}
