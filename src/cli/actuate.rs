use std::path::PathBuf;

use underfoot::feel::{CueSender, RendererConfig, ScopeReader, renderer};
use underfoot::floor::Floor;
use underfoot::sink::{ActuatorSink, LatencyMeter, LatencyProbe, SilentSink, WavOptions, WavSink, WhenFull};
use underfoot::units::{HostClock, Instant};

use super::failure::Failure;

/// Where actuator samples go.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct ActuateArgs {
    /// Record the actuator channels in a WAV file instead of playing them.
    #[arg(long, value_name = "FILE")]
    wav: Option<PathBuf>,
    /// Samples per second and channel of the recording.
    #[arg(long, value_name = "HZ", default_value_t = 48_000)]
    rate: u32,
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
    /// Why nothing is heard, for the person at the machine.
    pub(crate) notice: Option<String>,
}

impl ActuateArgs {
    /// Starts what was asked for; without a sound card the samples go nowhere, and `notice` says why.
    ///
    /// `start` is the present on the floor's sample clock, `clock` the one that stamps packets.
    pub(crate) fn start(
        &self,
        floor: &Floor,
        start: Instant,
        clock: HostClock,
    ) -> Result<Actuation, Failure> {
        let latency = LatencyMeter::new();
        let probe = LatencyProbe::new(latency.clone(), clock);
        let (feel, mut renderer) = renderer(RendererConfig::of(floor, self.rate));
        let scope = renderer.scope();
        let sink: Box<dyn ActuatorSink> = match &self.wav {
            Some(path) => {
                let options = WavOptions {
                    start,
                    latency: Some(probe),
                    when_full: WhenFull::LeaveOut,
                    ..WavOptions::default()
                };
                Box::new(WavSink::create(path, renderer, options)?)
            }
            None => Box::new(SilentSink::new(renderer, start, Some(probe))),
        };
        Ok(Actuation { feel, sink, scope, latency, notice: None })
    }
}
