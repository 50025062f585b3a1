//! An app that owns its floor: force frames in, events out, a control set. Needs no hardware.

use underfoot::engine::Engine;
use underfoot::floor::Floor;
use underfoot::schema::{self, Kinds};
use underfoot::sense::{ForceFrame, Method};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::{EventKind, Value};

/// Presses the light and prints the events.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A floor from a layout.
    let floor = Floor::default();
    let page = include_str!("../layouts/first_steps.ron");
    let layout = schema::parse_layout(page, "first_steps.ron", &Kinds::builtin(), &floor.geometry)?.layout;
    let light = layout.widgets[layout.widget_index("light").ok_or("no light here")?].area.centre();
    let mut engine = Engine::new(floor.geometry, layout, Method::Tracker);

    // Frames in, one a millisecond, from any source. Here 150 N lie on the light for a fifth of a second.
    for millis in 0..1000 {
        let mut frame = ForceFrame::empty(&floor.geometry);
        frame.at = Instant::from_millis(millis);
        if (400..600).contains(&millis) {
            frame.add_load(&floor.geometry, light, Newtons(150.0));
        }
        // Events out.
        let events = engine.step(&frame).events.to_vec();
        for event in events {
            match (event.id.as_str(), event.kind) {
                ("light", EventKind::Changed(Value::Switch(on))) => {
                    println!("The light is {}.", if on { "on" } else { "off" });
                    // A control set by the app.
                    engine.set_value("volume", Value::Number(if on { 0.8 } else { 0.0 }))?;
                }
                (id, kind) => println!("{id}: {}", kind.name()),
            }
        }
    }
    println!("Volume: {:?}", engine.value("volume"));
    Ok(())
}
