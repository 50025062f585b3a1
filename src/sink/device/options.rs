//! Options of a sound card.

use crate::sink::LatencyProbe;
use crate::units::HostClock;

/// Mapping of the floor's channels to those of the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mix {
    /// One channel per actuator; a device with fewer channels is rejected.
    #[default]
    PerActuator,
    /// One channel per actuator up to the number of device channels; the other actuators stay silent.
    AsManyAsThereAre,
    /// All tiles on two loudspeakers, placed by their column, so that a designer can hear the floor at a desk.
    Stereo,
}

/// Options of a device.
#[derive(Clone)]
#[non_exhaustive]
pub struct DeviceOptions {
    /// The device's name or a part of it, its name in the system (`hw:1,0`), its identifier
    /// ([`super::DeviceEntry::id`]), a host (`jack`), or `paced`: a clock in place of a card. If absent, the system's
    /// default at the start, which stays in use when the default changes.
    pub name: Option<String>,
    /// Samples per second; 48 or 96 kHz if absent and there is a choice.
    pub sample_rate: Option<u32>,
    /// Whether samples are converted if the device lacks that rate; otherwise such a device is rejected.
    pub resample: bool,
    /// Preferred number of frames per block; a block is the shortest response time to a cue. If absent, 128 (64 for
    /// `paced`) at the start, and more after repeated underruns.
    pub block: Option<u32>,
    /// Mapping of the floor's channels to those of the device.
    pub mix: Mix,
    /// With the clock that stamps cues, each cue is played exactly the renderer's delay after its cause; without, as
    /// soon as possible.
    pub steady: Option<HostClock>,
    /// Measures the latency of the cues, if present.
    pub latency: Option<LatencyProbe>,
}

impl Default for DeviceOptions {
    /// The system's default device in its preferred configuration, one channel per actuator, each cue as soon as
    /// possible.
    fn default() -> Self {
        Self {
            name: None,
            sample_rate: None,
            resample: false,
            block: None,
            mix: Mix::default(),
            steady: None,
            latency: None,
        }
    }
}

impl DeviceOptions {
    /// Sets the device to look for; `None` means the system's default.
    #[must_use]
    pub fn with_name(self, name: Option<String>) -> Self {
        Self { name, ..self }
    }

    /// Sets the samples per second; `None` means 48 or 96 kHz if there is a choice.
    #[must_use]
    pub fn with_sample_rate(self, sample_rate: Option<u32>) -> Self {
        Self { sample_rate, ..self }
    }

    /// Sets whether samples are converted if the device lacks that rate.
    #[must_use]
    pub fn with_resample(self, resample: bool) -> Self {
        Self { resample, ..self }
    }

    /// Sets the preferred number of frames per block; `None` starts at 128 and grows after underruns.
    #[must_use]
    pub fn with_block(self, block: Option<u32>) -> Self {
        Self { block, ..self }
    }

    /// Sets the mapping of the floor's channels to those of the device.
    #[must_use]
    pub fn with_mix(self, mix: Mix) -> Self {
        Self { mix, ..self }
    }

    /// Sets the clock that stamps cues; without it, each cue is played as soon as possible.
    #[must_use]
    pub fn with_steady(self, steady: Option<HostClock>) -> Self {
        Self { steady, ..self }
    }

    /// Measures the latency of the cues with `latency`.
    #[must_use]
    pub fn with_latency(self, latency: LatencyProbe) -> Self {
        Self { latency: Some(latency), ..self }
    }
}
