//! Every control of every shipped layout, operated by a person in the stance of the layout.

use crate::support::{Walker, layout};
use underfoot::glam::Vec2;
use underfoot::schema;
use underfoot::units::Newtons;
use underfoot::widget::{Behaviour, EventKind, Guard, Mapping, Value};

/// The weight of 70 kg on one foot.
const WEIGHT: Newtons = Newtons(690.0);

#[test]
fn every_control_of_every_shipped_layout_works_and_standing_beside_it_does_nothing() {
    for name in schema::builtin_layouts() {
        let page = layout(name);
        for widget in page.widgets.clone() {
            let id = widget.id.to_string();
            let at = widget.behaviour.thresholds();
            let mut walker = Walker::on(page.clone());
            // A person who has arrived and is no longer expected to step on.
            walker.stand(WEIGHT);
            walker.wait(3000);
            assert_eq!(walker.take_events(), [], "standing is no press: {name}");
            // Off the middle, at a place where each selector, stepper or dial changes.
            let place = widget.area.min + widget.area.size() * Vec2::new(0.75, 0.6);
            let taps = if matches!(at.guard, Guard::Confirm { .. }) { 2 } else { 1 };
            for _ in 0..taps {
                // Part of a foot rests on the tile behind.
                walker.step_at(place, at.press * 2.5);
                // A control that acts while it is held, or on which a person stands, waits for a settled foot.
                let waits = matches!(at.guard, Guard::HoldToRun { .. })
                    || matches!(widget.behaviour, Behaviour::Lean(_));
                let settled = if waits { 400 } else { 0 };
                walker.wait(150 + settled + at.dwell.as_millis() as u64);
                walker.lift();
                walker.wait(100);
            }
            // A single tap is certain once the time for a second one has passed.
            walker.wait(400);
            let events = walker.take_events();
            assert!(events.iter().all(|(of, _)| *of == id), "{name}: {events:?}");
            let kinds: Vec<EventKind> = events.into_iter().map(|(_, kind)| kind).collect();
            let ends = kinds.iter().filter(|kind| **kind == EventKind::Released).count();
            assert_eq!((kinds.first(), ends), (Some(&EventKind::Pressed), taps), "{name}: {id}: {kinds:?}");
            let acts = |kind: &EventKind| matches!(kind, EventKind::Clicked | EventKind::Changed(_));
            // A lean, and a value that moves by a rate, need more than a tap (see the timelines); a value in coarse steps
            // may have been there before.
            let is_slow = match &widget.behaviour {
                Behaviour::Lean(_) | Behaviour::Dial(_) => true,
                Behaviour::Slider(slider) => {
                    matches!(slider.mapping, Mapping::Rate(_)) || slider.scale.step > 0.0
                }
                _ => false,
            };
            let acts = kinds.iter().any(acts) || is_slow;
            assert!(acts, "{name}: {id}: {kinds:?}");
        }
    }
}

#[test]
fn every_slider_of_every_shipped_layout_follows_the_foot_to_a_twentieth_of_its_travel() {
    for name in schema::builtin_layouts() {
        let page = layout(name);
        for widget in page.widgets.clone() {
            let Behaviour::Slider(slider) = widget.behaviour else { continue };
            let size = widget.area.size();
            let share = |share: f32| widget.area.min + slider.track.place_at(share, size) * size;
            let mut walker = Walker::on(page.clone());
            walker.stand(WEIGHT);
            walker.step_at(share(0.3), slider.thresholds.press * 1.6);
            walker.wait(100);
            walker.slide_to(share(0.75), 0.3);
            walker.lift();
            walker.wait(100);
            let id = widget.id.as_str();
            let Some(Value::Number(value)) = walker.engine.value(id) else { panic!("{id} holds a number") };
            let reached = slider.scale.share(value);
            if let Mapping::Rate(_) = slider.mapping {
                assert!(value > slider.initial, "{name}: {id} at {value}");
                continue;
            }
            let tolerance = 0.05 + 0.5 * slider.scale.step / slider.scale.range();
            assert!((reached - 0.75).abs() <= tolerance, "{name}: {id} at {reached}");
        }
    }
}

#[test]
fn a_silent_floor_cancels_within_120_ms_and_wants_a_lift_afterwards() {
    let mut walker = Walker::on(layout("map"));
    walker.step_onto("home", Newtons(150.0));
    walker.wait(100);
    walker.connected = false;
    walker.wait(120);
    let home = |kind| ("home".to_string(), kind);
    assert_eq!(walker.take_events(), [home(EventKind::Pressed), home(EventKind::Cancelled)]);
    walker.connected = true;
    walker.wait(1500);
    assert_eq!(walker.take_events(), [], "still loaded");
    walker.lift();
    walker.wait(100);
    walker.step_onto("home", Newtons(150.0));
    walker.wait(100);
    assert_eq!(walker.take_events(), [home(EventKind::Pressed)]);
}
