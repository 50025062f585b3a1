//! The forces of presses on each control, answered or ignored.

use std::collections::{HashMap, VecDeque};

use underfoot::engine::{AnsweredPress, Ignored, IgnoredPress, Snapshot};
use underfoot::sense::ContactId;
use underfoot::units::{Instant, Newtons};
use underfoot::widget::WidgetId;

/// Maximum number of stored presses, of all controls: some minutes with busy feet.
const KEPT: usize = 400;

/// Number of contacts whose person is stored: their presses are reported after the contact has ended.
const CONTACTS: usize = 64;

/// One press of one control.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ControlPress {
    /// Time of its end.
    pub(super) at: Instant,
    pub(super) id: WidgetId,
    /// Its maximum force.
    pub(super) force: Newtons,
    /// Why it was ignored; `None` if it was answered.
    pub(super) why: Option<Ignored>,
    /// The person, as tracked on the floor; `None` if unknown.
    pub(super) person: Option<u32>,
    /// Whether it counts as intended.
    pub(super) counts: bool,
}

impl ControlPress {
    /// Whether the press was intended, judging from its end: any reason other than force or time indicates that the
    /// foot pressed for another purpose, or that its force was unknown.
    fn is_meant(why: Option<Ignored>) -> bool {
        matches!(why, None | Some(Ignored::TooLight | Ignored::TooShort))
    }
}

/// The presses since the window opened.
#[derive(Default)]
pub(super) struct PressLog {
    /// Oldest first.
    all: VecDeque<ControlPress>,
    /// Whether they come from a recording, which repeats them each time it shows an earlier moment.
    are_recorded: bool,
    /// The time of the last press that was dropped for a newer one, and per control the time up to which the presses
    /// were cleared: recorded presses up to then have been counted.
    dropped_at: Option<Instant>,
    forgotten_at: HashMap<WidgetId, Instant>,
    /// The time of the last snapshot.
    seen_at: Instant,
    /// The lists of the last snapshot.
    ignored: Vec<IgnoredPress>,
    answered: Vec<AnsweredPress>,
    people: VecDeque<(ContactId, u32)>,
    /// The message about the last threshold that was set here.
    pub(super) told: Option<(WidgetId, String)>,
}

impl PressLog {
    /// For a recording: counts each press once, however often its moment is shown.
    pub(super) fn recorded() -> Self {
        Self { are_recorded: true, ..Self::default() }
    }

    /// Takes in the presses that a snapshot lists for the first time; returns those of them that were ignored. After
    /// a snapshot of an earlier moment, all of them count as new.
    pub(super) fn update(&mut self, snapshot: &Snapshot) -> Vec<IgnoredPress> {
        if snapshot.at < self.seen_at {
            self.ignored.clear();
            self.answered.clear();
        }
        self.seen_at = snapshot.at;
        for foot in &snapshot.feet {
            if !self.people.iter().any(|(contact, _)| *contact == foot.contact) {
                self.people.truncate(CONTACTS - 1);
                self.people.push_front((foot.contact, foot.person));
            }
        }
        if self.answered != snapshot.answered {
            for press in &snapshot.answered {
                if !self.answered.contains(press) {
                    self.note(press.at, &press.id, press.contact, press.force, None);
                }
            }
            self.answered.clone_from(&snapshot.answered);
        }
        let mut new = Vec::new();
        if self.ignored != snapshot.ignored {
            new.extend(snapshot.ignored.iter().filter(|press| !self.ignored.contains(press)).cloned());
            for press in &new {
                self.note(press.at, &press.id, press.contact, press.force, Some(press.why));
            }
            self.ignored.clone_from(&snapshot.ignored);
        }
        new
    }

    fn note(&mut self, at: Instant, id: &WidgetId, contact: ContactId, force: Newtons, why: Option<Ignored>) {
        let person = self.people.iter().find(|(other, _)| *other == contact).map(|(_, person)| *person);
        let counts = ControlPress::is_meant(why) && force.is_finite();
        let press = ControlPress { at, id: id.clone(), force, why, person, counts };
        if self.are_recorded && self.is_noted(&press) {
            return;
        }
        if self.all.len() == KEPT {
            self.dropped_at = self.all.pop_front().map(|oldest| oldest.at);
        }
        // A recording may show an earlier moment than before, so insert the press in order of time.
        let place = if self.are_recorded {
            self.all.partition_point(|other| other.at <= press.at)
        } else {
            self.all.len()
        };
        self.all.insert(place, press);
        if self.told.as_ref().is_some_and(|(told, _)| told == id) {
            self.told = None;
        }
    }

    fn is_noted(&self, press: &ControlPress) -> bool {
        let is_it =
            |other: &ControlPress| (other.at, &other.id, other.why) == (press.at, &press.id, press.why);
        self.dropped_at.is_some_and(|dropped| press.at <= dropped)
            || self.forgotten_at.get(&press.id).is_some_and(|forgotten| press.at <= *forgotten)
            || self.all.iter().any(is_it)
    }

    /// The control that was pressed last, and the time at which that press ended.
    pub(super) fn latest(&self) -> Option<(&WidgetId, Instant)> {
        self.all.back().map(|press| (&press.id, press.at))
    }

    /// The presses of one control, the latest first.
    pub(super) fn of(&self, id: &WidgetId) -> impl Iterator<Item = &ControlPress> {
        self.all.iter().rev().filter(move |press| press.id == *id)
    }

    /// The forces of the presses of one control that count, and the number of people who made them.
    pub(super) fn counted(&self, id: &WidgetId) -> (Vec<Newtons>, usize) {
        let forces = self.of(id).filter(|press| press.counts).map(|press| press.force).collect();
        let mut people: Vec<u32> =
            self.of(id).filter(|press| press.counts).filter_map(|press| press.person).collect();
        people.sort_unstable();
        people.dedup();
        (forces, people.len())
    }

    /// Sets whether one press of a control counts; `number` counts from the latest.
    pub(super) fn let_count(&mut self, id: &WidgetId, number: usize, counts: bool) {
        let mut of = self.all.iter_mut().rev().filter(|press| press.id == *id);
        if let Some(press) = of.nth(number) {
            press.counts = counts;
        }
    }

    /// Clears the presses of one control, for example before another person begins.
    pub(super) fn forget(&mut self, id: &WidgetId) {
        let latest = self.of(id).next().map(|latest| latest.at);
        self.forgotten_at.extend(latest.map(|at| (id.clone(), at)));
        self.all.retain(|press| press.id != *id);
        self.told = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot::engine::{FootRole, FootState};

    fn id(name: &str) -> WidgetId {
        WidgetId::new(name)
    }

    fn foot(contact: u32, person: u32) -> FootState {
        FootState { contact: ContactId(contact), role: FootRole::Free, person, weight: None }
    }

    fn answered(at_ms: u64, contact: u32, force: f32) -> AnsweredPress {
        let at = Instant::from_millis(at_ms);
        AnsweredPress { at, id: id("home"), contact: ContactId(contact), force: Newtons(force) }
    }

    fn ignored(at_ms: u64, contact: u32, force: f32, why: Ignored) -> IgnoredPress {
        let at = Instant::from_millis(at_ms);
        IgnoredPress { at, id: id("home"), contact: ContactId(contact), force: Newtons(force), why }
    }

    #[test]
    fn each_press_is_noted_once_with_its_person_and_those_that_were_not_meant_do_not_count() {
        let mut presses = PressLog::default();
        let mut snapshot = Snapshot { feet: vec![foot(1, 5), foot(2, 6)], ..Snapshot::default() };
        presses.update(&snapshot);
        // The lists report the presses once the feet are gone.
        snapshot.feet.clear();
        snapshot.answered = vec![answered(100, 1, 120.0), answered(200, 2, 90.0)];
        snapshot.ignored =
            vec![ignored(150, 1, 40.0, Ignored::TooLight), ignored(250, 2, 600.0, Ignored::Step)];
        assert_eq!(presses.update(&snapshot).len(), 2);
        assert_eq!(presses.update(&snapshot), []);
        let (mut forces, people) = presses.counted(&id("home"));
        forces.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!((forces, people), (vec![Newtons(40.0), Newtons(90.0), Newtons(120.0)], 2));
        // The same press at another time is a different one; lists that lose their oldest entries contain nothing
        // new.
        snapshot.answered = vec![answered(200, 2, 90.0), answered(300, 2, 90.0)];
        presses.update(&snapshot);
        assert_eq!(presses.of(&id("home")).count(), 5);
        assert_eq!(presses.of(&id("zoom")).count(), 0);
    }

    /// The snapshot of one moment of a recording.
    fn shown(at_ms: u64, answered_so_far: Vec<AnsweredPress>, ignored_so_far: Vec<IgnoredPress>) -> Snapshot {
        let at = Instant::from_millis(at_ms);
        Snapshot { at, answered: answered_so_far, ignored: ignored_so_far, ..Snapshot::default() }
    }

    #[test]
    fn a_recorded_press_is_counted_once_however_often_it_is_shown() {
        let mut presses = PressLog::recorded();
        let early = || answered(100, 1, 120.0);
        let light = || ignored(150, 2, 40.0, Ignored::TooLight);
        let late = || answered(200, 3, 90.0);
        presses.update(&shown(120, vec![early()], vec![]));
        presses.update(&shown(300, vec![early(), late()], vec![light()]));
        presses.let_count(&id("home"), 0, false);
        let counted = presses.counted(&id("home"));
        // Back to the beginning and through it again, which lists the light press again.
        presses.update(&shown(10, vec![], vec![]));
        assert_eq!(presses.update(&shown(160, vec![early()], vec![light()])).len(), 1);
        presses.update(&shown(300, vec![early(), late()], vec![light()]));
        assert_eq!(presses.of(&id("home")).count(), 3);
        assert_eq!(presses.counted(&id("home")), counted, "one that was left out stays so");
    }

    #[test]
    fn a_recorded_press_that_was_jumped_over_is_counted_when_it_is_shown() {
        let mut presses = PressLog::recorded();
        presses.update(&shown(900, vec![answered(800, 3, 90.0)], vec![]));
        presses.update(&shown(10, vec![], vec![]));
        presses.update(&shown(200, vec![answered(100, 1, 120.0)], vec![]));
        let forces: Vec<f32> = presses.of(&id("home")).map(|press| press.force.0).collect();
        assert_eq!(forces, [90.0, 120.0], "the latest first");
    }

    #[test]
    fn recorded_presses_that_were_forgotten_or_made_room_do_not_come_back() {
        let mut presses = PressLog::recorded();
        presses.update(&shown(200, vec![answered(100, 1, 120.0)], vec![]));
        presses.forget(&id("home"));
        presses.update(&shown(10, vec![], vec![]));
        presses.update(&shown(200, vec![answered(100, 1, 120.0)], vec![]));
        assert_eq!(presses.of(&id("home")).count(), 0);
        for number in 1..=KEPT as u64 + 1 {
            let at = 1000 * number;
            presses.update(&shown(at, vec![answered(at, 1, 100.0)], vec![]));
        }
        presses.update(&shown(10, vec![], vec![]));
        presses.update(&shown(1000, vec![answered(1000, 1, 100.0)], vec![]));
        let first = presses.of(&id("home")).last().unwrap();
        assert_eq!((presses.of(&id("home")).count(), first.at), (KEPT, Instant::from_millis(2000)));
    }

    #[test]
    fn a_press_is_left_out_and_taken_in_by_its_place_from_the_latest() {
        let mut presses = PressLog::default();
        let snapshot = Snapshot {
            answered: vec![answered(100, 1, 120.0), answered(200, 2, 15.0)],
            ..Snapshot::default()
        };
        presses.update(&snapshot);
        presses.let_count(&id("home"), 0, false);
        assert_eq!(presses.counted(&id("home")), (vec![Newtons(120.0)], 0));
        presses.let_count(&id("home"), 9, false);
        presses.forget(&id("home"));
        assert_eq!(presses.latest(), None);
        assert_eq!(presses.update(&snapshot), [], "what is forgotten does not come again");
        assert_eq!(presses.latest(), None);
    }
}
