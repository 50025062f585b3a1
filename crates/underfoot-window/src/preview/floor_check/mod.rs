//! Checks the floor while a person walks on it: which board reads which tiles, and whether every sensor answers.
//!
//! [`underfoot::serve::WiringWalk`] and [`underfoot::serve::WalkTest`] decide which forces count as a step or an answer; this
//! module holds the display and the input. The floor's controls are off during a check.

mod marks;
mod panel;

use std::path::PathBuf;

use eframe::egui::{Key, Ui};

use super::feed::PreviewCommand;
use super::shown::ShownFloor;
use underfoot::floor::{Floor, TileId};
use underfoot::serve::{FeltLoad, SensorVerdict, WalkTest, Wiring, WiringTask, WiringWalk};
use underfoot::source::TappedPackets;

/// Checks a floor while the window shows it.
pub(super) struct FloorCheck {
    packets: TappedPackets,
    /// `None` outside a check.
    walk: Option<Walk>,
    /// The wiring that the last complete walk found.
    found: Option<Wiring>,
    /// The file for the floor.
    path: String,
}

/// The current walk.
enum Walk {
    Wiring(Box<WiringWalk>),
    Test(Box<WalkTest>),
}

/// Default name of the file for the floor.
const KEPT: &str = "checked_floor.ron";

/// The mark of one tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TileMark {
    /// No result yet.
    Open,
    /// Some of its sensors have answered.
    Begun,
    /// All its sensors, or its board, are right.
    Good,
    /// It has a fault.
    Bad,
    /// The next tile to step on.
    Wanted,
    /// It carries a load, but another tile was the next one to step on.
    Felt,
}

impl TileMark {
    /// The state in words, after the tile's name.
    const fn words(self) -> &'static str {
        match self {
            Self::Open => "not yet",
            Self::Begun => "some sensors answer",
            Self::Good => "good",
            Self::Bad => "something is wrong",
            Self::Wanted => "step here",
            Self::Felt => "feels somebody",
        }
    }
}

impl FloorCheck {
    pub(super) fn new(packets: TappedPackets) -> Self {
        Self { packets, walk: None, found: None, path: KEPT.into() }
    }

    /// Takes in the packets since the last frame.
    fn receive(&mut self) {
        match &mut self.walk {
            Some(Walk::Wiring(walk)) => self.packets.take(|packet| {
                walk.take(packet);
            }),
            Some(Walk::Test(walk)) => self.packets.take(|packet| walk.take(packet)),
            // Drop packets from before the walk.
            None => self.packets.take(|_| {}),
        }
    }

    /// Whether a check is running: the floor's controls are off, and Design mode is unavailable.
    pub(super) fn is_running(&self) -> bool {
        self.walk.is_some()
    }

    /// Passes the packets to the current walk and stores its result; Escape ends the walk.
    pub(super) fn follow(&mut self, ui: &Ui, shown: &ShownFloor) {
        self.receive();
        if let Some(Walk::Wiring(walk)) = &self.walk
            && self.found.is_none()
            && let Some(Ok(found)) = walk.outcome(&shown.floor)
        {
            self.found = (!found.moved.is_empty()).then_some(found);
        }
        if ui.input(|i| i.key_pressed(Key::Escape)) && self.is_running() {
            return self.begin(None, shown);
        }
        if self.is_running() {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(33));
        }
    }

    /// Begins or ends a walk; the controls are off during a walk.
    fn begin(&mut self, walk: Option<Walk>, shown: &ShownFloor) {
        let was = self.is_running();
        self.found = None;
        self.packets.want(walk.is_some());
        self.packets.take(|_| {});
        self.walk = walk;
        let is = self.is_running();
        if is != was {
            shown.command(PreviewCommand::TurnControlsOff(is));
        }
    }

    /// Saves the floor with the boards as the walk found them.
    fn save(&self, shown: &ShownFloor) {
        if let Some(found) = &self.found {
            let path = PathBuf::from(self.path.trim());
            shown.command(PreviewCommand::SaveFloor { floor: Box::new(found.floor.clone()), path });
        }
    }

    /// The mark of the tile with this index.
    fn mark(&self, floor: &Floor, index: usize) -> TileMark {
        let tile = floor.geometry.tile_at_index(index);
        match &self.walk {
            None => TileMark::Open,
            Some(Walk::Wiring(walk)) => wiring_mark(walk, tile),
            Some(Walk::Test(walk)) => test_mark(walk.tile(index).unwrap_or([SensorVerdict::Untried; 4])),
        }
    }
}

fn wiring_mark(walk: &WiringWalk, tile: TileId) -> TileMark {
    if walk.task() == WiringTask::Step(tile) {
        return TileMark::Wanted;
    }
    if walk.felt().is_some_and(|felt| felt.tile == tile) && matches!(walk.task(), WiringTask::Step(_)) {
        return TileMark::Felt;
    }
    match walk.steps().iter().find(|step| step.tile == tile) {
        Some(step) if step.board == step.found && step.tile == step.felt => TileMark::Good,
        Some(_) => TileMark::Bad,
        None => TileMark::Open,
    }
}

fn test_mark(sensors: [SensorVerdict; 4]) -> TileMark {
    if sensors.iter().any(|sensor| sensor.is_fault()) {
        TileMark::Bad
    } else if sensors.iter().all(|sensor| *sensor == SensorVerdict::Answers) {
        TileMark::Good
    } else if sensors.contains(&SensorVerdict::Answers) {
        TileMark::Begun
    } else {
        TileMark::Open
    }
}

/// The load on the floor now, in words.
fn felt_words(felt: FeltLoad) -> String {
    format!("Board {} feels {:.0} N, by the floor file on tile {}.", felt.board, felt.force_n, felt.tile)
}
