//! R7 to R9: feet that slip, people who walk across, and a control that is held too long.

use serde_json::Value;

use super::session::session;
use super::tape::events;
use crate::end_to_end::{said, underfoot};

/// One person's scenario: an approach from the page's south side, then `steps`.
fn somebody(steps: &str) -> String {
    format!(
        "Scenario(title: \"Somebody\", person: (mass_kg: 70, foot_m: 0.27), \
         steps: [Wait(ms: 1200), Enter(from: South, at: (2.2, 0.5)), {steps}, Wait(ms: 500)])"
    )
}

/// The second of the first `event` of `id`.
fn time_of(lines: &[Value], id: &str, event: &str) -> f64 {
    lines.iter().find(|line| line["id"] == id && line["event"] == event).unwrap()["t_s"].as_f64().unwrap()
}

#[test]
fn r7_a_foot_that_slips_off_one_control_cancels_it_and_does_not_press_the_next() {
    let page =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/map.ron")).unwrap();
    let slip = "Drag(from: (1.4, 2.8), to: (2.2, 2.45), speed_m_s: 0.3, force_n: 140)";
    let lines = session(&page, &somebody(slip), &[]);
    assert_eq!(events(&lines), ["pan_west pressed", "pan_west cancelled"]);
    let pressed = format!("{slip}, Wait(ms: 500), Press(widget: \"pan_south\", force_n: 140)");
    let lines = session(&page, &somebody(&pressed), &[]);
    assert_eq!(events(&lines)[2..], ["pan_south pressed", "pan_south released", "pan_south clicked"]);
}

/// Two strips across the floor, each in its own region.
const STRIPS: &str = r#"Layout(version: 1,
    regions: [(id: "south", at: (0, 2), size: (6, 0.9)), (id: "north", at: (0, 4.2), size: (6, 0.9))],
    widgets: [
        (id: "drive", kind: "dead_man", at: (0.5, 2), size: (5, 0.9)),
        (id: "go", kind: "button", guard: Confirm, at: (0.5, 4.2), size: (5, 0.9)),
    ],
)"#;

/// Deliberate presses, from beside each strip.
const MEANT: &str = "Point(at: (2.5, 2.45), force_n: 140, hold_ms: 1500), Wait(ms: 500), WalkTo(at: (2.2, 3.2)), \
    Point(at: (2.5, 4.65), force_n: 140, hold_ms: 500), Wait(ms: 500), Point(at: (2.5, 4.65), force_n: 140, hold_ms: 500)";

/// Four walkers, one after the other, over both strips and along each.
const WALKERS: &str = r#"Scenario(title: "Walking over", person: (mass_kg: 70, foot_m: 0.27, speed_m_s: 1.2),
    steps: [Wait(ms: 1200), Enter(from: South, at: (2.2, 5.5)), Leave(to: North)],
    others: [
        (person: (mass_kg: 90, foot_m: 0.29, speed_m_s: 0.8),
            steps: [Wait(ms: 7500), Enter(from: North, at: (4, 0.5)), Leave(to: South)]),
        (person: (mass_kg: 60, foot_m: 0.24, speed_m_s: 1.5),
            steps: [Wait(ms: 13500), Enter(from: West, at: (5.5, 2.4)), Leave(to: East)]),
        (person: (mass_kg: 60, foot_m: 0.24, speed_m_s: 1.1),
            steps: [Wait(ms: 20000), Enter(from: East, at: (0.5, 4.2)), Leave(to: West)]),
    ],
)"#;

#[test]
fn r8_people_who_walk_over_guarded_controls_start_none_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.mcap");
    let lines = session(STRIPS, WALKERS, &["--record", path.to_str().unwrap()]);
    assert_eq!(events(&lines), Vec::<String>::new());
    // They have stepped on both strips: the recording holds the positions of feet.
    let arguments = ["--speed", "max", "--no-osc", "--json", "--json-contacts"];
    let replayed = underfoot().arg("replay").arg(&path).args(arguments).output().unwrap();
    assert!(replayed.status.success(), "{}", said(&replayed));
    let lines = String::from_utf8(replayed.stdout).unwrap();
    let rows: Vec<f64> = lines
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap())
        .filter_map(|line| line["contacts"].as_array().cloned())
        .flatten()
        .filter(|contact| contact["force_n"].as_f64() > Some(100.0))
        .map(|contact| contact["y_m"].as_f64().unwrap() / 0.304)
        .collect();
    for strip in [2.0..2.9, 4.2..5.1] {
        let count = rows.iter().filter(|row| strip.contains(*row)).count();
        assert!(count > 50, "{count} looks at feet on {strip:?}");
    }
    let meant = events(&session(STRIPS, &somebody(MEANT), &[]));
    for event in ["drive pressed", "go clicked"] {
        assert!(meant.iter().any(|one| one == event), "{event}: {meant:?}");
    }
}

#[test]
fn r9_a_control_held_too_long_warns_stops_and_wants_a_lift() {
    let page = STRIPS.replace("at: (0.5, 2)", "guard: HoldToRun(max_s: 4, warn_s: 2), at: (0.5, 2)");
    let held = "Point(at: (2.5, 2.45), force_n: 140, hold_ms: 6000), Wait(ms: 500), \
                Point(at: (2.5, 2.45), force_n: 140, hold_ms: 1000)";
    let lines = session(&page, &somebody(held), &[]);
    let all = ["pressed", "warned", "cancelled", "pressed", "released"].map(|event| format!("drive {event}"));
    assert_eq!(events(&lines), all);
    let pressed = time_of(&lines, "drive", "pressed");
    let after = |event| (time_of(&lines, "drive", event) - pressed).round();
    assert_eq!((after("warned"), after("cancelled")), (2.0, 4.0));
}
