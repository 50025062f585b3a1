//! The signal path of a device: renderer, resampler, mixdown.

#![deny(clippy::disallowed_macros, clippy::disallowed_methods, clippy::disallowed_types)]

use std::time::Duration;

use cpal::{FromSample, Sample};

use super::block_clock::BlockClock;
use super::choice::DeviceConfig;
use super::mixdown::Mixdown;
use super::options::DeviceOptions;
use super::resample::Resampler;
use crate::feel::Renderer;
use crate::floor::Floor;
use crate::sink::{HandedOn, LatencyProbe};
use crate::units::{HostClock, Instant};

/// Runs in the device's callback and survives a change of the stream.
pub(super) struct DevicePlayer {
    renderer: Renderer,
    mixdown: Mixdown,
    steady: Option<(HostClock, BlockClock)>,
    probe: Option<LatencyProbe>,
    resampler: Option<Resampler>,
    /// One block of the renderer.
    block: Vec<f32>,
    /// One block at the device's rate, if it differs.
    resampled: Vec<f32>,
}

impl DevicePlayer {
    pub(super) fn new(
        renderer: Renderer,
        floor: &Floor,
        options: &DeviceOptions,
        choice: DeviceConfig,
    ) -> Self {
        let samples = renderer.max_block() * renderer.channels();
        let mut player = Self {
            mixdown: Mixdown::new(floor, options.mix, renderer.channels(), choice.channels.into()),
            renderer,
            steady: options.steady.clone().map(|clock| (clock, BlockClock::default())),
            probe: options.latency.clone(),
            resampler: None,
            block: vec![0.0; samples],
            resampled: Vec::new(),
        };
        player.fit(floor, options, choice);
        player
    }

    /// Adapts to another stream; not called while one plays.
    pub(super) fn fit(&mut self, floor: &Floor, options: &DeviceOptions, choice: DeviceConfig) {
        let width = self.renderer.channels();
        self.mixdown = Mixdown::new(floor, options.mix, width, choice.channels.into());
        let (from, to) = (self.renderer.sample_rate(), choice.sample_rate);
        let most = self.renderer.max_block();
        self.resampler = (from != to).then(|| Resampler::new(width, from, to, most));
        self.resampled.resize(if from == to { 0 } else { most * width }, 0.0);
        self.restart();
    }

    /// Discards the cues sent while nothing was played, so that they do not all start at once.
    pub(super) fn restart(&mut self) {
        self.renderer.restart();
        if let Some((_, blocks)) = &mut self.steady {
            blocks.forget();
        }
    }

    /// Fills a device buffer of any length whose first sample sounds after `sounds_in`, which is zero if unknown.
    ///
    /// # Real-time
    /// No allocation, lock or log; the clocks, if any, are read.
    pub(super) fn fill<T: Sample + FromSample<f32>>(&mut self, out: &mut [T], sounds_in: Duration) {
        let width = self.mixdown.device_width();
        let rate = self.renderer.sample_rate();
        let begun = self.probe.as_ref().map(LatencyProbe::now);
        let frames = out.len() / width;
        let device_rate = self.device_rate();
        let mut start = self
            .steady
            .as_mut()
            .map(|(clock, blocks)| blocks.start_of_block(clock() + sounds_in, frames, device_rate));
        let mut before = 0;
        let most = self.resampler.as_ref().map_or(self.renderer.max_block(), Resampler::most);
        for out in out.chunks_mut(most * width) {
            let frames = out.len() / width;
            if self.resampler.is_some() {
                self.fill_resampled(out, frames, start);
            } else {
                let block = &mut self.block[..frames * self.renderer.channels()];
                match start {
                    Some(start) => self.renderer.render(block, start),
                    None => self.renderer.render_now(block),
                }
                self.mixdown.write(block, out);
            }
            start =
                start.map(|start| start + Duration::from_secs_f64(frames as f64 / f64::from(device_rate)));
            if let (Some(probe), Some(begun)) = (&self.probe, begun) {
                let sounds =
                    begun + sounds_in + Duration::from_secs_f64(f64::from(before) / f64::from(device_rate));
                let sounds = (!sounds_in.is_zero()).then_some(sounds);
                probe.handed_on(self.renderer.onsets(), HandedOn { sounds, sample_rate: rate });
            }
            before += frames as u32;
        }
    }

    /// Fills `frames` frames at the device's rate from the required number of frames at the renderer's rate.
    fn fill_resampled<T: Sample + FromSample<f32>>(
        &mut self,
        out: &mut [T],
        frames: usize,
        start: Option<Instant>,
    ) {
        let Self { renderer, mixdown, resampler, block, resampled, .. } = self;
        let Some(resampler) = resampler else { return };
        let (channels, rate) = (renderer.channels(), f64::from(renderer.sample_rate()));
        let mut needed = resampler.needed(frames);
        while needed > 0 {
            let taken = needed.min(renderer.max_block());
            let block = &mut block[..taken * channels];
            match start {
                Some(start) => {
                    let ahead = Duration::from_secs_f64((resampler.ahead() / rate).max(0.0));
                    renderer.render(block, start + ahead);
                }
                None => renderer.render_now(block),
            }
            resampler.take(block);
            needed -= taken;
        }
        let resampled = &mut resampled[..frames * channels];
        resampler.give(resampled);
        mixdown.write(resampled, out);
    }

    fn device_rate(&self) -> u32 {
        self.resampler.as_ref().map_or(self.renderer.sample_rate(), Resampler::rate)
    }
}
