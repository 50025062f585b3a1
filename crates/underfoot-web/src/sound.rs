//! The sound of one frame of the page, in one piece: each piece wakes the thread that plays it.

use std::cell::RefCell;
use std::rc::Rc;

use super::floor::RATE;

/// Length of the silence after a sound that is still played, in samples of both sides: pauses within a sound keep
/// their length.
const PAUSE: usize = RATE as usize;

/// Collects samples, left and right in turn. Clones share them.
#[derive(Clone, Debug, Default)]
pub struct FrameSound(Rc<RefCell<Waiting>>);

#[derive(Debug, Default)]
struct Waiting {
    samples: Vec<f32>,
    /// Number of silent samples that still have to be played.
    pause: usize,
}

impl FrameSound {
    /// Adds samples.
    pub fn add(&self, samples: &[f32]) {
        self.0.borrow_mut().samples.extend_from_slice(samples);
    }

    /// Passes the samples since the last call to `play`; drops those of a lasting silence.
    pub fn play(&self, play: impl FnOnce(&[f32])) {
        let mut waiting = self.0.borrow_mut();
        let Waiting { samples, pause } = &mut *waiting;
        if samples.iter().any(|sample| *sample != 0.0) {
            *pause = PAUSE;
        }
        if *pause > 0 && !samples.is_empty() {
            play(samples);
            *pause = pause.saturating_sub(samples.len());
        }
        samples.clear();
    }
}
