//! Conversion of the renderer's channels to the device's channels and format.

#![deny(clippy::disallowed_macros, clippy::disallowed_methods, clippy::disallowed_types)]

use cpal::{FromSample, Sample};

use super::super::stereo::StereoMix;
use super::options::Mix;
use crate::floor::Floor;

/// Maps the renderer's channels to those of a device.
#[derive(Debug)]
pub(super) struct Mixdown {
    /// Number of input channels.
    width: usize,
    /// Number of output channels, at least one.
    device_width: usize,
    /// `None` if channels are passed through.
    stereo: Option<StereoMix>,
}

impl Mixdown {
    /// Maps `width` channels of `floor` to `device_width` channels of a device.
    pub(super) fn new(floor: &Floor, mix: Mix, width: usize, device_width: usize) -> Self {
        let stereo = match mix {
            Mix::PerActuator | Mix::AsManyAsThereAre => None,
            Mix::Stereo => Some(StereoMix::new(floor, width)),
        };
        Self { width, device_width: device_width.max(1), stereo }
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
            let Some(stereo) = &self.stereo else {
                for (from, to) in from.iter().zip(to) {
                    *to = T::from_sample(*from);
                }
                continue;
            };
            let sides = stereo.sides(from);
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
