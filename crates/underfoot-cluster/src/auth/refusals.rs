//! Rejected messages, counted by reason.

use thiserror::Error;

/// Reason for rejecting a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Refusal {
    /// It has another format, or is of a kind that this program does not receive.
    #[error("it has another format")]
    Malformed,
    /// Its MAC is wrong: it was written with another key, or changed on the way.
    #[error("it was not written with this floor's key")]
    Forged,
    /// It answers no message that this program has sent since its start: it is an earlier recording, or its sender
    /// has received nothing yet.
    #[error("it answers no message since the start")]
    Unanswered,
    /// It answers a message of more than 250 ms ago.
    #[error("it is too old")]
    Stale,
    /// A message with its counter has come already, or with one that is far greater.
    #[error("it has come before")]
    Repeated,
    /// Its counter is far beyond the last one.
    #[error("its counter is far beyond the last one")]
    Jumped,
}

/// Number of rejected messages, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Refusals {
    /// [`Refusal::Malformed`].
    pub malformed: u64,
    /// [`Refusal::Forged`].
    pub forged: u64,
    /// [`Refusal::Unanswered`], without those of senders that have answered since.
    pub unanswered: u64,
    /// [`Refusal::Stale`].
    pub stale: u64,
    /// [`Refusal::Repeated`].
    pub repeated: u64,
    /// [`Refusal::Jumped`].
    pub jumped: u64,
}

impl Refusals {
    pub(super) fn count(&mut self, refusal: Refusal) {
        let counter = match refusal {
            Refusal::Malformed => &mut self.malformed,
            Refusal::Forged => &mut self.forged,
            Refusal::Unanswered => &mut self.unanswered,
            Refusal::Stale => &mut self.stale,
            Refusal::Repeated => &mut self.repeated,
            Refusal::Jumped => &mut self.jumped,
        };
        *counter = counter.saturating_add(1);
    }

    /// Each count with its reason, in words that follow a number and a noun.
    #[must_use]
    pub const fn by_reason(&self) -> [(u64, &'static str); 6] {
        [
            (self.malformed, "of another format"),
            (self.forged, "not written with this floor's key"),
            (self.unanswered, "recorded before this start, or from a program that receives nothing"),
            (self.stale, "older than 250 ms"),
            (self.repeated, "that had come before"),
            (self.jumped, "with a counter far beyond the last"),
        ]
    }

    /// All of them together.
    #[must_use]
    pub fn all(&self) -> u64 {
        self.by_reason().iter().map(|(count, _)| count).sum()
    }
}
