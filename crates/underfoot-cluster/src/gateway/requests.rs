//! Requests of apps that nodes were asked and have not all answered.

use std::net::SocketAddr;
use std::time::Duration;

use underfoot::units::Instant;
use underfoot::wire::ControlMessage;

use crate::message::{NodeAnswer, NodeRequest, NodeState};

/// How long nodes may take: a node's own patience with its sensing thread is 200 ms, and each way may be late.
const ANSWER_WITHIN: Duration = Duration::from_millis(500);

/// Most requests that wait; further ones are refused.
const MOST: usize = 1024;

/// Who asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Asker {
    /// An app.
    App(Option<SocketAddr>),
    /// The gateway, to bring a node to where the others are: nobody hears of it.
    Gateway,
}

/// What was asked of one node.
#[derive(Clone, Debug)]
struct Part {
    area: usize,
    request: NodeRequest,
    answer: Option<Result<Vec<NodeState>, String>>,
}

#[derive(Clone, Debug)]
struct Open {
    asker: Asker,
    message: ControlMessage,
    parts: Vec<Part>,
    asked: Instant,
}

/// A request that all nodes have answered, or not in time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Answered {
    pub(super) asker: Asker,
    pub(super) message: ControlMessage,
    /// How controls are now, or why it was not done, by one node at least.
    pub(super) done: Result<Vec<NodeState>, String>,
}

/// Requests under way.
#[derive(Clone, Debug, Default)]
pub(super) struct Requests {
    number: u64,
    open: Vec<Open>,
    /// Whether there are some that no beat has carried yet.
    are_new: bool,
}

impl Requests {
    /// Asks the nodes of `areas`, by number and name; false if too many requests wait.
    pub(super) fn ask(
        &mut self,
        asker: Asker,
        message: ControlMessage,
        areas: &[(usize, String)],
        now: Instant,
    ) -> bool {
        if self.open.len() >= MOST {
            return false;
        }
        let mut parts = Vec::with_capacity(areas.len());
        for (area, name) in areas {
            self.number += 1;
            parts.push(Part {
                area: *area,
                request: NodeRequest::of(self.number, name, &message),
                answer: None,
            });
        }
        self.open.push(Open { asker, message, parts, asked: now });
        self.are_new = true;
        true
    }

    /// Whether something was asked since this was called last.
    pub(super) const fn take_news(&mut self) -> bool {
        std::mem::replace(&mut self.are_new, false)
    }

    /// What nodes are asked and have not answered, in order.
    pub(super) fn unanswered(&self) -> impl Iterator<Item = &NodeRequest> {
        let parts = self.open.iter().flat_map(|open| &open.parts);
        parts.filter(|part| part.answer.is_none()).map(|part| &part.request)
    }

    /// Takes note of an answer of the node of area number `area`.
    pub(super) fn note(&mut self, area: usize, answer: NodeAnswer) {
        let mut parts = self.open.iter_mut().flat_map(|open| &mut open.parts);
        let is_it = |part: &&mut Part| (part.area, part.request.number) == (area, answer.number);
        if let Some(part) = parts.find(is_it) {
            part.answer.get_or_insert(match answer.refused {
                Some(why) => Err(why),
                None => Ok(answer.states),
            });
        }
    }

    /// Takes note that the node of area number `area` is lost: it answers nothing.
    pub(super) fn lose(&mut self, area: usize, name: &str) {
        let parts = self.open.iter_mut().flat_map(|open| &mut open.parts);
        for part in parts.filter(|part| part.area == area) {
            part.answer.get_or_insert_with(|| Err(format!("its area \"{name}\" is lost")));
        }
    }

    /// Those that are over at `now`, in the order in which they were asked.
    pub(super) fn answered(&mut self, now: Instant) -> Vec<Answered> {
        let is_over = |open: &mut Open| {
            now.since(open.asked) > ANSWER_WITHIN || open.parts.iter().all(|part| part.answer.is_some())
        };
        let over = self.open.extract_if(.., is_over);
        over.map(|Open { asker, message, parts, .. }| {
            let answers = parts.into_iter().map(|part| {
                let unanswered =
                    || Err(format!("the node of area \"{}\" does not answer", part.request.area));
                part.answer.unwrap_or_else(unanswered)
            });
            let done: Result<Vec<Vec<NodeState>>, String> = answers.collect();
            Answered { asker, message, done: done.map(|states| states.concat()) }
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> Instant {
        Instant::from_millis(ms)
    }

    fn asked(requests: &mut Requests) -> Vec<u64> {
        requests.unanswered().map(|request| request.number).collect()
    }

    #[test]
    fn a_request_is_done_when_all_nodes_have_done_it() {
        let mut requests = Requests::default();
        let areas = [(0, "west".to_owned()), (1, "east".to_owned())];
        assert!(requests.ask(Asker::App(None), ControlMessage::CancelAll, &areas, at(0)));
        assert!(requests.take_news() && !requests.take_news());
        assert_eq!(asked(&mut requests), [1, 2]);
        let answer = |number| NodeAnswer { number, ..NodeAnswer::default() };
        requests.note(1, answer(1));
        assert_eq!(asked(&mut requests), [1, 2], "not that node's");
        requests.note(0, answer(1));
        assert_eq!((asked(&mut requests), requests.answered(at(400))), (vec![2], vec![]));
        requests.note(1, answer(2));
        let done = &requests.answered(at(400))[0];
        assert_eq!((&done.message, &done.done), (&ControlMessage::CancelAll, &Ok(vec![])));
    }

    #[test]
    fn a_node_that_refuses_is_lost_or_is_silent_is_why_it_is_not_done() {
        let mut requests = Requests::default();
        let areas = [(0, "west".to_owned())];
        for _ in 0..3 {
            requests.ask(Asker::App(None), ControlMessage::CancelAll, &areas, at(0));
        }
        let why = |requests: &mut Requests, ms| {
            requests.answered(at(ms)).pop().and_then(|answered| answered.done.err())
        };
        let refused = Some("it is locked".to_owned());
        requests.note(0, NodeAnswer { number: 1, refused, ..NodeAnswer::default() });
        assert_eq!(why(&mut requests, 1).as_deref(), Some("it is locked"));
        requests.open.pop();
        requests.lose(0, "west");
        assert_eq!(why(&mut requests, 2).as_deref(), Some("its area \"west\" is lost"));
        requests.ask(Asker::Gateway, ControlMessage::CancelAll, &areas, at(10));
        assert_eq!(why(&mut requests, 510), None);
        assert_eq!(why(&mut requests, 511).as_deref(), Some("the node of area \"west\" does not answer"));
    }
}
