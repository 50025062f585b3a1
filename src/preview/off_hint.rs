//! Why a control is off, as the floor and the side panel say it.

use crate::engine::Snapshot;
use crate::widget::OffReason;

/// Why control number `index` is off, in a sentence; `None` if a foot can press it, and before the floor is sensed.
pub(super) fn why_off(snapshot: &Snapshot, index: usize) -> Option<String> {
    let reason = snapshot.widgets.get(index)?.off?;
    (reason != OffReason::Waiting).then(|| reason.explain(&snapshot.floor_file))
}
