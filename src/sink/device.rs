//! Actuators and loudspeakers through the sound card; the only user of cpal.

mod block_clock;
mod choice;
mod mixdown;
mod player;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use cpal::traits::{DeviceTrait, HostTrait, StreamTrait};
use cpal::{DeviceId, ErrorKind, FromSample, I24, SampleFormat, SizedSample, U24};

use self::choice::Choice;
use self::mixdown::Mixdown;
use self::player::Player;
use super::{ActuatorSink, LatencyProbe, SinkError};
use crate::feel::Renderer;
use crate::floor::Floor;
use crate::units::HostClock;
use crate::units::Instant;

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
pub struct DeviceOptions {
    /// The device's name or a part of it, or what the system calls it (`hw:1,0`); the system's own choice if absent.
    pub name: Option<String>,
    /// Samples per second; 48 or 96 kHz if absent and there is a choice.
    pub sample_rate: Option<u32>,
    /// Frames per block, as a wish; a block is the shortest time in which a cue can be answered.
    pub block: u32,
    /// How the floor's channels go onto those of the device.
    pub mix: Mix,
    /// With the clock that stamps cues, each is played exactly the renderer's delay after its cause; without, as soon as possible.
    pub steady: Option<HostClock>,
    /// Measures the latency of the cues, if wanted.
    pub latency: Option<LatencyProbe>,
}

impl Default for DeviceOptions {
    /// The system's own choice, in blocks of 128 frames, one channel per actuator, each cue as soon as possible.
    fn default() -> Self {
        Self { name: None, sample_rate: None, block: 128, mix: Mix::default(), steady: None, latency: None }
    }
}

/// A device that was found fit for a floor, and how it will be used; it makes no sound yet.
///
/// It tells the sample rate that the renderer must be made for.
pub struct OutputDevice {
    device: cpal::Device,
    name: String,
    choice: Choice,
    floor: Floor,
    options: DeviceOptions,
}

impl OutputDevice {
    /// Finds the device that `options` ask for, and a way to use it for `floor`.
    ///
    /// # Errors
    /// [`SinkError::Device`] if there is no such device or it can't do what is
    /// asked; the message says what it can do, and what to do about it.
    pub fn find(floor: &Floor, options: DeviceOptions) -> Result<Self, SinkError> {
        let host = cpal::default_host();
        let device = match &options.name {
            None => host.default_output_device(),
            Some(name) => named(&host, name),
        };
        match device {
            Some(device) => Self::with(device, floor, options),
            None => Err(missing(options.name.as_deref())),
        }
    }

    fn with(device: cpal::Device, floor: &Floor, options: DeviceOptions) -> Result<Self, SinkError> {
        let name = device.to_string();
        let ranges =
            device.supported_output_configs().map_err(|error| trouble(&name, &error))?.collect::<Vec<_>>();
        let choice = choice::choose(&name, &ranges, floor.channel_count(), &options)?;
        Ok(Self { device, name, choice, floor: floor.clone(), options })
    }

    /// The device's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Samples per second that the renderer must give.
    #[must_use]
    pub fn sample_rate(&self) -> u32 {
        self.choice.sample_rate
    }

    /// Channels of the device that will be used or kept silent.
    #[must_use]
    pub fn channels(&self) -> u16 {
        self.choice.channels
    }

    /// Starts playing what `renderer` gives.
    ///
    /// # Errors
    /// [`SinkError::Device`] if the renderer was made for another sample rate,
    /// or the device is in use, gone, or can't be played after all.
    pub fn play(self, renderer: Renderer) -> Result<DeviceSink, SinkError> {
        if renderer.sample_rate() != self.choice.sample_rate {
            let (made_for, wanted) = (renderer.sample_rate(), self.choice.sample_rate);
            return Err(SinkError::Device {
                message: format!("{} plays {wanted} samples per second, not {made_for}", self.name),
            });
        }
        let shared = Arc::new(Shared::default());
        let mixdown =
            Mixdown::new(&self.floor, self.options.mix, renderer.channels(), self.choice.channels.into());
        let player = Player::new(renderer, mixdown, self.options.steady, self.options.latency);
        let stream = match self.choice.format {
            SampleFormat::I8 => stream::<i8>(&self.device, self.choice, player, &shared),
            SampleFormat::I16 => stream::<i16>(&self.device, self.choice, player, &shared),
            SampleFormat::I24 => stream::<I24>(&self.device, self.choice, player, &shared),
            SampleFormat::I32 => stream::<i32>(&self.device, self.choice, player, &shared),
            SampleFormat::U8 => stream::<u8>(&self.device, self.choice, player, &shared),
            SampleFormat::U16 => stream::<u16>(&self.device, self.choice, player, &shared),
            SampleFormat::U24 => stream::<U24>(&self.device, self.choice, player, &shared),
            SampleFormat::U32 => stream::<u32>(&self.device, self.choice, player, &shared),
            SampleFormat::F64 => stream::<f64>(&self.device, self.choice, player, &shared),
            _ => stream::<f32>(&self.device, self.choice, player, &shared),
        };
        let stream = stream.map_err(|error| trouble(&self.name, &error))?;
        stream.play().map_err(|error| trouble(&self.name, &error))?;
        Ok(DeviceSink { _stream: stream, shared, name: self.name, choice: self.choice })
    }
}

/// The names of all devices that can play something, for a list to choose from; empty if there is none.
#[must_use]
pub fn output_device_names() -> Vec<String> {
    cpal::default_host()
        .output_devices()
        .map(|devices| devices.map(|device| device.to_string()).collect())
        .unwrap_or_default()
}

/// A floor's actuators, or a designer's loudspeakers, on a sound card.
///
/// The device keeps its own time: its callback renders, and does nothing else.
/// Dropping the sink stops it.
pub struct DeviceSink {
    _stream: cpal::Stream,
    shared: Arc<Shared>,
    name: String,
    choice: Choice,
}

impl DeviceSink {
    /// How the device is doing.
    #[must_use]
    pub fn status(&self) -> DeviceStatus {
        DeviceStatus {
            name: self.name.clone(),
            sample_rate: self.choice.sample_rate,
            channels: self.choice.channels,
            blocks: self.shared.blocks.load(Ordering::Relaxed),
            underruns: self.shared.underruns.load(Ordering::Relaxed),
            lost: self.shared.lost.get().cloned(),
        }
    }
}

impl ActuatorSink for DeviceSink {
    /// Does nothing, since the device keeps its own time; a device that was lost is told of once.
    fn advance(&mut self, _now: Instant) -> Result<(), SinkError> {
        match self.shared.lost.get() {
            Some(reason) if !self.shared.told.swap(true, Ordering::Relaxed) => Err(SinkError::Device {
                message: format!("{} is lost ({reason}): plug it in again and restart", self.name),
            }),
            _ => Ok(()),
        }
    }
}

/// How a device is doing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceStatus {
    /// Its name.
    pub name: String,
    /// Samples per second.
    pub sample_rate: u32,
    /// Channels in use or kept silent.
    pub channels: u16,
    /// Blocks played so far: if this stands still, the device hangs.
    pub blocks: u64,
    /// Times when samples came too late for the device.
    pub underruns: u64,
    /// Why it plays no more; `None` while it plays.
    pub lost: Option<String>,
}

/// What the callbacks tell.
#[derive(Debug, Default)]
struct Shared {
    blocks: AtomicU64,
    underruns: AtomicU64,
    lost: OnceLock<String>,
    /// Whether [`DeviceSink::advance`] has told that it is lost.
    told: AtomicBool,
}

impl Shared {
    fn note(&self, error: &cpal::Error) {
        match error.kind() {
            ErrorKind::Xrun => {
                self.underruns.fetch_add(1, Ordering::Relaxed);
            }
            ErrorKind::DeviceNotAvailable
            | ErrorKind::StreamInvalidated
            | ErrorKind::HostUnavailable
            | ErrorKind::PermissionDenied => {
                // Only the first reason counts; the rest follow from it.
                let _ = self.lost.set(error.to_string());
            }
            _ => tracing::warn!("sound card: {error}"),
        }
    }
}

fn stream<T: SizedSample + FromSample<f32>>(
    device: &cpal::Device,
    choice: Choice,
    mut player: Player,
    shared: &Arc<Shared>,
) -> Result<cpal::Stream, cpal::Error> {
    let (played, failed) = (Arc::clone(shared), Arc::clone(shared));
    device.build_output_stream::<T, _, _>(
        choice.stream_config(),
        move |out, _| {
            player.fill(out);
            played.blocks.fetch_add(1, Ordering::Relaxed);
        },
        move |error| failed.note(&error),
        None,
    )
}

/// The device of that very name or identifier, or else the first that has it in its name, or what the system knows by it.
fn named(host: &cpal::Host, name: &str) -> Option<cpal::Device> {
    let wanted = name.to_lowercase();
    let find = |fits: &dyn Fn(&cpal::Device) -> bool| host.output_devices().ok()?.find(fits);
    find(&|device| device.id().is_ok_and(|id| id.id() == name) || device.to_string().to_lowercase() == wanted)
        .or_else(|| find(&|device| device.to_string().to_lowercase().contains(&wanted)))
        .or_else(|| host.device_by_id(&DeviceId::new(host.id(), name)))
}

fn missing(name: Option<&str>) -> SinkError {
    let message = match (name, output_device_names()) {
        (Some(name), names) if !names.is_empty() => {
            format!("there is no sound card `{name}`: choose one of {}", names.join(", "))
        }
        _ => "no sound card was found: connect one, record to a WAV file, or go on without".into(),
    };
    SinkError::Device { message }
}

fn trouble(name: &str, error: &cpal::Error) -> SinkError {
    let message = match error.kind() {
        ErrorKind::DeviceNotAvailable | ErrorKind::HostUnavailable => format!(
            "the sound card {name} can't be used ({error}): connect one, record to a WAV file, or go on without"
        ),
        ErrorKind::DeviceBusy => {
            format!("the sound card {name} is in use: close the program that plays on it, or choose another")
        }
        ErrorKind::PermissionDenied => format!(
            "the sound card {name} may not be used ({error}): on Linux, join the group `audio` and log in again"
        ),
        _ => format!("the sound card {name} can't be played ({error}): try another device, rate or block"),
    };
    SinkError::Device { message }
}

#[cfg(test)]
mod tests;
