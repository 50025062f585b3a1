//! The history of all contacts, and the assignment of feet to people.

mod history;
mod past;

use glam::Vec2;

pub(super) use self::history::{AS_GOOD_AS_LIFTED_N, FootHistory, PressMode};
use super::people::TrackedPerson;
use super::snapshot::FootState;
use super::step::{Landing, STEP_TIME};
use crate::layout::Stance;
use crate::sense::{Contact, ContactId};
use crate::units::{Instant, Newtons};

/// Initial capacity for feet and people; more cost one allocation.
const ROOM: usize = 64;

/// Minimum load on a supporting foot, in newtons.
const SUPPORT_N: f32 = 100.0;

/// All contacts with their history, and the people to which they belong.
#[derive(Clone, Debug)]
pub(super) struct FootHistories {
    /// Sorted by id.
    feet: Vec<FootHistory>,
    people: Vec<TrackedPerson>,
    next_person: u32,
}

impl Default for FootHistories {
    fn default() -> Self {
        Self { feet: Vec::with_capacity(ROOM), people: Vec::with_capacity(ROOM), next_person: 1 }
    }
}

impl FootHistories {
    /// Processes the contacts of one frame.
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
        self.take_apart(now);
    }

    /// The history of a contact.
    pub(super) fn of(&self, id: ContactId) -> Option<&FootHistory> {
        self.feet.binary_search_by_key(&id, |foot| foot.id).ok().and_then(|at| self.feet.get(at))
    }

    /// Notes that a contact has engaged a control.
    pub(super) fn note_press(&mut self, id: ContactId) {
        if let Ok(at) = self.feet.binary_search_by_key(&id, |foot| foot.id) {
            self.feet[at].pressing = true;
        }
    }

    /// The weight of the person to whom this foot belongs; `None` if unknown.
    pub(super) fn weight(&self, id: ContactId) -> Option<Newtons> {
        self.person_of(id)?.weight()
    }

    /// The state of each contact, in their order.
    pub(super) fn states(&self, now: Instant) -> impl Iterator<Item = FootState> + '_ {
        self.feet.iter().map(move |foot| FootState {
            contact: foot.id,
            role: foot.role(now),
            person: foot.person,
            weight: self.weight(foot.id),
        })
    }

    fn person_of(&self, id: ContactId) -> Option<&TrackedPerson> {
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
            others.find(|other| other.was_at(foot.place) || other.contained(&foot, person.sum, now))
        {
            foot.go_on_as(other);
            return foot;
        }
        let rests = |other: &FootHistory| {
            other.force >= AS_GOOD_AS_LIFTED_N && now.since(other.landed) > STEP_TIME && !other.pressing
        };
        let mut mine = self.feet.iter().filter(|other| other.person == person.id && !other.is_object());
        let landing = Landing {
            at: foot.place,
            support: support.map(|support| support.as_support(now)),
            left: person.last_left(now),
            rests: mine.any(rests),
            carried: person.carried,
        };
        foot.land(&landing);
        foot
    }

    /// Merges two people that are one: while their feet were on the way, each foot was assigned to a person of its
    /// own.
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

    /// Splits a person into two where another body stands on one of the feet.
    fn take_apart(&mut self, now: Instant) {
        for at in 0..self.feet.len() {
            if self.feet[at].bears_another_body(now) {
                let person = self.newcomer(now);
                let id = self.people[person].id;
                self.feet[at].give_to(id);
            }
        }
    }

    /// The index of the person to whom a foot that lands at `place` belongs; a new person if the place is out of
    /// reach for all known ones.
    fn whose(&mut self, place: Vec2, now: Instant) -> usize {
        let near = self
            .people
            .iter()
            .enumerate()
            .filter_map(|(at, person)| Some((at, person.reach_to(place, &self.feet, now)?)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        near.map(|(at, _)| at).unwrap_or_else(|| self.newcomer(now))
    }

    /// The index of a new person.
    fn newcomer(&mut self, now: Instant) -> usize {
        self.people.push(TrackedPerson::new(self.next_person, now));
        self.next_person = self.next_person.wrapping_add(1);
        self.people.len() - 1
    }
}

#[cfg(test)]
mod tests {
    use super::super::step::OtherFoot;
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
        // A person with narrow feet stands, tracked as one foot that may be two. The weight goes over to the right
        // foot, which splits off; nothing is left of the load on the other one.
        give(&mut feet, &[contact(1, (0.5, 0.3), 700.0, true)], 3000);
        give(&mut feet, &[contact(1, (0.4, 0.3), 600.0, false), contact(2, (0.6, 0.3), 100.0, true)], 100);
        give(&mut feet, &[contact(1, (0.4, 0.3), 20.0, true), contact(2, (0.6, 0.3), 680.0, false)], 500);
        let standing = contact(2, (0.6, 0.3), 660.0, false);
        give(&mut feet, std::slice::from_ref(&standing), 5);
        // The left foot lands on a control.
        let now = give(&mut feet, &[standing, contact(3, (0.5, 0.9), 40.0, false)], 10);
        let foot = feet.of(ContactId(3)).unwrap();
        assert!(!foot.is_step_on(PressMode::Tap, now), "it presses");
        assert_eq!(foot.beside, OtherFoot::Stands);
    }

    #[test]
    fn a_foot_on_which_another_body_stands_is_another_person_s() {
        let person_of_second = |first_n: f32, second_n: f32, ms: u64| {
            let mut feet = FootHistories::default();
            // A person stands on one foot; another foot lands a step away.
            let standing = contact(1, (1.8, 0.6), 700.0, false);
            (0..500).for_each(|ms| {
                feet.update(std::slice::from_ref(&standing), &[], Instant::from_millis(ms));
            });
            let both = [contact(1, (1.8, 0.6), first_n, false), contact(2, (1.4, 1.3), second_n, false)];
            (500..500 + ms).for_each(|ms| feet.update(&both, &[], Instant::from_millis(ms)));
            (feet.of(ContactId(1)).unwrap().person, feet.of(ContactId(2)).unwrap().person)
        };
        let is_one = |(one, other)| one == other;
        assert!(is_one(person_of_second(350.0, 350.0, 3000)), "stands on both");
        assert!(is_one(person_of_second(700.0, 98.0, 3000)), "somebody heavy presses");
        assert!(is_one(person_of_second(800.0, 700.0, 150)), "both feet of somebody who jumps");
        assert!(!is_one(person_of_second(700.0, 690.0, 400)));
    }

    #[test]
    fn a_foot_is_nobody_s_whose_other_foot_stands_further_off_than_anybody_steps() {
        let mut feet = FootHistories::default();
        let mut give = |contacts: &[Contact], ms: u64| feet.update(contacts, &[], Instant::from_millis(ms));
        let (one, other) = (contact(1, (1.0, 1.6), 600.0, false), contact(2, (1.4, 2.1), 600.0, false));
        // One person steps north; 0.4 s after the trailing foot has left, a foot of another person lands a metre
        // south of its last place.
        give(std::slice::from_ref(&one), 0);
        give(&[one, other.clone()], 500);
        give(std::slice::from_ref(&other), 700);
        give(&[other, contact(3, (1.2, 0.6), 300.0, false)], 1100);
        let person = |id| feet.of(ContactId(id)).unwrap().person;
        assert_ne!(person(2), person(3));
    }
}
