//! Which counters of one sender have come: each counts once.

/// How far behind the greatest counter one may come, as datagrams overtake each other on a network.
const BEHIND: u64 = 64;

/// How far beyond the greatest counter the next one may be: what a node sends in half an hour without a pause, so that
/// one that was cut off for that long is taken at once.
const AHEAD: u64 = 1 << 20;

/// Greatest counter that a sender reaches: a million messages a second for 290,000 years.
const GREATEST: u64 = u64::MAX >> 1;

/// What a counter is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Novelty {
    /// It has not come, and is greater than all that have.
    Newest,
    /// It has not come; a greater one has.
    Overtaken,
    /// It has come, or is so far behind that nobody knows.
    Repeated,
    /// It is further beyond the others than a sender gets.
    Jumped,
}

/// The counters of one sender.
///
/// # Source
/// RFC 4303, appendix A2: the anti-replay window of IPsec.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    newest: u64,
    /// Bit n: whether `newest - n` has come.
    seen: u64,
}

impl Window {
    /// The window of a sender of which `counter` came first; `None` for one that no sender reaches.
    pub(super) fn beginning(counter: u64) -> Option<Self> {
        (counter <= GREATEST).then_some(Self { newest: counter, seen: 1 })
    }

    pub(super) fn look(&self, counter: u64) -> Novelty {
        if counter > self.newest {
            let is_near = counter - self.newest <= AHEAD && counter <= GREATEST;
            return if is_near { Novelty::Newest } else { Novelty::Jumped };
        }
        let behind = self.newest - counter;
        let has_come = behind >= BEHIND || self.seen >> behind & 1 == 1;
        if has_come { Novelty::Repeated } else { Novelty::Overtaken }
    }

    /// Takes note that `counter` has come, which is neither repeated nor jumped.
    pub(super) fn note(&mut self, counter: u64) {
        if counter > self.newest {
            let step = counter - self.newest;
            self.seen = if step < BEHIND { self.seen << step | 1 } else { 1 };
            self.newest = counter;
        } else {
            self.seen |= 1_u64.checked_shl((self.newest - counter) as u32).unwrap_or(0);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_counter_far_beyond_the_last_one_changes_nothing() {
        let window = Window::beginning(5).unwrap();
        for counter in [5 + AHEAD + 1, GREATEST, GREATEST + 1, u64::MAX] {
            assert_eq!(window.look(counter), Novelty::Jumped, "{counter}");
        }
        assert_eq!(window.look(6), Novelty::Newest);
        assert_eq!(window.look(5 + AHEAD), Novelty::Newest);
        assert!(Window::beginning(u64::MAX).is_none());
    }

    proptest! {
        /// Against a set of all that have come: none is taken twice, and none near the newest is taken for one that has.
        #[test]
        fn each_counter_counts_once_in_whatever_order_they_come(
            steps in prop::collection::vec(-80_i64..90, 1..400),
        ) {
            let mut window = Window::beginning(1000).unwrap();
            let mut come = BTreeSet::from([1000_u64]);
            let mut last = 1000_i64;
            for step in steps {
                last = (last + step).max(0);
                let counter = last as u64;
                let newest = *come.last().unwrap();
                let novelty = window.look(counter);
                let expected = if counter > newest {
                    Novelty::Newest
                } else if come.contains(&counter) || newest - counter >= BEHIND {
                    Novelty::Repeated
                } else {
                    Novelty::Overtaken
                };
                prop_assert_eq!(novelty, expected);
                if novelty != Novelty::Repeated {
                    window.note(counter);
                    come.insert(counter);
                }
            }
        }
    }
}
