//! What the boards have read in the slots that wait for others.

use super::sample::Sample;

/// How many slots may wait for their boards at once.
pub(super) const BUFFERS: usize = 8;

/// A place for each board's sample in each slot that waits.
///
/// Those of one slot lie side by side, as they are written and read: mostly no more than one slot waits, and what lies
/// between samples would be fetched for nothing.
#[derive(Clone, Debug)]
pub(super) struct Buffers {
    boards: usize,
    samples: Vec<Sample>,
}

impl Buffers {
    pub(super) fn new(boards: usize) -> Self {
        Self { boards, samples: vec![Sample::EMPTY; BUFFERS * boards] }
    }

    /// What the board of this number has read in the slot of this buffer, or of an earlier one.
    pub(super) fn sample(&self, buffer: usize, board: usize) -> &Sample {
        &self.samples[buffer * self.boards + board]
    }

    pub(super) fn sample_mut(&mut self, buffer: usize, board: usize) -> &mut Sample {
        &mut self.samples[buffer * self.boards + board]
    }
}
