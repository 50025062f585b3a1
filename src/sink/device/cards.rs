//! The sound cards that the system offers.

use std::str::FromStr;
use std::sync::Arc;

use cpal::traits::{DeviceTrait, HostTrait};
use cpal::{DeviceId, ErrorKind, HostId, SupportedStreamConfigRange};

use super::paced::{self, PACED};
use crate::sink::SinkError;

/// Something that plays samples, found but not yet in use.
#[derive(Clone)]
pub(super) enum Card {
    /// What the system offers.
    System(cpal::Device),
    /// A clock that stands in for a card.
    Paced,
}

impl Card {
    /// What people call it.
    pub(super) fn name(&self) -> String {
        match self {
            Self::System(device) => device.to_string(),
            Self::Paced => PACED.into(),
        }
    }

    /// What the system knows it by, with the host's name before it; its name where the system has no such thing.
    pub(super) fn id(&self) -> String {
        match self {
            Self::System(device) => device.id().map_or_else(|_| device.to_string(), |id| id.to_string()),
            Self::Paced => PACED.into(),
        }
    }

    /// Everything it can be opened with.
    pub(super) fn ranges(&self) -> Result<Vec<SupportedStreamConfigRange>, cpal::Error> {
        match self {
            Self::System(device) => Ok(device.supported_output_configs()?.collect()),
            Self::Paced => Ok(paced::ranges()),
        }
    }
}

/// Where cards are searched for: the system, or what a test makes of it.
pub(super) trait Cards: Send + Sync {
    /// The card that the system would choose now.
    fn chosen_by_system(&self) -> Option<Card>;

    /// The card of this very identifier ([`Card::id`]), if it is there now.
    fn by_id(&self, id: &str) -> Option<Card>;

    /// The first card that people would call by this name.
    fn by_name(&self, name: &str) -> Option<Card>;

    /// All names that [`Cards::by_name`] knows.
    fn names(&self) -> Vec<String>;
}

/// Every host that the system has.
#[derive(Debug, Default)]
pub(super) struct System;

impl System {
    pub(super) fn shared() -> Arc<dyn Cards> {
        Arc::new(Self)
    }
}

impl Cards for System {
    fn chosen_by_system(&self) -> Option<Card> {
        chosen_of(&cpal::default_host())
    }

    fn by_id(&self, id: &str) -> Option<Card> {
        if id == PACED {
            return Some(Card::Paced);
        }
        let Ok(id) = DeviceId::from_str(id) else { return self.by_name(id) };
        // A host made anew: some know only the devices that were there when they were made.
        of_id(&cpal::host_from_id(id.host()).ok()?, &id)
    }

    fn by_name(&self, name: &str) -> Option<Card> {
        if name.eq_ignore_ascii_case(PACED) {
            return Some(Card::Paced);
        }
        // `jack`, or `jack:output`: a host that need not be the system's first choice, and is not asked unless named.
        if let Some(host) = host_of(name) {
            let host = cpal::host_from_id(host).ok()?;
            return match name.split_once(':') {
                Some((_, rest)) => named(&host, rest),
                None => chosen_of(&host),
            };
        }
        named(&cpal::default_host(), name)
    }

    fn names(&self) -> Vec<String> {
        names(&cpal::default_host())
    }
}

/// The host that `name` begins with, up to a colon or as a whole.
fn host_of(name: &str) -> Option<HostId> {
    let host = name.split_once(':').map_or(name, |(host, _)| host);
    HostId::from_str(&host.to_lowercase()).ok()
}

/// The card that a host would choose now, by its identifier, so that it stays that card when the choice changes.
pub(super) fn chosen_of(host: &cpal::Host) -> Option<Card> {
    let default = host.default_output_device()?;
    let fixed = default.id().ok().and_then(|id| host.device_by_id(&id));
    Some(Card::System(fixed.unwrap_or(default)))
}

/// The device of that very identifier.
pub(super) fn of_id(host: &cpal::Host, id: &DeviceId) -> Option<Card> {
    host.device_by_id(id).map(Card::System)
}

/// The device of that very name or identifier, or else the first that has it in its name, or what the system knows by
/// it.
pub(super) fn named(host: &cpal::Host, name: &str) -> Option<Card> {
    let wanted = name.to_lowercase();
    let find = |fits: &dyn Fn(&cpal::Device) -> bool| host.output_devices().ok()?.find(fits);
    let is_meant = |device: &cpal::Device| {
        device.id().is_ok_and(|id| id.id() == name) || device.to_string().to_lowercase() == wanted
    };
    find(&is_meant)
        .or_else(|| find(&|device| device.to_string().to_lowercase().contains(&wanted)))
        .or_else(|| host.device_by_id(&DeviceId::new(host.id(), name)))
        .map(Card::System)
}

/// The names of a host's devices.
pub(super) fn names(host: &cpal::Host) -> Vec<String> {
    host.output_devices()
        .map(|devices| devices.map(|device| device.to_string()).collect())
        .unwrap_or_default()
}

/// One device, for a list to choose from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceEntry {
    /// The host that offers it: ALSA, JACK, CoreAudio, ...
    pub host: String,
    /// What people call it.
    pub name: String,
    /// What the system knows it by; `--device` takes it as well as the name.
    pub id: String,
    /// Whether it is its host's own choice.
    pub is_default: bool,
    /// Most channels it can be opened with; 0 if it can't be asked, for example because it is in use.
    pub channels: u16,
    /// Sample rates that it can be opened with at most channels, lowest first: from, to.
    pub rates: Vec<(u32, u32)>,
    /// Frames in a block: least and most; `None` if it does not say.
    pub block: Option<(u32, u32)>,
    /// Why it could not be asked.
    pub trouble: Option<String>,
}

/// All devices of all hosts that can play something, and the paced clock that stands in for one.
#[must_use]
pub fn output_devices() -> Vec<DeviceEntry> {
    let mut entries = Vec::new();
    for id in cpal::available_hosts() {
        let Ok(host) = cpal::host_from_id(id) else { continue };
        let chosen = host.default_output_device().and_then(|device| device.id().ok());
        for device in host.output_devices().into_iter().flatten() {
            let is_default = device.id().ok().is_some_and(|id| Some(id) == chosen);
            entries.push(entry(host.id().name(), &Card::System(device), is_default));
        }
    }
    entries.push(entry("underfoot", &Card::Paced, false));
    entries
}

fn entry(host: &str, card: &Card, is_default: bool) -> DeviceEntry {
    let (ranges, trouble) = match card.ranges() {
        Ok(ranges) => (ranges, None),
        Err(error) => (Vec::new(), Some(error.to_string())),
    };
    let channels = ranges.iter().map(SupportedStreamConfigRange::channels).max().unwrap_or(0);
    let widest = || ranges.iter().filter(|range| range.channels() == channels);
    let mut rates: Vec<_> =
        widest().map(|range| (range.min_sample_rate(), range.max_sample_rate())).collect();
    rates.sort_unstable();
    rates.dedup();
    let block = widest().find_map(|range| match *range.buffer_size() {
        cpal::SupportedBufferSize::Range { min, max } => Some((min, max)),
        cpal::SupportedBufferSize::Unknown => None,
    });
    DeviceEntry {
        host: host.into(),
        name: card.name(),
        id: card.id(),
        is_default,
        channels,
        rates,
        block,
        trouble,
    }
}

/// What a person can do about `error` of the card called `name`.
pub(super) fn trouble(name: &str, error: &cpal::Error) -> SinkError {
    let message = match error.kind() {
        ErrorKind::DeviceNotAvailable | ErrorKind::HostUnavailable => format!(
            "the sound card {name} can't be used ({error}): connect one, record to a WAV file, or go on without"
        ),
        ErrorKind::DeviceBusy => {
            format!("the sound card {name} is in use: close the program that plays on it, or choose another")
        }
        ErrorKind::PermissionDenied => format!(
            "the sound card {name} may not be used ({error}): on Linux, join the group `audio` and log in again"
        ),
        _ => format!("the sound card {name} can't be played ({error}): try another device, rate or block"),
    };
    SinkError::Device { message }
}
