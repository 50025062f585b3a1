use std::time::Duration;

use cpal::{FromSample, Sample};

use super::block_clock::BlockClock;
use super::mixdown::Mixdown;
use crate::feel::Renderer;
use crate::sink::LatencyProbe;
use crate::units::HostClock;

/// What runs in the device's callback.
pub(super) struct Player {
    renderer: Renderer,
    mixdown: Mixdown,
    steady: Option<(HostClock, BlockClock)>,
    probe: Option<LatencyProbe>,
    /// One block as the renderer gives it.
    block: Vec<f32>,
}

impl Player {
    pub(super) fn new(
        renderer: Renderer,
        mixdown: Mixdown,
        steady: Option<HostClock>,
        probe: Option<LatencyProbe>,
    ) -> Self {
        let block = vec![0.0; renderer.max_block() * renderer.channels()];
        let steady = steady.map(|clock| (clock, BlockClock::default()));
        Self { renderer, mixdown, steady, probe, block }
    }

    /// Fills a device buffer of any length.
    ///
    /// # Real-time
    /// No allocation, lock or log; the clocks, if any, are read once.
    pub(super) fn fill<T: Sample + FromSample<f32>>(&mut self, out: &mut [T]) {
        let width = self.mixdown.device_width();
        let rate = self.renderer.sample_rate();
        let mut start = self
            .steady
            .as_mut()
            .map(|(clock, blocks)| blocks.start_of_block(clock(), out.len() / width, rate));
        for out in out.chunks_mut(self.renderer.max_block() * width) {
            let frames = out.len() / width;
            let block = &mut self.block[..frames * self.renderer.channels()];
            match &mut start {
                Some(start) => {
                    self.renderer.render(block, *start);
                    *start = *start + Duration::from_secs_f64(frames as f64 / f64::from(rate));
                }
                None => self.renderer.render_now(block),
            }
            self.mixdown.write(block, out);
            if let Some(probe) = &self.probe {
                probe.handed_on(self.renderer.onsets());
            }
        }
    }
}
