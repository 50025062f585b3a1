use crate::floor::Actuator;

/// Channels that the output stage works on side by side.
pub(super) const LANES: usize = 16;

/// Where a tile's share of a cue goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Output {
    pub(super) channel: usize,
    /// Full scales per newton.
    pub(super) per_newton: f32,
}

/// Which channel moves which tile.
#[derive(Clone, Debug)]
pub(super) struct Wiring {
    outputs: Box<[Option<Output>]>,
}

impl Wiring {
    /// `actuators` in tile order; one whose channel the device lacks, or whose full scale is not a force, is left out.
    pub(super) fn new(actuators: Vec<Option<Actuator>>, channels: usize) -> Self {
        let output = |actuator: Actuator| {
            let channel = usize::from(actuator.channel);
            let full_scale = actuator.full_scale.0;
            (channel < channels && full_scale.is_finite() && full_scale > 0.0)
                .then(|| Output { channel, per_newton: full_scale.recip() })
        };
        Self { outputs: actuators.into_iter().map(|actuator| actuator.and_then(output)).collect() }
    }

    /// What moves tile number `tile`; `None` if nothing does.
    pub(super) fn output(&self, tile: u16) -> Option<Output> {
        self.outputs.get(usize::from(tile)).copied().flatten()
    }
}

/// One block of samples per channel, on the way to the limiter; channels that nobody writes to cost nothing.
#[derive(Clone, Debug)]
pub(super) struct Mix {
    samples: Vec<f32>,
    stride: usize,
    frames: usize,
    /// Which rows hold this block's samples; the others hold old ones.
    is_open: Vec<bool>,
}

impl Mix {
    /// Rows of up to `max_frames` samples for `channels` channels, filled up to whole groups of [`LANES`].
    pub(super) fn new(channels: usize, max_frames: usize) -> Self {
        let rows = channels.next_multiple_of(LANES);
        // An odd number of cache lines: rows at a power of two apart would share the same cache sets.
        let stride = max_frames.next_multiple_of(LANES) + 16;
        Self { samples: vec![0.0; rows * stride], stride, frames: 0, is_open: vec![false; rows] }
    }

    /// Starts a block of `frames` silent samples per channel.
    pub(super) fn begin(&mut self, frames: usize) {
        self.frames = frames;
        self.is_open.fill(false);
    }

    /// The block of one channel, to add to.
    pub(super) fn row(&mut self, channel: usize) -> &mut [f32] {
        let start = channel * self.stride;
        let row = &mut self.samples[start..start + self.frames];
        if !self.is_open[channel] {
            row.fill(0.0);
            self.is_open[channel] = true;
        }
        row
    }

    /// Whether anybody has written to the channels of this group.
    pub(super) fn is_open(&self, group: usize) -> bool {
        self.is_open[group * LANES..(group + 1) * LANES].contains(&true)
    }

    /// Makes sure that every row of a group holds this block's samples.
    pub(super) fn open(&mut self, group: usize) {
        for channel in group * LANES..(group + 1) * LANES {
            self.row(channel);
        }
    }

    /// The [`LANES`] samples from number `LANES * span` on of each row of an open group.
    ///
    /// What lies beyond the block is of no meaning.
    #[inline(always)]
    pub(super) fn square(&self, group: usize, span: usize) -> [&[f32; LANES]; LANES] {
        std::array::from_fn(|lane| {
            let start = (group * LANES + lane) * self.stride + span * LANES;
            self.samples[start..].first_chunk().unwrap_or(&[0.0; LANES])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Newtons;

    #[test]
    fn actuators_the_device_cannot_drive_are_left_out() {
        let actuator = |channel, newtons| Some(Actuator { channel, full_scale: Newtons(newtons) });
        let wiring = Wiring::new(
            vec![actuator(1, 40.0), None, actuator(2, 40.0), actuator(0, 0.0), actuator(0, f32::NAN)],
            2,
        );
        assert_eq!(wiring.output(0), Some(Output { channel: 1, per_newton: 0.025 }));
        assert!((1..=5).all(|tile| wiring.output(tile).is_none()));
    }

    #[test]
    fn a_new_block_starts_silent_even_if_only_the_group_reads_it() {
        let mut mix = Mix::new(3, 8);
        mix.begin(8);
        mix.row(1).fill(1.0);
        assert!(mix.is_open(0));
        mix.begin(4);
        assert!(!mix.is_open(0));
        mix.row(0)[3] = 0.5;
        mix.open(0);
        assert_eq!(mix.square(0, 0)[0][..4], [0.0, 0.0, 0.0, 0.5]);
        assert_eq!(mix.square(0, 0)[1][..4], [0.0; 4]);
    }
}
