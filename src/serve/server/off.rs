//! Which controls are off, and why: reported when that changes.

use crate::engine::Engine;
use crate::widget::{Guard, OffReason};

/// What was reported of the controls with the guard `HoldToRun`. Their users count on them and cannot see why they are
/// off; of all others an app asks.
#[derive(Debug, Default)]
pub(super) struct OffWatch {
    /// The layout that `told` belongs to.
    revision: u64,
    /// For each control of the layout what was reported.
    told: Vec<Option<OffReason>>,
    /// For each control what was found at the last look.
    seen: Vec<Option<OffReason>>,
}

impl OffWatch {
    /// The indices of the controls of which there is something to report. To be asked ten times a second.
    ///
    /// What passes by itself is reported once it has lasted from one look to the next: a foot that lands drives sensors
    /// to the end of their range for some milliseconds.
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
