//! What a web client is told first: where the controls are, and how they are.

use serde_json::{Value, json};
use underfoot::floor::Geometry;
use underfoot::runtime::Snapshot;
use underfoot::widget;

/// The floor and its controls as a line.
pub(super) fn greeting(seen: &Snapshot, geometry: &Geometry) -> String {
    let pages = &seen.layout.pages;
    let controls: Vec<Value> = seen
        .layout
        .widgets
        .iter()
        .map(|widget| {
            let state = seen.control(widget.id.as_str());
            let (at, size) = (widget.area.min, widget.area.max - widget.area.min);
            json!({
                "id": widget.id.as_str(),
                "kind": widget.kind,
                "label": state.as_ref().map(|state| &*state.label),
                "page": widget.page.and_then(|page| pages.get(page)).map(|page| page.id.as_str()),
                "x_m": at.x, "y_m": at.y, "width_m": size.x, "depth_m": size.y,
                "value": state.and_then(|state| state.value).map(value),
            })
        })
        .collect();
    let size = geometry.bounds().max;
    json!({
        "event": "floor",
        "title": seen.layout.title,
        "width_m": size.x, "depth_m": size.y,
        "tile_m": geometry.tile_m(),
        "link": seen.floor.link.name(),
        "page": seen.page(),
        "controls": controls,
    })
    .to_string()
}

/// As in JSON lines.
fn value(value: widget::Value) -> Value {
    match value {
        widget::Value::Switch(on) => json!(on),
        widget::Value::Number(number) => json!(number),
        widget::Value::Choice(choice) => json!(choice),
        widget::Value::Pair(pair) => json!([pair.x, pair.y]),
    }
}
