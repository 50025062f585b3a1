//! Between frames and events a running floor allocates no memory: including people, steps, weights, regions and
//! guards.

use std::time::Duration;

use assert_no_alloc::{assert_no_alloc, violation_count};
use underfoot::engine::{Engine, Snapshot};
use underfoot::floor::Geometry;
use underfoot::layout::CursorRule;
use underfoot::schema::{Kinds, builtin_layout, parse_layout};
use underfoot::sense::{ForceFrame, Method, Quality};
use underfoot::units::Instant;
use underfoot_lab::experiment::{DrawnVisit, Rig};
use underfoot_sim::Foot;

/// The frames of one person's visit, `times` as heavy, and its length in milliseconds.
fn visit(geometry: Geometry, times: f32) -> (Vec<ForceFrame>, u64) {
    let visit = DrawnVisit::of(3, &geometry).unwrap();
    let mut rig = Rig::ideal(geometry);
    let (mut frames, mut feet) = (Vec::<ForceFrame>::new(), Vec::<Foot>::new());
    let length = visit.script().duration().as_millis() as u64;
    for ms in 1..length {
        feet.clear();
        visit.script().feet_at(Instant::from_millis(ms), &mut feet);
        let heavy = |foot: &Foot| Foot { force: foot.force * times, ..*foot };
        rig.step(feet.iter().map(|foot| heavy(foot).as_load()), |frame| frames.push(frame.clone()));
    }
    (frames, length)
}

// R4
#[test]
fn people_on_controls_allocate_nothing_by_any_cursor_rule() {
    let geometry = Geometry::default();
    let (mut frames, length) = visit(geometry, 1.0);
    // A board that falls silent for a moment.
    for frame in &mut frames[4000..4100] {
        frame.quality[12..18].fill([Quality::Stale; 4]);
    }
    let text = builtin_layout("all_controls").unwrap();
    for rule in [CursorRule::Largest, CursorRule::Working, CursorRule::Each] {
        let mut layout = parse_layout(text, "all", &Kinds::builtin(), &geometry).unwrap().layout;
        layout.regions[0].cursor = rule;
        let mut engine = Engine::new(geometry, layout, Method::Tracker);
        let mut snapshot = Snapshot::default();
        let mut events = 0;
        let mut pass = |number: u32, frame: &mut ForceFrame| {
            frame.at = frame.at + Duration::from_millis(length) * number.min(1);
            events += engine.step(frame).events.len();
            engine.snapshot(&mut snapshot);
        };
        // Two passes, of which the first is for warming up.
        frames.iter_mut().for_each(|frame| pass(0, frame));
        let before = violation_count();
        for frame in &mut frames {
            assert_no_alloc(|| pass(1, frame));
        }
        assert_eq!(violation_count(), before, "{rule:?}");
        for frame in &mut frames {
            frame.at = frame.at.before(Duration::from_millis(length));
        }
        println!("{rule:?}: {events} events");
    }
}

#[test]
fn grounds_allocate_nothing_while_they_crack_and_heal() {
    let geometry = Geometry::default();
    // A giant, so that there are many ground events.
    let (frames, length) = visit(geometry, 3.0);
    for name in ["pond", "winter_walk"] {
        let text = builtin_layout(name).unwrap();
        let layout = parse_layout(text, name, &Kinds::builtin(), &geometry).unwrap().layout;
        let mut engine = Engine::new(geometry, layout, Method::Tracker);
        let mut snapshot = Snapshot::default();
        let mut events = 0;
        let mut pass = |round: u32, frame: &ForceFrame| {
            let mut frame = frame.clone();
            frame.at = frame.at + Duration::from_millis(length) * round;
            let before = violation_count();
            assert_no_alloc(|| {
                events += engine.step(&frame).grounds.len();
                engine.snapshot(&mut snapshot);
            });
            violation_count() - before
        };
        for frame in &frames {
            pass(0, frame);
        }
        let violations: u32 = frames.iter().map(|frame| pass(1, frame)).sum();
        assert_eq!(violations, 0, "{name}");
        println!("{name}: {events} events");
        assert!(events > 100, "{name}: {events}");
    }
}
