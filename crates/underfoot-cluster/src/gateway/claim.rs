//! The node that serves an area.

use std::time::Duration;

use underfoot::units::Instant;

/// Time for which a silent node still claims its area against another claimant.
const CLAIMED_FOR: Duration = Duration::from_secs(1);

/// Nodes of one area that are counted separately; the dispute holds with more of them as well.
const MOST: usize = 8;

/// One node's claim.
#[derive(Clone, Debug)]
struct Claim {
    node: u64,
    name: String,
    first: Instant,
    heard: Instant,
}

/// The claims of one area.
#[derive(Clone, Debug, Default)]
pub(super) struct Claims(Vec<Claim>);

/// The node that serves an area.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Holder {
    /// No node has claimed it recently.
    Nobody,
    /// This node.
    One(u64),
    /// Several nodes keep claiming it.
    Disputed,
}

impl Claims {
    /// Notes that the node `node` with the name `name` claims the area.
    pub(super) fn note(&mut self, node: u64, name: &str, now: Instant) {
        match self.0.iter_mut().find(|claim| claim.node == node) {
            Some(claim) => claim.heard = now,
            None => {
                if self.0.len() == MOST {
                    self.0.remove(0);
                }
                self.0.push(Claim { node, name: name.to_owned(), first: now, heard: now });
            }
        }
    }

    /// The node that serves the area. A node that replaces another one holds it; two that alternate dispute it, until
    /// all but one have been silent for a second.
    pub(super) fn holder(&mut self, now: Instant) -> Holder {
        let latest = self.0.iter().map(|claim| claim.heard).max();
        self.0.retain(|claim| now.since(claim.heard) < CLAIMED_FOR || Some(claim.heard) == latest);
        let Some(last) = self.0.iter().max_by_key(|claim| claim.first) else { return Holder::Nobody };
        let is_old = |claim: &&Claim| claim.node != last.node;
        match self.0.iter().filter(is_old).any(|old| old.heard >= last.first) {
            true => Holder::Disputed,
            false => Holder::One(last.node),
        }
    }

    /// The names of the nodes.
    pub(super) fn names(&self) -> String {
        let names: Vec<&str> = self.0.iter().map(|claim| claim.name.as_str()).collect();
        names.join(" and ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> Instant {
        Instant::from_millis(ms)
    }

    #[test]
    fn a_node_that_starts_again_takes_its_own_place() {
        let mut claims = Claims::default();
        assert_eq!(claims.holder(at(0)), Holder::Nobody);
        claims.note(1, "first", at(0));
        claims.note(1, "first", at(300));
        claims.note(2, "second", at(302));
        assert_eq!(claims.holder(at(302)), Holder::One(2));
        assert_eq!(claims.holder(at(60_000)), Holder::One(2), "also when it has long been silent");
    }

    #[test]
    fn two_that_take_turns_both_lose_until_one_gives_way() {
        let mut claims = Claims::default();
        claims.note(1, "first", at(0));
        claims.note(2, "second", at(10));
        claims.note(1, "first", at(12));
        assert_eq!(claims.holder(at(12)), Holder::Disputed);
        assert_eq!(claims.names(), "first and second");
        (1..20).for_each(|tick| claims.note(1, "first", at(12 + 100 * tick)));
        assert_eq!(claims.holder(at(1000)), Holder::Disputed);
        assert_eq!(claims.holder(at(1912)), Holder::One(1));
    }
}
