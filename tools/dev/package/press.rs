//! Prints the events of the control `home` on a simulated floor: `press SCENARIO`.

use underfoot::floor::Floor;
use underfoot::runtime::Kind;
use underfoot::schema::{self, Kinds};
use underfoot_sim::{FloorQuality, Scenario};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let geometry = Floor::default().geometry;
    let text = schema::builtin_layout("map").ok_or("no such layout")?;
    let layout = schema::parse_layout(text, "map.ron", &Kinds::builtin(), &geometry)?.layout;
    let scenario = Scenario::load(std::env::args().nth(1).ok_or("which scenario?")?.as_ref())?;
    let floor = underfoot_sim::session(layout, &scenario, FloorQuality::default())?.start()?;
    // It ends with the scenario.
    for event in &floor {
        if let (Kind::Control(kind), "home") = (event.kind, event.id()) {
            println!("home {}", kind.name());
        }
    }
    Ok(())
}
