//! The reason why a control is off, for the floor and the side panel.

use underfoot::engine::Snapshot;
use underfoot::widget::OffReason;

/// The reason why control number `index` is off, as a sentence; `None` if a foot can press it, and before the floor
/// is sensed.
pub(super) fn why_off(snapshot: &Snapshot, index: usize) -> Option<String> {
    let reason = snapshot.widgets.get(index)?.off?;
    (reason != OffReason::Waiting).then(|| reason.explain(&snapshot.floor_file))
}
