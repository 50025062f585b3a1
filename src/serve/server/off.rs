//! Watches which controls are off, and the reasons, and reports changes.

use crate::engine::Engine;
use crate::widget::{Guard, OffReason};

/// The last reports about the controls with the guard `HoldToRun`. Their users rely on them and cannot see why they
/// are off; for other controls an app asks.
#[derive(Debug, Default)]
pub(super) struct OffWatch {
    /// The layout that `told` belongs to.
    revision: u64,
    /// The last reported reason for each control of the layout.
    told: Vec<Option<OffReason>>,
    /// The reason found at the last check for each control.
    seen: Vec<Option<OffReason>>,
}

impl OffWatch {
    /// Returns the indices of the controls with a change to report. Called ten times a second.
    ///
    /// A transient reason is reported only if it lasts from one check to the next: a landing foot drives sensors to
    /// the end of their range for some milliseconds.
    pub(super) fn news(&mut self, engine: &Engine, revision: u64) -> Vec<usize> {
        let widgets = &engine.layout().widgets;
        if self.revision != revision || self.told.len() != widgets.len() {
            self.revision = revision;
            self.told = vec![None; widgets.len()];
            self.seen = vec![None; widgets.len()];
        }
        let mut news = Vec::new();
        for (index, widget) in widgets.iter().enumerate() {
            if !matches!(widget.behaviour.thresholds().guard, Guard::HoldToRun(_)) {
                continue;
            }
            let now = engine.off(index).filter(|reason| *reason != OffReason::Waiting);
            let (Some(told), Some(seen)) = (self.told.get_mut(index), self.seen.get_mut(index)) else {
                continue;
            };
            let was = std::mem::replace(seen, now);
            let has_lasted = was == now || now.is_none_or(OffReason::is_lasting);
            if now != *told && has_lasted {
                *told = now;
                news.push(index);
            }
        }
        news
    }
}
