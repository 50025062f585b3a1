//! Several things in a row: how many, of what, with which labels.

use super::thing::PaletteThing;

/// Maximum number of things that one search puts down.
const MOST: usize = 24;

/// One part of a search such as `3 switch; slider: Bass, Treble`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PutOrder<'w> {
    /// The words that name the thing.
    pub(super) words: &'w str,
    count: usize,
    labels: &'w str,
}

/// A thing to put down, as often as the user asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::preview::design) struct InHand {
    pub(in crate::preview::design) thing: PaletteThing,
    /// How many are left, this one included.
    left: usize,
    /// The labels of the first of them.
    labels: Vec<String>,
}

impl<'w> PutOrder<'w> {
    /// The parts of a search; none without words.
    pub(super) fn all(search: &'w str) -> Vec<Self> {
        search.split(';').filter(|part| !part.trim().is_empty()).map(Self::of).collect()
    }

    fn of(part: &'w str) -> Self {
        let (name, labels) = part.split_once(':').unwrap_or((part, ""));
        let name = name.trim();
        let counted = name.split_once(char::is_whitespace).and_then(|(number, rest)| {
            let number = number.parse::<usize>().ok().filter(|number| (1..=MOST).contains(number))?;
            Some((number, rest.trim()))
        });
        let (count, words) = counted.unwrap_or((1, name));
        Self { words, count, labels }
    }

    /// This many of `thing`, with these labels.
    pub(super) fn take(self, thing: PaletteThing) -> InHand {
        let labels = self.labels.split(',').map(str::trim).filter(|label| !label.is_empty());
        let labels: Vec<String> = labels.take(MOST).map(str::to_owned).collect();
        InHand { thing, left: self.count.max(labels.len()), labels }
    }
}

impl InHand {
    /// One thing with its usual label.
    pub(super) const fn one(thing: PaletteThing) -> Self {
        Self { thing, left: 1, labels: Vec::new() }
    }

    /// The label of the next one; `None` for the usual one.
    pub(in crate::preview::design) fn label(&self) -> Option<&str> {
        self.labels.first().map(String::as_str)
    }

    /// The number that is left.
    pub(in crate::preview::design) const fn left(&self) -> usize {
        self.left
    }

    /// Goes on to the next one, after one was put down; with `stays` there always is a next one.
    pub(in crate::preview::design) fn next(mut self, stays: bool) -> Option<Self> {
        if !self.labels.is_empty() {
            self.labels.remove(0);
        }
        self.left = self.left.saturating_sub(1).max(usize::from(stays));
        (self.left > 0).then_some(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(search: &str) -> (String, usize, Vec<String>) {
        let order = PutOrder::of(search);
        let hand = order.take(PaletteThing::Region);
        (order.words.to_owned(), hand.left, hand.labels)
    }

    #[test]
    fn a_search_names_a_thing_a_number_and_labels() {
        let told = |words: &str, count, labels: &[&str]| {
            (words.to_owned(), count, labels.iter().map(|label| (*label).to_owned()).collect())
        };
        assert_eq!(order("heavy button"), told("heavy button", 1, &[]));
        assert_eq!(order(" 6  button "), told("button", 6, &[]));
        assert_eq!(order("button: Map, Über uns ,"), told("button", 2, &["Map", "Über uns"]));
        assert_eq!(order("4 dial: Bass"), told("dial", 4, &["Bass"]));
        assert_eq!(order("900 dial"), told("900 dial", 1, &[]));
        assert_eq!(order("6"), told("6", 1, &[]));
        assert_eq!(order(":"), told("", 1, &[]));
        let parts = PutOrder::all("2 switch; dial: Bass;; ");
        assert_eq!(parts.iter().map(|part| part.words).collect::<Vec<_>>(), ["switch", "dial"]);
        assert_eq!(PutOrder::all(" ; "), []);
    }

    #[test]
    fn labels_are_used_up_one_by_one() {
        let mut hand = PutOrder::of("3 dial: Bass, Treble").take(PaletteThing::Region);
        let mut labels = Vec::new();
        loop {
            labels.push(hand.label().unwrap_or_default().to_owned());
            match hand.next(false) {
                Some(next) => hand = next,
                None => break,
            }
        }
        assert_eq!(labels, ["Bass", "Treble", ""]);
        let one = PutOrder::of("dial").take(PaletteThing::Region);
        assert!(one.clone().next(true).is_some_and(|next| next.next(true).is_some()));
        assert_eq!(one.next(false), None);
    }
}
