//! State of a floor at one instant, by the names of its controls.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use triple_buffer::Output;

use crate::engine::{self, ControlState};
use crate::layout::Layout;
use crate::widget::Value;

/// State of a floor at one instant, by the names of its controls; updated every 5 ms.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SessionSnapshot {
    /// The layout that is on the floor.
    pub layout: Arc<Layout>,
    /// State of the floor, in the order of the layout.
    pub floor: engine::Snapshot,
}

impl SessionSnapshot {
    /// State of the control named `id`; `None` for an unknown name.
    #[must_use]
    pub fn control(&self, id: &str) -> Option<ControlState> {
        ControlState::of(&self.layout, self.layout.widget_index(id)?, &self.floor)
    }

    /// States of all controls, in the order of the layout.
    pub fn controls(&self) -> impl Iterator<Item = ControlState> + '_ {
        (0..self.layout.widgets.len()).filter_map(|index| ControlState::of(&self.layout, index, &self.floor))
    }

    /// Value of the control named `id`; `None` for a button or an unknown name.
    #[must_use]
    pub fn value(&self, id: &str) -> Option<Value> {
        self.floor.widgets.get(self.layout.widget_index(id)?)?.value
    }

    /// The name of the page that is shown; `None` in a layout without pages.
    #[must_use]
    pub fn page(&self) -> Option<&str> {
        self.layout.pages.get(self.floor.page).map(|page| page.id.as_str())
    }
}

/// The latest state that the sensing thread has written, and the layouts that it may belong to.
#[derive(Debug)]
pub(super) struct Shown(Mutex<State>);

#[derive(Debug)]
struct State {
    latest: Output<engine::Snapshot>,
    /// The layout that is shown.
    layout: Arc<Layout>,
    /// Layouts given later, with their revisions.
    later: VecDeque<(u64, Arc<Layout>)>,
    /// Number of layouts given.
    given: u64,
}

impl Shown {
    pub(super) fn new(latest: Output<engine::Snapshot>, layout: Layout) -> Self {
        Self(Mutex::new(State { latest, layout: Arc::new(layout), later: VecDeque::new(), given: 0 }))
    }

    /// Stores a layout and passes it to the engine by `give`, so that both number layouts alike.
    pub(super) fn give(&self, layout: Layout, give: impl FnOnce(Layout)) -> u64 {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        // Discards outdated layouts even if there is no reader.
        state.layout();
        state.given += 1;
        let given = state.given;
        state.later.push_back((given, Arc::new(layout.clone())));
        give(layout);
        given
    }

    pub(super) fn take(&self) -> Output<engine::Snapshot> {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (_, last) = triple_buffer::triple_buffer(&state.latest.read().clone());
        std::mem::replace(&mut state.latest, last)
    }

    pub(super) fn read(&self) -> SessionSnapshot {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let layout = state.layout();
        SessionSnapshot { layout, floor: state.latest.read().clone() }
    }

    /// The layout that is on the floor.
    pub(super) fn layout(&self) -> Arc<Layout> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).layout()
    }
}

impl State {
    /// The layout of the latest state. Discards the layouts before it.
    fn layout(&mut self) -> Arc<Layout> {
        let revision = self.latest.read().layout_revision;
        while let Some((_, next)) = self.later.pop_front_if(|(given, _)| *given <= revision) {
            self.layout = next;
        }
        Arc::clone(&self.layout)
    }
}
