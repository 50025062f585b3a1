//! Minimum and maximum of each channel over short stretches, for drawing.

use rtrb::{Consumer, Producer, RingBuffer};

/// Points per channel that a [`ScopeReader`] holds.
const POINTS: usize = 128;

/// Time covered by those points, in seconds.
const SPAN_S: f32 = 0.1;

/// Maximum number of rows that wait for the reader; when it stops reading, newer ones are dropped.
const WAITING: usize = 2 * POINTS;

/// The lowest and highest sample of a short stretch, in full scales.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MinMax {
    /// Minimum, at least -1.
    pub min: f32,
    /// Maximum, at most 1.
    pub max: f32,
}

/// The actuators' samples of the last 100 ms, for a window's scopes.
///
/// The renderer's end writes, this end reads; neither ever waits for the other. A reader that pauses misses the
/// samples of the meanwhile.
#[derive(Debug)]
pub struct ScopeReader {
    ring: Consumer<MinMax>,
    channels: usize,
    /// Channel after channel, [`POINTS`] each.
    points: Vec<MinMax>,
    row: Vec<MinMax>,
}

/// The renderer's end of a scope.
#[derive(Debug)]
pub(super) struct ScopeWriter {
    ring: Producer<MinMax>,
    /// The stretch in progress.
    row: Vec<MinMax>,
    frames_left: usize,
    frames_per_point: usize,
}

/// Both ends of a scope for `channels` channels, at least one.
pub(super) fn scope(channels: usize, sample_rate: f32) -> (ScopeWriter, ScopeReader) {
    let (producer, consumer) = RingBuffer::new(WAITING * channels);
    let frames_per_point = (SPAN_S * sample_rate / POINTS as f32).round().max(1.0) as usize;
    let writer = ScopeWriter {
        ring: producer,
        row: vec![UNSEEN; channels],
        frames_left: frames_per_point,
        frames_per_point,
    };
    let reader = ScopeReader {
        ring: consumer,
        channels,
        points: vec![MinMax::default(); POINTS * channels],
        row: vec![MinMax::default(); channels],
    };
    (writer, reader)
}

const UNSEEN: MinMax = MinMax { min: f32::INFINITY, max: f32::NEG_INFINITY };

impl ScopeWriter {
    /// Processes a block of interleaved samples.
    pub(super) fn observe(&mut self, samples: &[f32]) {
        for frame in samples.chunks_exact(self.row.len()) {
            for (point, sample) in self.row.iter_mut().zip(frame) {
                point.min = point.min.min(*sample);
                point.max = point.max.max(*sample);
            }
            self.frames_left -= 1;
            if self.frames_left == 0 {
                // A full ring means that the reader has stopped; dropping is right then.
                let _ = self.ring.push_entire_slice(&self.row);
                self.row.fill(UNSEEN);
                self.frames_left = self.frames_per_point;
            }
        }
    }
}

impl ScopeReader {
    /// Number of channels.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Takes the rows rendered since the last call; returns whether there were any.
    pub fn update(&mut self) -> bool {
        let rows = self.ring.slots() / self.channels;
        for _ in 0..rows {
            if self.ring.pop_entire_slice(&mut self.row).is_err() {
                break;
            }
            for (points, point) in self.points.chunks_exact_mut(POINTS).zip(&self.row) {
                points.rotate_left(1);
                points[POINTS - 1] = *point;
            }
        }
        rows > 0
    }

    /// The last 100 ms of `channel`, oldest first: 128 stretches of 0.78 ms; empty if there is no such channel.
    #[must_use]
    pub fn channel(&self, channel: usize) -> &[MinMax] {
        self.points.chunks_exact(POINTS).nth(channel).unwrap_or(&[])
    }

    /// The highest absolute sample of the last 100 ms of `channel`, 0 to 1.
    #[must_use]
    pub fn peak(&self, channel: usize) -> f32 {
        self.channel(channel).iter().fold(0.0, |peak, point| peak.max(point.max).max(-point.min))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shows_the_extremes_of_each_stretch_of_each_channel() {
        // 12.8 kHz: ten frames a point.
        let (mut writer, mut reader) = scope(2, 12_800.0);
        let mut samples = [0.0; 2 * 25];
        samples[2 * 3] = 0.7;
        samples[2 * 14 + 1] = -0.2;
        writer.observe(&samples[..20]);
        writer.observe(&samples[20..]);
        assert!(reader.update());
        assert_eq!(reader.channel(0)[126], MinMax { min: 0.0, max: 0.7 });
        assert_eq!(reader.channel(1)[127], MinMax { min: -0.2, max: 0.0 });
        assert_eq!((reader.peak(0), reader.peak(1)), (0.7, 0.2));
        assert!(reader.channel(2).is_empty());
        // The last five frames don't make a whole stretch yet.
        assert!(!reader.update());
    }

    #[test]
    fn a_reader_that_looks_away_costs_nothing_and_comes_back() {
        let (mut writer, mut reader) = scope(1, 12_800.0);
        writer.observe(&vec![0.5; 128_000]);
        assert!(reader.update());
        writer.observe(&[0.1; 1280]);
        assert!(reader.update());
        assert_eq!(reader.peak(0), 0.1);
    }
}
