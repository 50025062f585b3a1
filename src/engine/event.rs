//! Events inside the engine: they name a control by its index in the layout.

use glam::Vec2;

use crate::layout::Layout;
use crate::sense::ContactId;
use crate::units::{Instant, Newtons};
use crate::widget::{EventKind, WidgetEvent};

/// An event of a control, within the step in which its layout is in use.
///
/// An event that waits for the next step is a [`WidgetEvent`]: its layout may be replaced before.
#[derive(Clone, Copy, Debug)]
pub(super) struct ControlEvent {
    pub(super) at: Instant,
    /// The index of the control; beyond all controls if the layout lacks it.
    pub(super) widget: usize,
    pub(super) kind: EventKind,
    pub(super) contact: Option<ContactId>,
    pub(super) force: Newtons,
    pub(super) position: Vec2,
}

impl ControlEvent {
    /// The event with the index of its control in `layout`.
    pub(super) fn indexed(event: &WidgetEvent, layout: &Layout) -> Self {
        let WidgetEvent { at, ref id, kind, contact, force, position } = *event;
        let widget = layout.widget_index(id.as_str()).unwrap_or(layout.widgets.len());
        Self { at, widget, kind, contact, force, position }
    }

    /// The event with the id of its control in `layout`; `None` if the layout lacks the control.
    pub(super) fn named(&self, layout: &Layout) -> Option<WidgetEvent> {
        let Self { at, widget, kind, contact, force, position } = *self;
        let id = layout.widgets.get(widget)?.id.clone();
        Some(WidgetEvent { at, id, kind, contact, force, position })
    }
}
