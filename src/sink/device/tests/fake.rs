//! A fake cpal host: its cards play on request and can be pulled out and plugged in.

use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use assert_no_alloc::{assert_no_alloc, violation_count};
use cpal::platform::{CustomHost, CustomStream};
use cpal::traits::{DeviceTrait, HostTrait, StreamTrait};
use cpal::{
    BufferSize, ChannelCount, Data, DeviceDescription, DeviceDescriptionBuilder, DeviceId, Error, ErrorKind,
    FrameCount, HostId, InputCallbackInfo, OutputCallbackInfo, OutputStreamTimestamp, SampleFormat,
    SizedSample, StreamConfig, StreamInstant, SupportedBufferSize, SupportedStreamConfig,
    SupportedStreamConfigRange,
};

use super::super::cards::{self, Card, Cards};

type OnData = Box<dyn FnMut(&mut Data, &OutputCallbackInfo) + Send>;
type OnError = Box<dyn FnMut(Error) + Send>;

/// A host with its cards.
#[derive(Clone, Default)]
pub(super) struct FakeHost {
    cards: Arc<Mutex<Vec<FakeCard>>>,
    /// Number of searches for devices.
    pub(super) looks: Arc<AtomicUsize>,
}

impl FakeHost {
    pub(super) fn with(cards: &[&FakeCard]) -> Self {
        let host = Self::default();
        cards.iter().for_each(|card| host.plug_in(card));
        host
    }

    /// Makes the card available; the first card is the system's default.
    pub(super) fn plug_in(&self, card: &FakeCard) {
        self.cards.lock().unwrap().push(card.clone());
    }

    pub(super) fn pull_out(&self, card: &FakeCard) {
        self.cards.lock().unwrap().retain(|other| other.id != card.id);
    }

    fn host(&self) -> cpal::Host {
        CustomHost::from_host(self.clone()).into()
    }

    pub(super) fn cards(&self) -> Arc<dyn Cards> {
        Arc::new(self.clone())
    }
}

impl Cards for FakeHost {
    fn chosen_by_system(&self) -> Option<Card> {
        cards::chosen_of(&self.host())
    }

    fn by_id(&self, id: &str) -> Option<Card> {
        cards::of_id(&self.host(), &id.parse().ok()?)
    }

    fn by_name(&self, name: &str) -> Option<Card> {
        cards::named(&self.host(), name)
    }

    fn names(&self) -> Vec<String> {
        cards::names(&self.host())
    }
}

impl HostTrait for FakeHost {
    type Devices = std::vec::IntoIter<FakeCard>;
    type Device = FakeCard;

    fn is_available() -> bool {
        true
    }

    fn devices(&self) -> Result<Self::Devices, Error> {
        self.looks.fetch_add(1, Ordering::Relaxed);
        Ok(self.cards.lock().unwrap().clone().into_iter())
    }

    fn default_input_device(&self) -> Option<FakeCard> {
        None
    }

    fn default_output_device(&self) -> Option<FakeCard> {
        self.cards.lock().unwrap().first().cloned()
    }
}

/// A sound card.
#[derive(Clone)]
pub(super) struct FakeCard {
    id: &'static str,
    state: Arc<Mutex<State>>,
}

struct State {
    channels: ChannelCount,
    rate: u32,
    format: SampleFormat,
    /// Longest supported block.
    longest: u32,
    callbacks: Option<(OnData, OnError)>,
    /// The configurations it was opened with.
    opened: Vec<StreamConfig>,
}

impl FakeCard {
    /// A card at 48 kHz with exactly this number of channels.
    pub(super) fn new(id: &'static str, channels: ChannelCount, format: SampleFormat) -> Self {
        let state =
            State { channels, rate: 48_000, format, longest: 4096, callbacks: None, opened: Vec::new() };
        Self { id, state: Arc::new(Mutex::new(state)) }
    }

    pub(super) fn set_rate(&self, rate: u32) {
        self.state.lock().unwrap().rate = rate;
    }

    pub(super) fn set_channels(&self, channels: ChannelCount) {
        self.state.lock().unwrap().channels = channels;
    }

    pub(super) fn set_longest_block(&self, longest: u32) {
        self.state.lock().unwrap().longest = longest;
    }

    /// Returns how often it was opened.
    pub(super) fn opened(&self) -> usize {
        self.state.lock().unwrap().opened.len()
    }

    /// Returns the block length requested last.
    pub(super) fn block(&self) -> BufferSize {
        self.state.lock().unwrap().opened.last().unwrap().buffer_size
    }

    /// Requests a block as the card's driver would; empty if nothing plays. A6: the callback must not allocate.
    pub(super) fn pull<T: SizedSample>(&self, frames: usize) -> Vec<T> {
        let mut state = self.state.lock().unwrap();
        let mut buffer = vec![T::EQUILIBRIUM; frames * usize::from(state.channels)];
        let Some((on_data, _)) = state.callbacks.as_mut() else { return Vec::new() };
        // SAFETY: the pointer, length and format are those of `buffer`, which outlives `data`.
        let mut data = unsafe { Data::from_parts(buffer.as_mut_ptr().cast(), buffer.len(), T::FORMAT) };
        let timestamp =
            OutputStreamTimestamp { callback: StreamInstant::ZERO, playback: StreamInstant::ZERO };
        let before = violation_count();
        assert_no_alloc(|| on_data(&mut data, &OutputCallbackInfo::new(timestamp)));
        assert_eq!(violation_count(), before, "the callback allocates");
        buffer
    }

    /// Reports an error as the card's driver would.
    pub(super) fn fail(&self, kind: ErrorKind) {
        let mut state = self.state.lock().unwrap();
        if let Some((_, on_error)) = state.callbacks.as_mut() {
            on_error(Error::new(kind));
        }
    }
}

impl PartialEq for FakeCard {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl Eq for FakeCard {}

impl Hash for FakeCard {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.id.hash(state);
    }
}

impl fmt::Debug for FakeCard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id)
    }
}

impl fmt::Display for FakeCard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id)
    }
}

impl DeviceTrait for FakeCard {
    type SupportedInputConfigs = std::iter::Empty<SupportedStreamConfigRange>;
    type SupportedOutputConfigs = std::iter::Once<SupportedStreamConfigRange>;
    type Stream = FakeStream;

    fn description(&self) -> Result<DeviceDescription, Error> {
        Ok(DeviceDescriptionBuilder::new(self.id).build())
    }

    fn id(&self) -> Result<DeviceId, Error> {
        Ok(DeviceId::new(HostId::Custom, self.id))
    }

    fn supported_input_configs(&self) -> Result<Self::SupportedInputConfigs, Error> {
        Ok(std::iter::empty())
    }

    fn supported_output_configs(&self) -> Result<Self::SupportedOutputConfigs, Error> {
        let state = self.state.lock().unwrap();
        let buffer = SupportedBufferSize::Range { min: 64, max: state.longest };
        let State { channels, rate, format, .. } = *state;
        Ok(std::iter::once(SupportedStreamConfigRange::new(channels, rate, rate, buffer, format)))
    }

    fn default_input_config(&self) -> Result<SupportedStreamConfig, Error> {
        Err(Error::new(ErrorKind::UnsupportedConfig))
    }

    fn default_output_config(&self) -> Result<SupportedStreamConfig, Error> {
        Err(Error::new(ErrorKind::UnsupportedConfig))
    }

    fn build_input_stream_raw<D, E>(
        &self,
        _: StreamConfig,
        _: SampleFormat,
        _: D,
        _: E,
        _: Option<Duration>,
    ) -> Result<FakeStream, Error>
    where
        D: FnMut(&Data, &InputCallbackInfo) + Send + 'static,
        E: FnMut(Error) + Send + 'static,
    {
        Err(Error::new(ErrorKind::UnsupportedOperation))
    }

    fn build_output_stream_raw<D, E>(
        &self,
        config: StreamConfig,
        format: SampleFormat,
        on_data: D,
        on_error: E,
        _: Option<Duration>,
    ) -> Result<FakeStream, Error>
    where
        D: FnMut(&mut Data, &OutputCallbackInfo) + Send + 'static,
        E: FnMut(Error) + Send + 'static,
    {
        let mut state = self.state.lock().unwrap();
        assert_eq!((config.channels, format), (state.channels, state.format));
        state.opened.push(config);
        state.callbacks = Some((Box::new(on_data), Box::new(on_error)));
        Ok(FakeStream(self.clone()))
    }
}

/// A stream that drops its callbacks when it is dropped, like all streams.
pub(super) struct FakeStream(FakeCard);

impl Drop for FakeStream {
    fn drop(&mut self) {
        let callbacks = self.0.state.lock().unwrap().callbacks.take();
        drop(callbacks);
    }
}

impl StreamTrait for FakeStream {
    fn play(&self) -> Result<(), Error> {
        Ok(())
    }

    fn pause(&self) -> Result<(), Error> {
        Ok(())
    }

    fn buffer_size(&self) -> Result<FrameCount, Error> {
        Ok(64)
    }

    fn now(&self) -> StreamInstant {
        StreamInstant::ZERO
    }
}

/// Streams may be moved to the thread that closes them.
const _: fn() = || {
    fn can_be_sent<T: Send>() {}
    can_be_sent::<CustomStream>();
};
