//! Rendering in step with the sample clock.

use std::time::Duration;

use crate::feel::{Onset, Renderer};
use crate::units::Instant;

/// Renders exactly as many samples as time has passed on the floor's sample clock.
#[derive(Debug)]
pub(super) struct Lockstep {
    renderer: Renderer,
    start: Instant,
    frames: u64,
    block: Vec<f32>,
}

impl Lockstep {
    /// The first sample is at `start`.
    pub(super) fn new(renderer: Renderer, start: Instant) -> Self {
        let block = vec![0.0; renderer.max_block() * renderer.channels()];
        Self { renderer, start, frames: 0, block }
    }

    pub(super) fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// Frames rendered so far.
    pub(super) fn frames(&self) -> u64 {
        self.frames
    }

    /// Renders every sample before `now` and passes them to `hand_on` block by block, interleaved.
    pub(super) fn advance<E>(
        &mut self,
        now: Instant,
        mut hand_on: impl FnMut(&[f32], &[Onset]) -> Result<(), E>,
    ) -> Result<(), E> {
        let rate = u128::from(self.renderer.sample_rate());
        let wanted = (now.since(self.start).as_micros() * rate / 1_000_000) as u64;
        while self.frames < wanted {
            let frames = (wanted - self.frames).min(self.renderer.max_block() as u64);
            let micros = (u128::from(self.frames) * 1_000_000 + rate / 2) / rate;
            let block_start = self.start + Duration::from_micros(micros as u64);
            let block = &mut self.block[..frames as usize * self.renderer.channels()];
            self.renderer.render(block, block_start);
            self.frames += frames;
            hand_on(block, self.renderer.onsets())?;
        }
        Ok(())
    }
}
