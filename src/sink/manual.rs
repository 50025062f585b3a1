//! Samples kept in memory.

use std::convert::Infallible;

use super::lockstep::Lockstep;
use super::{ActuatorSink, HandedOn, LatencyProbe, SinkError};
use crate::feel::{Onset, Renderer};
use crate::units::Instant;

/// Keeps all samples in memory, for tests and work without a device.
///
/// Time passes only with [`ActuatorSink::advance`], and every cue starts at its own sample.
#[derive(Debug)]
pub struct ManualSink {
    lockstep: Lockstep,
    channels: Vec<Vec<f32>>,
    onsets: Vec<(u64, Onset)>,
    probe: Option<LatencyProbe>,
}

impl ManualSink {
    /// A sink whose first sample is at `start` on the floor's sample clock.
    #[must_use]
    pub fn new(renderer: Renderer, start: Instant) -> Self {
        Self {
            channels: vec![Vec::new(); renderer.channels()],
            lockstep: Lockstep::new(renderer, start),
            onsets: Vec::new(),
            probe: None,
        }
    }

    /// Measures latency with `probe`.
    #[must_use]
    pub fn with_latency(mut self, probe: LatencyProbe) -> Self {
        self.probe = Some(probe);
        self
    }

    /// Returns all samples of `channel` so far; empty if there is no such channel.
    #[must_use]
    pub fn channel(&self, channel: usize) -> &[f32] {
        self.channels.get(channel).map_or(&[], Vec::as_slice)
    }

    /// Number of channels.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.channels.len()
    }

    /// Returns the first moving sample of every cue so far, counted from the start, and the arrival time of its
    /// packet.
    pub fn onsets(&self) -> impl Iterator<Item = (u64, Instant)> {
        self.onsets.iter().map(|(block, onset)| (block + onset.frame as u64, onset.received))
    }

    /// The renderer inside, for its rate and counters.
    #[must_use]
    pub fn renderer(&self) -> &Renderer {
        self.lockstep.renderer()
    }
}

impl ActuatorSink for ManualSink {
    fn advance(&mut self, now: Instant) -> Result<(), SinkError> {
        let Self { lockstep, channels, onsets, probe } = self;
        let mut first = lockstep.frames();
        let width = channels.len().max(1);
        let Ok(()) = lockstep.advance::<Infallible>(now, |block, started| {
            if let Some(probe) = probe {
                probe.handed_on(started, HandedOn::default());
            }
            onsets.extend(started.iter().map(|onset| (first, *onset)));
            for (channel, samples) in channels.iter_mut().enumerate() {
                samples.extend(block.iter().skip(channel).step_by(width));
            }
            first += (block.len() / width) as u64;
            Ok(())
        });
        Ok(())
    }
}
