//! Buffers for the boards' samples in the slots that wait for other boards.

use super::sample::BoardSample;

/// Maximum number of slots that wait for their boards.
pub(super) const BUFFERS: usize = 8;

/// One sample for each board in each waiting slot.
///
/// The samples of one slot are contiguous, in the order of access: mostly only one slot waits, and gaps between
/// samples would waste memory bandwidth.
#[derive(Clone, Debug)]
pub(super) struct Buffers {
    boards: usize,
    samples: Vec<BoardSample>,
}

impl Buffers {
    pub(super) fn new(boards: usize) -> Self {
        Self { boards, samples: vec![BoardSample::EMPTY; BUFFERS * boards] }
    }

    /// The sample of this board in the slot of this buffer, or in an earlier slot.
    pub(super) fn sample(&self, buffer: usize, board: usize) -> &BoardSample {
        &self.samples[buffer * self.boards + board]
    }

    pub(super) fn sample_mut(&mut self, buffer: usize, board: usize) -> &mut BoardSample {
        &mut self.samples[buffer * self.boards + board]
    }
}
