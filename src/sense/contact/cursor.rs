//! The foot that operates a region.

use std::time::Duration;

use glam::Vec2;

use super::{Contact, ContactId};
use crate::floor::Rect;
use crate::units::{Instant, Newtons};

/// The contact that operates the controls of one region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cursor {
    /// Its identifier.
    pub contact: ContactId,
    /// Its centroid, in floor metres.
    pub position: Vec2,
    /// Its force.
    pub force: Newtons,
}

impl Cursor {
    /// `contact` as a cursor.
    #[must_use]
    pub fn of(contact: &Contact) -> Self {
        Self { contact: contact.id, position: contact.centroid, force: contact.force }
    }
}

/// Margin and time by which a rival must be heavier to become the cursor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stickiness {
    /// The rival's force over the cursor's, at least 1.
    pub margin: f32,
    /// Time for which it must stay above the margin without interruption.
    pub patience: Duration,
}

impl Default for Stickiness {
    /// 15 % heavier for 50 ms: two feet of nearly equal force do not make the cursor flicker (our choice).
    fn default() -> Self {
        Self { margin: 1.15, patience: Duration::from_millis(50) }
    }
}

/// Picks one region's cursor: the contact with the largest force in it, with hysteresis.
///
/// Only contacts with their centroid inside the region count; a foot beside it never becomes the cursor, at any
/// weight.
///
/// # Source
/// Largest force in the active region: paper, section 4.2. The stickiness is ours.
#[derive(Clone, Debug, Default)]
pub struct CursorPicker {
    stickiness: Stickiness,
    current: Option<ContactId>,
    /// Time since which a rival has been heavy enough.
    challenged: Option<Instant>,
    held: Option<ContactId>,
}

impl CursorPicker {
    /// A picker with the hysteresis `stickiness`.
    #[must_use]
    pub fn new(stickiness: Stickiness) -> Self {
        Self { stickiness, ..Self::default() }
    }

    /// Makes `contact` the cursor as long as it is down, at any place; `None` releases it.
    ///
    /// For a control that has captured the foot that drags it. The hold ends when the contact lifts.
    pub fn hold(&mut self, contact: Option<ContactId>) {
        self.held = contact;
    }

    /// The cursor of region `area` among `contacts` at time `now`; `None` without a contact in it.
    ///
    /// A `now` earlier than the last one counts as zero elapsed time.
    pub fn update(&mut self, area: Rect, contacts: &[Contact], now: Instant) -> Option<Cursor> {
        self.choose(contacts, |contact| area.contains(contact.centroid), now)
    }

    /// The cursor among the `contacts` for which `may` is true, at time `now`; `None` if there is none.
    ///
    /// A held contact is the cursor in any case. A `now` earlier than the last one counts as zero elapsed time.
    pub fn choose(
        &mut self,
        contacts: &[Contact],
        may: impl Fn(&Contact) -> bool,
        now: Instant,
    ) -> Option<Cursor> {
        if let Some(held) = self.held {
            if let Some(contact) = contacts.iter().find(|contact| contact.id == held) {
                self.current = Some(held);
                self.challenged = None;
                return Some(Cursor::of(contact));
            }
            self.held = None;
        }
        let inside = || contacts.iter().filter(|contact| may(contact));
        let heaviest = inside().max_by(|a, b| {
            // Of two equal ones the older, so that the order of the list does not matter.
            a.force.0.total_cmp(&b.force.0).then(b.id.cmp(&a.id))
        });
        let current = inside().find(|contact| Some(contact.id) == self.current);
        let chosen = match (heaviest, current) {
            (Some(rival), Some(current)) if rival.force.0 > current.force.0 * self.stickiness.margin => {
                let since = *self.challenged.get_or_insert(now);
                if now.since(since) >= self.stickiness.patience {
                    self.challenged = None;
                    rival
                } else {
                    current
                }
            }
            (_, Some(current)) => {
                self.challenged = None;
                current
            }
            (Some(heaviest), None) => {
                self.challenged = None;
                heaviest
            }
            (None, None) => {
                self.challenged = None;
                self.current = None;
                return None;
            }
        };
        self.current = Some(chosen.id);
        Some(Cursor::of(chosen))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Rect = Rect::new(Vec2::ZERO, Vec2::ONE);

    fn foot(id: u32, x: f32, force: f32) -> Contact {
        Contact {
            id: ContactId(id),
            centroid: Vec2::new(x, 0.5),
            force: Newtons(force),
            ..Contact::default()
        }
    }

    fn at(picker: &mut CursorPicker, ms: u64, contacts: &[Contact]) -> Option<u32> {
        picker.update(AREA, contacts, Instant::from_millis(ms)).map(|cursor| cursor.contact.0)
    }

    #[test]
    fn the_stance_foot_beside_the_region_is_never_the_cursor() {
        let mut picker = CursorPicker::default();
        assert_eq!(at(&mut picker, 0, &[foot(1, 1.1, 700.0)]), None);
        assert_eq!(at(&mut picker, 1, &[foot(1, 1.1, 700.0), foot(2, 0.8, 30.0)]), Some(2));
    }

    #[test]
    fn nearly_equal_feet_do_not_make_it_flicker() {
        let mut picker = CursorPicker::default();
        let mut changes = 0;
        let mut last = None;
        for ms in 0..1000 {
            let sway = if ms % 40 < 20 { 40.0 } else { -40.0 };
            let cursor = at(&mut picker, ms, &[foot(1, 0.2, 350.0 + sway), foot(2, 0.6, 350.0 - sway)]);
            changes += u32::from(last.is_some() && cursor != last);
            last = cursor;
        }
        assert_eq!(changes, 0);
    }

    #[test]
    fn a_rival_wins_after_50_ms_above_the_margin() {
        let mut picker = CursorPicker::default();
        let light = foot(1, 0.2, 100.0);
        at(&mut picker, 0, std::slice::from_ref(&light));
        let both = [light, foot(2, 0.6, 120.0)];
        assert_eq!(at(&mut picker, 10, &both), Some(1));
        assert_eq!(at(&mut picker, 59, &both), Some(1));
        assert_eq!(at(&mut picker, 60, &both), Some(2));
    }

    #[test]
    fn a_held_foot_stays_the_cursor_outside_until_it_lifts() {
        let mut picker = CursorPicker::default();
        picker.hold(Some(ContactId(1)));
        assert_eq!(at(&mut picker, 0, &[foot(1, 1.5, 20.0), foot(2, 0.5, 700.0)]), Some(1));
        assert_eq!(at(&mut picker, 1, &[foot(2, 0.5, 700.0)]), Some(2));
        assert_eq!(at(&mut picker, 2, &[foot(1, 1.5, 20.0), foot(2, 0.5, 700.0)]), Some(2));
    }
}
