//! Samples rendered and not played.

use std::convert::Infallible;

use super::lockstep::Lockstep;
use super::{ActuatorSink, HandedOn, LatencyProbe, SinkError};
use crate::feel::Renderer;
use crate::units::Instant;

/// Renders every sample and plays none: scopes and latency measurements work without a sound card.
#[derive(Debug)]
pub struct SilentSink {
    lockstep: Lockstep,
    probe: Option<LatencyProbe>,
}

impl SilentSink {
    /// A sink whose first sample is at `start` on the floor's sample clock.
    #[must_use]
    pub fn new(renderer: Renderer, start: Instant, probe: Option<LatencyProbe>) -> Self {
        Self { lockstep: Lockstep::new(renderer, start), probe }
    }
}

impl ActuatorSink for SilentSink {
    fn advance(&mut self, now: Instant) -> Result<(), SinkError> {
        let Self { lockstep, probe } = self;
        let Ok(()) = lockstep.advance::<Infallible>(now, |_, onsets| {
            if let Some(probe) = probe {
                probe.handed_on(onsets, HandedOn::default());
            }
            Ok(())
        });
        Ok(())
    }
}
