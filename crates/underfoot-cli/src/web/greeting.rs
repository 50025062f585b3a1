//! First messages: for a web client, the places and states of the controls; for a window, the whole floor.

use std::sync::mpsc::sync_channel;
use std::time::Duration;

use serde_json::{Value, json};
use underfoot::mirror::Greeting;
use underfoot::runtime::Snapshot;
use underfoot::serve::Command;
use underfoot::sink::control_json;

use super::Shared;

/// Maximum time to wait for the tare; without it, a joined window measures its own.
const PATIENCE: Duration = Duration::from_millis(200);

/// The greeting of a joined window: the floor with its current tare, the layout, and the states of its controls.
pub(super) fn mirror_greeting(seen: &Snapshot, shared: &Shared) -> String {
    let mut floor = shared.floor.clone();
    let (answer, answered) = sync_channel(1);
    if shared.session.send(Command::GiveTare(answer))
        && let Ok(Some(tare)) = answered.recv_timeout(PATIENCE)
    {
        floor.tare = tare;
    }
    Greeting::line(&floor, &seen.layout, &seen.floor, shared.method, shared.checks.is_some())
}

/// The floor and its controls as a line: for each control its place, and all fields of a line about its state.
pub(super) fn greeting(seen: &Snapshot, shared: &Shared) -> String {
    let geometry = &shared.floor.geometry;
    let controls: Vec<Value> = seen
        .layout
        .widgets
        .iter()
        .map(|widget| {
            let (at, size) = (widget.area.min, widget.area.max - widget.area.min);
            let mut control = json!({
                "kind": widget.kind,
                "x_m": at.x, "y_m": at.y, "width_m": size.x, "depth_m": size.y,
            });
            let state = seen.control(widget.id.as_str()).map(|state| control_json(&state));
            if let (Some(control), Some(Value::Object(state))) = (control.as_object_mut(), state) {
                // These two fields mark a separate line.
                control.extend(state.into_iter().filter(|(field, _)| field != "event" && field != "t_s"));
            }
            control
        })
        .collect();
    let size = geometry.bounds().max;
    json!({
        "event": "floor",
        "title": seen.layout.title,
        "width_m": size.x, "depth_m": size.y,
        "tile_m": geometry.tile_m(),
        "link": seen.floor.link.name(),
        "link_cause": seen.floor.link_cause.as_ref().map(|cause| cause.name()),
        "why": seen.floor.link_cause.as_ref().map(ToString::to_string),
        "page": seen.page(),
        "controls": controls,
    })
    .to_string()
}
