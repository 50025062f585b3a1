//! Changes of a text, with undo and redo.

/// One step: an offset in the text, with the old and the new content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct UndoStep {
    at: usize,
    old: String,
    new: String,
    /// Steps with the same stroke, from one drag or one stretch of typing, are merged.
    pub(super) stroke: Option<u64>,
}

impl UndoStep {
    /// The difference between two texts.
    pub(super) fn between(before: &str, after: &str, stroke: Option<u64>) -> Self {
        let same = |(a, b): &(u8, u8)| a == b;
        let head = before.bytes().zip(after.bytes()).take_while(same).count();
        let head = before.floor_char_boundary(head).min(after.floor_char_boundary(head));
        let (old, new) = (&before[head..], &after[head..]);
        let tail = old.bytes().rev().zip(new.bytes().rev()).take_while(same).count();
        let (mut from, mut to) = (old.len() - tail, new.len() - tail);
        while !old.is_char_boundary(from) || !new.is_char_boundary(to) {
            (from, to) = (from + 1, to + 1);
        }
        Self { at: head, old: old[..from].to_owned(), new: new[..to].to_owned(), stroke }
    }

    fn is_nothing(&self) -> bool {
        self.old == self.new
    }

    fn put(&self, text: &str, out: &str, into: &str) -> String {
        let (head, rest) = text.split_at(self.at);
        [head, into, rest.strip_prefix(out).unwrap_or(rest)].concat()
    }

    /// The text before this step.
    pub(super) fn undone(&self, text: &str) -> String {
        self.put(text, &self.new, &self.old)
    }

    /// The text after this step.
    pub(super) fn redone(&self, text: &str) -> String {
        self.put(text, &self.old, &self.new)
    }
}

/// The steps of a text, both done and undone ones.
#[derive(Clone, Debug, Default)]
pub(super) struct UndoHistory {
    steps: Vec<UndoStep>,
    /// The number of steps that are done.
    done: usize,
}

impl UndoHistory {
    /// Records that `before` became `after`; clears the undone steps.
    pub(super) fn note(&mut self, before: &str, after: &str, stroke: Option<u64>) {
        let last = self.last().filter(|last| stroke.is_some() && last.stroke == stroke);
        let (keep, step) = match last {
            Some(last) => (self.done - 1, UndoStep::between(&last.undone(before), after, stroke)),
            None => (self.done, UndoStep::between(before, after, stroke)),
        };
        if before == after {
            return;
        }
        self.steps.truncate(keep);
        self.steps.extend(Some(step).filter(|step| !step.is_nothing()));
        self.done = self.steps.len();
    }

    /// The next step to undo.
    pub(super) fn last(&self) -> Option<&UndoStep> {
        self.steps.get(self.done.checked_sub(1)?)
    }

    /// The next step to redo.
    pub(super) fn next(&self) -> Option<&UndoStep> {
        self.steps.get(self.done)
    }

    /// The number of steps that are done.
    pub(super) fn done(&self) -> usize {
        self.done
    }

    pub(super) fn go_back(&mut self) {
        self.done = self.done.saturating_sub(1);
    }

    pub(super) fn go_on(&mut self) {
        self.done = self.steps.len().min(self.done + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_holds_what_differs_whole_characters_of_it() {
        for (before, after) in [("abc", "axc"), ("", "é"), ("aé", "aè"), ("aa", "aaa"), ("ab", "")] {
            let step = UndoStep::between(before, after, None);
            assert_eq!((step.redone(before).as_str(), step.undone(after).as_str()), (after, before));
        }
        assert_eq!(UndoStep::between("at: (1, 2)", "at: (1, 3)", None).new, "3");
    }

    #[test]
    fn one_stroke_is_one_step() {
        let mut history = UndoHistory::default();
        for (before, after) in [("0", "1"), ("1", "2"), ("2", "3")] {
            history.note(before, after, Some(7));
        }
        history.note("3", "4", Some(8));
        assert_eq!(history.last().unwrap().undone("4"), "3");
        history.go_back();
        assert_eq!(history.last().unwrap().undone("3"), "0");
        // A drag that returns to its start is not a step.
        history.note("3", "0", Some(7));
        assert!(history.last().is_none() && history.next().is_none());
    }
}
