//! The sink on a device that exists only here, and plays when it is told to.

use std::fmt;
use std::sync::Mutex;
use std::time::Duration;

use cpal::platform::CustomDevice;
use cpal::{
    ChannelCount, Data, DeviceDescription, DeviceDescriptionBuilder, Error, FrameCount, InputCallbackInfo,
    OutputCallbackInfo, OutputStreamTimestamp, StreamConfig, StreamInstant, SupportedBufferSize,
    SupportedStreamConfig, SupportedStreamConfigRange,
};

use super::*;
use crate::feel::{Click, Cue, CueSender, Mode, RendererConfig, Spot, renderer};
use crate::sink::LatencyMeter;
use crate::units::Newtons;

type OnData = Box<dyn FnMut(&mut Data, &OutputCallbackInfo) + Send>;
type OnError = Box<dyn FnMut(Error) + Send>;

/// A sound card with 40 channels at 48 kHz.
#[derive(Clone)]
struct Card {
    channels: ChannelCount,
    format: SampleFormat,
    callbacks: Arc<Mutex<Option<(OnData, OnError)>>>,
}

impl Card {
    fn new(channels: ChannelCount, format: SampleFormat) -> Self {
        Self { channels, format, callbacks: Arc::default() }
    }

    fn device(&self) -> cpal::Device {
        CustomDevice::from_device(self.clone()).into()
    }

    /// Asks for a block as the card's driver would.
    fn pull<T: SizedSample>(&self, frames: usize) -> Vec<T> {
        let mut buffer = vec![T::EQUILIBRIUM; frames * usize::from(self.channels)];
        // SAFETY: the pointer, length and format are those of `buffer`, which outlives `data`.
        let mut data = unsafe { Data::from_parts(buffer.as_mut_ptr().cast(), buffer.len(), T::FORMAT) };
        let timestamp =
            OutputStreamTimestamp { callback: StreamInstant::ZERO, playback: StreamInstant::ZERO };
        if let Some((on_data, _)) = self.callbacks.lock().unwrap().as_mut() {
            on_data(&mut data, &OutputCallbackInfo::new(timestamp));
        }
        buffer
    }

    fn fail(&self, kind: ErrorKind) {
        if let Some((_, on_error)) = self.callbacks.lock().unwrap().as_mut() {
            on_error(Error::new(kind));
        }
    }
}

impl PartialEq for Card {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.callbacks, &other.callbacks)
    }
}

impl Eq for Card {}

impl std::hash::Hash for Card {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        Arc::as_ptr(&self.callbacks).hash(state);
    }
}

impl fmt::Debug for Card {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Card")
    }
}

impl fmt::Display for Card {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Card")
    }
}

impl DeviceTrait for Card {
    type SupportedInputConfigs = std::iter::Empty<SupportedStreamConfigRange>;
    type SupportedOutputConfigs = std::iter::Once<SupportedStreamConfigRange>;
    type Stream = CardStream;

    fn description(&self) -> Result<DeviceDescription, Error> {
        Ok(DeviceDescriptionBuilder::new("Card").build())
    }

    fn id(&self) -> Result<DeviceId, Error> {
        Err(Error::new(ErrorKind::UnsupportedOperation))
    }

    fn supported_input_configs(&self) -> Result<Self::SupportedInputConfigs, Error> {
        Ok(std::iter::empty())
    }

    fn supported_output_configs(&self) -> Result<Self::SupportedOutputConfigs, Error> {
        Ok(std::iter::once(SupportedStreamConfigRange::new(
            self.channels,
            48_000,
            48_000,
            SupportedBufferSize::Range { min: 64, max: 4096 },
            self.format,
        )))
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
    ) -> Result<Self::Stream, Error>
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
    ) -> Result<Self::Stream, Error>
    where
        D: FnMut(&mut Data, &OutputCallbackInfo) + Send + 'static,
        E: FnMut(Error) + Send + 'static,
    {
        assert_eq!((config.channels, format), (self.channels, self.format));
        *self.callbacks.lock().unwrap() = Some((Box::new(on_data), Box::new(on_error)));
        Ok(CardStream)
    }
}

struct CardStream;

impl StreamTrait for CardStream {
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

fn play(card: &Card, options: DeviceOptions, delay: Duration) -> (CueSender, DeviceSink) {
    let floor = Floor::default();
    let device = OutputDevice::with(card.device(), &floor, options).unwrap();
    let mut config = RendererConfig::of(&floor, device.sample_rate());
    config.delay = delay;
    let (sender, renderer) = renderer(config);
    let sink = device.play(renderer).unwrap();
    (sender, sink)
}

fn cue(tile: u16, at: Instant) -> Cue {
    let modes = [Mode { frequency_hz: 200.0, decay_s: 0.05, amplitude: 1.0 }];
    let click = Click { modes: modes.into_iter().collect(), level: Newtons(20.0) };
    Cue { at, received: at, spots: [Spot { tile, weight: 1.0 }].into_iter().collect(), click, to_air: 0.0 }
}

#[test]
fn a_cue_starts_with_the_block_it_meets_on_its_tiles_own_channel() {
    let card = Card::new(40, SampleFormat::F32);
    let meter = LatencyMeter::new();
    let latency = LatencyProbe::new(meter.clone(), Arc::new(|| Instant::from_micros(1_000_400)));
    let options = DeviceOptions { latency: Some(latency), ..DeviceOptions::default() };
    let (mut sender, mut sink) = play(&card, options, Duration::ZERO);
    card.pull::<f32>(480);
    sender.send(&cue(35, Instant::from_millis(1000)));
    // More frames than the renderer takes in one go.
    let block = card.pull::<f32>(700);
    let channel = |n: usize| block.iter().skip(n).step_by(40).copied().collect::<Vec<f32>>();
    assert!(channel(35)[0] != 0.0 && channel(35).iter().any(|sample| sample.abs() > 0.3));
    assert!((0..40).filter(|n| *n != 35).all(|n| channel(n).iter().all(|sample| *sample == 0.0)));
    assert_eq!(meter.summary().map(|latency| latency.count), Some(1));
    assert!(sink.advance(Instant::START).is_ok());
    assert_eq!((sink.status().blocks, sink.status().channels), (2, 40));
}

#[test]
fn the_cards_own_format_is_filled() {
    let card = Card::new(36, SampleFormat::I16);
    let (mut sender, _sink) = play(&card, DeviceOptions::default(), Duration::ZERO);
    card.pull::<i16>(480);
    sender.send(&cue(2, Instant::START));
    assert!(card.pull::<i16>(480).iter().skip(2).step_by(36).any(|sample| sample.abs() > 10_000));
}

#[test]
fn a_desk_hears_the_west_of_the_floor_on_the_left() {
    let card = Card::new(2, SampleFormat::F32);
    let options = DeviceOptions { mix: Mix::Stereo, ..DeviceOptions::default() };
    let (mut sender, _sink) = play(&card, options, Duration::ZERO);
    card.pull::<f32>(480);
    sender.send(&cue(0, Instant::START));
    let block = card.pull::<f32>(480);
    let power = |side: usize| block.iter().skip(side).step_by(2).map(|x| x * x).sum::<f32>();
    assert!(power(0) > 20.0 * power(1) && power(1) > 0.0);
}

/// A clock that the test sets stands for the host's; the card asks for blocks unevenly.
#[test]
fn with_a_clock_every_cue_is_equally_late() {
    let card = Card::new(36, SampleFormat::F32);
    let now = Arc::new(AtomicU64::new(0));
    let read = Arc::clone(&now);
    let steady: HostClock = Arc::new(move || Instant::from_micros(read.load(Ordering::Relaxed)));
    let options = DeviceOptions { steady: Some(steady), ..DeviceOptions::default() };
    let (mut sender, _sink) = play(&card, options, Duration::from_millis(8));
    let mut late = Vec::new();
    let mut frame = 0_u64;
    for block in 0..2000_u64 {
        // The callback of a 2 ms block runs up to 0.4 ms late.
        now.store(block * 2000 + (block * 37 % 5) * 100, Ordering::Relaxed);
        // A cue somewhere inside every 50th block, known at once.
        let at = Instant::from_micros(block * 2000 - (block * 53 % 1000).min(block * 2000));
        if block % 50 == 49 {
            sender.send(&cue((block / 50 % 36) as u16, at));
            late.push((frame, at, (block / 50 % 36) as usize));
        }
        let samples = card.pull::<f32>(96);
        late.retain_mut(|(sent, at, channel)| {
            let first = samples.iter().skip(*channel).step_by(36).position(|sample| *sample != 0.0);
            if let Some(first) = first {
                let due = at.micros() as f64 * 0.048 + 8.0 * 48.0;
                let played = (frame + first as u64) as f64;
                // The block starts 0.2 ms late on average; that is part of the steady delay.
                assert!((played - due + 9.6).abs() < 5.0, "sent at frame {sent}: {played} instead of {due}");
            }
            first.is_none()
        });
        frame += 96;
    }
    assert!(late.len() <= 1);
    assert_eq!(sender.counters().late, 0);
}

#[test]
fn a_card_that_is_pulled_out_is_told_once_and_stays_visible() {
    let card = Card::new(36, SampleFormat::F32);
    let (_sender, mut sink) = play(&card, DeviceOptions::default(), Duration::ZERO);
    card.fail(ErrorKind::Xrun);
    assert_eq!((sink.status().underruns, sink.status().lost), (1, None));
    card.fail(ErrorKind::DeviceNotAvailable);
    let message = sink.advance(Instant::START).unwrap_err().to_string();
    assert!(message.starts_with("Card is lost"), "{message}");
    assert!(sink.advance(Instant::START).is_ok());
    assert!(sink.status().lost.is_some());
}

#[test]
fn a_renderer_of_another_rate_and_a_card_too_small_are_refused() {
    let floor = Floor::default();
    let card = Card::new(36, SampleFormat::F32);
    let device = OutputDevice::with(card.device(), &floor, DeviceOptions::default()).unwrap();
    let (_sender, renderer) = renderer(RendererConfig::of(&floor, 96_000));
    let message = device.play(renderer).err().map(|error| error.to_string());
    assert_eq!(message.as_deref(), Some("Card plays 48000 samples per second, not 96000"));

    let small = Card::new(8, SampleFormat::F32);
    let message = OutputDevice::with(small.device(), &floor, DeviceOptions::default()).err().unwrap();
    assert!(message.to_string().contains("has 8 channels and the floor needs 36"), "{message}");
}
