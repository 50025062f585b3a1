//! Simulated people drag controls and the free floor by scenarios: through packets, contacts and controls.

use std::time::Duration;

use glam::Vec2;
use underfoot::engine::{Engine, FootRole, Snapshot};
use underfoot::floor::Floor;
use underfoot::glam;
use underfoot::sense::{Assembler, Method};
use underfoot::source::SensorSource;
use underfoot::widget::Value;
use underfoot_sim::{Pace, Scenario, SimConfig, SimFloor, SimulatedSource, calibrated};

use crate::support::page;

const CONTROLS: &str = r#"Layout(version: 1, title: "Controls to drag",
    regions: [(id: "all", at: (0, 1.6), size: (6, 2))],
    stances: [(at: (0.5, 0), size: (5, 1))],
    widgets: [
        (id: "pad", kind: "pad", at: (0.4, 1.8), size: (1.1, 1.1), min: (0, 0), max: (1, 1)),
        (id: "dial", kind: "dial", at: (2.4, 1.8), size: (1.2, 1.2), turn_deg: 720, min: 0, max: 1, step: 0),
        (id: "arc", kind: "arc_slider", at: (4.2, 1.8), size: (1.5, 0.9), min: 0, max: 1, step: 0),
    ])"#;

/// The values of the controls at the end, and the paths of free feet that pressed with 40 to 150 N.
fn play(steps: &str) -> (impl Fn(&str) -> Value, Vec<Vec2>) {
    let wired = Floor::default();
    let sim = SimFloor::new(&wired, SimConfig::default(), 3);
    let floor = calibrated(&wired, &sim, 3).unwrap();
    let layout = page(CONTROLS);
    let text = format!("Scenario(title: \"Drag\", steps: [Wait(ms: 500), {steps}])");
    let script = Scenario::parse("test", &text).unwrap().resolve(&layout, &floor.geometry).unwrap();
    let mut source = SimulatedSource::new(sim, Box::new(script), Pace::FreeRunning);
    let mut assembler = Assembler::new(&floor);
    let mut engine = Engine::new(floor.geometry, layout, Method::default());
    let (mut snapshot, mut way) = (Snapshot::default(), Vec::new());
    while let Ok(Some(packet)) = source.next(Duration::ZERO) {
        assembler.take(&packet);
        while let Some(frame) = assembler.ready() {
            engine.step(frame);
            engine.snapshot(&mut snapshot);
            let free =
                |id| snapshot.feet.iter().any(|foot| foot.contact == id && foot.role == FootRole::Free);
            let works = |force: f32| (40.0..150.0).contains(&force);
            let working = snapshot.contacts.iter().find(|foot| works(foot.force.0) && free(foot.id));
            way.extend(working.map(|foot| foot.centroid / floor.geometry.pitch_m()));
        }
    }
    (move |id: &str| engine.value(id).unwrap(), way)
}

fn number(value: Value) -> f32 {
    let Value::Number(number) = value else { panic!("{value:?}") };
    number
}

#[test]
fn a_pad_is_dragged_to_a_place_on_it() {
    let (value, _) = play(
        "Enter(from: South, at: (1.0, 0.5)), Drag(widget: \"pad\", from: (0.5, 0.5), to: (0.2, 0.8), force_n: 110)",
    );
    let Value::Pair(at) = value("pad") else { panic!("{:?}", value("pad")) };
    // 33 cm across: a centimetre is 3 %.
    assert!(at.distance(Vec2::new(0.2, 0.8)) < 0.06, "{at}");
}

#[test]
fn a_dial_is_turned_round_its_middle_and_an_arc_followed() {
    let (value, _) = play(
        "Enter(from: South, at: (3.0, 0.5)), Drag(widget: \"dial\", from: 0.0, to: 0.75, force_n: 110), \
         WalkTo(at: (4.9, 0.5), facing: North), Drag(widget: \"arc\", from: 0.1, to: 0.7, force_n: 110)",
    );
    let (dial, arc) = (number(value("dial")), number(value("arc")));
    assert!((dial - 0.75).abs() < 0.04, "one and a half turns of two: {dial}");
    assert!((arc - 0.7).abs() < 0.06, "{arc}");
}

#[test]
fn a_foot_goes_from_place_to_place_over_free_floor() {
    let (value, way) =
        play("Enter(from: South, at: (2.0, 0.5)), Drag(from: (1.9, 2.0), to: (1.9, 2.8), force_n: 110)");
    let (first, last) = (way.first().unwrap(), way.last().unwrap());
    // Tiles of 30 cm: 6 cm, the paper's worst near edges.
    assert!(first.distance(Vec2::new(1.9, 2.0)) < 0.2, "{first}");
    assert!(last.distance(Vec2::new(1.9, 2.8)) < 0.2, "{last}");
    let widest = way.iter().map(|at| (at.x - 1.9).abs()).fold(0.0, f32::max);
    assert!(widest < 0.2, "{widest}");
    assert_eq!(value("pad"), Value::Pair(Vec2::ZERO), "nothing else moved");
}
