//! Rejected messages, counted by reason.

use thiserror::Error;

/// Reason for rejecting a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum AuthRefusal {
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
pub struct AuthRefusals {
    /// [`AuthRefusal::Malformed`].
    pub malformed: u64,
    /// [`AuthRefusal::Forged`].
    pub forged: u64,
    /// [`AuthRefusal::Unanswered`], without those of senders that have answered since.
    pub unanswered: u64,
    /// [`AuthRefusal::Stale`].
    pub stale: u64,
    /// [`AuthRefusal::Repeated`].
    pub repeated: u64,
    /// [`AuthRefusal::Jumped`].
    pub jumped: u64,
}

impl AuthRefusals {
    pub(super) fn count(&mut self, refusal: AuthRefusal) {
        let counter = match refusal {
            AuthRefusal::Malformed => &mut self.malformed,
            AuthRefusal::Forged => &mut self.forged,
            AuthRefusal::Unanswered => &mut self.unanswered,
            AuthRefusal::Stale => &mut self.stale,
            AuthRefusal::Repeated => &mut self.repeated,
            AuthRefusal::Jumped => &mut self.jumped,
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
