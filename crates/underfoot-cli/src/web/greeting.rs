//! First messages: for a web client, the places and states of the controls; for a window, the whole floor.

use std::sync::mpsc::sync_channel;
use std::time::Duration;

use serde_json::{Map, Value};
use underfoot::mirror::Greeting;
use underfoot::outgoing::json::{FloorRecord, PlacedControl, Sentence, StateRecord, json_value};
use underfoot::runtime::SessionSnapshot;
use underfoot::serve::FloorCommand;

use super::Shared;

/// Maximum time to wait for the tare; without it, a joined window measures its own.
const PATIENCE: Duration = Duration::from_millis(200);

/// The greeting of a joined window: the floor with its current tare, the layout, and the states of its controls.
pub(super) fn mirror_greeting(seen: &SessionSnapshot, shared: &Shared) -> String {
    let mut floor = shared.floor.clone();
    let (answer, answered) = sync_channel(1);
    if shared.session.send(FloorCommand::GiveTare(answer))
        && let Ok(Some(tare)) = answered.recv_timeout(PATIENCE)
    {
        floor.tare = tare;
    }
    Greeting::line(&floor, &seen.layout, &seen.floor, shared.method, shared.checks.is_some())
}

/// The floor and its controls as a line: for each control its place, and all fields of a line about its state.
pub(super) fn greeting(seen: &SessionSnapshot, shared: &Shared) -> String {
    let geometry = &shared.floor.geometry;
    let controls = seen.layout.widgets.iter().map(|widget| {
        let (at, size) = (widget.area.min, widget.area.max - widget.area.min);
        let state = seen.control(widget.id.as_str()).map(|state| json_value(&StateRecord::from(&state)));
        let control = PlacedControl {
            kind: widget.kind.clone(),
            x_m: at.x.into(),
            y_m: at.y.into(),
            width_m: size.x.into(),
            depth_m: size.y.into(),
            state: if let Some(Value::Object(state)) = state { state } else { Map::default() },
        };
        // With the fields in the order of their names.
        serde_json::to_value(control).unwrap_or_default()
    });
    let (size, cause) = (geometry.bounds().max, seen.floor.link_cause.as_ref());
    let tile = geometry.tile_m();
    let record = FloorRecord {
        controls: controls.collect(),
        depth_m: size.y.into(),
        event: "floor".into(),
        link: seen.floor.link.name().into(),
        link_cause: cause.map(|cause| cause.name().into()),
        page: seen.page().map(Into::into),
        tile_depth_m: (tile.x != tile.y).then(|| tile.y.into()),
        tile_m: tile.x.into(),
        title: seen.layout.title.clone(),
        why: cause.map(|cause| Sentence(cause.to_string())),
        width_m: size.x.into(),
    };
    // Texts and numbers can always be written as JSON.
    serde_json::to_string(&record).unwrap_or_default()
}
