//! Requests of apps that nodes have not all answered yet.

use std::net::SocketAddr;
use std::time::Duration;

use underfoot::units::Instant;
use underfoot::wire::ControlMessage;

use crate::message::{NodeAnswer, NodeRequest, NodeState};

/// Time within which nodes must answer: a node waits 200 ms for its sensing thread, and each direction may add delay.
const ANSWER_WITHIN: Duration = Duration::from_millis(500);

/// Greatest number of open requests; further ones are refused.
const MOST: usize = 1024;

/// The origin of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Asker {
    /// An app.
    App(Option<SocketAddr>),
    /// The gateway, to bring a node to the state of the others: no app receives the answer.
    Gateway,
}

/// The part of a request that concerns one node.
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

/// A request that all nodes have answered, or that has reached its time-out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Answered {
    pub(super) asker: Asker,
    pub(super) message: ControlMessage,
    /// The states of controls afterwards, or the reason why one node at least refused it.
    pub(super) done: Result<Vec<NodeState>, String>,
}

/// The open requests.
#[derive(Clone, Debug, Default)]
pub(super) struct Requests {
    number: u64,
    open: Vec<Open>,
    /// Whether some have not been in a beat yet.
    are_new: bool,
}

impl Requests {
    /// Sends a request to the nodes of `areas`, by number and name; returns false if too many requests are open.
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

    /// Whether a request was added since the last call.
    pub(super) const fn take_news(&mut self) -> bool {
        std::mem::replace(&mut self.are_new, false)
    }

    /// The requests to nodes without an answer, in order.
    pub(super) fn unanswered(&self) -> impl Iterator<Item = &NodeRequest> {
        let parts = self.open.iter().flat_map(|open| &open.parts);
        parts.filter(|part| part.answer.is_none()).map(|part| &part.request)
    }

    /// Stores an answer of the node of area number `area`.
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

    /// Answers all requests to the node of area number `area`, which is lost, with a refusal.
    pub(super) fn lose(&mut self, area: usize, name: &str) {
        let parts = self.open.iter_mut().flat_map(|open| &mut open.parts);
        for part in parts.filter(|part| part.area == area) {
            part.answer.get_or_insert_with(|| Err(format!("its area \"{name}\" is lost")));
        }
    }

    /// Removes and returns the complete requests at `now`, in the order in which they came.
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
