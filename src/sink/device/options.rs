//! What is wanted of a sound card.

use crate::sink::LatencyProbe;
use crate::units::HostClock;

/// How the floor's channels go onto those of the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mix {
    /// One channel per actuator; a device with fewer is refused.
    #[default]
    PerActuator,
    /// One channel per actuator for as many as the device has; the others are not felt.
    AsManyAsThereAre,
    /// All tiles on two loudspeakers, placed by their column, so that a designer hears the floor at a desk.
    Stereo,
}

/// What is wanted of a device.
#[derive(Clone)]
#[non_exhaustive]
pub struct DeviceOptions {
    /// The device's name or a part of it, what the system calls it (`hw:1,0`), its identifier
    /// ([`super::DeviceEntry::id`]), a host (`jack`), or `paced`: a clock that stands in for a card. The
    /// system's own choice if absent: whatever that is at the start, it is never left for another.
    pub name: Option<String>,
    /// Samples per second; 48 or 96 kHz if absent and there is a choice.
    pub sample_rate: Option<u32>,
    /// Whether samples are converted where the device has not that rate; otherwise it is refused.
    pub resample: bool,
    /// Frames per block, as a wish; a block is the shortest time in which a cue can be answered. If absent, 128
    /// (64 of `paced`) to begin with, and more when samples come late again and again.
    pub block: Option<u32>,
    /// How the floor's channels go onto those of the device.
    pub mix: Mix,
    /// With the clock that stamps cues, each is played exactly the renderer's delay after its cause; without, as soon
    /// as possible.
    pub steady: Option<HostClock>,
    /// Measures the latency of the cues, if wanted.
    pub latency: Option<LatencyProbe>,
}

impl Default for DeviceOptions {
    /// The system's own choice, as it likes to be played, one channel per actuator, each cue as soon as possible.
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
    /// The device that is looked for; the system's own choice if `None`.
    #[must_use]
    pub fn with_name(self, name: Option<String>) -> Self {
        Self { name, ..self }
    }

    /// Samples per second; 48 or 96 kHz if `None` and there is a choice.
    #[must_use]
    pub fn with_sample_rate(self, sample_rate: Option<u32>) -> Self {
        Self { sample_rate, ..self }
    }

    /// Whether samples are converted where the device has not that rate.
    #[must_use]
    pub fn with_resample(self, resample: bool) -> Self {
        Self { resample, ..self }
    }

    /// Frames per block, as a wish; grows from 128 by itself if `None`.
    #[must_use]
    pub fn with_block(self, block: Option<u32>) -> Self {
        Self { block, ..self }
    }

    /// How the floor's channels go onto those of the device.
    #[must_use]
    pub fn with_mix(self, mix: Mix) -> Self {
        Self { mix, ..self }
    }

    /// The clock that stamps cues; without, each is played as soon as possible.
    #[must_use]
    pub fn with_steady(self, steady: Option<HostClock>) -> Self {
        Self { steady, ..self }
    }

    /// `latency` measures the cues.
    #[must_use]
    pub fn with_latency(self, latency: LatencyProbe) -> Self {
        Self { latency: Some(latency), ..self }
    }
}
