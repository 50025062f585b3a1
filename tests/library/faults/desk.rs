//! Common setup of the rows: the shipped map on a simulated floor, a person in front of it, and a part that breaks.

use underfoot::engine::Snapshot;
use underfoot::floor::{Corner, SensorId, TileId};
use underfoot::glam::Vec2;
use underfoot::sense::{Quality, Trouble};
use underfoot::units::Newtons;
use underfoot::widget::EventKind;

use crate::support::{Walker, layout};

/// A button's press is 60 N: a deliberate foot presses with somewhat more.
pub const FIRM: Newtons = Newtons(120.0);

/// A person in front of the shipped map, with an intact floor.
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

/// The last quality of a sensor in the engine.
pub fn quality(walker: &Walker, sensor: SensorId) -> Quality {
    let index = walker.geometry().index(sensor.tile).unwrap();
    let mut snapshot = Snapshot::default();
    walker.engine.snapshot(&mut snapshot);
    snapshot.tiles[index].quality[sensor.corner.index()]
}

pub fn trouble(walker: &Walker, sensor: SensorId) -> Option<Trouble> {
    walker.assembler.troubles().find(|(id, _)| *id == sensor).map(|(_, trouble)| trouble)
}

/// Presses `id` for 150 ms and lifts; returns whether the result was exactly one click.
pub fn clicks(walker: &mut Walker, id: &str) -> bool {
    walker.take_events();
    walker.step_onto(id, FIRM);
    walker.wait(150);
    walker.lift();
    walker.wait(100);
    let expected = [EventKind::Pressed, EventKind::Released, EventKind::Clicked];
    walker.take_events() == expected.map(|kind| (id.to_string(), kind))
}
