//! An open stream of a card.

use std::time::Duration;

use cpal::traits::{DeviceTrait, StreamTrait};
use cpal::{Error, FromSample, I24, OutputCallbackInfo, SampleFormat, SizedSample, U24};

use super::callback::{Callback, ErrorForwarder};
use super::cards::Card;
use super::choice::DeviceConfig;
use super::paced::PacedStream;

/// A running device; dropping it stops the device.
pub(super) enum Stream {
    System(#[expect(dead_code, reason = "it plays for as long as it is kept")] cpal::Stream),
    Paced(#[expect(dead_code, reason = "it plays for as long as it is kept")] PacedStream),
}

/// Opens a card and starts it.
pub(super) fn open(
    card: &Card,
    choice: DeviceConfig,
    callback: Callback,
    mut forwarder: ErrorForwarder,
) -> Result<Stream, Error> {
    let device = match card {
        Card::System(device) => device,
        Card::Paced => {
            return PacedStream::start(choice, callback, move |error| forwarder.hear(error))
                .map(Stream::Paced);
        }
    };
    let stream = match choice.format {
        SampleFormat::I8 => build::<i8>(device, choice, callback, forwarder),
        SampleFormat::I16 => build::<i16>(device, choice, callback, forwarder),
        SampleFormat::I24 => build::<I24>(device, choice, callback, forwarder),
        SampleFormat::I32 => build::<i32>(device, choice, callback, forwarder),
        SampleFormat::U8 => build::<u8>(device, choice, callback, forwarder),
        SampleFormat::U16 => build::<u16>(device, choice, callback, forwarder),
        SampleFormat::U24 => build::<U24>(device, choice, callback, forwarder),
        SampleFormat::U32 => build::<u32>(device, choice, callback, forwarder),
        SampleFormat::F64 => build::<f64>(device, choice, callback, forwarder),
        _ => build::<f32>(device, choice, callback, forwarder),
    }?;
    stream.play()?;
    Ok(Stream::System(stream))
}

/// Maximum time for a host to open a device.
const OPENING: Duration = Duration::from_secs(5);

fn build<T: SizedSample + FromSample<f32>>(
    device: &cpal::Device,
    choice: DeviceConfig,
    mut callback: Callback,
    mut forwarder: ErrorForwarder,
) -> Result<cpal::Stream, Error> {
    device.build_output_stream::<T, _, _>(
        choice.stream_config(),
        move |out, info| callback.run(out, sounds_in(info)),
        move |error| forwarder.hear(error),
        Some(OPENING),
    )
}

/// Returns the time from the callback to the sound of its block, by the host's account; zero if unknown.
fn sounds_in(info: &OutputCallbackInfo) -> Duration {
    let times = info.timestamp();
    times.playback.saturating_duration_since(times.callback)
}
