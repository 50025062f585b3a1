//! A person walks over the simulated floor, and the map follows their feet.
#![allow(clippy::panic, clippy::unwrap_used)]

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use serde_json::Value;
use underfoot::recording::Speed;
use underfoot::runtime::{Kind, Session};
use underfoot::widget::EventKind;

/// The map's state each time it came to rest during the shipped tour, played in real time.
fn rests(record: &Path) -> Vec<Value> {
    let tour = Path::new(env!("CARGO_MANIFEST_DIR")).join("tour.ron");
    let output = Command::new(env!("CARGO_BIN_EXE_underfoot-map"))
        .args(["--no-window", "--print-state", "--scenario"])
        .arg(tour)
        .arg("--record")
        .arg(record)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// The controls clicked when the recording `path` is sensed again.
fn clicks(path: &Path) -> Vec<String> {
    let session = Session::replay(path, Speed::Max).unwrap().start().unwrap();
    let events = std::iter::from_fn(|| session.next_event_timeout(Duration::from_secs(60)));
    let clicked = events.filter(|event| event.kind == Kind::Control(EventKind::Clicked));
    clicked.map(|event| event.id().to_owned()).collect()
}

#[test]
fn a_tour_pans_zooms_switches_a_layer_and_goes_home() {
    let record = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tour.mcap");
    let rests = rests(&record);
    let number = |rest: &Value, name: &str| rest[name].as_f64().unwrap();
    let near = |rest: &Value, name: &str, expected: f64, by: f64| {
        assert!((number(rest, name) - expected).abs() <= by, "{name} is not {expected}: {rest}");
    };
    let [start, panned, dragged, .., zoomed, without_names, home] = rests.as_slice() else {
        panic!("{rests:?}")
    };
    // A foot that lands a few centimetres off, or a busy machine, pans a little less or more.
    near(panned, "lon", number(start, "lon") + 30.0, 5.0);
    near(panned, "zoom", 2.0, 0.0);
    // 25 of 115 parts of a window of 1280 points, of which the world covers 1024. A centimetre of floor is 13
    // degrees.
    near(dragged, "lon", number(panned, "lon") + 97.8, 20.0);
    near(zoomed, "zoom", 5.0, 0.25);
    near(zoomed, "lon", number(dragged, "lon"), 0.1);
    assert_eq!((&zoomed["names"], &without_names["names"]), (&Value::Bool(true), &Value::Bool(false)));
    near(without_names, "zoom", number(zoomed, "zoom"), 0.0);
    for (name, by) in [("lon", 0.0), ("lat", 0.0), ("zoom", 0.0)] {
        near(home, name, number(start, name), by);
    }
    assert_eq!(
        clicks(&record).last().map(String::as_str),
        Some("home"),
        "the recording has the tour to its end"
    );
}
