//! Messages that are not taken, counted by why.

use thiserror::Error;

/// Why a message is not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Refusal {
    /// It is none of this program's messages, or longer than any.
    #[error("it has another form")]
    Malformed,
    /// Its hash is not that of the floor's key: it was written with another key, or changed on the way.
    #[error("it was not written with this floor's key")]
    Forged,
    /// It answers nothing that this program has sent since its start: it was recorded earlier, or its sender has heard
    /// nothing yet.
    #[error("it answers nothing that was sent since the start")]
    Unanswered,
    /// What it answers was sent too long ago.
    #[error("it is too old")]
    Stale,
    /// A message with its counter has been taken already, or one that came much later.
    #[error("it has come before")]
    Repeated,
    /// Its counter is far beyond the last one.
    #[error("its counter is far beyond the last one")]
    Jumped,
}

/// How many messages were not taken, by why.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Refusals {
    /// [`Refusal::Malformed`].
    pub malformed: u64,
    /// [`Refusal::Forged`].
    pub forged: u64,
    /// [`Refusal::Unanswered`]; those of a sender that answers later are taken off again.
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

    /// Each count, with what it counts in words that follow a number.
    #[must_use]
    pub const fn told(&self) -> [(u64, &'static str); 6] {
        [
            (self.malformed, "of another form"),
            (self.forged, "not written with this floor's key"),
            (self.unanswered, "recorded before this start, or of a program that hears nothing"),
            (self.stale, "older than 250 ms"),
            (self.repeated, "that had come before"),
            (self.jumped, "with a counter far beyond the last"),
        ]
    }

    /// All of them together.
    #[must_use]
    pub fn all(&self) -> u64 {
        self.told().iter().map(|(count, _)| count).sum()
    }
}
