//! The sound cards that the system offers.

use std::str::FromStr;
use std::sync::Arc;

use cpal::traits::{DeviceTrait, HostTrait};
use cpal::{DeviceId, ErrorKind, HostId, SupportedStreamConfigRange};

use super::paced::{self, PACED};
use crate::sink::SinkError;

/// A device that plays samples, found but not yet in use.
#[derive(Clone)]
pub(super) enum Card {
    /// A device of the system.
    System(cpal::Device),
    /// A clock in place of a sound card.
    Paced,
}

impl Card {
    /// Returns its name for people.
    pub(super) fn name(&self) -> String {
        match self {
            Self::System(device) => device.to_string(),
            Self::Paced => PACED.into(),
        }
    }

    /// Returns its identifier in the system, with the host's name before it; its name if the system has no
    /// identifiers.
    pub(super) fn id(&self) -> String {
        match self {
            Self::System(device) => device.id().map_or_else(|_| device.to_string(), |id| id.to_string()),
            Self::Paced => PACED.into(),
        }
    }

    /// Returns all configurations that it supports.
    pub(super) fn ranges(&self) -> Result<Vec<SupportedStreamConfigRange>, cpal::Error> {
        match self {
            Self::System(device) => Ok(device.supported_output_configs()?.collect()),
            Self::Paced => Ok(paced::ranges()),
        }
    }
}

/// A source of cards: the system, or a substitute in a test.
pub(super) trait Cards: Send + Sync {
    /// Returns the present default card of the system.
    fn chosen_by_system(&self) -> Option<Card>;

    /// Returns the card with exactly this identifier ([`Card::id`]), if it is present.
    fn by_id(&self, id: &str) -> Option<Card>;

    /// Returns the first card with this name.
    fn by_name(&self, name: &str) -> Option<Card>;

    /// Returns all names that [`Cards::by_name`] knows.
    fn names(&self) -> Vec<String>;
}

/// All hosts of the system.
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
        // Uses a new host: some know only the devices that existed when the host was made.
        of_id(&cpal::host_from_id(id.host()).ok()?, &id)
    }

    fn by_name(&self, name: &str) -> Option<Card> {
        if name.eq_ignore_ascii_case(PACED) {
            return Some(Card::Paced);
        }
        // `jack`, or `jack:output`: a host that may not be the system's default; it is opened only if named.
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

/// Returns the host that `name` begins with, up to a colon or as a whole.
fn host_of(name: &str) -> Option<HostId> {
    let host = name.split_once(':').map_or(name, |(host, _)| host);
    HostId::from_str(&host.to_lowercase()).ok()
}

/// Returns the present default card of a host, by its identifier, so that it stays the same when the default changes.
pub(super) fn chosen_of(host: &cpal::Host) -> Option<Card> {
    let default = host.default_output_device()?;
    let fixed = default.id().ok().and_then(|id| host.device_by_id(&id));
    Some(Card::System(fixed.unwrap_or(default)))
}

/// Returns the device with exactly this identifier.
pub(super) fn of_id(host: &cpal::Host, id: &DeviceId) -> Option<Card> {
    host.device_by_id(id).map(Card::System)
}

/// Returns the device with exactly this name or identifier; otherwise the first that contains it in its name, or the
/// one that the system knows by it.
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

/// One device, for a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceEntry {
    /// The host that offers it: ALSA, JACK, CoreAudio, ...
    pub host: String,
    /// Its name for people.
    pub name: String,
    /// Its identifier in the system; `--device` accepts it as well as the name.
    pub id: String,
    /// Whether it is the default device of its host.
    pub is_default: bool,
    /// Maximum number of channels; 0 if the query failed, for example because the device is in use.
    pub channels: u16,
    /// Sample rates with the maximum number of channels, lowest first: from, to.
    pub rates: Vec<(u32, u32)>,
    /// Minimum and maximum number of frames in a block; `None` if unknown.
    pub block: Option<(u32, u32)>,
    /// The reason why the query failed.
    pub trouble: Option<String>,
}

/// All output devices of all hosts, and the paced clock.
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

/// Advice for people about `error` of the card called `name`.
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
