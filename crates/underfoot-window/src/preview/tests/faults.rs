//! Faults that the window switches on, on a simulated floor.

use std::time::Duration;

use egui_kittest::kittest::Queryable;

use super::Room;
use crate::preview::rehearsal::Rehearsal;
use underfoot::floor::Floor;
use underfoot::source::{LinkFaults, SensorSource};
use underfoot_sim::{FootHandle, Pace, RehearsalSource, SimConfig, SimFloor, SimulatedSource, feet_by_hand};

/// A window on a simulated floor, with that floor's source; the floor ends with the handle.
fn room() -> (Room, RehearsalSource, FootHandle) {
    let floor = Floor::default();
    let sim = SimFloor::new(&floor, SimConfig::default(), 1);
    let (handle, nobody) = feet_by_hand();
    let inner = SimulatedSource::new(sim, Box::new(nobody), Pace::FreeRunning);
    let (source, switch) = RehearsalSource::new(inner, LinkFaults::default(), 1);
    let mut room = Room::simulated();
    room.window.state_mut().rehearsal = Some(Rehearsal::new(switch, &floor));
    room.run(2);
    room.window.get_by_label("Rehearse faults").click_accesskit();
    room.run(20);
    (room, source, handle)
}

/// Number of packets of board 2 among the next 60: ten without faults.
fn from_board_two(source: &mut RehearsalSource) -> usize {
    let next = |_| source.next(Duration::from_millis(1)).unwrap();
    (0..60).filter_map(next).filter(|packet| packet.board == 2).count()
}

#[test]
fn a_board_is_unplugged_and_everything_is_mended_again() {
    let (mut room, mut source, _nobody) = room();
    assert_eq!(from_board_two(&mut source), 10);
    room.window.get_by_label("Board 2 unplugged").click_accesskit();
    room.run(2);
    assert!(room.says("1 fault on"), "the top bar says so, lest somebody takes it for real");
    assert_eq!(from_board_two(&mut source), 0);
    room.window.get_by_label("Sensor sw of the tile").click_accesskit();
    room.run(2);
    room.window.get_by_label("torn off").click_accesskit();
    room.run(2);
    assert!(room.says("2 faults on"));
    room.window.get_by_label("Mend everything").click_accesskit();
    room.run(2);
    assert!(!room.says("faults on"));
    assert_eq!(from_board_two(&mut source), 10);
}
