//! The state of one region: the contacts that are its cursors, and the control under each of them.

use glam::Vec2;

use crate::layout::{CursorRule, Region};
use crate::sense::{Contact, ContactId, Cursor, CursorPicker};
use crate::units::{Instant, Newtons};

/// A foot that has engaged a control.
#[derive(Clone, Copy, Debug)]
pub(super) struct EngagedFoot {
    pub(super) widget: usize,
    pub(super) contact: ContactId,
    pub(super) force: Newtons,
    pub(super) position: Vec2,
}

/// A contact that operates controls, as a finger does on a screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finger {
    pub(super) cursor: Cursor,
    /// The control below it in the last frame, if this finger fed that control.
    pub(super) over: Option<usize>,
    /// The control that keeps it.
    pub(super) held: Option<EngagedFoot>,
}

impl Finger {
    fn new(contact: &Contact) -> Self {
        Self { cursor: Cursor::of(contact), over: None, held: None }
    }

    /// Whether this finger is on the control `widget`, or held by it.
    pub(super) fn has(&self, widget: usize) -> bool {
        self.over == Some(widget) || self.holds(widget)
    }

    /// Whether the control `widget` keeps this foot.
    pub(super) fn holds(&self, widget: usize) -> bool {
        self.held.is_some_and(|held| held.widget == widget)
    }
}

/// The state of one region.
#[derive(Debug, Default)]
pub(super) struct RegionState {
    picker: CursorPicker,
    cursor: Option<Cursor>,
    pub(super) fingers: Vec<Finger>,
}

impl RegionState {
    /// The cursor; the heaviest of several.
    pub(super) fn cursor(&self) -> Option<Cursor> {
        self.cursor
    }

    /// The cursors besides [`RegionState::cursor`].
    pub(super) fn more_cursors(&self) -> impl Iterator<Item = Cursor> + '_ {
        let first = self.cursor.map(|cursor| cursor.contact);
        self.fingers.iter().map(|finger| finger.cursor).filter(move |cursor| Some(cursor.contact) != first)
    }

    pub(super) fn held(&self) -> impl Iterator<Item = EngagedFoot> + Clone + '_ {
        self.fingers.iter().filter_map(|finger| finger.held)
    }

    /// Finds the region's cursors among those `contacts` for which `may` is true.
    pub(super) fn point(
        &mut self,
        region: &Region,
        contacts: &[Contact],
        may: impl Fn(&Contact) -> bool,
        now: Instant,
    ) {
        let area = region.area;
        let may = |contact: &Contact| area.contains(contact.centroid) && may(contact);
        let each = region.cursor == CursorRule::Each;
        let held = self.held().next().map(|held| held.contact);
        // An engaged control follows its own foot, independent of all others.
        self.picker.hold(held.filter(|_| !each));
        self.cursor = self.picker.choose(contacts, may, now);
        let cursor = self.cursor.map(|cursor| cursor.contact);
        self.fingers.retain(|finger| {
            let id = finger.cursor.contact;
            finger.held.is_some()
                || if each {
                    contacts.iter().any(|contact| contact.id == id && may(contact))
                } else {
                    held.is_none() && cursor == Some(id)
                }
        });
        for finger in &mut self.fingers {
            if let Some(contact) = contacts.iter().find(|contact| contact.id == finger.cursor.contact) {
                finger.cursor = Cursor::of(contact);
            }
        }
        for contact in contacts {
            let points = if each { may(contact) } else { held.is_none() && cursor == Some(contact.id) };
            if points && !self.fingers.iter().any(|finger| finger.cursor.contact == contact.id) {
                self.fingers.push(Finger::new(contact));
            }
        }
    }

    /// Releases the foot that `widget` keeps.
    pub(super) fn let_go(&mut self, widget: usize) -> Option<EngagedFoot> {
        let finger = self.fingers.iter_mut().find(|finger| finger.holds(widget))?;
        finger.over = None;
        finger.held.take()
    }
}
