//! The link to the boards, the sensors and the actuators.

use serde::{Deserialize, Serialize};

use super::text::{Few, Sentence, Word};
use crate::feel::{DeviceStatus, Muted};
use crate::floor::SensorId;
use crate::sense::{BoardTiming, SensorHealth, Trouble};
use crate::wire::{LinkCause, LinkState};

/// Maximum number of faulty sensors or muted tiles that a reader keeps.
const MOST_PARTS: usize = 4096;

/// The state of the link: a line `link`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LinkRecord {
    /// The state: [`LinkState::name`].
    pub state: Word,
}

impl From<LinkState> for LinkRecord {
    fn from(state: LinkState) -> Self {
        Self { state: state.name().into() }
    }
}

/// The cause of unusable frames: a line `link_cause`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LinkCauseRecord {
    /// The cause: [`LinkCause::name`]; null once it is gone.
    pub cause: Option<Word>,
    /// The board that it concerns.
    pub board: Option<u16>,
    /// The cause as a sentence.
    pub why: Sentence,
}

impl From<Option<&LinkCause>> for LinkCauseRecord {
    fn from(cause: Option<&LinkCause>) -> Self {
        Self {
            cause: cause.map(|cause| cause.name().into()),
            board: cause.and_then(LinkCause::board),
            why: cause.map(|cause| Sentence(cause.to_string())).unwrap_or_default(),
        }
    }
}

/// The muted actuators: a line `mute`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MuteRecord {
    /// Whether everything is muted.
    pub all: bool,
    /// Column and row of each muted tile.
    pub tiles: Few<[u16; 2], MOST_PARTS>,
}

impl From<&Muted> for MuteRecord {
    fn from(muted: &Muted) -> Self {
        Self { all: muted.all, tiles: muted.tiles.iter().map(|tile| [tile.column, tile.row]).collect() }
    }
}

/// The state of the sensors: a line `health`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct HealthRecord {
    /// Number of live sensors.
    pub live: u32,
    /// Number of degraded sensors.
    pub degraded: u32,
    /// Number of stale sensors.
    pub stale: u32,
    /// Number of faulty sensors.
    pub faulty: u32,
    /// Number of sensors without a calibration.
    pub uncalibrated: u32,
    /// [`SensorHealth::foreign`].
    pub foreign: bool,
    /// The sensors with faults.
    pub troubles: Few<TroubleRecord, MOST_PARTS>,
    /// The boards that do not send once a millisecond.
    #[serde(skip_serializing_if = "Few::is_empty")]
    pub rates: Few<RateRecord, MOST_PARTS>,
}

/// The rate of a board, and the time of its samples.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RateRecord {
    /// The board's number.
    pub board: u16,
    /// Packets a second.
    pub hz: f32,
    /// The source of its samples' times: [`crate::sense::TimeBase::name`].
    pub time: Word,
    /// Mean error of these times in milliseconds.
    pub jitter_ms: f32,
}

/// A sensor with a fault.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct TroubleRecord {
    /// Column of its tile.
    pub col: u16,
    /// Row of its tile.
    pub row: u16,
    /// Its corner: [`crate::floor::Corner::name`].
    pub corner: Word,
    /// The fault: [`Trouble::name`].
    pub trouble: Word,
}

impl From<&SensorHealth> for HealthRecord {
    fn from(health: &SensorHealth) -> Self {
        let SensorHealth { counts, uncalibrated, foreign, ref timings, ref troubles } = *health;
        let [live, degraded, stale, faulty] = counts;
        let record = |&(SensorId { tile, corner }, trouble): &(SensorId, Trouble)| TroubleRecord {
            col: tile.column,
            row: tile.row,
            corner: corner.name().into(),
            trouble: trouble.name().into(),
        };
        let troubles = troubles.iter().map(record).collect();
        let rate = |(board, timing): &(u16, BoardTiming)| RateRecord {
            board: *board,
            hz: timing.hz,
            time: timing.base.name().into(),
            jitter_ms: 1e3 * timing.jitter.as_secs_f32(),
        };
        let rates = timings.iter().map(rate).collect();
        Self { live, degraded, stale, faulty, uncalibrated, foreign, troubles, rates }
    }
}

/// The state of the device that drives the actuators: a line `device`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct DeviceRecord {
    /// The device's name.
    pub device: Sentence,
    /// Its state, by name.
    pub state: Word,
    /// The reason for that state.
    pub why: Sentence,
    /// Number of channels.
    pub channels: u16,
    /// Samples per second.
    pub sample_rate: u32,
    /// Samples of a block.
    pub block: u32,
    /// Number of blocks that came too late.
    pub underruns: u64,
    /// Number of times it was opened again.
    pub reopened: u64,
    /// The priority of its thread, by name.
    pub priority: Word,
}

impl From<&DeviceStatus> for DeviceRecord {
    fn from(status: &DeviceStatus) -> Self {
        Self {
            device: status.name.as_str().into(),
            state: status.state.name().into(),
            why: status.why.as_str().into(),
            channels: status.channels,
            sample_rate: status.sample_rate,
            block: status.block,
            underruns: status.underruns,
            reopened: status.reopened,
            priority: status.priority.name().into(),
        }
    }
}
