//! What both versions of TUIO have in common: a unit square seen from above, and frames in small datagrams.

use std::collections::HashMap;

use glam::Vec2;
use rosc::{OscBundle, OscMessage, OscPacket, OscTime, OscType, encoder};

use crate::floor::Geometry;
use crate::sense::{Contact, ContactId};
use crate::units::Instant;
use crate::wire::write;

/// Largest datagram, in bytes: what every network carries whole (1500 less the headers of IP and UDP),
/// and what clients with a buffer of 1536 bytes don't cut.
pub const TUIO_DATAGRAM: usize = 1472;

/// Most contacts of one frame: so many names still fit into one datagram.
pub const TUIO_CONTACTS: usize = 200;

/// Time that all contacts are sent at the latest, changed or not: datagrams may be lost.
pub(super) const REFRESH: std::time::Duration = std::time::Duration::from_secs(1);

/// A shoe's length and width, in metres; the floor feels no outlines.
pub(super) const SHOE_M: Vec2 = Vec2::new(0.27, 0.10);

/// The floor as TUIO sees it: 1 wide and 1 high, from the north-west corner, y towards the south.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    size: Vec2,
}

impl Surface {
    pub(super) fn of(geometry: &Geometry) -> Self {
        Self { size: geometry.bounds().size() }
    }

    /// Width and height, in metres.
    pub(super) const fn size(&self) -> Vec2 {
        self.size
    }

    /// A place on the surface, 0 to 1 both ways; places beyond the floor are moved to its edge.
    pub(super) fn place(&self, at: Vec2) -> Vec2 {
        let share = (at / self.size).clamp(Vec2::ZERO, Vec2::ONE);
        Vec2::new(share.x, 1.0 - share.y)
    }

    /// Metres per second as surfaces per second.
    pub(super) fn velocity(&self, velocity: Vec2) -> Vec2 {
        Vec2::new(velocity.x, -velocity.y) / self.size
    }
}

/// What is told of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Told {
    pub(super) place: Vec2,
    pub(super) velocity: Vec2,
    /// Change of speed, in surfaces per second squared.
    pub(super) acceleration: f32,
    /// Direction of the foot, clockwise from the x axis, 0 up to half a turn: heel and toe are not told apart.
    pub(super) angle: f32,
    pub(super) force: f32,
    /// Change of force, in newtons per second.
    pub(super) force_change: f32,
}

#[derive(Clone, Copy, Debug)]
struct Known {
    told: Told,
    at: Instant,
}

/// The contacts of the last frame, and which of those of the next one have to be told.
#[derive(Debug)]
pub(super) struct Memory {
    surface: Surface,
    known: HashMap<ContactId, Known>,
    refreshed: Option<Instant>,
}

impl Memory {
    pub(super) fn of(surface: Surface) -> Self {
        Self { surface, known: HashMap::new(), refreshed: None }
    }

    /// Those of `contacts` that are new or have changed, or all of them if that is due.
    pub(super) fn news(&mut self, at: Instant, contacts: &[&Contact]) -> Vec<(ContactId, Told)> {
        let refresh = self.refreshed.is_none_or(|last| at.since(last) >= REFRESH);
        if refresh {
            self.refreshed = Some(at);
        }
        self.known.retain(|id, _| contacts.iter().any(|contact| contact.id == *id));
        let mut news = Vec::new();
        for contact in contacts {
            let before = self.known.get(&contact.id).copied();
            let told = self.told(at, contact, before);
            if refresh || before.is_none_or(|before| before.told != told) {
                self.known.insert(contact.id, Known { told, at });
                news.push((contact.id, told));
            }
        }
        news
    }

    fn told(&self, at: Instant, contact: &Contact, before: Option<Known>) -> Told {
        let velocity = self.surface.velocity(contact.velocity);
        // Without a second tile nothing hints at the direction: as it was, at first to the north.
        let angle = match contact.difference {
            Some(difference) if difference != Vec2::ZERO => {
                (-difference.y).atan2(difference.x).rem_euclid(std::f32::consts::PI)
            }
            _ => before.map_or(std::f32::consts::FRAC_PI_2, |before| before.told.angle),
        };
        let rate = |now: f32, then: fn(&Told) -> f32| {
            let Some(before) = before else { return 0.0 };
            let seconds = at.since(before.at).as_secs_f32();
            if seconds > 0.0 { (now - then(&before.told)) / seconds } else { 0.0 }
        };
        let force = contact.force.0;
        Told {
            place: self.surface.place(contact.centroid),
            velocity,
            acceleration: rate(velocity.length(), |told| told.velocity.length()),
            angle,
            force,
            force_change: rate(force, |told| told.force),
        }
    }
}

/// The heaviest of `contacts`, as many as fit, in order of their names, and how many are left out.
pub(super) fn heaviest(contacts: &[Contact]) -> (Vec<&Contact>, usize) {
    let mut all: Vec<&Contact> = contacts.iter().collect();
    let left_out = all.len().saturating_sub(TUIO_CONTACTS);
    if left_out > 0 {
        all.sort_by(|a, b| b.force.0.total_cmp(&a.force.0));
        all.truncate(TUIO_CONTACTS);
    }
    all.sort_by_key(|contact| contact.id);
    (all, left_out)
}

/// A session id: TUIO's have a sign, ours don't.
pub(super) fn session(id: ContactId) -> OscType {
    OscType::Int(id.0.cast_signed())
}

pub(super) fn message(address: &str, args: Vec<OscType>) -> OscPacket {
    OscPacket::Message(OscMessage { addr: address.into(), args })
}

/// Sends one frame: `first`, as many of `news` as fit, `last`; in as many bundles as it takes, at least one.
///
/// Every bundle has the same beginning and end, so that each can be read by itself.
pub(super) fn send_frame(
    first: &[OscPacket],
    news: Vec<OscPacket>,
    last: &[OscPacket],
    mut send: impl FnMut(&[u8]),
) {
    let size = |packet: &OscPacket| encoder::encode(packet).map_or(0, |bytes| bytes.len() + 4);
    // The tag "#bundle", and the time.
    let frame = 16 + first.iter().chain(last).map(size).sum::<usize>();
    let mut bytes = Vec::new();
    let mut bundle = |content: Vec<OscPacket>| {
        let content = first.iter().cloned().chain(content).chain(last.iter().cloned()).collect();
        let timetag = OscTime { seconds: 0, fractional: 1 };
        bytes.clear();
        write(&OscPacket::Bundle(OscBundle { timetag, content }), &mut bytes);
        send(&bytes);
    };
    let (mut content, mut used) = (Vec::new(), frame);
    for packet in news {
        let more = size(&packet);
        if used + more > TUIO_DATAGRAM && !content.is_empty() {
            bundle(std::mem::take(&mut content));
            used = frame;
        }
        used += more;
        content.push(packet);
    }
    bundle(content);
}
