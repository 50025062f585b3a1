//! Options for samples: sound card, WAV file or silence, and the renderer that feeds them.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::time::Duration;

use underfoot::feel::{CueSender, Renderer, RendererConfig, renderer};
use underfoot::floor::Floor;
use underfoot::runtime::Actuators;
use underfoot::sink::{
    ActuatorSink, LatencyProbe, LatencyStages, SilentSink, SinkError, WavOptions, WavSink,
};
#[cfg(feature = "audio")]
use underfoot::sink::{DeviceOptions, Mix, OutputDevice};
use underfoot::units::{HostClock, Instant};

use super::number::delay_ms;

/// Options for the output of actuator samples.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct ActuateArgs {
    /// Record the actuator channels in a WAV file instead of playing them.
    #[arg(long, value_name = "FILE")]
    wav: Option<PathBuf>,
    /// Samples per second and channel; without it, 48000 in a file, and the preferred rate of the sound card.
    #[arg(long, value_name = "HZ", value_parser = clap::value_parser!(u32).range(8000..=384_000))]
    rate: Option<u32>,
    /// How the sound card plays the actuators.
    #[cfg(feature = "audio")]
    #[arg(long, value_enum, default_value_t)]
    sound: Sound,
    /// The sound card, by its name or a part of it, its identifier (`underfoot rack devices` lists them), or a
    /// host such as `jack`; `paced` is a clock that stands in for a card. Without it, the system's choice.
    #[cfg(feature = "audio")]
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Frames per block of the sound card: the shorter, the sooner a click is felt. Without it, 128 (64 with
    /// `--device paced`), and more if samples are late again and again.
    #[cfg(feature = "audio")]
    #[arg(long, value_name = "FRAMES", value_parser = clap::value_parser!(u32).range(1..=8192))]
    block: Option<u32>,
    /// Convert samples if the sound card does not support the rate of `--rate`; without it, such a card is refused.
    #[cfg(feature = "audio")]
    #[arg(long, requires = "rate")]
    resample: bool,
    /// Play every click exactly this many milliseconds after the foot that caused it; without it, as soon as
    /// possible. A delay that is too short for the sound card makes clicks late; they are counted.
    #[arg(long, value_name = "MS", value_parser = delay_ms)]
    delay_ms: Option<Duration>,
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
    /// No sound.
    Off,
}

/// Haptic output: cues in, samples out.
pub(crate) struct Actuation {
    /// Sends cues, from the sensing thread.
    pub(crate) feel: CueSender,
    /// Plays the samples; it stays on the thread that created it.
    pub(crate) sink: Box<dyn ActuatorSink>,
    /// The destination of the samples, or the reason why they are not audible.
    pub(crate) notice: String,
}

impl ActuateArgs {
    /// Starts the output that the options choose. Without a suitable sound card, it discards the samples, and the
    /// notice has the reason.
    ///
    /// `start` is the present on the floor's sample clock, and `clock` stamps packets. `prepare` gets the renderer
    /// before it plays: if several sound cards are tried, the last call counts.
    ///
    /// # Errors
    /// The recording can't begin, or the requested sound card can't be used.
    pub(crate) fn start(
        &self,
        floor: &Floor,
        start: Instant,
        clock: &HostClock,
        latency: LatencyStages,
        lost: &Arc<AtomicU64>,
        mut prepare: impl FnMut(&mut Renderer),
    ) -> Result<Actuation, SinkError> {
        let probe = LatencyProbe::of_stages(latency, clock.clone());
        let playing = match &self.wav {
            Some(path) => {
                let options =
                    WavOptions::default().with_start(start).with_latency(probe).with_lost(Arc::clone(lost));
                let notice = format!("Recording the actuators in {}.", path.display());
                self.playing(floor, self.file_rate(), notice, &mut prepare, |renderer| {
                    Ok(Box::new(WavSink::create(path, renderer, options)?))
                })?
            }
            None => match self.on_sound_card(floor, &probe, clock, &mut prepare) {
                Ok(playing) => playing,
                Err(NoSound::Refused(error)) => return Err(error),
                Err(NoSound::Silent(reason)) => {
                    self.playing(floor, self.file_rate(), reason, &mut prepare, |renderer| {
                        Ok(Box::new(SilentSink::new(renderer, start, Some(probe))))
                    })?
                }
            },
        };
        Ok(playing)
    }

    /// Returns the function with which a session opens its actuators; `notice` gets a description of the output.
    pub(crate) fn opener(
        &self,
        latency: LatencyStages,
        lost: Arc<AtomicU64>,
        prepare: impl FnMut(&mut Renderer) + Send + 'static,
        notice: impl FnOnce(String) + Send + 'static,
    ) -> impl FnOnce(&Floor, Instant, &HostClock) -> Result<Actuators, SinkError> + Send + 'static {
        let args = self.clone();
        move |floor, start, clock| {
            let Actuation { feel, sink, notice: text } =
                args.start(floor, start, clock, latency, &lost, prepare)?;
            notice(text);
            Ok(Actuators { feel, sink })
        }
    }

    /// The WAV file to record, if any.
    pub(crate) fn wav(&self) -> Option<&Path> {
        self.wav.as_deref()
    }

    /// The same options, but with a channel per tile in place of the automatic choice.
    pub(crate) fn for_wiring(&self) -> Self {
        #[cfg(feature = "audio")]
        if self.sound == Sound::Auto {
            return Self { sound: Sound::Tiles, ..self.clone() };
        }
        self.clone()
    }

    pub(crate) fn file_rate(&self) -> u32 {
        self.rate.unwrap_or(48_000)
    }

    fn playing(
        &self,
        floor: &Floor,
        rate: u32,
        notice: String,
        prepare: &mut dyn FnMut(&mut Renderer),
        sink: impl FnOnce(Renderer) -> Result<Box<dyn ActuatorSink>, SinkError>,
    ) -> Result<Actuation, SinkError> {
        let config = RendererConfig::of(floor, rate).with_delay(self.delay_ms.unwrap_or_default());
        let (feel, mut renderer) = renderer(config);
        prepare(&mut renderer);
        Ok(Actuation { feel, sink: sink(renderer)?, notice })
    }

    #[cfg(not(feature = "audio"))]
    fn on_sound_card(
        &self,
        _: &Floor,
        _: &LatencyProbe,
        _: &HostClock,
        _: &mut dyn FnMut(&mut Renderer),
    ) -> Result<Actuation, NoSound> {
        Err(NoSound::Silent("This program was built without sound.".into()))
    }

    #[cfg(feature = "audio")]
    fn on_sound_card(
        &self,
        floor: &Floor,
        probe: &LatencyProbe,
        clock: &HostClock,
        prepare: &mut dyn FnMut(&mut Renderer),
    ) -> Result<Actuation, NoSound> {
        let mixes: &[Mix] = match self.sound {
            Sound::Auto => &[Mix::PerActuator, Mix::Stereo],
            Sound::Tiles => &[Mix::PerActuator],
            Sound::Stereo => &[Mix::Stereo],
            Sound::Off => return Err(NoSound::Silent("The sound is off, as asked.".into())),
        };
        let mut trouble = None;
        for &mix in mixes {
            let options = DeviceOptions::default()
                .with_name(self.device.clone())
                .with_sample_rate(self.rate)
                .with_resample(self.resample)
                .with_block(self.block)
                .with_mix(mix)
                .with_steady(self.delay_ms.map(|_| clock.clone()))
                .with_latency(probe.clone());
            let played = OutputDevice::find(floor, options).and_then(|device| {
                let heard = if mix == Mix::Stereo { "all tiles in stereo" } else { "a channel per tile" };
                let notice = format!("Sound: {}, {heard}.", device.name());
                self.playing(floor, device.sample_rate(), notice, prepare, |renderer| {
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

/// Reasons why the sound card does not play.
enum NoSound {
    /// The program continues without sound and shows this text.
    Silent(String),
    /// The options request sound explicitly, so the program must not continue without it.
    #[cfg_attr(not(feature = "audio"), expect(dead_code, reason = "nothing can be asked for without sound"))]
    Refused(SinkError),
}
