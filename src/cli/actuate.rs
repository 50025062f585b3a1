use std::path::PathBuf;

use underfoot::feel::{CueSender, Renderer, RendererConfig, ScopeReader, renderer};
use underfoot::floor::Floor;
use underfoot::sink::{
    ActuatorSink, LatencyMeter, LatencyProbe, SilentSink, SinkError, WavOptions, WavSink, WhenFull,
};
#[cfg(feature = "audio")]
use underfoot::sink::{DeviceOptions, Mix, OutputDevice};
use underfoot::units::{HostClock, Instant};

use super::failure::Failure;

/// Where actuator samples go.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct ActuateArgs {
    /// Record the actuator channels in a WAV file instead of playing them.
    #[arg(long, value_name = "FILE")]
    wav: Option<PathBuf>,
    /// Samples per second and channel; without it 48000 in a file, and what the sound card likes best.
    #[arg(long, value_name = "HZ")]
    rate: Option<u32>,
    /// How the sound card plays the actuators.
    #[cfg(feature = "audio")]
    #[arg(long, value_enum, default_value_t)]
    sound: Sound,
    /// The sound card, by its name or a part of it; without it, the system's choice.
    #[cfg(feature = "audio")]
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
}

#[cfg(feature = "audio")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
enum Sound {
    /// A channel per actuator if the card has enough, otherwise all of them on two loudspeakers.
    #[default]
    Auto,
    /// A channel per actuator; a card with fewer is refused.
    Tiles,
    /// All actuators on two loudspeakers, placed by their column.
    Stereo,
    /// None.
    Off,
}

/// Cues in, samples out.
pub(crate) struct Actuation {
    /// The sensing thread's end.
    pub(crate) feel: CueSender,
    /// What plays the samples; it stays on the thread that made it.
    pub(crate) sink: Box<dyn ActuatorSink>,
    /// What the window's scopes show.
    pub(crate) scope: Option<ScopeReader>,
    /// How long packets take to be felt.
    pub(crate) latency: LatencyMeter,
    /// Where the samples go, or why nobody hears them.
    pub(crate) notice: String,
}

/// A renderer and what plays it, before they are told apart.
struct Playing {
    feel: CueSender,
    sink: Box<dyn ActuatorSink>,
    scope: Option<ScopeReader>,
    notice: String,
}

impl ActuateArgs {
    /// Starts what was asked for. Without a sound card that fits, the samples go nowhere and the notice says why.
    ///
    /// `start` is the present on the floor's sample clock, `clock` the one that stamps packets.
    ///
    /// # Errors
    /// The recording can't be begun, or the sound card asked for by name can't be used.
    pub(crate) fn start(
        &self,
        floor: &Floor,
        start: Instant,
        clock: HostClock,
    ) -> Result<Actuation, Failure> {
        let latency = LatencyMeter::new();
        let probe = LatencyProbe::new(latency.clone(), clock);
        let playing = match &self.wav {
            Some(path) => {
                let options = WavOptions {
                    start,
                    latency: Some(probe),
                    when_full: WhenFull::LeaveOut,
                    ..WavOptions::default()
                };
                let notice = format!("Recording the actuators in {}.", path.display());
                self.playing(floor, self.file_rate(), notice, |renderer| {
                    Ok(Box::new(WavSink::create(path, renderer, options)?))
                })?
            }
            None => match self.on_sound_card(floor, &probe) {
                Ok(playing) => playing,
                Err(NoSound::Refused(error)) => return Err(error.into()),
                Err(NoSound::Silent(reason)) => {
                    self.playing(floor, self.file_rate(), reason, |renderer| {
                        Ok(Box::new(SilentSink::new(renderer, start, Some(probe))))
                    })?
                }
            },
        };
        let Playing { feel, sink, scope, notice } = playing;
        Ok(Actuation { feel, sink, scope, latency, notice })
    }

    fn file_rate(&self) -> u32 {
        self.rate.unwrap_or(48_000)
    }

    fn playing(
        &self,
        floor: &Floor,
        rate: u32,
        notice: String,
        sink: impl FnOnce(Renderer) -> Result<Box<dyn ActuatorSink>, SinkError>,
    ) -> Result<Playing, SinkError> {
        let (feel, mut renderer) = renderer(RendererConfig::of(floor, rate));
        let scope = renderer.scope();
        Ok(Playing { feel, sink: sink(renderer)?, scope, notice })
    }

    #[cfg(not(feature = "audio"))]
    fn on_sound_card(&self, _: &Floor, _: &LatencyProbe) -> Result<Playing, NoSound> {
        Err(NoSound::Silent("This program was built without sound.".into()))
    }

    #[cfg(feature = "audio")]
    fn on_sound_card(&self, floor: &Floor, probe: &LatencyProbe) -> Result<Playing, NoSound> {
        let mixes: &[Mix] = match self.sound {
            Sound::Auto => &[Mix::PerActuator, Mix::Stereo],
            Sound::Tiles => &[Mix::PerActuator],
            Sound::Stereo => &[Mix::Stereo],
            Sound::Off => return Err(NoSound::Silent("The sound is off, as asked.".into())),
        };
        let mut trouble = None;
        for &mix in mixes {
            let options = DeviceOptions {
                name: self.device.clone(),
                sample_rate: self.rate,
                mix,
                latency: Some(probe.clone()),
                ..DeviceOptions::default()
            };
            let played = OutputDevice::find(floor, options).and_then(|device| {
                let heard = if mix == Mix::Stereo { "all tiles in stereo" } else { "a channel per tile" };
                let notice = format!("Sound: {}, {heard}.", device.name());
                self.playing(floor, device.sample_rate(), notice, |renderer| {
                    Ok(Box::new(device.play(renderer)?))
                })
            });
            match played {
                Ok(playing) => return Ok(playing),
                Err(error) => trouble = Some(error),
            }
        }
        let asked_for = self.device.is_some() || self.sound == Sound::Tiles;
        Err(match trouble {
            Some(error) if asked_for => NoSound::Refused(error),
            Some(error) => NoSound::Silent(format!("No sound: {error}.")),
            None => NoSound::Silent("No sound.".into()),
        })
    }
}

/// Why the sound card does not play.
enum NoSound {
    /// Go on without, and say this.
    Silent(String),
    /// It was asked for, so that the program must not go on without.
    #[cfg_attr(not(feature = "audio"), expect(dead_code, reason = "nothing can be asked for without sound"))]
    Refused(SinkError),
}
