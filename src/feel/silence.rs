//! Silence and mutes, as the sender of cues requests them.

use super::limiter::Ramp;
use super::rack::Rack;
use super::schedule::Schedule;
use super::sender::{SenderState, count};

/// The ramp between sound and silence, and the requests that it has followed.
#[derive(Debug)]
pub(super) struct Silence {
    /// Number of changes of silence that have been processed; odd while silent.
    turns: u64,
    /// The same for the mutes of single tiles.
    mute_changes: u64,
    ramp: Ramp,
}

impl Silence {
    /// The ramp rises from zero, and no request has come.
    pub(super) fn new(sample_rate: u32) -> Self {
        Self { turns: 0, mute_changes: 0, ramp: Ramp::new(sample_rate as f32) }
    }

    /// Starts from zero again; the ramp then stays there while `shared` requests silence.
    pub(super) fn restart(&mut self, sample_rate: u32, shared: &SenderState) {
        self.ramp = Ramp::new(sample_rate as f32);
        if !shared.turns().is_multiple_of(2) {
            self.ramp.fade_out();
        }
    }

    /// Sets the ramp and the mutes of `rack` as the sender requests, and drops cues sent before a silence.
    pub(super) fn update(&mut self, shared: &SenderState, schedule: &mut Schedule, rack: &mut Rack) {
        let turns = shared.turns();
        if turns != self.turns {
            self.turns = turns;
            count(&shared.muted, schedule.forget(turns));
            self.ramp.fade_out();
        }
        if self.ramp.is_down() && turns.is_multiple_of(2) {
            self.ramp.fade_in();
        }
        let mute_changes = shared.mute_changes();
        if mute_changes != self.mute_changes {
            self.mute_changes = mute_changes;
            for (channel, muted) in shared.mutes().enumerate() {
                rack.mute(channel, muted);
            }
        }
    }

    /// The ramp between sound and silence.
    pub(super) const fn ramp(&self) -> &Ramp {
        &self.ramp
    }

    /// The gain of each of the next samples.
    pub(super) fn fill(&mut self, gains: &mut [f32]) {
        self.ramp.fill(gains);
    }
}
