//! Assignment of feet to people: contacts that land and stand near each other belong to one person.
//!
//! The engine identifies nobody. A contact belongs to the person with the nearest feet when it lands, within a long
//! step, unless that person has both feet down; it keeps its person until it lifts. Two people closer than a step may
//! exchange feet and then share a weight for a while; this has no other effect.

use std::time::Duration;

use arrayvec::ArrayVec;
use glam::Vec2;

use super::feet::FootHistory;
use super::weight::WeighingScale;
use crate::units::{Instant, Newtons};

/// Maximum length of a step, in metres.
const STRIDE_M: f32 = 1.1;

/// A contact that lands within this distance of a foot is part of the same foot, in metres: feet are wider.
pub(super) const SAME_FOOT_M: f32 = 0.12;

/// Contacts within this distance of each other may be parts of one foot that the tracker has not merged yet, in
/// metres. Contacts lighter than this, in newtons, are traces. Neither counts as two feet.
const ONE_FOOT_M: f32 = 0.2;
const TRACE_N: f32 = 40.0;

/// Two people do not stand on one leg each within this distance of each other, in metres.
pub(super) const STANCE_M: f32 = 0.45;

/// A foot that returns to its earlier place lands within this distance, in metres (our choice: people who turn on the
/// spot land further off).
const BACK_M: f32 = 0.03;

/// Time for which a foot that has left is stored; a person without feet on the floor too.
const REMEMBERED: Duration = Duration::from_secs(5);

/// Maximum time since a foot left for it to be the one that lands now.
const SWINGING: Duration = Duration::from_millis(1500);

/// A foot that has left the floor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left {
    at: Instant,
    place: Vec2,
    /// Whether it pressed a control.
    pressed: bool,
}

/// One person on the floor.
#[derive(Clone, Debug)]
pub(super) struct TrackedPerson {
    pub(super) id: u32,
    left: ArrayVec<Left, 8>,
    scale: WeighingScale,
    /// Sum of the person's contacts now.
    pub(super) sum: f32,
    /// Maximum sum so far.
    pub(super) carried: f32,
    seen: Instant,
}

impl TrackedPerson {
    pub(super) fn new(id: u32, now: Instant) -> Self {
        Self { id, left: ArrayVec::new(), scale: WeighingScale::default(), sum: 0.0, carried: 0.0, seen: now }
    }

    /// The person's weight; `None` until it is known.
    pub(super) fn weight(&self) -> Option<Newtons> {
        self.scale.weight()
    }

    /// Length of a step of this person to `place`, given all `feet`; `None` if out of reach.
    ///
    /// The earlier place of a foot that has left does not count while the other foot stands more than a step away.
    pub(super) fn reach_to(&self, place: Vec2, feet: &[FootHistory], now: Instant) -> Option<f32> {
        let mine = || feet.iter().filter(|foot| foot.person == self.id && !foot.is_object());
        let distances = || mine().map(|foot| foot.place.distance(place));
        let nearest = distances().fold(f32::INFINITY, f32::min);
        if nearest <= ONE_FOOT_M {
            return Some(nearest);
        }
        if self.has_both_down(feet) || distances().any(|distance| distance > STRIDE_M) {
            return None;
        }
        let left = self.left.iter().filter(|left| now.since(left.at) <= SWINGING);
        let nearest = left.map(|left| left.place.distance(place)).fold(nearest, f32::min);
        (nearest <= STRIDE_M).then_some(nearest)
    }

    /// Whether two feet of the person are on the floor.
    fn has_both_down(&self, feet: &[FootHistory]) -> bool {
        let firm = || {
            feet.iter()
                .filter(|foot| foot.person == self.id && !foot.is_object())
                .filter(|foot| foot.force >= TRACE_N)
        };
        firm().any(|one| firm().any(|other| one.place.distance(other.place) > ONE_FOOT_M))
    }

    /// Whether this person and the `other` one, each with one foot down, stand as one person does.
    pub(super) fn is_one_with(&self, other: &Self, feet: &[FootHistory]) -> bool {
        let of = |id: u32| feet.iter().filter(move |foot| foot.person == id && !foot.is_object());
        let near = |one: &FootHistory| of(other.id).any(|foot| foot.place.distance(one.place) <= STANCE_M);
        of(self.id).any(near) && !self.has_both_down(feet) && !other.has_both_down(feet)
    }

    /// Whether a foot that lands at `place` steps there, rather than returning to its earlier place after a press.
    pub(super) fn steps_to(&self, place: Vec2, now: Instant) -> bool {
        let back = |left: &Left| left.place.distance(place) <= BACK_M;
        let pressed = |left: &Left| left.pressed && now.since(left.at) <= SWINGING;
        !self.left.iter().any(|left| back(left) || pressed(left))
    }

    /// Time since a foot last left that had pressed no control.
    pub(super) fn last_left(&self, now: Instant) -> Option<Duration> {
        self.left.iter().filter(|left| !left.pressed).map(|left| now.since(left.at)).min()
    }

    /// Notes that a foot of the person has left the floor.
    pub(super) fn leave(&mut self, foot: &FootHistory, now: Instant) {
        if self.left.is_full() {
            self.left.remove(0);
        }
        self.left.push(Left { at: now, place: foot.place, pressed: foot.pressing });
    }

    /// Processes the sum of the person's contacts.
    pub(super) fn carry(&mut self, sum: f32, now: Instant) {
        self.sum = sum;
        self.carried = self.carried.max(sum);
        self.scale.weigh(sum, now);
        if sum > 0.0 {
            self.seen = now;
        }
        while self.left.first().is_some_and(|left| now.since(left.at) > REMEMBERED) {
            self.left.remove(0);
        }
    }

    pub(super) fn is_forgotten(&self, now: Instant) -> bool {
        now.since(self.seen) > REMEMBERED
    }
}
