//! Conversion of the renderer's channels to the device's channels and format.

#![deny(clippy::disallowed_macros, clippy::disallowed_methods, clippy::disallowed_types)]

use std::f32::consts::FRAC_PI_2;

use cpal::{FromSample, Sample};

use super::options::Mix;
use crate::floor::Floor;

/// Maps the renderer's channels to those of a device.
#[derive(Debug)]
pub(super) struct Mixdown {
    /// Number of input channels.
    width: usize,
    /// Number of output channels, at least one.
    device_width: usize,
    /// Gains of each input channel to the left and to the right; empty if channels are passed through.
    pans: Vec<[f32; 2]>,
}

impl Mixdown {
    /// Maps `width` channels of `floor` to `device_width` channels of a device.
    pub(super) fn new(floor: &Floor, mix: Mix, width: usize, device_width: usize) -> Self {
        let pans = match mix {
            Mix::PerActuator | Mix::AsManyAsThereAre => Vec::new(),
            Mix::Stereo => pans(floor, width),
        };
        Self { width, device_width: device_width.max(1), pans }
    }

    /// Returns the number of output channels.
    pub(super) fn device_width(&self) -> usize {
        self.device_width
    }

    /// Writes the frames `from` to `to`; device channels without a source are silent.
    ///
    /// # Real-time
    /// No allocation.
    pub(super) fn write<T: Sample + FromSample<f32>>(&self, from: &[f32], to: &mut [T]) {
        to.fill(T::EQUILIBRIUM);
        if self.width == 0 {
            return;
        }
        for (from, to) in from.chunks_exact(self.width).zip(to.chunks_exact_mut(self.device_width)) {
            if self.pans.is_empty() {
                for (from, to) in from.iter().zip(to) {
                    *to = T::from_sample(*from);
                }
                continue;
            }
            let mut sides = [0.0; 2];
            for (sample, pan) in from.iter().zip(&self.pans) {
                sides[0] += sample * pan[0];
                sides[1] += sample * pan[1];
            }
            match to {
                [both] => *both = T::from_sample((0.5 * (sides[0] + sides[1])).clamp(-1.0, 1.0)),
                _ => {
                    for (side, to) in sides.into_iter().zip(to) {
                        *to = T::from_sample(side.clamp(-1.0, 1.0));
                    }
                }
            }
        }
    }
}

/// Returns the gains to the left and to the right for each channel, by the column of its tile, at constant power.
fn pans(floor: &Floor, width: usize) -> Vec<[f32; 2]> {
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
    pans
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::Geometry;

    fn floor() -> Floor {
        Floor::of(Geometry::of_paper_tiles(3, 1).unwrap())
    }

    #[test]
    fn channels_go_straight_through_and_the_rest_is_silent() {
        let mut out = [9.0_f32; 8];
        Mixdown::new(&floor(), Mix::PerActuator, 3, 4).write(&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6], &mut out);
        assert_eq!(out, [0.1, 0.2, 0.3, 0.0, 0.4, 0.5, 0.6, 0.0]);
        let mut out = [9.0_f32; 4];
        Mixdown::new(&floor(), Mix::AsManyAsThereAre, 3, 2).write(&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6], &mut out);
        assert_eq!(out, [0.1, 0.2, 0.4, 0.5]);
    }

    #[test]
    fn samples_take_the_devices_own_format() {
        let mut out = [0_i16; 3];
        Mixdown::new(&floor(), Mix::PerActuator, 3, 3).write(&[1.0, -0.5, 0.0], &mut out);
        assert_eq!(out, [i16::MAX, -16_384, 0]);
        let mut out = [0_u8; 4];
        Mixdown::new(&floor(), Mix::PerActuator, 3, 4).write(&[0.0, 0.5, -1.0], &mut out);
        assert_eq!(out, [128, 192, 0, 128]);
    }

    #[test]
    fn in_stereo_the_west_is_left_and_no_column_is_louder() {
        let mixdown = Mixdown::new(&floor(), Mix::Stereo, 3, 2);
        let gains_of = |tile: usize| {
            let mut frame = [0.0; 3];
            frame[tile] = 0.6;
            let mut out = [0.0_f32; 2];
            mixdown.write(&frame, &mut out);
            out
        };
        assert!(gains_of(0)[0] > 0.55 && gains_of(0)[1] < 0.2);
        assert!((gains_of(1)[0] - gains_of(1)[1]).abs() < 1e-6);
        assert!(gains_of(2)[1] > 0.55);
        for tile in 0..3 {
            assert!((gains_of(tile)[0].hypot(gains_of(tile)[1]) - 0.6).abs() < 1e-6);
        }
        let mut out = [0.0_f32; 2];
        mixdown.write(&[1.0, 1.0, 1.0], &mut out);
        assert_eq!(out, [1.0, 1.0]);
    }
}
