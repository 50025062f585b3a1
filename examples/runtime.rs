//! An app operated with the feet. Start it, then send it a floor: `underfoot simulate --send 127.0.0.1:9000`.

use std::error::Error;
use std::time::Duration;

use underfoot::runtime::{Kind, Session};
use underfoot::widget::EventKind::{Changed, Clicked};
use underfoot::widget::Value;
use underfoot::wire::LinkState;

/// Follows the floor that sends its packets to `address`, until it falls silent.
pub(crate) fn follow(address: &str, mut say: impl FnMut(String)) -> Result<(), Box<dyn Error>> {
    let floor = Session::listen(address).layout_file("layouts/map.ron")?.start()?;
    while let Some(event) = floor.next_event_timeout(Duration::from_secs(60)) {
        match (event.id(), event.kind) {
            ("zoom", Kind::Control(Changed(Value::Number(at)))) => say(format!("zoom {at:.2}")),
            ("home", Kind::Control(Clicked)) => floor.control("zoom")?.set(0.0)?,
            (id, Kind::Control(kind)) => say(format!("{id} {}", kind.name())),
            (_, Kind::Link(LinkState::Lost)) => floor.stop(),
            (_, Kind::Ended(reason)) => say(format!("the floor is gone: {reason}")),
            _ => {}
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    follow("127.0.0.1:9000", |line| println!("{line}"))
}
