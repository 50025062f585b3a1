//! `/health`: the state of a floor as JSON.

use std::collections::BTreeMap;

use serde::Serialize;
use underfoot::outgoing::json::{DeviceRecord, HealthRecord, IgnoredRecord};
use underfoot::sense::Quality;

use super::super::broadcast::ClientCounts;
use super::observed::{HealthState, ObservedFloor};

/// The whole answer; the dashboard shows it.
#[derive(Debug, Serialize)]
pub(super) struct HealthPage {
    /// `ok`, `degraded` or `failed`.
    status: &'static str,
    /// The reasons why it is not `ok`.
    reasons: Vec<String>,
    version: &'static str,
    uptime_s: f64,
    title: String,
    /// The state of the link, by name.
    link: &'static str,
    /// The boards; empty if the sensing thread does not answer.
    boards: Vec<BoardRecord>,
    sensors: HealthRecord,
    device: Option<DeviceRecord>,
    feet: usize,
    held: Vec<String>,
    off: Vec<ControlOffRecord>,
    ignored: IgnoredPage,
    events: BTreeMap<&'static str, u64>,
    packets: PacketRecord,
    clients: ClientCounts,
    targets: TargetRecord,
}

/// One board.
#[derive(Debug, Serialize)]
struct BoardRecord {
    address: String,
    /// The quality of its sensors.
    state: &'static str,
    /// Seconds since its last usable packet; null before the first.
    age_s: Option<f64>,
    /// Share of the packets of the last second that were lost or too late.
    loss: f32,
    packets: u64,
    lost: u64,
    duplicate: u64,
}

/// A control that is off.
#[derive(Debug, Serialize)]
struct ControlOffRecord {
    id: String,
    off: &'static str,
    off_text: String,
}

/// The presses that controls ignored.
#[derive(Debug, Serialize)]
struct IgnoredPage {
    /// Their number since the start, by reason; reasons that never occurred are left out.
    counts: BTreeMap<&'static str, u64>,
    /// The latest 16, newest first.
    latest: Vec<LatestIgnored>,
}

#[derive(Debug, Serialize)]
struct LatestIgnored {
    /// Seconds before now.
    age_s: f64,
    #[serde(flatten)]
    press: IgnoredRecord,
}

/// Numbers of packets since the start.
#[derive(Debug, Serialize)]
struct PacketRecord {
    packets: u64,
    frames: u64,
    lost: u64,
    late: u64,
    duplicate: u64,
    refused: u64,
    /// Reports that could not be sent to other programs.
    unsent_events: u64,
    /// Times the floor was lost.
    losses: u64,
}

#[derive(Debug, Serialize)]
struct TargetRecord {
    sent: u64,
    unsent: u64,
}

impl HealthPage {
    pub(super) fn of(seen: &ObservedFloor) -> Self {
        let (state, reasons) = seen.health();
        let (snapshot, floor) = (&seen.snapshot, &seen.snapshot.floor);
        let boards = seen.boards.iter().flatten().map(|(address, board)| BoardRecord {
            address: address.clone(),
            state: quality(board.quality),
            age_s: board.age.map(|age| age.as_secs_f64()),
            loss: board.loss,
            packets: board.counts.packets,
            lost: board.counts.lost,
            duplicate: board.counts.duplicate,
        });
        let off = seen.controls_off().map(|(id, reason)| ControlOffRecord {
            id: id.to_owned(),
            off: reason.name(),
            off_text: reason.explain(&floor.floor_file),
        });
        let latest = floor.ignored.iter().rev().map(|press| LatestIgnored {
            age_s: floor.at.since(press.at).as_secs_f64(),
            press: press.into(),
        });
        let happened = |counts: &[(&'static str, u64)]| -> BTreeMap<&'static str, u64> {
            counts.iter().copied().filter(|(_, count)| *count > 0).collect()
        };
        let counters = &floor.counters;
        Self {
            status: state.name(),
            reasons,
            version: env!("CARGO_PKG_VERSION"),
            uptime_s: seen.uptime.as_secs_f64(),
            title: snapshot.layout.title.clone(),
            link: floor.link.name(),
            boards: boards.collect(),
            sensors: (&floor.health).into(),
            device: floor.device.as_ref().map(DeviceRecord::from),
            feet: floor.contacts.len(),
            held: floor.held.iter().map(ToString::to_string).collect(),
            off: off.collect(),
            ignored: IgnoredPage { counts: happened(&seen.ignored), latest: latest.collect() },
            events: happened(&seen.events),
            packets: PacketRecord {
                packets: counters.packets,
                frames: counters.frames,
                lost: counters.lost,
                late: counters.late,
                duplicate: counters.duplicate,
                refused: counters.refused(),
                unsent_events: floor.unsent_events,
                losses: seen.losses,
            },
            clients: seen.clients,
            targets: TargetRecord { sent: seen.targets.sent, unsent: seen.targets.unsent },
        }
    }

    /// Whether no control works.
    pub(super) fn is_failed(&self) -> bool {
        self.status == HealthState::Failed.name()
    }
}

/// The name of a quality.
pub(super) const fn quality(quality: Quality) -> &'static str {
    match quality {
        Quality::Live => "live",
        Quality::Degraded => "degraded",
        Quality::Stale => "stale",
        Quality::Faulty => "faulty",
    }
}
