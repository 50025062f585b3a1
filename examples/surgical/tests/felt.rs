//! The haptic cues of the console, which replace looking: slices, walls, refusals.
#![allow(clippy::panic, clippy::unwrap_used)]

use std::time::Duration;

use underfoot::engine::Engine;
use underfoot::floor::Floor;
use underfoot::schema::{self, Kinds};
use underfoot::sense::{Assembler, Method};
use underfoot::source::SensorSource;
use underfoot::widget::{EventKind, Value};
use underfoot_sim::{Pace, Scenario, SimConfig, SimFloor, SimulatedSource, calibrated};

/// The results of some steps.
struct Felt {
    cues: usize,
    /// The greatest number of sustained cues at once: friction, and the force of a wall.
    lasting: usize,
    events: Vec<EventKind>,
}

/// The results of these steps, with 40 slices and nothing to clear.
fn felt(steps: &str) -> Felt {
    let wired = Floor::default();
    let sim = SimFloor::new(&wired, SimConfig::default(), 1);
    let floor = calibrated(&wired, &sim, 1).unwrap();
    let console = include_str!("../console.ron");
    let layout =
        schema::parse_layout(console, "console.ron", &Kinds::builtin(), &floor.geometry).unwrap().layout;
    let text = format!("Scenario(title: \"Blind\", steps: [Wait(ms: 500), {steps}])");
    let feet = Scenario::parse("blind", &text).unwrap().resolve(&layout, &floor.geometry).unwrap();
    let mut source = SimulatedSource::new(sim, Box::new(feet), Pace::FreeRunning);
    let mut assembler = Assembler::new(&floor);
    let mut engine = Engine::new(floor.geometry, layout, Method::default());
    engine.set_range("slice", 1.0, 40.0).unwrap();
    engine.set_locked("clear", true).unwrap();
    let (mut cues, mut lasting, mut events) = (0, 0, Vec::new());
    while let Ok(Some(packet)) = source.next(Duration::ZERO) {
        assembler.take(&packet);
        while let Some(frame) = assembler.ready() {
            let step = engine.step(frame);
            cues += step.cues.len();
            lasting = lasting.max(step.sustained.len());
            events.extend(step.events.iter().map(|event| event.kind));
        }
    }
    Felt { cues, lasting, events }
}

#[test]
fn each_slice_and_the_end_of_them_is_felt() {
    let slides = |to: &str| felt(&format!("Enter(from: South, at: (3.8, 0.5)), Drag({to}, force_n: 110)"));
    let inside = slides("widget: \"slice\", from: 0.3, to: 0.8");
    let turned = inside.events.iter().filter(|kind| matches!(kind, EventKind::Changed(_))).count();
    assert!((17..=24).contains(&turned), "{turned} slices");
    // A click for each, and those of the press and its release.
    assert!(inside.cues >= turned, "{} cues for {turned} slices", inside.cues);
    assert_eq!(inside.lasting, 1, "friction");
    // On over the eastern edge of the slider.
    let beyond = slides("from: (4.5, 2.32), to: (4.95, 2.32)");
    let last = beyond.events.iter().rev().find(|kind| matches!(kind, EventKind::Changed(_)));
    assert_eq!(last, Some(&EventKind::Changed(Value::Number(40.0))));
    assert_eq!(beyond.lasting, 2, "a wall as well");
}

#[test]
fn a_refusal_is_felt_and_nothing_happens() {
    let pressed =
        felt("Enter(from: South, at: (1.0, 0.5)), Press(widget: \"clear\", force_n: 120, hold_ms: 300)");
    assert_eq!(pressed.events, [EventKind::Refused]);
    assert!(pressed.cues > 0);
    let walked = felt("Enter(from: South, at: (1.0, 0.5))");
    assert_eq!((walked.cues, walked.events), (0, vec![]), "walking on is not felt");
}
