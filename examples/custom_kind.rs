//! A custom control kind, in RON: a stiff pedal that clicks deeply. Needs no hardware.

use underfoot::engine::Engine;
use underfoot::floor::Floor;
use underfoot::schema::{self, Kinds};
use underfoot::sense::{ForceFrame, Method};
use underfoot::units::{Instant, Newtons};

/// Behaviour, feel and look of a stiff pedal; a file in a `widgets` folder works as well.
const STIFF_PEDAL: &str = r##"
Kind(
    name: "stiff_pedal",
    behaviour: Button,
    press_n: 220, release_n: 150, dwell_ms: 30, lockout_ms: 20,
    look: (shape: Box, face: "#efe3d6", lit: "#d9853b", ink: "#2f2014"),
    feel: (
        press: Click(level_n: 20, modes: [(hz: 120, decay_ms: 35, amplitude: 1.0), (hz: 260, decay_ms: 10, amplitude: 0.3)]),
        release: Click(level_n: 8, modes: [(hz: 160, decay_ms: 15, amplitude: 1.0)]),
    ),
)
"##;

const PAGE: &str = r#"
Layout(
    version: 1,
    title: "One pedal",
    regions: [(id: "page", at: (1, 2), size: (4, 3))],
    widgets: [(id: "brake", kind: "stiff_pedal", at: (2.5, 3), size: (1, 1), label: "Brake")],
)
"#;

/// Leans on the pedal and prints the events.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let geometry = Floor::default().geometry;
    let mut kinds = Kinds::builtin();
    kinds.add(STIFF_PEDAL, "stiff_pedal.ron")?;
    let layout = schema::parse_layout(PAGE, "page.ron", &kinds, &geometry)?.layout;
    let pedal = layout.widgets[0].area.centre();
    let mut engine = Engine::new(geometry, layout, Method::Tracker);

    // A foot leans on the pedal ever harder for a second, then releases it.
    for millis in 0..1500_u16 {
        let mut frame = ForceFrame::empty(&geometry);
        frame.at = Instant::from_millis(millis.into());
        if millis < 1000 {
            frame.add_load(&geometry, pedal, Newtons(f32::from(millis) * 0.4));
        }
        let step = engine.step(&frame);
        for event in step.events {
            println!(
                "{:.3} s: {} {} at {:.0} N",
                event.at.secs(),
                event.id,
                event.kind.name(),
                event.force.0
            );
        }
        for cue in step.cues {
            println!("         felt at {} Hz on tile {}", cue.click.modes[0].frequency_hz, cue.spots[0].tile);
        }
    }
    Ok(())
}
