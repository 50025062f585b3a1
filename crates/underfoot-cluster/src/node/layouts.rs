//! The layouts of a node: the one that runs, and the one that follows at a given time.
//!
//! ```text
//! gateway: a layout's text -> checked here -> "ready" or "refused"
//! gateway: that one, from a moment on      -> on the floor at that moment, or when the foot that is on a control lifts
//! ```

use std::time::Duration;

use underfoot::units::Instant;

use crate::message::{LayoutName, LayoutOrder, LayoutStanding};

/// Time after which the node leaves a silent leading gateway; without it, two gateways with different layouts would
/// take turns.
const LEADS_FOR: Duration = Duration::from_secs(1);

/// A node's layouts; `L` is the type of a checked layout.
#[derive(Clone, Debug)]
pub struct NodeLayouts<L> {
    standing: LayoutStanding,
    /// The layout that passed its check.
    ready: Option<(LayoutName, L)>,
    /// The time from which it is to run.
    due: Option<Instant>,
    /// The gateway that decides about layouts, and the time of its last message.
    leader: Option<(u64, Instant)>,
}

impl<L> NodeLayouts<L> {
    /// The layouts of a node that has one from its own file, or none.
    #[must_use]
    pub fn new(own: Option<LayoutName>) -> Self {
        let standing = LayoutStanding { running: own, ..LayoutStanding::default() };
        Self { standing, ready: None, due: None, leader: None }
    }

    /// The state of the layouts.
    #[must_use]
    pub const fn standing(&self) -> &LayoutStanding {
        &self.standing
    }

    /// Whether `gateway`, heard at `now`, is the one that decides about layouts.
    pub fn follows(&mut self, gateway: u64, now: Instant) -> bool {
        let others = self.leader.filter(|(leader, _)| *leader != gateway);
        if others.is_some_and(|(_, heard)| now.since(heard) < LEADS_FOR) {
            return false;
        }
        self.leader = Some((gateway, now));
        true
    }

    /// Whether the layout of that name has still to be checked.
    #[must_use]
    pub fn lacks(&self, name: &LayoutName) -> bool {
        let is_refused = self.standing.refused.as_ref().is_some_and(|(refused, _)| refused == name);
        !is_refused && self.standing.ready.as_ref() != Some(name)
    }

    /// Stores a checked layout, or the reason why it failed.
    pub fn note(&mut self, name: LayoutName, checked: Result<L, String>) {
        match checked {
            Ok(layout) => {
                self.standing.ready = Some(name);
                self.ready = Some((name, layout));
                self.due = None;
            }
            Err(why) => self.standing.refused = Some((name, why)),
        }
    }

    /// Processes the gateway's instruction for the node of `area`.
    pub fn order(&mut self, order: &LayoutOrder, area: &str) {
        let Some(current) = order.current else { return };
        if self.standing.running == Some(current) {
            // The same text under another gateway's number.
            self.standing.running = Some(current);
            return;
        }
        let from = order.from.iter().find(|(id, _)| id == area).map(|(_, from)| Instant::from_micros(*from));
        if self.standing.ready == Some(current) {
            self.due = from;
        }
    }

    /// The layout that is due at `now`; each is returned once.
    pub fn take_due(&mut self, now: Instant) -> Option<(LayoutName, L)> {
        if self.due.is_none_or(|due| now < due) {
            return None;
        }
        self.due = None;
        let (name, layout) = self.ready.take()?;
        self.standing.running = Some(name);
        self.standing.ready = None;
        Some((name, layout))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> Instant {
        Instant::from_millis(ms)
    }

    fn order(name: LayoutName, ms: u64) -> LayoutOrder {
        LayoutOrder { current: Some(name), from: vec![("west".into(), at(ms).micros())] }
    }

    #[test]
    fn a_layout_is_on_the_floor_at_the_moment_that_is_ordered_and_once() {
        let [old, new] = ["old", "new"].map(|text| LayoutName::of(1, text));
        let mut layouts = NodeLayouts::new(Some(old));
        layouts.order(&order(old, 0), "west");
        assert_eq!(layouts.take_due(at(5)), None, "it has that one");
        assert!(layouts.lacks(&new));
        layouts.order(&order(new, 100), "west");
        assert_eq!(layouts.take_due(at(200)), None, "it has not been checked");
        layouts.note(new, Ok("checked"));
        assert!(!layouts.lacks(&new));
        assert_eq!(layouts.take_due(at(200)), None, "ready is not ordered");
        layouts.order(&order(new, 300), "west");
        assert_eq!(layouts.take_due(at(299)), None);
        assert_eq!(layouts.take_due(at(300)), Some((new, "checked")));
        layouts.order(&order(new, 300), "west");
        assert_eq!(layouts.take_due(at(400)), None);
        assert_eq!(layouts.standing().running, Some(new));
    }

    #[test]
    fn what_is_refused_is_said_and_not_checked_again_and_never_on_the_floor() {
        let bad = LayoutName::of(2, "bad");
        let mut layouts = NodeLayouts::<()>::new(None);
        layouts.note(bad, Err("no such kind".into()));
        assert!(!layouts.lacks(&bad));
        layouts.order(&order(bad, 0), "west");
        assert_eq!(layouts.take_due(at(9)), None);
        assert_eq!(layouts.standing().refused, Some((bad, "no such kind".into())));
    }

    #[test]
    fn of_two_gateways_the_first_counts_until_it_is_silent() {
        let mut layouts = NodeLayouts::<()>::new(None);
        assert!(layouts.follows(1, at(0)) && !layouts.follows(2, at(500)) && layouts.follows(1, at(900)));
        assert!(!layouts.follows(2, at(1800)) && layouts.follows(2, at(1900)));
        assert!(!layouts.follows(1, at(1950)));
    }
}
