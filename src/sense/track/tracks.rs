//! The list of feet.

use std::ops::{Deref, DerefMut};

use super::state::Track;

/// Tracks in the order in which they began.
///
/// A track takes two kilobytes, and in a crowd one ends in nearly every frame. The list holds boxes, so that closing
/// the gap copies no tracks. The box of an ended track is reused; when none is left, as many boxes are allocated as
/// there are tracks, so that a nearly full floor allocates no memory.
#[derive(Clone, Debug)]
#[expect(clippy::vec_box, reason = "what moves in the list is to be small")]
pub(super) struct Tracks {
    list: Vec<Box<Track>>,
    spare: Vec<Box<Track>>,
}

impl Tracks {
    pub(super) fn with_capacity(tracks: usize) -> Self {
        Self { list: Vec::with_capacity(tracks), spare: Vec::with_capacity(tracks) }
    }

    pub(super) fn push(&mut self, track: Track) {
        if let Some(mut spare) = self.spare.pop() {
            *spare = track;
            self.list.push(spare);
            return;
        }
        self.spare.extend(std::iter::repeat_n(&track, self.list.len()).cloned().map(Box::new));
        self.list.push(Box::new(track));
    }

    pub(super) fn remove(&mut self, which: usize) {
        let ended = self.list.remove(which);
        self.spare.push(ended);
    }

    /// Removes the tracks for which `stays` is false.
    pub(super) fn retain(&mut self, stays: impl Fn(&Track) -> bool) {
        self.spare.extend(self.list.extract_if(.., |track| !stays(track)));
    }
}

impl Deref for Tracks {
    type Target = [Box<Track>];

    fn deref(&self) -> &Self::Target {
        &self.list
    }
}

impl DerefMut for Tracks {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.list
    }
}
