//! Presses on free floor close beside a control, which no control answers.

use std::time::Duration;

use glam::Vec2;

use underfoot::engine::{FootRole, Snapshot};
use underfoot::layout::{Layout, Widget};
use underfoot::sense::{Contact, ContactId};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::WidgetId;
use underfoot_scene::scene::in_drawn_order;

/// Distance from a control up to which a press counts as meant for it, in metres: about a hand's breadth, less than
/// the distance between controls that suit a shoe.
const NEAR_M: f32 = 0.10;

/// Minimum force of a press, in newtons: a foot at rest beside a control bears up to 35 N.
const PRESS_N: f32 = 35.0;

/// Duration from which a contact counts as standing.
const STANDING: Duration = Duration::from_millis(1500);

/// Distance from which a contact counts as a slide or a step, in metres.
const SLIDE_M: f32 = 0.08;

/// Maximum number of contacts under observation.
const CONTACTS: usize = 32;

/// A press beside a control.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct NearMiss {
    /// Time of its end.
    pub(super) at: Instant,
    /// The nearest control.
    pub(super) id: WidgetId,
    /// Distance from the control's edge, in metres.
    pub(super) distance_m: f32,
    /// The place of its maximum force, in floor metres.
    pub(super) place: Vec2,
    /// Its maximum force.
    pub(super) force: Newtons,
    /// The distance and the control's name, such as `3 cm beside North`.
    pub(super) text: String,
}

/// A contact that may become a near miss.
#[derive(Clone, Debug)]
struct FreePress {
    contact: ContactId,
    began: Instant,
    began_at: Vec2,
    strongest: Newtons,
    place: Vec2,
    /// Whether it has touched a control, carried a person, or slid.
    is_other: bool,
}

impl FreePress {
    fn new(contact: &Contact, at: Instant) -> Self {
        Self {
            contact: contact.id,
            began: at,
            began_at: contact.centroid,
            strongest: contact.force,
            place: contact.centroid,
            is_other: false,
        }
    }

    fn follow(&mut self, contact: &Contact, snapshot: &Snapshot, layout: &Layout) {
        let role = snapshot.feet.iter().find(|foot| foot.contact == contact.id).map(|foot| foot.role);
        self.is_other |= contact.split
            || role.is_some_and(|role| role != FootRole::Free)
            || contact.centroid.distance(self.began_at) > SLIDE_M
            || snapshot.at.since(self.began) > STANDING
            || layout.widget_at(snapshot.page, contact.centroid).is_some();
        if contact.force > self.strongest {
            (self.strongest, self.place) = (contact.force, contact.centroid);
        }
    }

    /// The near miss that has ended at `at`; `None` if the contact was something else.
    fn ended(&self, at: Instant, snapshot: &Snapshot, layout: &Layout) -> Option<NearMiss> {
        let is_explained = snapshot.ignored.iter().any(|press| press.contact == self.contact)
            || snapshot.answered.iter().any(|press| press.contact == self.contact);
        if self.is_other || is_explained || self.strongest.0 < PRESS_N {
            return None;
        }
        let (widget, distance_m) = nearest(layout, snapshot, self.place)?;
        let label = if widget.label.is_empty() { widget.id.as_str() } else { &widget.label };
        let name = in_drawn_order(label);
        let text = format!("{:.0} cm beside {name}", (100.0 * distance_m).max(1.0));
        Some(NearMiss {
            at,
            id: widget.id.clone(),
            distance_m,
            place: self.place,
            force: self.strongest,
            text,
        })
    }
}

/// The visible control nearest to `place`, and the distance from its edge in metres, if that is at most [`NEAR_M`].
fn nearest<'l>(layout: &'l Layout, snapshot: &Snapshot, place: Vec2) -> Option<(&'l Widget, f32)> {
    let is_hidden = |index: usize| snapshot.widgets.get(index).is_some_and(|state| state.hidden);
    let seen = layout.widgets.iter().enumerate();
    let seen = seen.filter(|(index, widget)| widget.is_on(snapshot.page) && !is_hidden(*index));
    let measured = seen.map(|(_, widget)| (widget, widget.area.distance(place)));
    measured.filter(|(_, far)| *far <= NEAR_M).min_by(|(_, one), (_, other)| one.total_cmp(other))
}

/// Finds near misses among the contacts of successive snapshots.
#[derive(Default)]
pub(super) struct NearMissWatch {
    presses: Vec<FreePress>,
    seen_at: Instant,
    /// The last near miss.
    latest: Option<NearMiss>,
}

impl NearMissWatch {
    /// Takes in a snapshot; returns the near misses that have ended since the last one.
    pub(super) fn update(&mut self, snapshot: &Snapshot, layout: &Layout) -> Vec<NearMiss> {
        if snapshot.at < self.seen_at {
            // A recording shows an earlier moment.
            *self = Self::default();
        }
        self.seen_at = snapshot.at;
        let is_down = |contact: ContactId| snapshot.contacts.iter().any(|other| other.id == contact);
        let (going_on, ended): (Vec<FreePress>, Vec<FreePress>) =
            std::mem::take(&mut self.presses).into_iter().partition(|press| is_down(press.contact));
        self.presses = going_on;
        for contact in &snapshot.contacts {
            let known = self.presses.iter_mut().find(|press| press.contact == contact.id);
            if let Some(press) = known {
                press.follow(contact, snapshot, layout);
            } else if self.presses.len() < CONTACTS {
                let mut press = FreePress::new(contact, snapshot.at);
                press.follow(contact, snapshot, layout);
                self.presses.push(press);
            }
        }
        let missed: Vec<NearMiss> =
            ended.iter().filter_map(|press| press.ended(snapshot.at, snapshot, layout)).collect();
        if let Some(last) = missed.last() {
            self.latest = Some(last.clone());
        }
        missed
    }

    /// The last near miss, if any.
    pub(super) fn latest(&self) -> Option<&NearMiss> {
        self.latest.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preview::sample::{at_rest, map, step_on};
    use underfoot::engine::{FootState, Ignored, IgnoredPress};

    /// A place `cm` centimetres to the east of `id`.
    fn east_of(layout: &Layout, id: &str, cm: f32) -> Vec2 {
        let area = layout.widgets[layout.widget_index(id).unwrap()].area;
        Vec2::new(area.max.x + 0.01 * cm, area.centre().y)
    }

    /// The near misses of one press with `force` newtons at `place` for `ms` milliseconds; `change` edits each
    /// snapshot.
    fn missed(place: Vec2, force: f32, ms: u64, change: impl Fn(&mut Snapshot)) -> Vec<NearMiss> {
        let layout = map();
        let mut watch = NearMissWatch::default();
        let mut all = Vec::new();
        for step in 0..=4 {
            let mut snapshot = at_rest(&layout);
            snapshot.at = Instant::from_millis(1000 + step * ms / 4);
            if step < 4 {
                step_on(&mut snapshot, 9, place, force, Vec2::ZERO);
            }
            change(&mut snapshot);
            all.extend(watch.update(&snapshot, &layout));
        }
        all
    }

    /// A control with free floor to its east, and the place 3 cm beside it.
    fn beside() -> (String, Vec2) {
        let layout = map();
        let free = |widget: &&Widget| {
            let place = east_of(&layout, widget.id.as_str(), 3.0);
            let others = layout.widgets.iter().filter(|other| other.id != widget.id);
            widget.is_on(0) && others.map(|other| other.area.distance(place)).all(|far| far > 0.03)
        };
        let widget = layout.widgets.iter().find(free).unwrap();
        (widget.id.to_string(), east_of(&layout, widget.id.as_str(), 3.0))
    }

    #[test]
    fn a_short_press_beside_a_control_names_it_and_its_distance() {
        let (id, place) = beside();
        let all = missed(place, 90.0, 300, |_| {});
        assert_eq!(all.len(), 1);
        assert_eq!((all[0].id.as_str(), all[0].force), (id.as_str(), Newtons(90.0)));
        assert!(all[0].text.starts_with("3 cm beside "), "{}", all[0].text);
    }

    #[test]
    fn a_foot_that_stands_rests_walks_or_has_a_reason_already_is_no_near_miss() {
        let (_, place) = beside();
        assert_eq!(missed(place, 90.0, 4000, |_| {}), [], "it stands");
        assert_eq!(missed(place, 20.0, 300, |_| {}), [], "it rests");
        let role = |snapshot: &mut Snapshot| {
            let (contact, role) = (ContactId(9), FootRole::Step);
            snapshot.feet = vec![FootState { contact, role, person: 1, weight: None }];
        };
        assert_eq!(missed(place, 90.0, 300, role), [], "it walks");
        let ignored = |snapshot: &mut Snapshot| {
            let (at, id, contact, force) = (snapshot.at, WidgetId::new("home"), ContactId(9), Newtons(90.0));
            snapshot.ignored = vec![IgnoredPress { at, id, contact, force, why: Ignored::OutsideRegion }];
        };
        assert_eq!(missed(place, 90.0, 300, ignored), [], "the floor gave its reason");
        assert_eq!(missed(map().widgets[0].area.centre(), 90.0, 300, |_| {}), [], "it is on the control");
    }

    #[test]
    fn a_press_far_from_all_controls_is_no_near_miss() {
        let layout = map();
        let far = |place: &Vec2| layout.widgets.iter().all(|widget| widget.area.distance(*place) > 0.12);
        let places = (0..180).flat_map(|x| (0..180).map(move |y| Vec2::new(x as f32, y as f32) * 0.01));
        for place in places.filter(far).take(3) {
            assert_eq!(missed(place, 90.0, 300, |_| {}), []);
        }
    }
}
