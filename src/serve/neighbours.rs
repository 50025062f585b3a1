//! Cues over the borders of an area.

use crate::feel::{Cue, SustainedCues};
use crate::units::Instant;

/// The computers that move tiles beside those of this one.
///
/// A control over a border belongs to one computer and is felt on the tiles of both. All calls are made on the sensing
/// thread, the first two with every frame; none may wait.
pub trait Neighbours: Send {
    /// Hands on, at `now`, what a frame led to, as far as it is felt on tiles of others.
    fn give(&mut self, cues: &[Cue], sustained: &SustainedCues, now: Instant);

    /// Adds what others have handed on by `now` that is felt on tiles of this computer, with the frame of time `at`.
    fn take(&mut self, at: Instant, now: Instant, cues: &mut Vec<Cue>, sustained: &mut SustainedCues);

    /// Sends what is due at `now` whatever happens on the floor. Called with every packet, and every 5 ms without one.
    fn poll(&mut self, now: Instant);
}
