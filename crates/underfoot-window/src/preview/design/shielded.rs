//! Locked records, which the pointer cannot grab, and hidden ones, which are not drawn.

use std::collections::BTreeSet;

use super::edited::EditedLayout;
use crate::edit::Address;

impl EditedLayout {
    /// The key of a record while others are added and removed: its id, or its place in the text.
    pub(super) fn key_of(&self, record: &Address) -> String {
        self.document.id_of(record).map_or_else(|| record.to_string(), str::to_owned)
    }

    /// Whether `keys` contains the record or a group around it.
    pub(super) fn is_in(&self, keys: &BTreeSet<String>, record: &Address) -> bool {
        if keys.is_empty() {
            return false;
        }
        let mut next = Some(record.clone());
        while let Some(record) = next {
            if record.split().is_some() && keys.contains(&self.key_of(&record)) {
                return true;
            }
            next = record.split().map(|(parent, ..)| parent);
        }
        false
    }

    pub(super) fn is_locked(&self, record: &Address) -> bool {
        self.is_in(&self.locked, record)
    }

    pub(super) fn is_hidden(&self, record: &Address) -> bool {
        self.is_in(&self.hidden, record)
    }

    pub(super) fn turn_lock(&mut self, records: &[Address]) {
        let keys: Vec<String> = records.iter().map(|record| self.key_of(record)).collect();
        turn(&mut self.locked, keys);
    }

    pub(super) fn turn_hidden(&mut self, records: &[Address]) {
        let keys: Vec<String> = records.iter().map(|record| self.key_of(record)).collect();
        turn(&mut self.hidden, keys);
    }

    /// Whether a selected record is locked; shows a message in that case.
    pub(super) fn holds_locked(&mut self) -> bool {
        let locked = self.selected.iter().find(|record| self.is_locked(record)).cloned();
        if let Some(record) = &locked {
            self.complain(format!("{} is locked; Ctrl+L unlocks it", self.key_of(record)));
        }
        locked.is_some()
    }
}

/// Adds `keys`, or removes them if the set contains all of them.
fn turn(set: &mut BTreeSet<String>, keys: Vec<String>) {
    if keys.iter().all(|key| set.contains(key)) {
        set.retain(|key| !keys.contains(key));
    } else {
        set.extend(keys);
    }
}
