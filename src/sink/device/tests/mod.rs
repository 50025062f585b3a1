//! The sink on a fake host.

mod fake;
mod faults;
mod playing;

use std::time::Duration;

use cpal::SampleFormat;

use self::fake::{FakeCard, FakeHost};
use super::*;
use crate::feel::{Click, Cue, CueSender, DeviceState, Mode, RendererConfig, Spot, renderer};
use crate::sink::LatencyProbe;
use crate::units::{HostClock, Newtons};

/// A floor on a device, supervised step by step.
struct Rig {
    sender: CueSender,
    supervisor: Supervisor,
    now: Duration,
}

impl Rig {
    fn on(host: &FakeHost, options: DeviceOptions) -> Self {
        Self::delayed(host, options, Duration::ZERO)
    }

    fn delayed(host: &FakeHost, options: DeviceOptions, delay: Duration) -> Self {
        let floor = Floor::default();
        let mut device = OutputDevice::find_among(host.cards(), &floor, options).unwrap();
        device.ask = None;
        let config = RendererConfig { delay, ..RendererConfig::of(&floor, device.sample_rate()) };
        let (sender, renderer) = renderer(config);
        Self { sender, supervisor: device.supervise(renderer).unwrap(), now: Duration::ZERO }
    }

    /// Runs the supervisor for `span`, as its thread would.
    fn pass(&mut self, span: Duration) {
        let end = self.now + span;
        while self.now < end {
            self.now += TICK;
            self.supervisor.tick(self.now);
        }
    }

    /// Runs the supervisor for `span` while the card asks for a block each time.
    fn play(&mut self, card: &FakeCard, span: Duration) {
        let end = self.now + span;
        while self.now < end {
            card.pull::<f32>(128);
            self.now += TICK;
            self.supervisor.tick(self.now);
        }
    }

    fn status(&self) -> DeviceStatus {
        self.supervisor.status().lock().unwrap().clone()
    }
}

fn millis(millis: u64) -> Duration {
    Duration::from_millis(millis)
}

fn cue(tile: u16, at: Instant) -> Cue {
    let modes = [Mode { frequency_hz: 200.0, decay_s: 0.05, amplitude: 1.0 }];
    let click = Click { modes: modes.into_iter().collect(), level: Newtons(20.0), ..Click::default() };
    let spots = [Spot { tile, weight: 1.0 }].into_iter().collect();
    Cue { at, received: at, spots, click, ..Cue::default() }
}

/// A card with a channel per tile of the paper's floor, and its host.
fn one_card() -> (FakeHost, FakeCard) {
    let card = FakeCard::new("Card", 36, SampleFormat::F32);
    (FakeHost::with(&[&card]), card)
}

fn is_silent(block: &[f32]) -> bool {
    block.iter().all(|sample| *sample == 0.0)
}
