//! What the rows share: the shipped map on a simulated floor, a person in front of it, and a part that breaks.

use underfoot::engine::Snapshot;
use underfoot::floor::{Corner, SensorId, TileId};
use underfoot::glam::Vec2;
use underfoot::sense::{Quality, Trouble};
use underfoot::units::Newtons;
use underfoot::widget::EventKind;

use crate::support::{Walker, layout};

/// A button's press is 60 N: a deliberate foot presses with some more.
pub const FIRM: Newtons = Newtons(120.0);

/// Somebody in front of the shipped map, with nothing wrong yet.
pub fn at_the_map() -> Walker {
    let mut walker = Walker::on(layout("map"));
    walker.stand(Newtons(690.0));
    walker.wait(300);
    assert_eq!(walker.take_events(), []);
    walker
}

/// The middle of the control `id`.
pub fn middle(walker: &Walker, id: &str) -> Vec2 {
    let page = walker.engine.layout();
    page.widgets[page.widget_index(id).unwrap()].area.centre()
}

/// The tile that carries the middle of `id`.
pub fn tile_of(walker: &Walker, id: &str) -> TileId {
    walker.geometry().tile_under(middle(walker, id)).unwrap()
}

pub fn sensor(tile: TileId, corner: Corner) -> SensorId {
    SensorId { tile, corner }
}

/// What the engine last knew of a sensor.
pub fn quality(walker: &Walker, sensor: SensorId) -> Quality {
    let index = walker.geometry().index(sensor.tile).unwrap();
    let mut snapshot = Snapshot::default();
    walker.engine.snapshot(&mut snapshot);
    snapshot.tiles[index].quality[sensor.corner.index()]
}

pub fn trouble(walker: &Walker, sensor: SensorId) -> Option<Trouble> {
    walker.assembler.troubles().find(|(id, _)| *id == sensor).map(|(_, trouble)| trouble)
}

/// Presses `id` for 150 ms and lifts; whether exactly a click came of it.
pub fn clicks(walker: &mut Walker, id: &str) -> bool {
    walker.take_events();
    walker.step_onto(id, FIRM);
    walker.wait(150);
    walker.lift();
    walker.wait(100);
    let expected = [EventKind::Pressed, EventKind::Released, EventKind::Clicked];
    walker.take_events() == expected.map(|kind| (id.to_string(), kind))
}
