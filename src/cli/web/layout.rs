//! A layout that somebody elsewhere puts on the floor: checked as a file is, or refused with what is wrong with it.

use serde_json::Value;
use underfoot::layout::Layout;
use underfoot::schema::{self, Kinds};
use underfoot::widget::Guard;

use super::Shared;

/// The request: its argument is the layout as text, made of shipped kinds.
pub(super) const REQUEST: &str = "layout";

/// Most bytes of a request with a layout: far more than the largest shipped one takes.
pub(super) const MOST_BYTES: usize = 1 << 20;

/// Puts it on the floor once no foot is engaged, or says why not.
pub(super) fn put(arguments: &[Value], shared: &Shared) -> Result<(), String> {
    if !shared.takes_layouts {
        return Err("the server keeps its layout: it takes others if it is started with --web-layouts".into());
    }
    let [Value::String(text)] = arguments else { return Err("expected a layout as text".into()) };
    let geometry = &shared.floor.geometry;
    let read = schema::parse_layout(text, "the layout", &Kinds::builtin(), geometry)
        .map_err(|diagnostics| diagnostics.to_string())?;
    // What acts while it is held may not be brought, moved or taken away from elsewhere.
    for (layout, whose) in [(&*shared.session.snapshot().layout, "on the floor"), (&read.layout, "sent")] {
        if let Some(id) = held_to_run(layout) {
            return Err(format!(
                "the layout {whose} has the control {id:?} with the guard HoldToRun: such layouts are changed \
                 where the server is"
            ));
        }
    }
    tracing::info!("a layout from elsewhere is on the floor");
    shared.session.set_layout(read.layout);
    Ok(())
}

/// A control that acts only while it is held.
fn held_to_run(layout: &Layout) -> Option<&str> {
    let held = layout
        .widgets
        .iter()
        .find(|widget| matches!(widget.behaviour.thresholds().guard, Guard::HoldToRun(_)));
    held.map(|widget| widget.id.as_str())
}
