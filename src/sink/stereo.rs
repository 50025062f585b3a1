//! All actuators on two loudspeakers.

use std::convert::Infallible;
use std::f32::consts::FRAC_PI_2;

use super::lockstep::Lockstep;
use super::{ActuatorSink, SinkError};
use crate::feel::Renderer;
use crate::floor::Floor;
use crate::units::Instant;

/// Mixes the renderer's channels to left and right, by the columns of their tiles, at constant power.
#[derive(Clone, Debug)]
pub(super) struct StereoMix {
    /// Gains of each channel to the left and to the right.
    pans: Vec<[f32; 2]>,
}

impl StereoMix {
    /// Mixes `width` channels of `floor`.
    pub(super) fn new(floor: &Floor, width: usize) -> Self {
        let (west, columns) = (floor.geometry.first().column, f32::from(floor.geometry.columns()));
        let mut pans = vec![[0.0; 2]; width];
        for (tile, actuator) in floor.geometry.tiles().zip(&floor.actuators) {
            if let Some(actuator) = actuator
                && let Some(pan) = pans.get_mut(usize::from(actuator.channel))
            {
                let (right, left) = ((f32::from(tile.column - west) + 0.5) / columns * FRAC_PI_2).sin_cos();
                *pan = [left, right];
            }
        }
        Self { pans }
    }

    /// Left and right of one frame; may exceed full scale.
    ///
    /// # Real-time
    /// No allocation.
    pub(super) fn sides(&self, frame: &[f32]) -> [f32; 2] {
        let mut sides = [0.0; 2];
        for (sample, pan) in frame.iter().zip(&self.pans) {
            sides[0] += sample * pan[0];
            sides[1] += sample * pan[1];
        }
        sides
    }
}

/// Renders every sample and gives all actuators away as two channels, for players without a channel per actuator, such
/// as a page in a browser.
pub struct StereoSink<F> {
    lockstep: Lockstep,
    mix: StereoMix,
    block: Vec<f32>,
    give: F,
}

impl<F: FnMut(&[f32])> StereoSink<F> {
    /// A sink whose first sample is at `start` on the floor's sample clock. It calls `give` with all samples of each
    /// call of [`ActuatorSink::advance`]: left and right in turn, within full scale.
    #[must_use]
    pub fn new(renderer: Renderer, floor: &Floor, start: Instant, give: F) -> Self {
        let mix = StereoMix::new(floor, renderer.channels());
        Self { lockstep: Lockstep::new(renderer, start), mix, block: Vec::new(), give }
    }
}

impl<F: FnMut(&[f32])> ActuatorSink for StereoSink<F> {
    fn advance(&mut self, now: Instant) -> Result<(), SinkError> {
        let Self { lockstep, mix, block, give } = self;
        let width = lockstep.renderer().channels().max(1);
        block.clear();
        let Ok(()) = lockstep.advance::<Infallible>(now, |samples, _| {
            let frames = samples.chunks_exact(width);
            block.extend(frames.flat_map(|frame| mix.sides(frame).map(|side| side.clamp(-1.0, 1.0))));
            Ok(())
        });
        if !block.is_empty() {
            give(block);
        }
        Ok(())
    }
}

impl<F> std::fmt::Debug for StereoSink<F> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("StereoSink").field("frames", &self.lockstep.frames()).finish_non_exhaustive()
    }
}
