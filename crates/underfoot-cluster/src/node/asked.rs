//! Which requests a node was asked, so that it does each once however often it hears of it.

use std::collections::VecDeque;

use crate::message::{NodeAnswer, NodeRequest};

/// Requests that are remembered.
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
    /// Answers to be sent.
    waiting: Vec<NodeAnswer>,
}

impl AskedRequests {
    /// Whether `request` of `gateway` is new; if it has been answered, the answer is sent once more.
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

    /// Takes note that `request` was not taken up after all: it is new when it comes again.
    pub fn forget(&mut self, gateway: u64, number: u64) {
        self.known.retain(|asked| (asked.gateway, asked.number) != (gateway, number));
    }

    /// Takes note of an answer, to be sent.
    pub fn answer(&mut self, answer: NodeAnswer) {
        let is_it = |asked: &&mut Asked| (asked.gateway, asked.number) == (answer.gateway, answer.number);
        if let Some(asked) = self.known.iter_mut().rev().find(is_it) {
            asked.answer = Some(answer.clone());
        }
        self.waiting.push(answer);
    }

    /// The answers to be sent now.
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
