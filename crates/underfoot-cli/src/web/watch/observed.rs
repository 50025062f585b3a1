//! One look at a floor: its snapshot, its boards, and the numbers of the program around it.

use std::collections::BTreeMap;
use std::sync::mpsc::sync_channel;
use std::time::Duration;

use underfoot::runtime::SessionSnapshot;
use underfoot::sense::{BoardStatus, Quality};
use underfoot::serve::FloorCommand;
use underfoot::widget::OffReason;
use underfoot::wire::LinkState;
use underfoot_io::targets::TargetCounts;

use super::super::Shared;
use super::super::broadcast::ClientCounts;

/// Maximum time to wait for the sensing thread; without an answer the floor has failed.
const PATIENCE: Duration = Duration::from_millis(200);

/// A floor at one instant.
#[derive(Debug)]
pub(super) struct ObservedFloor {
    pub(super) snapshot: SessionSnapshot,
    /// The address and the state of each board; `None` if the sensing thread does not answer.
    pub(super) boards: Option<Vec<(String, BoardStatus)>>,
    pub(super) events: Vec<(&'static str, u64)>,
    pub(super) ignored: Vec<(&'static str, u64)>,
    pub(super) losses: u64,
    pub(super) clients: ClientCounts,
    pub(super) targets: TargetCounts,
    pub(super) uptime: Duration,
    pub(super) has_ended: bool,
}

/// Whether a floor works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HealthState {
    /// Everything works.
    Ok,
    /// Controls work, but not everything does.
    Degraded,
    /// No control works.
    Failed,
}

impl HealthState {
    pub(super) const ALL: [Self; 3] = [Self::Ok, Self::Degraded, Self::Failed];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Degraded => "degraded",
            Self::Failed => "failed",
        }
    }
}

impl ObservedFloor {
    /// Looks at the floor now; waits for the sensing thread.
    pub(super) fn of(shared: &Shared) -> Self {
        let (to, boards) = sync_channel(1);
        let statuses =
            shared.session.send(FloorCommand::GiveBoards(to)).then(|| boards.recv_timeout(PATIENCE).ok());
        let addresses = shared.floor.boards.iter().map(|board| board.address.clone());
        let watch = &shared.watch;
        Self {
            snapshot: shared.session.snapshot(),
            boards: statuses.flatten().map(|statuses| addresses.zip(statuses).collect()),
            events: watch.events.kinds(),
            ignored: watch.events.ignored(),
            losses: watch.events.losses(),
            clients: shared.clients.counts(),
            targets: watch.messages.counts(),
            uptime: watch.started.elapsed(),
            has_ended: shared.session.has_ended(),
        }
    }

    /// Whether the floor works, and the reasons why it does not, or not entirely.
    pub(super) fn health(&self) -> (HealthState, Vec<String>) {
        let failures = self.failures();
        if !failures.is_empty() {
            return (HealthState::Failed, failures);
        }
        let defects = self.defects();
        (if defects.is_empty() { HealthState::Ok } else { HealthState::Degraded }, defects)
    }

    /// The reasons why no control works.
    fn failures(&self) -> Vec<String> {
        let floor = &self.snapshot.floor;
        if self.has_ended {
            return vec!["the floor has ended".into()];
        }
        if self.boards.is_none() {
            return vec!["the sensing thread does not answer".into()];
        }
        let link = match floor.link {
            LinkState::Waiting => "the floor waits for boards and for its tare",
            LinkState::Lost => "nothing usable has come from any board for 100 ms",
            LinkState::Live | LinkState::Partial => return Vec::new(),
        };
        [link.to_owned()].into_iter().chain(floor.link_cause.as_ref().map(ToString::to_string)).collect()
    }

    /// The reasons why not everything works.
    fn defects(&self) -> Vec<String> {
        let floor = &self.snapshot.floor;
        let mut found: Vec<String> = floor.link_cause.iter().map(ToString::to_string).collect();
        for (number, (address, board)) in self.boards.iter().flatten().enumerate() {
            if board.frozen {
                found.push(format!("board {number} ({address}) repeats its readings"));
            } else if matches!(board.quality, Quality::Stale | Quality::Faulty) {
                found.push(format!("nothing usable comes from board {number} ({address})"));
            }
        }
        let health = &floor.health;
        found.extend(health.troubles.iter().map(|(sensor, trouble)| format!("{sensor}: {trouble}")));
        if health.uncalibrated > 0 {
            found.push(format!("{} sensors are not calibrated", health.uncalibrated));
        }
        if health.foreign {
            found.push("the floor file seems to be another floor's".into());
        }
        let device = floor.device.as_ref().filter(|device| !device.why.is_empty());
        found.extend(device.map(|device| format!("actuators {}: {}", device.state.name(), device.why)));
        found
    }

    /// The number of controls that are off, by their reasons.
    pub(super) fn off(&self) -> BTreeMap<&'static str, u64> {
        let mut counts = BTreeMap::new();
        for reason in self.snapshot.floor.widgets.iter().filter_map(|widget| widget.off) {
            *counts.entry(reason.name()).or_default() += 1;
        }
        counts
    }

    /// The controls that are off, and their reasons.
    pub(super) fn controls_off(&self) -> impl Iterator<Item = (&str, OffReason)> {
        let widgets = self.snapshot.layout.widgets.iter().zip(&self.snapshot.floor.widgets);
        widgets.filter_map(|(widget, state)| Some((widget.id.as_str(), state.off?)))
    }
}
