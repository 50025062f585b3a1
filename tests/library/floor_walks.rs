//! Walks for setting up a floor: from board to board, and over every tile.

use underfoot::floor::{Corner, Floor, SensorId, TileId};
use underfoot::glam::Vec2;
use underfoot::serve::{SensorVerdict, WalkTest, WiringTask, WiringWalk};
use underfoot::units::Instant;
use underfoot::wire::SensorPacket;
use underfoot_sim::{Foot, SensorFault, SimFloor};

use crate::sender::{simulated, small_floor, standing};

/// Advances by `ms` milliseconds with `feet` on the floor, and passes the boards' packets to `take`.
fn pass(sim: &mut SimFloor, ms: u32, feet: &[Foot], mut take: impl FnMut(&SensorPacket)) {
    for sequence in 0..ms {
        for (board, readings) in (0..).zip(sim.step(feet)) {
            let (received, readings) = (Instant::START, readings.clone());
            take(&SensorPacket { board, sequence, received, readings });
        }
    }
}

fn middle(floor: &Floor, tile: TileId) -> Vec2 {
    floor.geometry.plate(tile).centre()
}

/// The packet as it arrives if the boards' cables are connected by `wires`: the place of each.
fn rewired(packet: &SensorPacket, wires: [u16; 2]) -> SensorPacket {
    SensorPacket { board: wires[usize::from(packet.board)], ..packet.clone() }
}

/// Follows the walk's tasks; with `astray`, steps on the first tile each time.
fn walk(wires: [u16; 2], astray: bool) -> (WiringWalk, Floor) {
    let floor = small_floor();
    let mut sim = simulated(&floor);
    let mut walk = WiringWalk::new(&floor);
    for _ in 0..40 {
        let feet = match walk.task() {
            WiringTask::Step(_) if astray => vec![standing(middle(&floor, TileId::new(0, 0)))],
            WiringTask::Step(tile) => vec![standing(middle(&floor, tile))],
            WiringTask::KeepOff | WiringTask::StepOff => Vec::new(),
            WiringTask::Nothing => break,
        };
        pass(&mut sim, 350, &feet, |packet| {
            walk.take(&rewired(packet, wires));
        });
    }
    (walk, floor)
}

#[test]
fn boards_that_are_where_they_should_be_are_found_there() {
    let (walk, floor) = walk([0, 1], false);
    assert_eq!((walk.steps().len(), walk.length()), (2, 2));
    let found = walk.outcome(&floor).unwrap().unwrap();
    assert!(found.moved.is_empty() && found.floor == floor);
}

#[test]
fn boards_that_have_changed_places_get_each_others_addresses() {
    let (walk, floor) = walk([1, 0], false);
    assert_eq!(walk.steps()[0].tile, TileId::new(0, 0));
    let found = walk.outcome(&floor).unwrap().unwrap();
    assert_eq!(found.moved, [(0, 1), (1, 0)]);
    assert_eq!(found.floor.boards[0].address, floor.boards[1].address);
    assert_eq!(found.floor.boards[1].address, floor.boards[0].address);
}

#[test]
fn who_steps_on_the_same_tile_each_time_is_told_so() {
    let (walk, floor) = walk([0, 1], true);
    assert!(walk.outcome(&floor).unwrap().is_err());
}

#[test]
fn nothing_is_asked_before_every_board_has_been_heard_and_silent_ones_are_named() {
    let floor = small_floor();
    let (mut sim, mut walk) = (simulated(&floor), WiringWalk::new(&floor));
    let only_first = |packet: &SensorPacket, walk: &mut WiringWalk| {
        if packet.board == 0 {
            walk.take(packet);
        }
    };
    pass(&mut sim, 1000, &[], |packet| only_first(packet, &mut walk));
    assert_eq!((walk.task(), walk.unheard().collect::<Vec<_>>()), (WiringTask::KeepOff, vec![1]));
    assert!(walk.felt().is_none() && walk.outcome(&floor).is_none());
    pass(&mut sim, 400, &[], |packet| {
        walk.take(packet);
    });
    assert_eq!(walk.task(), WiringTask::Step(TileId::new(0, 0)));
    // A light touch is not a step, but is shown.
    let mut light = standing(middle(&floor, TileId::new(2, 1)));
    light.force.0 = 90.0;
    pass(&mut sim, 400, &[light], |packet| {
        walk.take(packet);
    });
    assert_eq!(walk.task(), WiringTask::Step(TileId::new(0, 0)));
    assert_eq!(walk.felt().map(|felt| felt.tile), Some(TileId::new(2, 1)));
}

/// Steps on each tile, near its middle and near two of its corners.
fn walk_over(sim: &mut SimFloor, floor: &Floor, test: &mut WalkTest) {
    pass(sim, 400, &[], |packet| test.take(packet));
    for index in 0..floor.geometry.tile_count() {
        let at = middle(floor, floor.geometry.tile_at_index(index));
        for off in [
            Vec2::ZERO,
            Vec2::new(0.06, 0.06),
            Vec2::new(-0.06, -0.06),
            Vec2::new(0.06, -0.06),
            Vec2::new(-0.06, 0.06),
        ] {
            pass(sim, 250, &[Foot { length_m: 0.1, ..standing(at + off) }], |packet| test.take(packet));
            pass(sim, 50, &[], |packet| test.take(packet));
        }
    }
}

#[test]
fn every_tile_of_a_good_floor_turns_green_and_not_before_it_is_stepped_on() {
    let floor = small_floor();
    let (mut sim, mut test) = (simulated(&floor), WalkTest::new(&floor));
    pass(&mut sim, 400, &[], |packet| test.take(packet));
    assert!(test.is_rested() && !test.is_done());
    assert_eq!((test.passed(), test.tile(0)), (0, Some([SensorVerdict::Untried; 4])));
    pass(&mut sim, 300, &[standing(middle(&floor, TileId::new(0, 0)))], |packet| test.take(packet));
    assert_eq!(test.tile(0), Some([SensorVerdict::Answers; 4]));
    assert_eq!(test.tile(5), Some([SensorVerdict::Untried; 4]));
    let (mut sim, mut test) = (simulated(&floor), WalkTest::new(&floor));
    walk_over(&mut sim, &floor, &mut test);
    assert_eq!((test.passed(), test.is_done(), test.faults().count()), (6, true, 0));
}

#[test]
fn a_sensor_that_does_not_answer_is_named_and_no_other() {
    let floor = small_floor();
    let broken = SensorId { tile: TileId::new(1, 1), corner: Corner::NorthWest };
    for fault in [SensorFault::Open, SensorFault::Short, SensorFault::Stuck] {
        let (mut sim, mut test) = (simulated(&floor), WalkTest::new(&floor));
        sim.set_fault(broken, Some(fault));
        walk_over(&mut sim, &floor, &mut test);
        let faults: Vec<_> = test.faults().collect();
        assert_eq!(faults, [(broken, SensorVerdict::Still)], "{fault:?}");
        assert_eq!((test.passed(), test.is_done()), (5, true), "{fault:?}");
    }
}

#[test]
fn packets_of_other_floors_change_nothing() {
    let (floor, other) = (small_floor(), Floor::default());
    let (mut test, mut walk) = (WalkTest::new(&floor), WiringWalk::new(&floor));
    let mut sim = SimFloor::new(&other, underfoot_sim::SimConfig::default(), 3);
    pass(&mut sim, 400, &[], |packet| {
        test.take(packet);
        walk.take(packet);
    });
    assert!(!test.is_rested() && walk.task() == WiringTask::KeepOff);
}
