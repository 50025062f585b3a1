//! States of controls that have gone off or on, for one client.

use underfoot::outgoing::json::{Line, Message, StateRecord};
use underfoot::runtime::Snapshot;
use underfoot::widget::OffReason;

/// For each control of the layout, the reason for which it is off, as the client knows it.
#[derive(Debug, Default)]
pub(super) struct OffNews(Vec<Option<OffReason>>);

impl OffNews {
    /// Notes what the greeting in `seen` says.
    pub(super) fn greeted(&mut self, seen: &Snapshot) {
        self.0 = reasons(seen).collect();
    }

    /// Returns a line for each control whose reason has changed, and notes that.
    pub(super) fn lines(&mut self, seen: &Snapshot) -> Vec<String> {
        let changed = |(index, now): (usize, Option<OffReason>)| {
            let told = self.0.get_mut(index)?;
            (std::mem::replace(told, now) != now).then_some(index)
        };
        let indices: Vec<usize> = reasons(seen).enumerate().filter_map(changed).collect();
        let states = indices.into_iter().filter_map(|index| {
            let id = &seen.layout.widgets.get(index)?.id;
            Some(StateRecord::from(&seen.control(id.as_str())?))
        });
        states.map(|state| Line::timeless(Message::State(state)).text()).collect()
    }
}

fn reasons(seen: &Snapshot) -> impl Iterator<Item = Option<OffReason>> + '_ {
    seen.floor.widgets.iter().map(|widget| widget.off)
}
