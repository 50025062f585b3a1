//! The requests that a node has received, so that it does each once, however often it is repeated.

use std::collections::VecDeque;

use crate::message::{NodeAnswer, NodeRequest};

/// Greatest number of remembered requests.
const MOST: usize = 1024;

#[derive(Clone, Debug)]
struct Asked {
    gateway: u64,
    number: u64,
    answer: Option<NodeAnswer>,
}

/// The latest requests and their answers.
#[derive(Clone, Debug, Default)]
pub struct AskedRequests {
    known: VecDeque<Asked>,
    /// Answers that the next message sends.
    waiting: Vec<NodeAnswer>,
}

impl AskedRequests {
    /// Whether `request` of `gateway` is new. If it already has an answer, this queues the answer again.
    pub fn is_new(&mut self, gateway: u64, request: &NodeRequest) -> bool {
        let is_it = |asked: &&Asked| (asked.gateway, asked.number) == (gateway, request.number);
        if let Some(asked) = self.known.iter().rev().find(is_it) {
            self.waiting.extend(asked.answer.clone());
            return false;
        }
        if self.known.len() == MOST {
            self.known.pop_front();
        }
        self.known.push_back(Asked { gateway, number: request.number, answer: None });
        true
    }

    /// Forgets a request that was not carried out: it is new when it comes again.
    pub fn forget(&mut self, gateway: u64, number: u64) {
        self.known.retain(|asked| (asked.gateway, asked.number) != (gateway, number));
    }

    /// Stores an answer and queues it.
    pub fn answer(&mut self, answer: NodeAnswer) {
        let is_it = |asked: &&mut Asked| (asked.gateway, asked.number) == (answer.gateway, answer.number);
        if let Some(asked) = self.known.iter_mut().rev().find(is_it) {
            asked.answer = Some(answer.clone());
        }
        self.waiting.push(answer);
    }

    /// Takes the queued answers.
    pub fn take_answers(&mut self) -> Vec<NodeAnswer> {
        std::mem::take(&mut self.waiting)
    }
}

#[cfg(test)]
mod tests {
    use underfoot::wire::ControlMessage;

    use super::*;

    #[test]
    fn a_request_that_comes_again_is_answered_again_and_not_done_again() {
        let mut asked = AskedRequests::default();
        let request = NodeRequest::of(7, "west", &ControlMessage::CancelAll);
        assert!(asked.is_new(1, &request));
        assert!(!asked.is_new(1, &request), "under way");
        assert!(asked.take_answers().is_empty());
        let answer = NodeAnswer { gateway: 1, number: 7, ..NodeAnswer::default() };
        asked.answer(answer.clone());
        assert_eq!(asked.take_answers(), std::slice::from_ref(&answer));
        assert!(!asked.is_new(1, &request));
        assert_eq!(asked.take_answers(), [answer]);
        assert!(asked.is_new(2, &request), "another gateway's");
        asked.forget(2, 7);
        assert!(asked.is_new(2, &request));
    }
}
