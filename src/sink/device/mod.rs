//! Actuators and loudspeakers through the sound card; the only user of cpal.
//!
//! `callback`, and the code that it calls, runs on the device's own thread. Clippy checks that code for locks, logs
//! and calls that block (`clippy.toml`), and the tests here run every callback under `assert_no_alloc`.

mod block_clock;
mod callback;
mod cards;
mod choice;
mod mixdown;
mod options;
mod paced;
mod player;
mod priority;
mod resample;
mod stream;
mod supervisor;
mod watch;

use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant as HostInstant};

use self::cards::{Card, Cards, System, trouble};
pub use self::cards::{DeviceEntry, output_devices};
use self::choice::DeviceConfig;
pub use self::options::{DeviceOptions, Mix};
use self::player::DevicePlayer;
use self::priority::Ask;
use self::supervisor::{Supervisor, SupervisorConfig};
use super::{ActuatorSink, SinkError};
use crate::feel::{DeviceStatus, Renderer};
use crate::floor::Floor;
use crate::units::Instant;

/// A device that fits a floor, and its configuration; it makes no sound yet.
///
/// It gives the sample rate for the renderer.
pub struct OutputDevice {
    cards: Arc<dyn Cards>,
    card: Card,
    name: String,
    choice: DeviceConfig,
    floor: Floor,
    options: DeviceOptions,
    block_is_asked: bool,
    ask: Option<Ask>,
}

impl OutputDevice {
    /// Finds the device that `options` request, and a configuration for `floor`.
    ///
    /// # Errors
    /// [`SinkError::Device`] if there is no such device or it lacks a requested feature; the message gives its
    /// features and advice.
    pub fn find(floor: &Floor, options: DeviceOptions) -> Result<Self, SinkError> {
        Self::find_among(System::shared(), floor, options)
    }

    fn find_among(
        cards: Arc<dyn Cards>,
        floor: &Floor,
        mut options: DeviceOptions,
    ) -> Result<Self, SinkError> {
        let card = match &options.name {
            None => cards.chosen_by_system(),
            Some(name) => cards.by_id(name).or_else(|| cards.by_name(name)),
        };
        let Some(card) = card else { return Err(no_such_device(options.name.as_deref(), &cards.names())) };
        let block_is_asked = options.block.is_some();
        if matches!(card, Card::Paced) {
            options.block.get_or_insert(paced::BLOCK);
            options.sample_rate.get_or_insert(paced::SAMPLE_RATE);
        }
        let name = card.name();
        let ranges = card.ranges().map_err(|error| trouble(&name, &error))?;
        let choice = choice::choose(&name, &ranges, floor, &options)?;
        let (floor, ask) = (floor.clone(), Some(priority::ask_system as Ask));
        Ok(Self { cards, card, name, choice, floor, options, block_is_asked, ask })
    }

    /// The device's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the samples per second of the renderer.
    #[must_use]
    pub fn sample_rate(&self) -> u32 {
        match self.options.sample_rate {
            Some(asked) if self.options.resample => asked,
            _ => self.choice.sample_rate,
        }
    }

    /// Returns the samples per second of the device itself: another rate only with conversion.
    #[must_use]
    pub fn device_rate(&self) -> u32 {
        self.choice.sample_rate
    }

    /// Returns the number of device channels, used or silent.
    #[must_use]
    pub fn channels(&self) -> u16 {
        self.choice.channels
    }

    /// Starts playing the samples of `renderer`.
    ///
    /// From now on a thread supervises the device: when it is lost or hangs, the thread opens it again as soon as
    /// possible and discards the cues in between.
    ///
    /// # Errors
    /// [`SinkError::Device`] if the renderer was made for another sample rate, or the device is in use, missing, or
    /// fails to play.
    pub fn play(self, renderer: Renderer) -> Result<DeviceSink, SinkError> {
        DeviceSink::keep(self.supervise(renderer)?)
    }

    fn supervise(mut self, renderer: Renderer) -> Result<Supervisor, SinkError> {
        if renderer.sample_rate() != self.sample_rate() {
            let (made_for, wanted) = (renderer.sample_rate(), self.sample_rate());
            return Err(SinkError::Device {
                message: format!("{} plays {wanted} samples per second, not {made_for}", self.name),
            });
        }
        // The renderer stays the same when the device comes back.
        self.options.sample_rate = Some(renderer.sample_rate());
        let player = DevicePlayer::new(renderer, &self.floor, &self.options, self.choice);
        let Self { cards, card, choice, floor, options, block_is_asked, ask, .. } = self;
        Supervisor::begin(
            SupervisorConfig { cards, card, choice, floor, options, block_is_asked, ask },
            player,
        )
    }
}

/// Interval between two checks of a device.
const TICK: Duration = Duration::from_millis(20);

/// Maximum wait for a device to close at the end of the program.
const SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(1);

/// A floor's actuators, or a designer's loudspeakers, on a sound card.
///
/// The device has its own clock: its callback renders, and does nothing else. Dropping the sink stops the device.
pub struct DeviceSink {
    status: Arc<Mutex<DeviceStatus>>,
    /// `None` only while being dropped.
    stop: Option<Sender<()>>,
    stopped: Receiver<()>,
}

impl DeviceSink {
    fn keep(mut supervisor: Supervisor) -> Result<Self, SinkError> {
        let status = supervisor.status();
        let (stop, told) = channel::<()>();
        let (stopping, stopped) = channel();
        let begun = HostInstant::now();
        let work = move || {
            while told.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                supervisor.tick(begun.elapsed());
            }
            drop(supervisor);
            // The receiver may have stopped waiting.
            let _ = stopping.send(());
        };
        let spawned = thread::Builder::new().name("sound card".into()).spawn(work);
        spawned.map_err(|error| SinkError::Device {
            message: format!(
                "the sound card can't be looked after, since there is no thread to be had: {error}"
            ),
        })?;
        Ok(Self { status, stop: Some(stop), stopped })
    }
}

impl Drop for DeviceSink {
    /// Closes the device; does not wait indefinitely for one that hangs.
    fn drop(&mut self) {
        self.stop = None;
        if self.stopped.recv_timeout(SHUTDOWN_TIMEOUT).is_err() {
            tracing::warn!("the sound card does not let itself be closed");
        }
    }
}

impl ActuatorSink for DeviceSink {
    /// Does nothing, since the device has its own clock; the supervisor reopens a device that has stopped.
    fn advance(&mut self, _now: Instant) -> Result<(), SinkError> {
        Ok(())
    }

    fn device(&self, status: &mut DeviceStatus) -> bool {
        status.clone_from(&self.status.lock().unwrap_or_else(PoisonError::into_inner));
        true
    }
}

fn no_such_device(name: Option<&str>, names: &[String]) -> SinkError {
    let message = match name {
        Some(name) if cfg!(not(feature = "jack")) && name.to_lowercase().starts_with("jack") => {
            "this program was built without JACK: build it with `--features jack`, which needs JACK's headers \
             (Debian: libjack-jackd2-dev)"
                .into()
        }
        Some(name) if !names.is_empty() => {
            format!(
                "there is no sound card `{name}`: choose one of {}, or `paced` for a clock without sound",
                names.join(", ")
            )
        }
        Some(name) => {
            format!("there is no sound card `{name}` and no other: `underfoot rack devices` lists all")
        }
        None => "no sound card was found: connect one, record to a WAV file, or go on without".into(),
    };
    SinkError::Device { message }
}

#[cfg(test)]
mod tests;
