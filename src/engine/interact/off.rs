//! The reasons why controls are off.

use super::belief::is_sensed;
use super::{Interaction, holds_to_run};
use crate::layout::Layout;
use crate::sense::{CalibrationFault, ForceFrame, HoldDoubt, Quality};
use crate::widget::OffReason;

impl Interaction {
    /// The reason why no foot can press `widget` in `frame`, the last one processed; `None` if a foot can. Before the
    /// first frame the floor counts as unsensed.
    pub(in crate::engine) fn off(
        &self,
        widget: usize,
        layout: &Layout,
        frame: Option<&ForceFrame>,
    ) -> Option<OffReason> {
        if self.controls.get(widget)?.is_disabled() {
            return Some(OffReason::Disabled);
        }
        let Some(frame) = frame else { return Some(OffReason::Waiting) };
        let runs = holds_to_run(layout, widget);
        if let Some(fault) = frame.calibration_fault.filter(|_| runs) {
            return Some(of_calibration(fault));
        }
        if self.unsensed.get(widget) == Some(&true) {
            return Some(self.of_silence(widget, frame));
        }
        if runs && self.is_suspected(widget, frame) {
            return Some(OffReason::SensorTrouble);
        }
        let doubt = self.of_readings(widget, frame).filter(|_| runs);
        if doubt.is_some_and(|doubt| doubt != OffReason::SlowReadings) {
            return doubt;
        }
        let is_held = self.held().any(|held| held.widget == widget);
        let rivals = !is_held && self.runs_elsewhere(widget, layout);
        if rivals { Some(OffReason::OtherHeld) } else { doubt }
    }

    /// The reason for a control on a tile without sensing.
    fn of_silence(&self, widget: usize, frame: &ForceFrame) -> OffReason {
        let qualities = self.tiles_under(widget).filter_map(|tile| frame.quality.get(tile));
        let worst = qualities.filter(|tile| !is_sensed(tile)).flatten().max();
        match (worst, frame.calibration_fault) {
            (Some(Quality::Faulty), Some(CalibrationFault::BoardsSwapped)) => OffReason::BoardsSwapped,
            (Some(Quality::Faulty), _) => OffReason::SensorTrouble,
            _ if self.of_readings(widget, frame) == Some(OffReason::RepeatedReadings) => {
                OffReason::RepeatedReadings
            }
            _ => OffReason::LinkLost,
        }
    }

    /// The reason why the readings of some tile under `widget` are unsuitable for holding it. A noise estimate that
    /// is still missing only delays a foot and inhibits nothing.
    pub(super) fn of_readings(&self, widget: usize, frame: &ForceFrame) -> Option<OffReason> {
        let doubts = self.tiles_under(widget).filter_map(|tile| *frame.hold_doubts.get(tile)?);
        let reasons = doubts.filter_map(|doubt| match doubt {
            HoldDoubt::Unlearned => None,
            HoldDoubt::Repeats => Some(OffReason::RepeatedReadings),
            HoldDoubt::Coarse => Some(OffReason::CoarseReadings),
            HoldDoubt::Slow => Some(OffReason::SlowReadings),
        });
        let order = |reason: &OffReason| OffReason::ALL.iter().position(|one| one == reason);
        reasons.min_by_key(order)
    }

    /// Whether every tile under a control that acts while it is held has a suspected sensor: no force there starts
    /// it.
    fn is_suspected(&self, widget: usize, frame: &ForceFrame) -> bool {
        let mut tiles = self.tiles_under(widget).peekable();
        tiles.peek().is_some() && tiles.all(|tile| frame.may_start.get(tile) == Some(&false))
    }

    /// The indices of the tiles under a control.
    fn tiles_under(&self, widget: usize) -> impl Iterator<Item = usize> + '_ {
        self.tiles_under.get(widget).into_iter().flatten().copied()
    }
}

/// The reason why controls that act while they are held are off on the whole floor.
pub(super) const fn of_calibration(fault: CalibrationFault) -> OffReason {
    match fault {
        CalibrationFault::Missing => OffReason::NotCalibrated,
        CalibrationFault::OtherFloor => OffReason::OtherFloor,
        CalibrationFault::BoardsSwapped => OffReason::BoardsSwapped,
    }
}
