//! The anti-replay window: each counter of a sender counts once.

/// Distance behind the greatest counter at which one is still accepted: datagrams overtake each other on a network.
const BEHIND: u64 = 64;

/// Greatest step of the counter: as many messages as a node sends in half an hour, so that a node that was cut off
/// for that long is accepted at once.
const AHEAD: u64 = 1 << 20;

/// Greatest counter of any sender: a million messages a second for 290,000 years.
const GREATEST: u64 = u64::MAX >> 1;

/// Relation of a counter to those that have come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Novelty {
    /// It is greater than all of them.
    Newest,
    /// It is new, but a greater one has come.
    Overtaken,
    /// It has come, or lies behind the window.
    Repeated,
    /// It is further beyond them than any sender's counter gets.
    Jumped,
}

/// The counters of one sender.
///
/// # Source
/// RFC 4303, appendix A2: the anti-replay window of IPsec.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReplayWindow {
    newest: u64,
    /// Bit n: whether `newest - n` has come.
    seen: u64,
}

impl ReplayWindow {
    /// The window after a sender's first message with this `counter`; `None` beyond the greatest counter of any
    /// sender.
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

    /// Adds a `counter` that is neither repeated nor jumped.
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
        let window = ReplayWindow::beginning(5).unwrap();
        for counter in [5 + AHEAD + 1, GREATEST, GREATEST + 1, u64::MAX] {
            assert_eq!(window.look(counter), Novelty::Jumped, "{counter}");
        }
        assert_eq!(window.look(6), Novelty::Newest);
        assert_eq!(window.look(5 + AHEAD), Novelty::Newest);
        assert!(ReplayWindow::beginning(u64::MAX).is_none());
    }

    proptest! {
        /// Compared with a set of all counters that have come.
        #[test]
        fn each_counter_counts_once_in_any_order(
            steps in prop::collection::vec(-80_i64..90, 1..400),
        ) {
            let mut window = ReplayWindow::beginning(1000).unwrap();
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
