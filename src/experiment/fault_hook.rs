//! Hooks for faults in the middle of an experiment.

use super::rig::Rig;
use crate::feel::Cue;
use crate::sense::ForceFrame;
use crate::wire::Readings;

/// What goes wrong while people are on an experiment's floor; every method does nothing unless it is written.
///
/// Milliseconds are those of the experiment's scene, from 1.
pub trait FaultHook {
    /// Called before each millisecond; may break sensors.
    fn before(&mut self, milli: u64, rig: &mut Rig) {
        let _ = (milli, rig);
    }

    /// Called with what each board is about to send in each millisecond.
    fn disturb(&mut self, milli: u64, board: usize, readings: &mut Readings) {
        let _ = (milli, board, readings);
    }

    /// Called with each frame before contacts are made of it.
    fn sensed(&mut self, milli: u64, frame: &ForceFrame) {
        let _ = (milli, frame);
    }

    /// Called with what the tracker's engine makes the floor do, where there is one.
    fn felt(&mut self, milli: u64, cues: &[Cue]) {
        let _ = (milli, cues);
    }
}

/// Nothing goes wrong.
impl FaultHook for () {}
