//! Cues over the borders of an area.

use crate::feel::{Cue, SustainedCues};
use crate::units::Instant;

/// The computers that drive the tiles next to those of this one.
///
/// A control across a border belongs to one computer and is felt on the tiles of both. The sensing thread makes all
/// calls, the first two with every frame; none may block.
pub trait Neighbours: Send {
    /// Sends, at `now`, the cues of a frame that are felt on tiles of other computers.
    fn give(&mut self, cues: &[Cue], sustained: &SustainedCues, now: Instant);

    /// Adds the cues received by `now` that are felt on tiles of this computer, with the frame of time `at`.
    fn take(&mut self, at: Instant, now: Instant, cues: &mut Vec<Cue>, sustained: &mut SustainedCues);

    /// Sends everything that is due at `now`. Called with every packet, and every 5 ms without one.
    fn poll(&mut self, now: Instant);
}
