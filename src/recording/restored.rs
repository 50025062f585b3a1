//! Requests that bring a floor into the state of another one.

use crate::engine::Snapshot;
use crate::floor::SensorChoice;
use crate::layout::Layout;
use crate::sense::Trouble;
use crate::source::log::{Entries, LogEntry};
use crate::widget::Indicator;
use crate::wire::ControlMessage;

/// The requests after which the controls of `layout` are as in `snapshot`, as entries of its moment.
pub(super) fn entries(snapshot: &Snapshot, layout: &Layout) -> Entries {
    requests(snapshot, layout)
        .into_iter()
        .map(|message| (snapshot.at, LogEntry::Request(message.into())))
        .collect()
}

fn requests(snapshot: &Snapshot, layout: &Layout) -> Vec<ControlMessage> {
    let mut requests = Vec::new();
    let id_of = |index: usize| layout.widgets.get(index).map(|widget| widget.id.clone());
    if let Some(page) = layout.pages.get(snapshot.page).filter(|_| snapshot.page > 0) {
        requests.push(ControlMessage::ShowPage { page: page.id.clone() });
    }
    for (index, text) in &snapshot.labels {
        requests.extend(id_of(*index).map(|id| ControlMessage::Label { id, text: text.to_string() }));
    }
    for (index, scale) in &snapshot.ranges {
        let (least, greatest) = (scale.min, scale.max);
        requests.extend(id_of(*index).map(|id| ControlMessage::SetRange { id, least, greatest }));
    }
    for (widget, state) in layout.widgets.iter().zip(&snapshot.widgets) {
        let id = || widget.id.clone();
        requests.extend(state.value.map(|value| ControlMessage::Set { id: id(), value }));
        if state.indicator != Indicator::default() {
            requests.push(ControlMessage::Indicate { id: id(), indicator: state.indicator });
        }
        if state.disabled {
            requests.push(ControlMessage::Disable { id: id() });
        }
        if state.locked {
            requests.push(ControlMessage::Lock { id: id() });
        }
    }
    if snapshot.muted.all {
        requests.push(ControlMessage::Mute { on: true });
    }
    let off = snapshot.health.troubles.iter().filter(|(_, trouble)| *trouble == Trouble::Off);
    requests.extend(
        off.map(|(sensor, _)| ControlMessage::UseSensors {
            choice: SensorChoice::Sensor(*sensor),
            on: false,
        }),
    );
    requests.extend(snapshot.muted.tiles.iter().map(|&tile| ControlMessage::MuteTile { tile, on: true }));
    requests
}
