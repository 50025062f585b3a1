//! Keeps a device playing: opens it again after failures.

use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use cpal::{BufferSize, Error, ErrorKind};
use rtrb::Consumer;

use super::callback::{Callback, CallbackStats, ErrorForwarder};
use super::cards::{Card, Cards, trouble};
use super::choice::{self, DeviceConfig};
use super::options::DeviceOptions;
use super::player::DevicePlayer;
use super::priority::{Ask, FIX, Promotion};
use super::stream::{self, Stream};
use super::watch::{Alarm, Watch};
use crate::feel::{DeviceState, DeviceStatus, Priority};
use crate::floor::Floor;
use crate::sink::SinkError;

/// Interval between attempts to reopen a device.
const RETRY: Duration = Duration::from_secs(1);

/// Minimum time between two pieces of the same advice.
const QUIET: Duration = Duration::from_secs(600);

/// Maximum wait for a closing stream to return the player; after that each tick checks again.
const LETTING_GO: Duration = Duration::from_millis(500);

/// Keeps a device playing: detects loss, hangs and repeated underruns, and reopens the same device.
///
/// The caller passes the time, so that tests need no clock.
pub(super) struct Supervisor {
    cards: Arc<dyn Cards>,
    id: String,
    /// Whether the user set the block length, which then stays constant.
    block_is_asked: bool,
    floor: Floor,
    options: DeviceOptions,
    ask: Option<Ask>,
    stats: Arc<CallbackStats>,
    watch: Watch,
    open: Option<Open>,
    /// The player while no stream is open; `None` also until a closed stream has returned it.
    parked: Option<DevicePlayer>,
    home: (Sender<DevicePlayer>, Receiver<DevicePlayer>),
    retry_at: Duration,
    status: Arc<Mutex<DeviceStatus>>,
    /// The status to publish next.
    now: DeviceStatus,
    said_denied: bool,
    /// Time of the last message that longer blocks are impossible.
    said_storm: Option<Duration>,
}

/// A running stream.
struct Open {
    stream: Stream,
    reports: Consumer<Error>,
    choice: DeviceConfig,
    /// Block count when it was opened.
    blocks: u64,
}

/// The configuration of a supervisor.
pub(super) struct SupervisorConfig {
    pub(super) cards: Arc<dyn Cards>,
    pub(super) card: Card,
    pub(super) choice: DeviceConfig,
    pub(super) floor: Floor,
    pub(super) options: DeviceOptions,
    pub(super) block_is_asked: bool,
    pub(super) ask: Option<Ask>,
}

impl Supervisor {
    /// Opens the device for the first time.
    pub(super) fn begin(config: SupervisorConfig, player: DevicePlayer) -> Result<Self, SinkError> {
        let SupervisorConfig { cards, card, choice, floor, options, block_is_asked, ask } = config;
        let now = DeviceStatus {
            name: card.name(),
            id: card.id(),
            sample_rate: choice.sample_rate,
            channels: choice.channels,
            ..DeviceStatus::default()
        };
        let mut supervisor = Self {
            cards,
            id: card.id(),
            block_is_asked,
            floor,
            options,
            ask,
            stats: Arc::default(),
            watch: Watch::default(),
            open: None,
            parked: Some(player),
            home: channel(),
            retry_at: Duration::ZERO,
            status: Arc::new(Mutex::new(now.clone())),
            now,
            said_denied: false,
            said_storm: None,
        };
        supervisor
            .start(&card, choice, Duration::ZERO, false)
            .map_err(|error| trouble(&card.name(), &error))?;
        Ok(supervisor)
    }

    /// Returns the published status of the device.
    pub(super) fn status(&self) -> Arc<Mutex<DeviceStatus>> {
        Arc::clone(&self.status)
    }

    /// Checks the device; called about fifty times a second.
    pub(super) fn tick(&mut self, now: Duration) {
        if self.open.is_some() {
            self.look_after(now);
        } else {
            self.bring_back(now);
        }
        self.tell();
    }

    fn look_after(&mut self, now: Duration) {
        let Some(open) = &mut self.open else { return };
        let blocks = self.stats.blocks.load(Ordering::Relaxed);
        if blocks != open.blocks && self.now.state != DeviceState::Playing {
            (self.now.state, self.now.why) = (DeviceState::Playing, String::new());
            tracing::warn!("{} plays again", self.now.name);
        }
        while let Ok(error) = open.reports.pop() {
            match error.kind() {
                ErrorKind::DeviceNotAvailable | ErrorKind::HostUnavailable | ErrorKind::PermissionDenied => {
                    return self.close(now + RETRY, DeviceState::Lost, &error.to_string());
                }
                ErrorKind::StreamInvalidated | ErrorKind::DeviceChanged => {
                    // The system may play on another device now, which nobody selected.
                    return self.close(now, DeviceState::Faulty, &error.to_string());
                }
                _ => tracing::warn!("{}: {error}", self.now.name),
            }
        }
        let choice = open.choice;
        let frames = match self.stats.frames.load(Ordering::Relaxed) {
            0 => frames_of(choice.buffer_size).unwrap_or(0),
            frames => frames,
        };
        let block = Duration::from_secs_f64(f64::from(frames) / f64::from(choice.sample_rate.max(1)));
        let underruns = self.stats.underruns.load(Ordering::Relaxed);
        match self.watch.look(now, blocks, underruns, block) {
            None => {}
            Some(Alarm::Silent) => self.close(now, DeviceState::Faulty, "it has stopped asking for samples"),
            Some(Alarm::Storm) => self.enlarge(now, choice, frames),
        }
    }

    /// Reopens the device with blocks of twice the length, if it supports them.
    fn enlarge(&mut self, now: Duration, choice: DeviceConfig, frames: u32) {
        let name = &self.now.name;
        let wanted = DeviceOptions { block: Some(frames.saturating_mul(2)), ..self.options.clone() };
        let larger = self.cards.by_id(&self.id).and_then(|card| self.choose(&card, &wanted).ok());
        match larger.filter(|larger| larger.buffer_size != choice.buffer_size) {
            Some(larger) if !self.block_is_asked => {
                let longer = frames_of(larger.buffer_size).unwrap_or(0);
                tracing::warn!(
                    "{name} gets its samples late again and again: going on with blocks of {longer} frames in place \
                     of {frames}; what else runs on this machine, and has the sound real-time priority?"
                );
                self.options.block = wanted.block;
                self.close(now, DeviceState::Faulty, "it needs longer blocks");
            }
            larger if self.said_storm.is_none_or(|said| now >= said + QUIET) => {
                self.said_storm = Some(now);
                let advice = match larger {
                    Some(_) => "ask for longer blocks (`block`)",
                    None => "it can't have longer blocks, so set them in its server",
                };
                tracing::warn!(
                    "{name} gets its samples late again and again: {advice}, or relieve this machine"
                );
            }
            _ => {}
        }
    }

    /// Closes the stream; it may be reopened from `retry_at` on.
    fn close(&mut self, retry_at: Duration, state: DeviceState, why: &str) {
        let Some(Open { stream, .. }) = self.open.take() else { return };
        if self.now.state == DeviceState::Playing {
            tracing::warn!("{} is {}: {why}", self.now.name, state.name());
        }
        (self.now.state, self.now.why) = (state, why.to_string());
        self.retry_at = retry_at;
        self.watch.closed();
        // The status is published first, since closing may hang in the host.
        self.tell();
        let letting_go = std::thread::Builder::new().name("closing".into()).spawn(move || drop(stream));
        if let Err(error) = letting_go {
            // In that case the stream was dropped here.
            tracing::debug!("no thread to close a device: {error}");
        }
        self.parked = self.home.1.recv_timeout(LETTING_GO).ok();
    }

    /// Tries to reopen the device when it is time.
    fn bring_back(&mut self, now: Duration) {
        if self.parked.is_none() {
            self.parked = self.home.1.try_recv().ok();
        }
        let Some(player) = &mut self.parked else { return };
        // Cues sent while no stream is open are discarded.
        player.restart();
        if now < self.retry_at {
            return;
        }
        self.retry_at = now + RETRY;
        let Some(card) = self.cards.by_id(&self.id) else {
            if self.now.state != DeviceState::Lost {
                self.now.why = "it is not there".into();
            }
            self.now.state = DeviceState::Lost;
            return;
        };
        let choice = match self.choose(&card, &self.options) {
            Ok(choice) => choice,
            Err(error) => return self.refuse(DeviceState::Unfit, &error.to_string()),
        };
        match self.start(&card, choice, now, true) {
            Ok(()) => {
                self.now.reopened += 1;
                (self.now.sample_rate, self.now.channels) = (choice.sample_rate, choice.channels);
            }
            Err(error) => self.refuse(DeviceState::Faulty, &error.to_string()),
        }
    }

    fn refuse(&mut self, state: DeviceState, why: &str) {
        if (self.now.state, self.now.why.as_str()) != (state, why) {
            tracing::warn!("{} is {}: {why}", self.now.name, state.name());
        }
        (self.now.state, self.now.why) = (state, why.to_string());
    }

    /// Chooses a configuration of `card` at the renderer's rate.
    fn choose(&self, card: &Card, options: &DeviceOptions) -> Result<DeviceConfig, SinkError> {
        let ranges = card.ranges().map_err(|error| trouble(&card.name(), &error))?;
        choice::choose(&card.name(), &ranges, &self.floor, options)
    }

    /// Opens the device; `is_back` if it was away.
    fn start(
        &mut self,
        card: &Card,
        choice: DeviceConfig,
        now: Duration,
        is_back: bool,
    ) -> Result<(), Error> {
        let Some(mut player) = self.parked.take() else { return Ok(()) };
        player.fit(&self.floor, &self.options, choice);
        let (forwarder, reports) = ErrorForwarder::new(Arc::clone(&self.stats));
        let (blocks, underruns) = (&self.stats.blocks, &self.stats.underruns);
        let (blocks, underruns) = (blocks.load(Ordering::Relaxed), underruns.load(Ordering::Relaxed));
        self.stats.frames.store(0, Ordering::Relaxed);
        let promotion = Promotion::new(self.ask, matches!(card, Card::Paced));
        let callback = Callback::new(player, choice, self.home.0.clone(), Arc::clone(&self.stats), promotion);
        let callback = if is_back { callback.forgetting() } else { callback };
        match stream::open(card, choice, callback, forwarder) {
            Ok(stream) => {
                self.watch.opened(now, blocks, underruns);
                self.open = Some(Open { stream, reports, choice, blocks });
                Ok(())
            }
            Err(error) => {
                self.parked = self.home.1.recv_timeout(LETTING_GO).ok();
                Err(error)
            }
        }
    }

    /// Publishes the status of the device.
    fn tell(&mut self) {
        self.now.blocks = self.stats.blocks.load(Ordering::Relaxed);
        self.now.underruns = self.stats.underruns.load(Ordering::Relaxed);
        self.now.priority = self.stats.priority();
        self.now.block = self.stats.frames.load(Ordering::Relaxed);
        if self.now.priority == Priority::Denied && !self.said_denied {
            self.said_denied = true;
            tracing::warn!("{}: {FIX}", self.now.name);
        }
        self.status.lock().unwrap_or_else(PoisonError::into_inner).clone_from(&self.now);
    }
}

fn frames_of(size: BufferSize) -> Option<u32> {
    match size {
        BufferSize::Fixed(frames) => Some(frames),
        BufferSize::Default => None,
    }
}
