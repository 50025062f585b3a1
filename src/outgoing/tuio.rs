//! Common parts of both TUIO versions: a unit square seen from above, and frames in small datagrams.

use std::collections::HashMap;

use glam::Vec2;
use rosc::{OscMessage, OscPacket, OscTime, OscType, encoder};

use super::osc::at_once;
use crate::floor::Geometry;
use crate::sense::{Contact, ContactId};
use crate::units::Instant;
use crate::wire::write;

/// Maximum size of a datagram, in bytes: the size that every network carries unfragmented (1500 less the headers of
/// IP and UDP), and that clients with a buffer of 1536 bytes do not truncate.
pub const TUIO_DATAGRAM: usize = 1472;

/// Maximum number of contacts of one frame: their ids still fit into one datagram.
pub const TUIO_CONTACTS: usize = 200;

/// Maximum time between two full reports of all contacts, changed or not: datagrams may be lost.
pub(super) const REFRESH: std::time::Duration = std::time::Duration::from_secs(1);

/// Length and width of a shoe, in metres; the floor does not measure outlines.
pub(super) const SHOE_M: Vec2 = Vec2::new(0.27, 0.10);

/// The floor in TUIO coordinates: 1 wide and 1 high, from the north-west corner, y towards the south.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    size: Vec2,
}

impl Surface {
    pub(super) fn of(geometry: &Geometry) -> Self {
        Self { size: geometry.bounds().size() }
    }

    /// Returns width and height, in metres.
    pub(super) const fn size(&self) -> Vec2 {
        self.size
    }

    /// Converts a place to the surface, 0 to 1 both ways; clamps places beyond the floor to its edge.
    pub(super) fn place(&self, at: Vec2) -> Vec2 {
        let share = (at / self.size).clamp(Vec2::ZERO, Vec2::ONE);
        Vec2::new(share.x, 1.0 - share.y)
    }

    /// Converts metres per second to surfaces per second.
    pub(super) fn velocity(&self, velocity: Vec2) -> Vec2 {
        Vec2::new(velocity.x, -velocity.y) / self.size
    }
}

/// The reported state of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ReportedContact {
    pub(super) place: Vec2,
    pub(super) velocity: Vec2,
    /// Change of speed, in surfaces per second squared.
    pub(super) acceleration: f32,
    /// Direction of the foot, clockwise from the x axis, 0 up to half a turn: heel and toe are indistinguishable.
    pub(super) angle: f32,
    pub(super) force: f32,
    /// Change of force, in newtons per second.
    pub(super) force_change: f32,
}

/// A contact to report in this frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct News {
    pub(super) id: ContactId,
    pub(super) told: ReportedContact,
    /// Whether this is its first report.
    is_new: bool,
}

#[derive(Clone, Copy, Debug)]
struct Known {
    told: ReportedContact,
    at: Instant,
}

/// The contacts of the last frame, from which it selects the ones to report in the next frame.
#[derive(Debug)]
pub(super) struct LastContacts {
    surface: Surface,
    known: HashMap<ContactId, Known>,
    refreshed: Option<Instant>,
}

impl LastContacts {
    pub(super) fn of(surface: Surface) -> Self {
        Self { surface, known: HashMap::new(), refreshed: None }
    }

    /// Returns the `contacts` that are new or changed, or all of them if a full report is due.
    pub(super) fn news(&mut self, at: Instant, contacts: &[&Contact]) -> Vec<News> {
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
                news.push(News { id: contact.id, told, is_new: before.is_none() });
            }
        }
        news
    }

    fn told(&self, at: Instant, contact: &Contact, before: Option<Known>) -> ReportedContact {
        let velocity = self.surface.velocity(contact.velocity);
        // Without a second tile the direction is unknown: it keeps its last value, at first north.
        let angle = match contact.difference {
            Some(difference) if difference != Vec2::ZERO => {
                (-difference.y).atan2(difference.x).rem_euclid(std::f32::consts::PI)
            }
            _ => before.map_or(std::f32::consts::FRAC_PI_2, |before| before.told.angle),
        };
        let rate = |now: f32, then: fn(&ReportedContact) -> f32| {
            let Some(before) = before else { return 0.0 };
            let seconds = at.since(before.at).as_secs_f32();
            if seconds > 0.0 { (now - then(&before.told)) / seconds } else { 0.0 }
        };
        let force = contact.force.0;
        ReportedContact {
            place: self.surface.place(contact.centroid),
            velocity,
            acceleration: rate(velocity.length(), |told| told.velocity.length()),
            angle,
            force,
            force_change: rate(force, |told| told.force),
        }
    }
}

/// Returns the heaviest of `contacts` up to the maximum, in order of their ids, and the number of contacts left out.
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

/// Returns a session id: TUIO's are signed, contact ids are unsigned.
pub(super) fn session(id: ContactId) -> OscType {
    OscType::Int(id.0.cast_signed())
}

pub(super) fn message(address: &str, args: Vec<OscType>) -> OscPacket {
    OscPacket::Message(OscMessage { addr: address.into(), args })
}

/// Frame numbers per second of the clock: about the maximum mean rate of datagrams of a floor.
const NUMBERS_PER_SECOND: u64 = 500;

/// Returns the number of the first frame of a program that starts at `clock`, 1 to `i32::MAX`.
///
/// Clients treat a smaller number than the last as a late datagram, so a restarted program has to continue above its
/// last number. The numbers restart after 49 days.
#[must_use]
pub fn tuio_first_frame(clock: OscTime) -> i32 {
    let fraction = (u64::from(clock.fractional) * NUMBERS_PER_SECOND) >> 32;
    let number = (u64::from(clock.seconds) * NUMBERS_PER_SECOND + fraction) % i32::MAX.cast_unsigned() as u64;
    i32::try_from(number + 1).unwrap_or(1)
}

/// Returns the frame number after `number`: always positive.
const fn following(number: i32) -> i32 {
    if number < 1 || number == i32::MAX { 1 } else { number + 1 }
}

/// Sends one frame in as many bundles as needed, at least one; `next` is the number of the next bundle.
///
/// `bundle` makes a bundle from its number, the ids of the alive contacts, and the messages made by `set`. Clients
/// treat each bundle as a frame, drop a bundle with a known number, and invent a place for contacts that are alive
/// but were never set. Therefore each bundle has its own number, and a new contact is alive only from the bundle on
/// that sets it.
pub(super) fn send_frame(
    next: &mut i32,
    contacts: &[&Contact],
    news: &[News],
    set: impl Fn(&News) -> OscPacket,
    bundle: impl Fn(i32, Vec<OscType>, Vec<OscPacket>) -> Vec<OscPacket>,
    mut send: impl FnMut(&[u8]),
) {
    let size = |packet: &OscPacket| encoder::encode(packet).map_or(0, |bytes| bytes.len() + 4);
    let everybody = contacts.iter().map(|contact| session(contact.id)).collect();
    // The tag "#bundle", the time, and the content common to all bundles.
    let frame = 16 + bundle(1, everybody, Vec::new()).iter().map(size).sum::<usize>();
    let mut unset: Vec<ContactId> = news.iter().filter(|news| news.is_new).map(|news| news.id).collect();
    let mut bytes = Vec::new();
    let mut news = news.iter().map(|news| (news.id, set(news))).peekable();
    loop {
        let (mut sets, mut used) = (Vec::new(), frame);
        while let Some((id, packet)) =
            news.next_if(|(_, packet)| sets.is_empty() || used + size(packet) <= TUIO_DATAGRAM)
        {
            used += size(&packet);
            unset.retain(|unset| *unset != id);
            sets.push(packet);
        }
        let alive = contacts.iter().filter(|contact| !unset.contains(&contact.id));
        let content = bundle(*next, alive.map(|contact| session(contact.id)).collect(), sets);
        *next = following(*next);
        write(&at_once(content), &mut bytes);
        send(&bytes);
        if news.peek().is_none() {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_starts_later_begins_with_a_larger_number() {
        let at = |seconds, fractional| tuio_first_frame(OscTime { seconds, fractional });
        let then = at(3_900_000_000, 0);
        assert!(then > 0);
        // A hundred seconds of 500 numbers each later, and half a second.
        assert_eq!(at(3_900_000_100, 0) - then, 50_000);
        assert_eq!(at(3_900_000_000, 1 << 31) - then, 250);
        for seconds in [0, 1, 4_294_967, u32::MAX] {
            assert!(at(seconds, u32::MAX) >= 1);
        }
        assert_eq!([0, 1, i32::MAX, -5].map(following), [1, 2, 1, 1]);
    }
}
