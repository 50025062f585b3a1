//! The rows of samples to which voices and clicks are added, and the channel of each tile.

use glam::{Mat4, Vec4};

use crate::floor::Actuator;

/// Channels that the output stage works on side by side.
pub(super) const LANES: usize = 16;

/// Some of a group's channels: bit by bit, lane 0 the lowest.
pub(super) type LaneSet = u16;

/// A share of a sound below this (-100 dB) counts as zero.
pub(super) const FAINT: f32 = 1e-5;

/// The output for a tile's share of a cue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CueOutput {
    pub(super) channel: usize,
    /// Full scales per newton.
    pub(super) per_newton: f32,
}

/// The channel of each tile.
#[derive(Clone, Debug)]
pub(super) struct TileChannels {
    outputs: Box<[Option<CueOutput>]>,
}

impl TileChannels {
    /// `actuators` in tile order; leaves out those with a channel that the device lacks, or without a positive full
    /// scale.
    pub(super) fn new(actuators: Vec<Option<Actuator>>, channels: usize) -> Self {
        let output = |actuator: Actuator| {
            let channel = usize::from(actuator.channel);
            let full_scale = actuator.full_scale.0;
            (channel < channels && full_scale.is_finite() && full_scale > 0.0)
                .then(|| CueOutput { channel, per_newton: full_scale.recip() })
        };
        Self { outputs: actuators.into_iter().map(|actuator| actuator.and_then(output)).collect() }
    }

    /// The channel of each tile.
    pub(super) fn channels(&self) -> impl Iterator<Item = Option<usize>> + '_ {
        self.outputs.iter().map(|output| output.map(|output| output.channel))
    }

    /// The output of tile number `tile`; `None` if it has none.
    pub(super) fn output(&self, tile: u16) -> Option<CueOutput> {
        self.outputs.get(usize::from(tile)).copied().flatten()
    }
}

/// One block of samples per channel, on the way to the limiter; unused channels cost nothing.
#[derive(Clone, Debug)]
pub(super) struct MixBlock {
    samples: Vec<f32>,
    stride: usize,
    frames: usize,
    /// Rows of each group with samples of this block; the others hold old ones.
    open: Vec<LaneSet>,
}

impl MixBlock {
    /// Rows of up to `max_frames` samples for `channels` channels, filled up to whole groups of [`LANES`].
    pub(super) fn new(channels: usize, max_frames: usize) -> Self {
        let rows = channels.next_multiple_of(LANES);
        // An odd number of cache lines: rows at a power of two apart would share the same cache sets.
        let stride = max_frames.next_multiple_of(LANES) + 16;
        Self { samples: vec![0.0; rows * stride], stride, frames: 0, open: vec![0; rows / LANES] }
    }

    /// Starts a block of `frames` silent samples per channel.
    pub(super) fn begin(&mut self, frames: usize) {
        self.frames = frames;
        self.open.fill(0);
    }

    /// The block of one channel, to add to.
    pub(super) fn row(&mut self, channel: usize) -> &mut [f32] {
        let start = channel * self.stride;
        let row = &mut self.samples[start..start + self.frames];
        let (open, lane) = (&mut self.open[channel / LANES], 1 << (channel % LANES));
        if *open & lane == 0 {
            row.fill(0.0);
            *open |= lane;
        }
        row
    }

    /// Whether the channels of this group contain samples of this block.
    pub(super) fn is_open(&self, group: usize) -> bool {
        self.open[group] != 0
    }

    /// Adds samples `from` up to `from + samples` of a group's rows to `columns`, which must have at least as many.
    ///
    /// Unused rows add nothing. Columns beyond `samples` are undefined afterwards.
    ///
    /// # Panics
    /// If `from` is not a multiple of [`LANES`].
    #[inline(always)]
    pub(super) fn add_to(&self, group: usize, from: usize, samples: usize, columns: &mut [[f32; LANES]]) {
        debug_assert!(from.is_multiple_of(LANES));
        for (square, columns) in
            columns[..samples.next_multiple_of(LANES)].as_chunks_mut::<LANES>().0.iter_mut().enumerate()
        {
            let mut rows = [&NOTHING; LANES];
            for (lane, row) in rows.iter_mut().enumerate() {
                let start = (group * LANES + lane) * self.stride + from + square * LANES;
                if self.open[group] >> lane & 1 == 1
                    && let Some(samples) = self.samples[start..].first_chunk()
                {
                    *row = samples;
                }
            }
            let mut across = [[0.0; LANES]; LANES];
            transpose(&rows, &mut across);
            // As one flat run of numbers: the compiler turns nested loops over both into slow gathers.
            for (sample, more) in columns.as_flattened_mut().iter_mut().zip(across.as_flattened()) {
                *sample += more;
            }
        }
    }
}

const NOTHING: [f32; LANES] = [0.0; LANES];

/// Transposes rows to columns, in squares of four by four.
// Not inlined: with wider instructions the compiler turns these shuffles into slow gathers.
#[inline(never)]
pub(super) fn transpose<const N: usize>(rows: &[&[f32; N]; LANES], columns: &mut [[f32; LANES]; N]) {
    for lane in (0..LANES).step_by(4) {
        for n in (0..N).step_by(4) {
            let square = Mat4::from_cols(
                Vec4::from_slice(&rows[lane][n..]),
                Vec4::from_slice(&rows[lane + 1][n..]),
                Vec4::from_slice(&rows[lane + 2][n..]),
                Vec4::from_slice(&rows[lane + 3][n..]),
            )
            .transpose();
            square.x_axis.write_to_slice(&mut columns[n][lane..]);
            square.y_axis.write_to_slice(&mut columns[n + 1][lane..]);
            square.z_axis.write_to_slice(&mut columns[n + 2][lane..]);
            square.w_axis.write_to_slice(&mut columns[n + 3][lane..]);
        }
    }
}

/// Below this a number counts as zero; far above the denormal numbers, which are slow to compute with.
const TRIFLE: f32 = 1e-12;

/// Sets tiny values to zero; returns the largest absolute value that is left.
#[inline(always)]
pub(super) fn settled(numbers: &mut [[f32; LANES]]) -> f32 {
    // Without a sign, the bits of numbers are in the order of the numbers.
    let mut largest = 0;
    for number in numbers.as_flattened_mut() {
        *number = if number.abs() < TRIFLE { 0.0 } else { *number };
        largest = number.abs().to_bits().max(largest);
    }
    f32::from_bits(largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Newtons;

    #[test]
    fn actuators_the_device_cannot_drive_are_left_out() {
        let actuator = |channel, newtons| Some(Actuator { channel, full_scale: Newtons(newtons) });
        let wiring = TileChannels::new(
            vec![actuator(1, 40.0), None, actuator(2, 40.0), actuator(0, 0.0), actuator(0, f32::NAN)],
            2,
        );
        assert_eq!(wiring.output(0), Some(CueOutput { channel: 1, per_newton: 0.025 }));
        assert!((1..=5).all(|tile| wiring.output(tile).is_none()));
    }

    #[test]
    fn a_new_block_starts_silent_even_if_only_the_group_reads_it() {
        let mut mix = MixBlock::new(3, 8);
        mix.begin(8);
        mix.row(1).fill(1.0);
        assert!(mix.is_open(0));
        mix.begin(4);
        assert!(!mix.is_open(0));
        mix.row(0)[3] = 0.5;
        let mut columns = [[0.25; LANES]; LANES];
        mix.add_to(0, 0, 4, &mut columns);
        assert_eq!((columns[3][0], columns[3][1], columns[2][0]), (0.75, 0.25, 0.25));
    }
}
