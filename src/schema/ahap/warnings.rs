//! Differences between a pattern and the effect made from it.

use std::collections::BTreeMap;

/// Notes, each with the number of its occurrences.
#[derive(Debug, Default)]
pub(super) struct ImportNotes {
    notes: BTreeMap<String, usize>,
    /// Notes beyond [`MOST`].
    more: usize,
}

/// Maximum number of different notes; a file of 4 MB could cause a hundred thousand.
const MOST: usize = 40;

impl ImportNotes {
    /// Notes that `it` has no counterpart.
    pub(super) fn lost(&mut self, it: String) {
        self.note(it + LOST);
    }

    /// Notes a difference in full.
    pub(super) fn note(&mut self, difference: String) {
        if self.notes.len() >= MOST && !self.notes.contains_key(&difference) {
            self.more += 1;
            return;
        }
        *self.notes.entry(difference).or_default() += 1;
    }

    /// Returns all notes as lines.
    pub(super) fn into_lines(self) -> Vec<String> {
        let line = |(note, count): (String, usize)| match (count, note.split_once(": ")) {
            (2.., Some((what, rest))) => format!("{what} ({count} times): {rest}"),
            _ => note,
        };
        let more = (self.more > 0).then(|| format!("and {} further differences", self.more));
        self.notes.into_iter().map(line).chain(more).collect()
    }
}

const LOST: &str = ": no counterpart, left out";
