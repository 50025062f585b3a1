//! One layout on all nodes: proposed to all, and active on all from one time on, or on none.
//!
//! ```text
//! propose -> text to all nodes -> each live one is ready -> current, from a moment on that all nodes know
//!                              \-> one refuses, or does not answer for 5 s -> all keep the one they have
//! a node that joins -> text of the current one -> current at once
//! ```

use std::time::Duration;

use underfoot::units::Instant;

use crate::message::{LayoutName, LayoutStanding};

/// Time within which nodes must check a layout.
const ANSWER_WITHIN: Duration = Duration::from_secs(5);

/// Time from the decision to the change on all nodes: two beats.
const AHEAD: Duration = Duration::from_millis(100);

/// Interval at which a text is sent again while a node lacks it.
const SEND_EVERY: Duration = Duration::from_millis(500);

/// A layout's name and text.
#[derive(Clone, Debug, PartialEq)]
struct Text {
    name: LayoutName,
    text: String,
}

#[derive(Clone, Debug)]
struct Proposal {
    text: Text,
    since: Instant,
}

/// The outcome of a proposal.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ProposalOutcome {
    /// All nodes run it from that time on.
    Current(LayoutName, Instant),
    /// No node runs it.
    Dropped(LayoutName, String),
    /// A node that joined refuses the current one.
    Unfit(String, String),
}

/// A live node: its area, and the state of its layouts.
pub(super) type NodeLayout<'a> = (&'a str, &'a LayoutStanding);

/// The layouts of a gateway.
#[derive(Clone, Debug, Default)]
pub(super) struct GatewayLayouts {
    revision: u64,
    current: Option<(Text, Instant)>,
    proposed: Option<Proposal>,
    send_due: Instant,
    /// Areas reported as refusing the current layout.
    unfit: Vec<String>,
}

impl GatewayLayouts {
    /// Proposes the layout that `text` describes, in place of any earlier proposal.
    pub(super) fn propose(&mut self, text: String, now: Instant) -> LayoutName {
        self.revision += 1;
        let name = LayoutName::of(self.revision, &text);
        self.proposed = Some(Proposal { text: Text { name, text }, since: now });
        self.send_due = now;
        name
    }

    /// Whether `text` is that of the proposal, or of the current layout without one.
    pub(super) fn is_known(&self, text: &str) -> bool {
        let proposed = self.proposed.as_ref().map(|proposal| &proposal.text);
        proposed.or(self.current.as_ref().map(|(text, _)| text)).is_some_and(|known| known.text == text)
    }

    /// The current layout, and the time from which it applies.
    pub(super) fn current(&self) -> Option<(LayoutName, Instant)> {
        self.current.as_ref().map(|(text, from)| (text.name, *from))
    }

    /// The text that nodes need at `now`.
    pub(super) fn send<'a>(
        &mut self,
        mut live: impl Iterator<Item = NodeLayout<'a>>,
        now: Instant,
    ) -> Option<(LayoutName, &str)> {
        if now < self.send_due {
            return None;
        }
        let proposed = self.proposed.as_ref().map(|proposal| &proposal.text);
        let text = proposed.or(self.current.as_ref().map(|(text, _)| text))?;
        let lacks = |standing: &LayoutStanding| {
            let is_refused = standing.refused.as_ref().is_some_and(|(name, _)| *name == text.name);
            !is_refused && standing.ready != Some(text.name) && standing.running != Some(text.name)
        };
        if !live.any(|(_, standing)| lacks(standing)) {
            return None;
        }
        self.send_due = now + SEND_EVERY;
        Some((text.name, &text.text))
    }

    /// The decision at `now`, given the live nodes.
    pub(super) fn decide<'a>(
        &mut self,
        live: impl Iterator<Item = NodeLayout<'a>> + Clone,
        now: Instant,
    ) -> Option<ProposalOutcome> {
        let Some(proposal) = &self.proposed else { return self.unfit(live) };
        let (name, since) = (proposal.text.name, proposal.since);
        let refused = live.clone().find_map(|(area, standing)| {
            let (_, why) = standing.refused.as_ref().filter(|(refused, _)| *refused == name)?;
            Some(format!("the node of area \"{area}\" refuses it: {why}"))
        });
        let has_it = |standing: &LayoutStanding| [standing.ready, standing.running].contains(&Some(name));
        let mut missing = live.filter(|(_, standing)| !has_it(standing)).map(|(area, _)| area).peekable();
        let why = match (refused, missing.peek()) {
            (Some(why), _) => why,
            (None, None) => {
                let text = self.proposed.take().map(|proposal| proposal.text)?;
                let from = now + AHEAD;
                self.current = Some((text, from));
                self.unfit.clear();
                return Some(ProposalOutcome::Current(name, from));
            }
            (None, Some(area)) if now.since(since) > ANSWER_WITHIN => {
                format!("the node of area \"{area}\" does not say within 5 s that it has it")
            }
            (None, Some(_)) => return None,
        };
        self.proposed = None;
        Some(ProposalOutcome::Dropped(name, why))
    }

    /// A node that refuses the current layout and has not been reported yet.
    fn unfit<'a>(&mut self, live: impl Iterator<Item = NodeLayout<'a>>) -> Option<ProposalOutcome> {
        let name = self.current.as_ref()?.0.name;
        for (area, standing) in live {
            let Some((_, why)) = standing.refused.as_ref().filter(|(refused, _)| *refused == name) else {
                continue;
            };
            if !self.unfit.iter().any(|known| known == area) {
                self.unfit.push(area.to_owned());
                return Some(ProposalOutcome::Unfit(area.to_owned(), why.clone()));
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> Instant {
        Instant::from_millis(ms)
    }

    /// Two nodes and the states of their layouts.
    struct Nodes([LayoutStanding; 2]);

    impl Nodes {
        fn live(&self) -> impl Iterator<Item = NodeLayout<'_>> + Clone {
            ["west", "east"].into_iter().zip(&self.0)
        }
    }

    #[test]
    fn a_layout_is_current_when_all_live_nodes_are_ready_and_from_a_moment_to_come() {
        let mut layouts = GatewayLayouts::default();
        let mut nodes = Nodes(Default::default());
        let name = layouts.propose("new".into(), at(0));
        assert_eq!(layouts.send(nodes.live(), at(0)), Some((name, "new")));
        assert_eq!(layouts.send(nodes.live(), at(400)), None, "not again at once");
        nodes.0[0].ready = Some(name);
        assert_eq!(layouts.decide(nodes.live(), at(10)), None);
        assert!(layouts.send(nodes.live(), at(500)).is_some());
        nodes.0[1].ready = Some(name);
        assert_eq!(layouts.decide(nodes.live(), at(600)), Some(ProposalOutcome::Current(name, at(700))));
        assert_eq!(layouts.current(), Some((name, at(700))));
        assert_eq!(layouts.send(nodes.live(), at(9000)), None);
        // A node that joins receives it.
        nodes.0[1] = LayoutStanding::default();
        assert_eq!(layouts.send(nodes.live(), at(9500)), Some((name, "new")));
    }

    #[test]
    fn a_layout_that_one_node_refuses_or_does_not_answer_is_no_node_s() {
        let mut layouts = GatewayLayouts::default();
        let mut nodes = Nodes(Default::default());
        let old = layouts.propose("old".into(), at(0));
        nodes.0.iter_mut().for_each(|node| node.ready = Some(old));
        layouts.decide(nodes.live(), at(1));
        let bad = layouts.propose("bad".into(), at(1000));
        nodes.0[0].ready = Some(bad);
        nodes.0[1].refused = Some((bad, "no such kind".into()));
        let said = "the node of area \"east\" refuses it: no such kind".to_owned();
        assert_eq!(layouts.decide(nodes.live(), at(1001)), Some(ProposalOutcome::Dropped(bad, said)));
        assert_eq!(layouts.current(), Some((old, at(101))));
        let slow = layouts.propose("slow".into(), at(2000));
        nodes.0[0].ready = Some(slow);
        assert_eq!(layouts.decide(nodes.live(), at(7000)), None);
        let dropped = layouts.decide(nodes.live(), at(7001)).unwrap();
        assert!(
            matches!(&dropped, ProposalOutcome::Dropped(_, why) if why.contains("\"east\"")),
            "{dropped:?}"
        );
        assert!(bad.revision < slow.revision);
    }

    #[test]
    fn a_node_that_joins_and_does_not_take_the_current_layout_is_named_once() {
        let mut layouts = GatewayLayouts::default();
        let mut nodes = Nodes(Default::default());
        let name = layouts.propose("new".into(), at(0));
        assert!(
            matches!(layouts.decide([].into_iter(), at(1)), Some(ProposalOutcome::Current(..))),
            "nobody to ask"
        );
        nodes.0[1].refused = Some((name, "why".into()));
        let named = ProposalOutcome::Unfit("east".into(), "why".into());
        assert_eq!(layouts.decide(nodes.live(), at(2)), Some(named));
        assert_eq!(layouts.decide(nodes.live(), at(3)), None);
    }
}
