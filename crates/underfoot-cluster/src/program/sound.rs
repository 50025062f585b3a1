//! A node's actuators.

use clap::Args;
use underfoot::feel::{RendererConfig, renderer};
use underfoot::floor::Floor;
use underfoot::runtime::Actuators;
#[cfg(feature = "audio")]
use underfoot::sink::{DeviceOptions, OutputDevice};
use underfoot::sink::{SilentSink, SinkError};
use underfoot::units::Instant;

/// Options for playing the actuators.
#[derive(Args, Clone, Debug, Default)]
pub(super) struct SoundArgs {
    /// The sound card that plays the area's actuators, a channel each: its name or a part of it (`underfoot rack
    /// devices` lists them), or `paced`, a clock that stands in for one. Without it there are no haptics.
    #[cfg(feature = "audio")]
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
}

impl SoundArgs {
    /// Opens the actuators of `floor`; the calling thread keeps them.
    pub(super) fn open(&self, floor: &Floor, start: Instant) -> Result<Actuators, SinkError> {
        #[cfg(feature = "audio")]
        if self.device.is_some() {
            let device = OutputDevice::find(floor, DeviceOptions::default().with_name(self.device.clone()))?;
            let (feel, renderer) = renderer(RendererConfig::of(floor, device.sample_rate()));
            return Ok(Actuators { feel, sink: Box::new(device.play(renderer)?) });
        }
        let (feel, renderer) = renderer(RendererConfig::of(floor, 48_000));
        Ok(Actuators { feel, sink: Box::new(SilentSink::new(renderer, start, None)) })
    }
}
