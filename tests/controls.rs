//! Every control of every shipped layout, worked by a person who stands where the layout says.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use support::{Walker, layout};
use underfoot::schema;
use underfoot::units::Newtons;
use underfoot::widget::{Behaviour, EventKind, Value};

/// The weight of 70 kg on one foot.
const WEIGHT: Newtons = Newtons(690.0);

#[test]
fn every_button_and_switch_of_every_shipped_layout_works() {
    for name in schema::builtin_layouts() {
        let page = layout(name);
        for widget in page.widgets.clone() {
            let press = widget.behaviour.thresholds().press * 1.6;
            let last = match widget.behaviour {
                Behaviour::Button(_) => EventKind::Clicked,
                Behaviour::Switch(switch) => EventKind::Changed(Value::Switch(!switch.initial)),
                _ => continue,
            };
            let mut walker = Walker::on(page.clone());
            walker.stand(WEIGHT);
            walker.wait(300);
            assert_eq!(walker.take_events(), [], "standing is no press: {name}");
            walker.step_onto(widget.id.as_str(), press);
            walker.wait(150);
            walker.lift();
            walker.wait(100);
            let id = widget.id.to_string();
            let expected = [EventKind::Pressed, EventKind::Released, last].map(|kind| (id.clone(), kind));
            assert_eq!(walker.take_events(), expected, "{name}: {id}");
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
