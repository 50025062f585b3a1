//! Haptics and sound: a channel for each tile's actuator, on a sound card or in a file.

use std::path::PathBuf;

use clap::Args;
use underfoot::feel::{RendererConfig, renderer};
use underfoot::floor::Floor;
use underfoot::runtime::{Actuators, SessionBuilder};
use underfoot::sink::{ActuatorSink, SinkError, WavOptions, WavSink};
#[cfg(feature = "audio")]
use underfoot::sink::{DeviceOptions, Mix, OutputDevice};
use underfoot::units::Instant;

/// Samples per second of files.
const RATE: u32 = 48_000;

/// The output for actuators.
#[derive(Args, Clone, Debug)]
pub struct Feel {
    /// Record the actuators' samples into a WAV file, instead of playing them.
    #[arg(long, value_name = "FILE")]
    wav: Option<PathBuf>,
    /// The sound card of the actuators, by its name or a part of it (`underfoot rack devices` lists them); `paced` is
    /// a clock that stands in for a card. Without it, the system's default.
    #[cfg(feature = "audio")]
    #[arg(long, value_name = "NAME", conflicts_with = "wav")]
    device: Option<String>,
}

impl Feel {
    /// Adds the actuators to `session`.
    pub fn attach(self, session: SessionBuilder) -> SessionBuilder {
        session.actuators(move |floor, start, _| self.open(floor, start))
    }

    fn open(self, floor: &Floor, start: Instant) -> Result<Actuators, SinkError> {
        if let Some(path) = self.wav {
            let (feel, renderer) = renderer(RendererConfig::of(floor, RATE));
            let sink = WavSink::create(path, renderer, WavOptions::default().with_start(start))?;
            return Ok(Actuators { feel, sink: Box::new(sink) });
        }
        #[cfg(feature = "audio")]
        {
            let is_asked = self.device.is_some();
            // Each tile has a channel of its own if the card has enough; otherwise all share two loudspeakers.
            let mut played = Err(None);
            for mix in [Mix::PerActuator, Mix::Stereo] {
                played = played.or_else(|_| play(floor, self.device.clone(), mix).map_err(Some));
            }
            match played {
                Ok(actuators) => return Ok(actuators),
                Err(Some(error)) if is_asked => return Err(error),
                Err(error) => {
                    let why = error.map_or(String::new(), |error| format!(": {error}"));
                    eprintln!("Nothing is felt or heard{why}");
                }
            }
        }
        let (feel, _) = renderer(RendererConfig::of(floor, RATE));
        Ok(Actuators { feel, sink: Box::new(Unfelt) })
    }
}

/// A floor without haptics, which renders nothing.
struct Unfelt;

impl ActuatorSink for Unfelt {
    fn advance(&mut self, _: Instant) -> Result<(), SinkError> {
        Ok(())
    }
}

#[cfg(feature = "audio")]
fn play(floor: &Floor, name: Option<String>, mix: Mix) -> Result<Actuators, SinkError> {
    let device = OutputDevice::find(floor, DeviceOptions::default().with_name(name).with_mix(mix))?;
    let (feel, renderer) = renderer(RendererConfig::of(floor, device.sample_rate()));
    Ok(Actuators { feel, sink: Box::new(device.play(renderer)?) })
}
