//! An effect tried on one tile.

use std::sync::Arc;

use crate::feel::{Audition, Cue, CueSender, Effect, Gesture, Spot, Spots, SustainedCues};
use crate::units::Instant;

/// An effect on trial on one tile.
#[derive(Debug)]
pub(super) struct EffectTrial {
    effect: Arc<Effect>,
    gesture: Gesture,
    spots: Spots,
    /// Begins with the first frame.
    audition: Option<Audition>,
    cues: Vec<Cue>,
    sustained: SustainedCues,
}

impl EffectTrial {
    pub(super) fn new(effect: Arc<Effect>, gesture: Gesture, tile: u16) -> Self {
        let spots = [Spot { tile, weight: 1.0 }].into_iter().collect();
        Self { effect, gesture, spots, audition: None, cues: Vec::new(), sustained: SustainedCues::new() }
    }

    /// Sends the cues at `now` together with the sustained cues of the floor; returns whether the trial continues.
    pub(super) fn step(&mut self, now: Instant, floor: &SustainedCues, feel: &mut CueSender) -> bool {
        let Self { effect, gesture, spots, audition, cues, sustained } = self;
        let audition =
            audition.get_or_insert_with(|| Audition::new(Arc::clone(effect), gesture.clone(), now));
        cues.clear();
        sustained.clone_from(floor);
        let goes_on = audition.step(now, spots, cues, sustained);
        for cue in cues.iter() {
            // The sender counts the cues that it cannot send.
            feel.send(cue);
        }
        feel.sustain(sustained);
        goes_on
    }
}
