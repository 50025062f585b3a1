//! One contact with its history: time of landing, motion, and whether it is a foot that may press.

use std::time::Duration;

use glam::Vec2;

use super::super::ignored::Ignored;
use super::super::people::{SAME_FOOT_M, STANCE_M, TrackedPerson};
use super::super::snapshot::FootRole;
use super::super::step::{CARRIES, HeldSince, Landing, Loading, RESTS, RESTS_N, StepWatch, Support};
use super::super::still::Stillness;
use super::past::{PLACE_EVERY, Past, PastLoad};
use crate::sense::{Contact, ContactId};
use crate::units::Instant;
use crate::widget::Guard;

/// Number of recorded places from which the rolling velocity of a supporting foot follows, and number of the latest
/// ones to skip: in the last tenth of a second the tracker may have merged the landing foot into this one.
const ROLL_PLACES: usize = 13;
const SKIPPED_PLACES: usize = 5;

/// Time that a foot must have been down before it starts a guarded control (fault R8), and how steady it must be:
/// over the last tenth of a second its force changes by at most this share, and its place by at most this distance in
/// metres.
const SETTLED: Duration = Duration::from_millis(300);
const STEADY_PLACES: usize = 4;
const STEADY_SHARE: f32 = 0.2;
const STEADY_M: f32 = 0.015;

/// A jump or a fall: the load drops below this share of its maximum over so many recorded places. A foot that returns
/// from a control to the floor lowers the load by less than a fifth for a moment.
const FALLEN: f32 = 0.6;
const FALL_PLACES: usize = 15;

/// Minimum force on the other foot for it to count as standing, in newtons.
const STOOD_N: f32 = 150.0;

/// A press reaches this share of its force within this time; a shift of weight from foot to foot takes at least 0.3
/// s.
const EARLY: Duration = Duration::from_millis(150);
const AT_ONCE: f32 = 0.85;

/// Below this force a foot counts as lifted, in newtons: less than the release threshold of any control.
pub(in crate::engine) const AS_GOOD_AS_LIFTED_N: f32 = 8.0;

/// Minimum sum of a person's contacts for a share of it to be meaningful, in newtons.
const SUM_N: f32 = 250.0;

/// Minimum load on the person's other feet for such a share, in newtons.
const OTHERS_N: f32 = 50.0;

/// An ambiguous contact must split into two feet within this time of its mark.
const TOLD_APART: Duration = Duration::from_millis(100);

/// A foot that splits from another contact carries at least this share of its person's load from its first frame on;
/// a foot that lands reaches a tenth of a body no sooner than 5 ms after it has touched the floor (10 N a
/// millisecond, see [`super::super::step`]).
const TOLD_APART_SHARE: f32 = 0.1;

/// A foot belongs to another person if both this foot and the others carry at least this share of the person's load
/// at the landing, for at least this time (our choices: a person on both feet has half on each; a jump with both feet
/// loads more than a body for a tenth of a second).
const ANOTHER_BODY: f32 = 0.8;
const ANOTHER_FOR: Duration = Duration::from_millis(300);

/// The way of pressing to which a control responds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::engine) enum PressMode {
    /// A press that ends soon.
    Tap,
    /// A press that may last.
    Hold,
    /// A press that acts from its first moment on; its foot moves a value.
    Follow,
    /// A stance: the person stands on it.
    Stand,
}

/// One contact with its history.
#[derive(Clone, Debug)]
pub(in crate::engine) struct FootHistory {
    pub(in crate::engine) id: ContactId,
    pub(in crate::engine) person: u32,
    pub(in crate::engine) landed: Instant,
    pub(in crate::engine) landed_at: Vec2,
    pub(in crate::engine) place: Vec2,
    pub(in crate::engine) force: f32,
    /// Whether it has engaged a control since it landed.
    pub(in crate::engine) pressing: bool,
    /// Whether it came from elsewhere, rather than from a control back to its earlier place.
    stepped: bool,
    /// Whether the person stood on the other foot when it landed.
    pub(super) has_support: bool,
    pub(super) in_stance: bool,
    /// When the tracker last marked it as perhaps two feet.
    ambiguous: Option<Instant>,
    step: bool,
    watch: StepWatch,
    still: Stillness,
    /// Share of the body that it carries, if known.
    share: Option<f32>,
    /// Its force `EARLY` after the landing.
    early: Option<f32>,
    /// Load on the person's other feet at the last update.
    others: f32,
    /// The person's load when it landed, and since when it and the others have each carried about as much.
    before: f32,
    another: HeldSince,
    past: Past,
}

impl FootHistory {
    pub(super) fn new(contact: &Contact, person: &TrackedPerson, now: Instant) -> Self {
        let (place, force) = (contact.centroid, contact.force.0);
        Self {
            id: contact.id,
            person: person.id,
            landed: now,
            landed_at: place,
            place,
            force,
            pressing: false,
            stepped: person.steps_to(place, now),
            has_support: false,
            in_stance: false,
            ambiguous: may_be_two(contact).then_some(now),
            step: false,
            watch: StepWatch::default(),
            still: Stillness::new(force, place, now),
            share: None,
            early: None,
            others: 0.0,
            before: person.sum,
            another: HeldSince::default(),
            past: Past::new(PastLoad { place, force, others: 0.0 }, now),
        }
    }

    /// Whether it is an object left on the floor.
    pub(in crate::engine) fn is_object(&self) -> bool {
        self.still.is_object()
    }

    /// Whether it may be a cursor.
    ///
    /// # Errors
    /// It stands in a stance zone, or is an object.
    pub(in crate::engine) fn may_lead(&self) -> Result<(), Ignored> {
        if self.in_stance {
            Err(Ignored::Stance)
        } else if self.is_object() {
            Err(Ignored::Object)
        } else {
            Ok(())
        }
    }

    /// Whether a control of this mode may respond to it.
    ///
    /// # Errors
    /// It is an object, or it walks, stands or rests there.
    pub(in crate::engine) fn may_operate(&self, mode: PressMode, now: Instant) -> Result<(), Ignored> {
        if self.is_object() {
            Err(Ignored::Object)
        } else if self.is_step_on(mode, now) {
            Err(Ignored::Step)
        } else {
            Ok(())
        }
    }

    /// Whether it walks, stands or rests on a control of this mode.
    pub(super) fn is_step_on(&self, mode: PressMode, now: Instant) -> bool {
        match mode {
            PressMode::Tap => self.step || self.watch.stands(now) || self.watch.rests(now),
            PressMode::Hold | PressMode::Follow => {
                self.step || self.watch.stands(now) && self.took_weight_over()
            }
            PressMode::Stand => false,
        }
    }

    #[inline]
    pub(super) fn update(&mut self, contact: &Contact, now: Instant) {
        (self.place, self.force) = (contact.centroid, contact.force.0);
        if may_be_two(contact) {
            self.ambiguous = Some(now);
        }
        self.still.update(self.force, self.place, now);
        self.past.note(PastLoad { place: self.place, force: self.force, others: self.others }, now);
    }

    /// Mean velocity of its centre of pressure over the last quarter of a second, without the latest tenth.
    fn rolling(&self) -> Vec2 {
        let known = self.past.len().saturating_sub(SKIPPED_PLACES + 1).min(ROLL_PLACES);
        if known < ROLL_PLACES / 2 {
            return Vec2::ZERO;
        }
        let place = |ago: usize| self.past.ago(ago).place;
        let span = PLACE_EVERY.as_secs_f32() * known as f32;
        (place(SKIPPED_PLACES) - place(SKIPPED_PLACES + known)) / span
    }

    /// Whether the person jumps or falls: the other foot has left the floor within the last 0.3 s, and this one has
    /// not taken over its load.
    pub(in crate::engine) fn falls(&self) -> bool {
        let lately = || self.past.latest(FALL_PLACES);
        let others = lately().map(|past| past.others).fold(0.0, f32::max);
        let sum = lately().map(|past| past.others + past.force).fold(0.0, f32::max);
        others >= STOOD_N && self.others < FALLEN * others && self.others + self.force < FALLEN * sum
    }

    /// Whether it is, or recently was, at this place, where another contact lands now: two feet cannot stand in one
    /// place.
    pub(super) fn was_at(&self, place: Vec2) -> bool {
        let near = |at: Vec2| at.distance(place) <= SAME_FOOT_M;
        near(self.place) || self.past.latest(usize::MAX).any(|past| near(past.place))
    }

    /// Whether another contact of the same person, with a total of `sum` on the floor, is a foot that was down before
    /// as an undetected part of this one.
    pub(super) fn contained(&self, other: &Self, sum: f32, now: Instant) -> bool {
        self.ambiguous.is_some_and(|at| now.since(at) <= TOLD_APART)
            && self.place.distance(other.place) <= STANCE_M
            && other.force >= TOLD_APART_SHARE * sum.max(SUM_N)
    }

    /// Continues the history of `other`: this contact has not just landed. It is the same foot with a new id, a part
    /// of it split off for a while, or a second foot that stood undetected beside it.
    pub(super) fn go_on_as(&mut self, other: &Self) {
        (self.landed, self.landed_at) = (other.landed, other.landed_at);
        (self.step, self.stepped, self.has_support) = (other.step, other.stepped, other.has_support);
    }

    /// Sets the support and the step state from the landing.
    pub(super) fn land(&mut self, landing: &Landing) {
        self.has_support = landing.has_standing_support();
        self.step = landing.walks();
    }

    /// Whether its force and place are those of a tenth of a second ago, within the limits of a steady foot.
    fn is_steady(&self) -> bool {
        self.has_steady_force() && self.place.distance(self.past.ago(STEADY_PLACES).place) <= STEADY_M
    }

    /// Whether it was down a tenth of a second ago already, with the same force within `STEADY_SHARE`.
    fn has_steady_force(&self) -> bool {
        self.past.len() > STEADY_PLACES
            && (self.force - self.past.ago(STEADY_PLACES).force).abs() <= STEADY_SHARE * self.force
    }

    /// Whether its history allows it to start a press of a control with this `guard`.
    ///
    /// A control to stand on ([`PressMode::Stand`]) starts once the foot has settled. A guarded control starts once
    /// the foot has settled without taking the weight over, since that would be a step; a control that only requires
    /// confirmation starts at once if the other foot supports the person. A free control starts at once, except one
    /// that acts at once ([`PressMode::Follow`]): no foot on it may carry a body, and a foot without a standing foot
    /// beside it must have stopped gaining weight. A foot that lands in a walk stops gaining only when it is already
    /// classified as a step.
    pub(in crate::engine) fn is_meant(&self, mode: PressMode, guard: Guard, now: Instant) -> bool {
        let stays = || now.since(self.landed) >= SETTLED && self.is_steady();
        let settled = || stays() && !self.took_weight_over();
        match (mode, guard) {
            (PressMode::Stand, _) => stays(),
            (PressMode::Tap | PressMode::Hold, Guard::Free) => true,
            (PressMode::Follow, Guard::Free) => {
                (self.has_support || self.has_steady_force())
                    && self.share.is_none_or(|share| share < CARRIES)
            }
            (_, Guard::Confirm { .. }) => self.has_support || settled(),
            (_, Guard::HoldToRun { .. }) => settled(),
        }
    }

    /// Whether it carries as much as a resting foot and its force grew slowly: a press reaches its force at once, a
    /// shift of weight takes longer.
    fn took_weight_over(&self) -> bool {
        let rests = self.force >= RESTS_N && self.share.is_none_or(|share| share >= RESTS);
        rests && self.early.is_none_or(|early| early < AT_ONCE * self.force)
    }

    pub(super) fn as_support(&self, now: Instant) -> Support {
        Support {
            at: self.place,
            age: now.since(self.landed),
            stepped: self.stepped,
            rolling: self.rolling(),
        }
    }

    #[inline]
    pub(super) fn judge(&mut self, person: &TrackedPerson, now: Instant) {
        if self.force < AS_GOOD_AS_LIFTED_N {
            (self.landed, self.landed_at) = (now, self.place);
            (self.step, self.watch, self.early) = (false, StepWatch::default(), None);
            (self.before, self.another) = (person.sum, HeldSince::default());
            return;
        }
        let of_weight = person.weight().map(|weight| self.force / weight.0);
        let others = (person.sum - self.force).max(0.0);
        self.others = others;
        let is_another = self.before >= SUM_N && self.force.min(others) >= ANOTHER_BODY * self.before;
        self.another.note(is_another, now);
        let of_sum = (person.sum >= SUM_N && others >= OTHERS_N).then(|| self.force / person.sum);
        let share = match (of_weight, of_sum) {
            (Some(weight), Some(sum)) => Some(weight.max(sum)),
            (weight, sum) => weight.or(sum),
        };
        self.share = share;
        if now.since(self.landed) >= EARLY {
            self.early.get_or_insert(self.force);
        }
        let loading = Loading {
            force: self.force,
            share,
            age: now.since(self.landed),
            travelled: self.place.distance(self.landed_at),
            has_support: self.has_support,
        };
        self.step |= self.watch.is_step(&loading, now);
    }

    /// Whether it has carried a second body for long enough, in addition to the one that stood there at its landing.
    pub(super) fn bears_another_body(&self, now: Instant) -> bool {
        self.another.lasts(now) >= Some(ANOTHER_FOR)
    }

    /// Assigns the foot to another person.
    pub(super) fn give_to(&mut self, person: u32) {
        self.person = person;
        (self.others, self.before, self.another) = (0.0, 0.0, HeldSince::default());
    }

    pub(super) fn role(&self, now: Instant) -> FootRole {
        if self.is_object() {
            FootRole::Object
        } else if self.in_stance {
            FootRole::Stance
        } else if self.is_step_on(PressMode::Tap, now) {
            FootRole::Step
        } else {
            FootRole::Free
        }
    }
}

/// Whether `contact` may be two feet. A contact that split from another may not be a foot at all.
fn may_be_two(contact: &Contact) -> bool {
    contact.ambiguous && !contact.split
}
