//! What is known of each contact beyond the present frame: since when it is down, how it moved,
//! whose it is, and whether it is a foot that may press at all.

use std::time::Duration;

use glam::Vec2;

use super::people::{Person, SAME_FOOT_M, STANCE_M};
use super::snapshot::{FootRole, FootState};
use super::step::{CARRIES, Landing, Loading, RESTS, RESTS_N, StepWatch, Support};
use super::still::Stillness;
use crate::layout::Stance;
use crate::sense::{Contact, ContactId};
use crate::units::{Instant, Newtons};
use crate::widget::Guard;

/// FootHistories and people for which there is room from the start; more cost an allocation once.
const ROOM: usize = 64;

/// How often a foot's place is kept, and how many of them: the last 0.4 s.
const PLACE_EVERY: Duration = Duration::from_millis(20);
const PLACES: usize = 20;

/// How a supporting foot rolls is taken from this many kept places before the latest five: in the
/// last tenth of a second the foot that lands may have been taken for a part of it.
const ROLL_PLACES: usize = 13;
const SKIPPED_PLACES: usize = 5;

/// How long a foot must have been down before it starts what must not start by accident (fault R8),
/// and how steady: over the last tenth of a second, by this share of its force and this far in metres.
const SETTLED: Duration = Duration::from_millis(300);
const STEADY_PLACES: usize = 4;
const STEADY_SHARE: f32 = 0.2;
const STEADY_M: f32 = 0.015;

/// Who jumps or falls is left by this share of what the floor carried within so many kept places; a
/// foot that goes from a control back to the floor leaves less than a fifth missing for a moment.
const FALLEN: f32 = 0.6;
const FALL_PLACES: usize = 15;

/// Least force on the other foot for it to count as standing, in newtons.
const STOOD_N: f32 = 150.0;

/// A press has most of its force after so long; weight is shifted from foot to foot in no less than 0.3 s.
const EARLY: Duration = Duration::from_millis(150);
const AT_ONCE: f32 = 0.85;

/// A support carries at least this much, in newtons.
const SUPPORT_N: f32 = 100.0;

/// A foot as light as this has as good as left the floor, in newtons: below the release of any control.
pub(super) const AS_GOOD_AS_LIFTED_N: f32 = 8.0;

/// Least sum of somebody's contacts from which shares of it say anything, in newtons.
const SUM_N: f32 = 250.0;

/// What the other foot must carry for such a share, in newtons.
const OTHERS_N: f32 = 50.0;

/// A contact that may have been two feet is told apart into both within so long of having been marked.
const TOLD_APART: Duration = Duration::from_millis(100);

/// Feet that had been one contact carry at least this share of their person from their first frame on; one that lands
/// has a tenth of a body no sooner than 5 ms after it has touched the floor (10 N a millisecond, see [`super::step`]).
const TOLD_APART_SHARE: f32 = 0.1;

/// Where a foot was, with which force, and what the person's other feet carried.
#[derive(Clone, Copy, Debug, Default)]
struct PastLoad {
    place: Vec2,
    force: f32,
    others: f32,
}

/// Which way of pressing a control answers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PressMode {
    /// A press that is over soon.
    Tap,
    /// A press that may last.
    Hold,
    /// A press that acts from its first moment on, and whose foot moves a value.
    Follow,
    /// A stance: the person stands on it.
    Stand,
}

/// One contact with its past.
#[derive(Clone, Debug)]
pub(super) struct FootHistory {
    pub(super) id: ContactId,
    pub(super) person: u32,
    pub(super) landed: Instant,
    pub(super) landed_at: Vec2,
    pub(super) place: Vec2,
    pub(super) force: f32,
    /// Whether a control has engaged it since it landed.
    pub(super) pressing: bool,
    /// Whether it came from elsewhere, and not from a control back to where it had stood.
    stepped: bool,
    /// Whether somebody stood on the other foot when it landed.
    has_support: bool,
    in_stance: bool,
    /// When it was last marked as perhaps two feet.
    ambiguous: Option<Instant>,
    step: bool,
    watch: StepWatch,
    still: Stillness,
    /// Share of the body that it carries, where that is known.
    share: Option<f32>,
    /// What it pressed with when it had been down for a moment.
    early: Option<f32>,
    /// What the person's other feet carried when this one was last examined.
    others: f32,
    past: [PastLoad; PLACES],
    next: usize,
    kept: usize,
    kept_at: Instant,
}

impl FootHistory {
    fn new(contact: &Contact, person: &Person, now: Instant) -> Self {
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
            ambiguous: contact.ambiguous.then_some(now),
            step: false,
            watch: StepWatch::default(),
            still: Stillness::new(force, place, now),
            share: None,
            early: None,
            others: 0.0,
            // The latest is at `next` - 1.
            past: [PastLoad { place, force, others: 0.0 }; PLACES],
            next: 0,
            kept: 0,
            kept_at: now,
        }
    }

    /// Whether it has been left on the floor and counts as an object.
    pub(super) fn is_object(&self) -> bool {
        self.still.is_object()
    }

    /// Whether it stands in a stance zone.
    pub(super) fn is_in_stance(&self) -> bool {
        self.in_stance
    }

    /// Whether it may be a cursor: neither a standing foot in its zone nor an object.
    pub(super) fn may_lead(&self) -> bool {
        !self.in_stance && !self.is_object()
    }

    /// Whether it walks, stands or rests on a control of this mode, which therefore must not answer.
    pub(super) fn is_step_on(&self, mode: PressMode, now: Instant) -> bool {
        match mode {
            PressMode::Tap => self.step || self.watch.stands(now) || self.watch.rests(now),
            PressMode::Hold | PressMode::Follow => {
                self.step || self.watch.stands(now) && self.took_weight_over()
            }
            PressMode::Stand => false,
        }
    }

    fn update(&mut self, contact: &Contact, now: Instant) {
        (self.place, self.force) = (contact.centroid, contact.force.0);
        if contact.ambiguous {
            self.ambiguous = Some(now);
        }
        self.still.update(self.force, self.place, now);
        if now.since(self.kept_at) >= PLACE_EVERY {
            self.kept_at = now;
            self.past[self.next] = PastLoad { place: self.place, force: self.force, others: self.others };
            self.next = (self.next + 1) % PLACES;
            self.kept = (self.kept + 1).min(PLACES);
        }
    }

    /// How its centre of pressure has moved over the last quarter of a second, the last tenth left out.
    fn rolling(&self) -> Vec2 {
        let known = self.kept.saturating_sub(SKIPPED_PLACES + 1).min(ROLL_PLACES);
        if known < ROLL_PLACES / 2 {
            return Vec2::ZERO;
        }
        let place = |ago: usize| self.past(ago).place;
        let span = PLACE_EVERY.as_secs_f32() * known as f32;
        (place(SKIPPED_PLACES) - place(SKIPPED_PLACES + known)) / span
    }

    /// What it was like so many kept places ago.
    fn past(&self, ago: usize) -> PastLoad {
        self.past[(self.next + 2 * PLACES - 1 - ago) % PLACES]
    }

    /// Whether the other foot has left the floor within the last 0.3 s, and this one has not taken over
    /// what it carried: the person jumps or falls.
    pub(super) fn falls(&self) -> bool {
        let lately = || (0..FALL_PLACES.min(self.kept)).map(|ago| self.past(ago));
        let others = lately().map(|past| past.others).fold(0.0, f32::max);
        let sum = lately().map(|past| past.others + past.force).fold(0.0, f32::max);
        others >= STOOD_N && self.others < FALLEN * others && self.others + self.force < FALLEN * sum
    }

    /// Whether it is or was of late where another contact lands now: two feet don't stand in one place.
    fn was_at(&self, place: Vec2) -> bool {
        let near = |at: Vec2| at.distance(place) <= SAME_FOOT_M;
        near(self.place) || (0..self.kept).any(|ago| near(self.past(ago).place))
    }

    /// Whether another contact of the same person, who had `sum` on the floor, is a foot that had been down unseen as part of
    /// this one.
    fn held(&self, other: &Self, sum: f32, now: Instant) -> bool {
        self.ambiguous.is_some_and(|at| now.since(at) <= TOLD_APART)
            && self.place.distance(other.place) <= STANCE_M
            && other.force >= TOLD_APART_SHARE * sum.max(SUM_N)
    }

    /// Whether it presses neither harder nor elsewhere than a tenth of a second ago.
    fn is_steady(&self) -> bool {
        self.has_steady_force() && self.place.distance(self.past(STEADY_PLACES).place) <= STEADY_M
    }

    /// Whether it presses no harder than a tenth of a second ago, when it was down already, and no less.
    fn has_steady_force(&self) -> bool {
        self.kept > STEADY_PLACES
            && (self.force - self.past(STEADY_PLACES).force).abs() <= STEADY_SHARE * self.force
    }

    /// Whether it may start a press of a control with this `guard`, as far as its past tells.
    ///
    /// A control to stand on ([`PressMode::Stand`]) starts once the foot has settled. A guarded control starts once
    /// the foot has settled and has not taken the weight over, since that would be a step; one that only asks for
    /// confirmation does so at once if the other foot supports the person. A free control starts at once, unless it acts
    /// at once ([`PressMode::Follow`]): then a foot beside which nobody stands must have stopped gaining weight, which
    /// a foot that lands in a walk does only when it is known for a step, and no foot may carry a body.
    pub(super) fn is_meant(&self, mode: PressMode, guard: Guard, now: Instant) -> bool {
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

    /// Whether it carries as much as a resting foot does and came to it slowly: a press is put on at
    /// once, a body is shifted over.
    fn took_weight_over(&self) -> bool {
        let rests = self.force >= RESTS_N && self.share.is_none_or(|share| share >= RESTS);
        rests && self.early.is_none_or(|early| early < AT_ONCE * self.force)
    }

    fn as_support(&self, now: Instant) -> Support {
        Support {
            at: self.place,
            age: now.since(self.landed),
            stepped: self.stepped,
            rolling: self.rolling(),
        }
    }

    fn judge(&mut self, person: &Person, now: Instant) {
        if self.force < AS_GOOD_AS_LIFTED_N {
            (self.landed, self.landed_at) = (now, self.place);
            (self.step, self.watch, self.early) = (false, StepWatch::default(), None);
            return;
        }
        let of_weight = person.weight().map(|weight| self.force / weight.0);
        let others = (person.sum - self.force).max(0.0);
        self.others = others;
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

    fn role(&self, now: Instant) -> FootRole {
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

/// All contacts with their past, and the people they belong to.
#[derive(Clone, Debug)]
pub(super) struct FootHistories {
    /// In the order of their ids.
    feet: Vec<FootHistory>,
    people: Vec<Person>,
    next_person: u32,
}

impl Default for FootHistories {
    fn default() -> Self {
        Self { feet: Vec::with_capacity(ROOM), people: Vec::with_capacity(ROOM), next_person: 1 }
    }
}

impl FootHistories {
    /// Takes in the contacts of one frame.
    ///
    /// # Real-time
    /// Allocates nothing while there are no more than 64 contacts.
    pub(super) fn update(&mut self, contacts: &[Contact], stances: &[Stance], now: Instant) {
        let Self { feet, people, .. } = self;
        let before = feet.len();
        feet.retain(|foot| {
            let down = contacts.iter().any(|contact| contact.id == foot.id);
            if !down && let Some(person) = people.iter_mut().find(|person| person.id == foot.person) {
                person.leave(foot, now);
            }
            down
        });
        people.retain(|person| !person.is_forgotten(now));
        let mut changed = feet.len() != before;
        for contact in contacts {
            match self.feet.binary_search_by_key(&contact.id, |foot| foot.id) {
                Ok(at) => self.feet[at].update(contact, now),
                Err(at) => {
                    let foot = self.land(contact, now);
                    changed = true;
                    self.feet.insert(at, foot);
                }
            }
        }
        if changed {
            self.bring_together();
        }
        for person in &mut self.people {
            let mine = self.feet.iter().filter(|foot| foot.person == person.id && !foot.is_object());
            person.carry(mine.map(|foot| foot.force).sum(), now);
        }
        for foot in &mut self.feet {
            foot.in_stance = stances.iter().any(|stance| stance.area.contains(foot.place));
            if let Some(person) = self.people.iter().find(|person| person.id == foot.person) {
                foot.judge(person, now);
            }
        }
    }

    /// The foot of a contact.
    pub(super) fn of(&self, id: ContactId) -> Option<&FootHistory> {
        self.feet.binary_search_by_key(&id, |foot| foot.id).ok().and_then(|at| self.feet.get(at))
    }

    /// A control has engaged a contact.
    pub(super) fn note_press(&mut self, id: ContactId) {
        if let Ok(at) = self.feet.binary_search_by_key(&id, |foot| foot.id) {
            self.feet[at].pressing = true;
        }
    }

    /// The weight of the person whose foot this is; `None` if it is not known.
    pub(super) fn weight(&self, id: ContactId) -> Option<Newtons> {
        self.person_of(id)?.weight()
    }

    /// What there is to show of each contact, in their order.
    pub(super) fn states(&self, now: Instant) -> impl Iterator<Item = FootState> + '_ {
        self.feet.iter().map(move |foot| FootState {
            contact: foot.id,
            role: foot.role(now),
            person: foot.person,
            weight: self.weight(foot.id),
        })
    }

    fn person_of(&self, id: ContactId) -> Option<&Person> {
        let person = self.of(id)?.person;
        self.people.iter().find(|known| known.id == person)
    }

    fn land(&mut self, contact: &Contact, now: Instant) -> FootHistory {
        let whose = self.whose(contact.centroid, now);
        let person = &self.people[whose];
        let mut foot = FootHistory::new(contact, person, now);
        let support = self
            .feet
            .iter()
            .filter(|other| other.person == person.id && !other.is_object())
            .filter(|other| other.force >= SUPPORT_N && !other.pressing)
            .max_by(|a, b| a.force.total_cmp(&b.force));
        let mut others = self.feet.iter().filter(|other| other.person == person.id && !other.is_object());
        if let Some(other) =
            others.find(|other| other.was_at(foot.place) || other.held(&foot, person.sum, now))
        {
            // No foot that has just come, but the first one under another name, a part of it told apart for a while, or
            // a second one that had stood beside it unseen.
            (foot.landed, foot.landed_at) = (other.landed, other.landed_at);
            (foot.step, foot.stepped, foot.has_support) = (other.step, other.stepped, other.has_support);
            return foot;
        }
        let landing = Landing {
            at: foot.place,
            support: support.map(|support| support.as_support(now)),
            left: person.last_left(now),
        };
        foot.has_support = landing.has_standing_support();
        foot.step = landing.walks();
        foot
    }

    /// Makes one person of two that had been taken for two while their feet were on the way.
    fn bring_together(&mut self) {
        let mut first = 0;
        while first < self.people.len() {
            let one = &self.people[first];
            let second = (first + 1..self.people.len())
                .find(|&second| one.is_one_with(&self.people[second], &self.feet));
            match second {
                Some(second) => {
                    let (kept, gone) = (one.id, self.people.remove(second).id);
                    for foot in self.feet.iter_mut().filter(|foot| foot.person == gone) {
                        foot.person = kept;
                    }
                }
                None => first += 1,
            }
        }
    }

    /// The position of the person to whom a foot that lands at `place` belongs; a new person if no known one can have put it there.
    fn whose(&mut self, place: Vec2, now: Instant) -> usize {
        let near = self
            .people
            .iter()
            .enumerate()
            .filter_map(|(at, person)| Some((at, person.reach_to(place, &self.feet, now)?)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((at, _)) = near {
            return at;
        }
        self.people.push(Person::new(self.next_person, now));
        self.next_person = self.next_person.wrapping_add(1);
        self.people.len() - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(id: u32, at: (f32, f32), force: f32, ambiguous: bool) -> Contact {
        Contact {
            id: ContactId(id),
            centroid: at.into(),
            force: Newtons(force),
            ambiguous,
            ..Contact::default()
        }
    }

    #[test]
    fn a_foot_that_had_stood_unseen_beside_the_other_has_not_just_stepped_there() {
        let (mut feet, mut ms) = (FootHistories::default(), 0);
        let mut give = |feet: &mut FootHistories, contacts: &[Contact], millis: u64| {
            for _ in 0..millis {
                ms += 1;
                feet.update(contacts, &[], Instant::from_millis(ms));
            }
            Instant::from_millis(ms)
        };
        // Somebody with narrow feet stands, taken for one foot that may be two; weight goes over to the right one, which
        // is told apart; nothing is left of the other one's load.
        give(&mut feet, &[contact(1, (0.5, 0.3), 700.0, true)], 3000);
        give(&mut feet, &[contact(1, (0.4, 0.3), 600.0, false), contact(2, (0.6, 0.3), 100.0, true)], 100);
        give(&mut feet, &[contact(1, (0.4, 0.3), 20.0, true), contact(2, (0.6, 0.3), 680.0, false)], 500);
        let standing = contact(2, (0.6, 0.3), 660.0, false);
        give(&mut feet, std::slice::from_ref(&standing), 5);
        // The left foot comes down on a control.
        let now = give(&mut feet, &[standing, contact(3, (0.5, 0.9), 40.0, false)], 10);
        let foot = feet.of(ContactId(3)).unwrap();
        assert!(!foot.is_step_on(PressMode::Tap, now), "it presses");
        assert!(foot.has_support, "beside a foot that stands");
    }
}
