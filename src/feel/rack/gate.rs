//! Gates that open and close channels without a click.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use crate::feel::mix::LANES;

/// Length of a full rise or fall, in seconds.
pub(super) const RAMP_S: f32 = 0.005;

/// Opens and closes each channel of a group in 5 ms: for mutes, and for voices with faulty samples.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Gate {
    /// Rise per sample; negative for a closing channel.
    slope: [f32; LANES],
    level: [f32; LANES],
    step: f32,
    muted: [bool; LANES],
    tripped: [bool; LANES],
    /// Whether every channel has reached its target.
    at_rest: bool,
}

impl Gate {
    /// Open gates.
    pub(super) fn new(sample_rate: f32) -> Self {
        let step = (RAMP_S * sample_rate).recip();
        Self {
            slope: [step; LANES],
            level: [1.0; LANES],
            step,
            muted: [false; LANES],
            tripped: [false; LANES],
            at_rest: true,
        }
    }

    /// Mutes or unmutes a channel.
    pub(super) fn mute(&mut self, lane: usize, muted: bool) {
        self.muted[lane] = muted;
        self.turn(lane);
    }

    /// Closes a channel until its voices are gone; returns false if it is already tripped.
    pub(super) fn trip(&mut self, lane: usize) -> bool {
        let first = !self.tripped[lane];
        self.tripped[lane] = true;
        self.turn(lane);
        first
    }

    /// Whether any channel is tripped.
    pub(super) fn is_tripped(&self) -> bool {
        self.tripped.iter().fold(false, |any, tripped| any | tripped)
    }

    /// Opens tripped channels that have closed, and returns them: their voices may be dropped now.
    pub(super) fn reset(&mut self) -> [bool; LANES] {
        let mut closed = [false; LANES];
        for lane in 0..LANES {
            closed[lane] = self.tripped[lane] && self.level[lane] == 0.0;
            if closed[lane] {
                self.tripped[lane] = false;
                self.turn(lane);
            }
        }
        closed
    }

    fn turn(&mut self, lane: usize) {
        let closes = self.muted[lane] || self.tripped[lane];
        self.slope[lane] = if closes { -self.step } else { self.step };
        self.at_rest = false;
    }

    /// Sets every channel to its target at once.
    pub(super) fn settle(&mut self) {
        if self.at_rest {
            return;
        }
        self.at_rest = true;
        for lane in 0..LANES {
            self.level[lane] = if self.slope[lane] < 0.0 { 0.0 } else { 1.0 };
        }
    }

    /// Whether every channel is open and stays open.
    #[inline(always)]
    pub(super) fn is_open(&self) -> bool {
        let mut open = true;
        for lane in 0..LANES {
            open &= (self.level[lane] == 1.0) & (self.slope[lane] > 0.0);
        }
        open
    }

    /// Multiplies a stretch of samples by the levels of the gates.
    #[inline(always)]
    pub(super) fn run(&mut self, columns: &mut [[f32; LANES]]) {
        for column in columns {
            for lane in 0..LANES {
                let level = self.level[lane] + self.slope[lane];
                let level = if level > 1.0 { 1.0 } else { level };
                self.level[lane] = if level > 0.0 { level } else { 0.0 };
                column[lane] *= self.level[lane];
            }
        }
        self.at_rest = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f32 = 48_000.0;

    /// The output for a steady 1 in the next `samples`, on channels 0 and 1.
    fn through(gate: &mut Gate, samples: usize) -> Vec<[f32; 2]> {
        let mut columns = vec![[1.0; LANES]; samples];
        gate.run(&mut columns);
        columns.into_iter().map(|column| [column[0], column[1]]).collect()
    }

    #[test]
    fn a_muted_channel_fades_out_in_5_ms_and_the_others_go_on() {
        let mut gate = Gate::new(RATE);
        gate.mute(0, true);
        let faded = through(&mut gate, 300);
        let steps = faded.windows(2).map(|pair| (pair[1][0] - pair[0][0]).abs());
        assert!(steps.fold(0.0, f32::max) < 0.005);
        assert!(faded[0][0] > 0.99 && faded[200][0] > 0.1);
        assert!(faded[241..].iter().all(|frame| *frame == [0.0, 1.0]));
        gate.mute(0, false);
        assert!(through(&mut gate, 300)[241..].iter().all(|frame| *frame == [1.0, 1.0]));
    }

    #[test]
    fn a_tripped_channel_comes_back_by_itself_but_not_if_it_is_muted() {
        let mut gate = Gate::new(RATE);
        assert!(gate.trip(0) && !gate.trip(0));
        gate.trip(1);
        gate.mute(1, true);
        through(&mut gate, 100);
        assert!(!gate.reset().contains(&true), "still fading");
        through(&mut gate, 200);
        assert_eq!(gate.reset()[..3], [true, true, false]);
        assert_eq!(through(&mut gate, 300)[299], [1.0, 0.0]);
    }
}
