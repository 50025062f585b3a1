//! Rate, format, channels and block length that fit a floor.

use cpal::{BufferSize, SampleFormat, StreamConfig, SupportedBufferSize, SupportedStreamConfigRange};

use super::options::{DeviceOptions, Mix};
use crate::floor::Floor;
use crate::sink::{ChannelMap, SinkError};

/// The configuration in which a device is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DeviceConfig {
    pub(super) channels: u16,
    pub(super) sample_rate: u32,
    pub(super) format: SampleFormat,
    pub(super) buffer_size: BufferSize,
}

impl DeviceConfig {
    pub(super) fn stream_config(self) -> StreamConfig {
        StreamConfig { channels: self.channels, sample_rate: self.sample_rate, buffer_size: self.buffer_size }
    }
}

/// Default number of frames in a block.
const BLOCK: u32 = 128;

/// Rates in order of preference.
const RATES: [u32; 3] = [48_000, 96_000, 44_100];

/// Sample formats in order of preference: first the one without conversion, then by precision.
const FORMATS: [SampleFormat; 10] = [
    SampleFormat::F32,
    SampleFormat::I32,
    SampleFormat::I24,
    SampleFormat::F64,
    SampleFormat::I16,
    SampleFormat::U32,
    SampleFormat::U24,
    SampleFormat::U16,
    SampleFormat::I8,
    SampleFormat::U8,
];

/// Chooses the best configuration in `ranges` of the device `name` for `floor`.
///
/// A device without the requested sample rate is rejected, unless conversion is allowed: then its rate is the nearest
/// above, or its highest.
pub(super) fn choose(
    name: &str,
    ranges: &[SupportedStreamConfigRange],
    floor: &Floor,
    options: &DeviceOptions,
) -> Result<DeviceConfig, SinkError> {
    let needed = floor.channel_count();
    let refuse = |message: String| Err(SinkError::Device { message });
    let playable = || ranges.iter().filter(|range| FORMATS.contains(&range.sample_format()));
    let most = playable().map(SupportedStreamConfigRange::channels).max().unwrap_or(0);
    if most == 0 {
        return refuse(format!("the sound card {name} plays nothing we can give: choose another"));
    }
    let wanted = match options.mix {
        Mix::PerActuator if usize::from(most) < needed => {
            return refuse(too_few(name, most, floor));
        }
        Mix::PerActuator | Mix::AsManyAsThereAre => needed.clamp(1, most.into()),
        Mix::Stereo => usize::from(most.min(2)),
    };
    // No more channels than needed: the rest would only be filled with silence.
    let channels = playable()
        .map(SupportedStreamConfigRange::channels)
        .filter(|channels| usize::from(*channels) >= wanted)
        .min()
        .unwrap_or(most);
    let fitting = || playable().filter(|range| range.channels() == channels);

    let Some(sample_rate) = pick_rate(fitting, options.sample_rate, options.resample) else {
        let asked = options.sample_rate.unwrap_or_default();
        let offered: Vec<String> = fitting()
            .map(|range| match (range.min_sample_rate(), range.max_sample_rate()) {
                (low, high) if low == high => low.to_string(),
                (low, high) => format!("{low} to {high}"),
            })
            .collect();
        return refuse(format!(
            "the sound card {name} can't play {asked} samples per second with {channels} channels: it offers {}; \
             ask for one of these, or for the rate to be converted (`resample`)",
            offered.join(", ")
        ));
    };
    let rank = |format| FORMATS.iter().position(|other| *other == format);
    let Some(range) =
        fitting().filter(|range| range.contains_rate(sample_rate)).min_by_key(|r| rank(r.sample_format()))
    else {
        return refuse(format!("the sound card {name} plays nothing we can give: choose another"));
    };
    let buffer_size = match *range.buffer_size() {
        SupportedBufferSize::Range { min, max } if min <= max => {
            BufferSize::Fixed(options.block.unwrap_or(BLOCK).clamp(min.max(1), max.max(1)))
        }
        _ => BufferSize::Default,
    };
    Ok(DeviceConfig { channels, sample_rate, format: range.sample_format(), buffer_size })
}

/// Returns the requested rate, or else the preferred one; `None` if the device has no such rate.
fn pick_rate<'a, I>(fitting: impl Fn() -> I, asked: Option<u32>, resample: bool) -> Option<u32>
where
    I: Iterator<Item = &'a SupportedStreamConfigRange>,
{
    let offered = |rate: &u32| fitting().any(|range| range.contains_rate(*rate));
    match asked {
        Some(rate) if offered(&rate) => Some(rate),
        Some(rate) if resample => {
            let above = fitting().map(SupportedStreamConfigRange::min_sample_rate).filter(|low| *low > rate);
            above.min().or_else(|| fitting().map(SupportedStreamConfigRange::max_sample_rate).max())
        }
        Some(_) => None,
        None => RATES
            .into_iter()
            .find(offered)
            .or_else(|| fitting().map(SupportedStreamConfigRange::max_sample_rate).max()),
    }
}

/// Makes the message for a device with too few channels, with the floor's map and the tiles that it cannot drive.
fn too_few(name: &str, most: u16, floor: &Floor) -> String {
    let map = ChannelMap::new(floor);
    let (needed, tiles) = (floor.channel_count(), map.beyond(most.into()).count());
    format!(
        "the sound card {name} has {most} channels and the floor needs {needed}: {tiles} tiles would not be felt. \
         Connect one with more, give the floor's tiles other channels (`actuators` in the floor file), or mix \
         them into two (`sound`). The channel of each tile, from 0:\n{map}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(channels: u16, low: u32, high: u32, format: SampleFormat) -> SupportedStreamConfigRange {
        let buffer = SupportedBufferSize::Range { min: 64, max: 4096 };
        SupportedStreamConfigRange::new(channels, low, high, buffer, format)
    }

    fn chosen(
        ranges: &[SupportedStreamConfigRange],
        mix: Mix,
        rate: Option<u32>,
    ) -> Result<DeviceConfig, String> {
        let options = DeviceOptions { mix, sample_rate: rate, block: Some(32), ..DeviceOptions::default() };
        choose("Test", ranges, &Floor::default(), &options).map_err(|error| error.to_string())
    }

    #[test]
    fn takes_the_fewest_channels_that_do_at_the_rate_we_like_and_the_finest_format() {
        let card = [
            range(64, 44_100, 192_000, SampleFormat::I16),
            range(64, 44_100, 192_000, SampleFormat::I32),
            range(128, 44_100, 192_000, SampleFormat::F32),
            range(2, 44_100, 192_000, SampleFormat::F32),
        ];
        let choice = chosen(&card, Mix::PerActuator, None).unwrap();
        assert_eq!((choice.channels, choice.sample_rate, choice.format), (64, 48_000, SampleFormat::I32));
        assert_eq!(choice.buffer_size, BufferSize::Fixed(64));
        assert_eq!(chosen(&card, Mix::PerActuator, Some(96_000)).unwrap().sample_rate, 96_000);
        let stereo = chosen(&card, Mix::Stereo, None).unwrap();
        assert_eq!((stereo.channels, stereo.format), (2, SampleFormat::F32));
    }

    #[test]
    fn too_few_channels_are_refused_with_both_numbers_unless_allowed() {
        let card = [range(2, 8_000, 48_000, SampleFormat::F32), range(8, 96_000, 96_000, SampleFormat::F32)];
        let message = chosen(&card, Mix::PerActuator, None).unwrap_err();
        assert!(
            message.contains("has 8 channels and the floor needs 36: 28 tiles would not be felt"),
            "{message}"
        );
        assert!(message.contains("row   5 | 30 31 32 33 34 35\n"), "{message}");
        let some = chosen(&card, Mix::AsManyAsThereAre, None).unwrap();
        assert_eq!((some.channels, some.sample_rate), (8, 96_000));
    }

    #[test]
    fn a_rate_the_card_lacks_is_refused_with_what_it_offers() {
        let card = [range(2, 44_100, 48_000, SampleFormat::F32)];
        let message = chosen(&card, Mix::Stereo, Some(96_000)).unwrap_err();
        assert!(message.contains("can't play 96000") && message.contains("44100 to 48000"), "{message}");
    }

    #[test]
    fn a_rate_is_converted_only_when_asked_to_the_nearest_that_loses_nothing() {
        let card = [44_100, 48_000, 192_000].map(|rate| range(2, rate, rate, SampleFormat::F32));
        let rate = |asked| {
            let options = DeviceOptions {
                mix: Mix::Stereo,
                sample_rate: Some(asked),
                resample: true,
                ..DeviceOptions::default()
            };
            choose("Test", &card, &Floor::default(), &options).unwrap().sample_rate
        };
        assert_eq!([22_050, 48_000, 96_000, 384_000].map(rate), [44_100, 48_000, 192_000, 192_000]);
    }

    #[test]
    fn a_card_that_offers_nothing_usable_is_refused() {
        assert!(chosen(&[], Mix::Stereo, None).is_err());
        assert!(chosen(&[range(2, 1, 9_999_999, SampleFormat::DsdU8)], Mix::Stereo, None).is_err());
    }
}
