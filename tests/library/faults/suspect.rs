//! S6 loads without a cause, S9 an uncalibrated floor, S11 feet that one tile cannot separate.

use underfoot::floor::{Corner, Floor, Geometry, SensorId, TileId};
use underfoot::glam::Vec2;
use underfoot::sense::{Quality, Trouble};
use underfoot::units::Newtons;
use underfoot::widget::{EventKind, OffReason};
use underfoot_sim::{SensorFault, SimConfig, SimFloor, SimulatedSensors};

use super::bench::{BUTTON, Bench, foot};
use super::desk::{at_the_map, clicks, quality, sensor, tile_of, trouble};

#[test]
fn s6_fifty_newtons_out_of_nowhere_are_suspect_at_once_and_press_nothing() {
    for newtons in [50.0, 150.0, -30.0] {
        for corner in Corner::ALL {
            let mut walker = at_the_map();
            let part = sensor(tile_of(&walker, "home"), corner);
            walker.sim.set_fault(part, Some(SensorFault::Offset(Newtons(newtons))));
            walker.wait(3);
            assert!(quality(&walker, part) >= Quality::Degraded, "{newtons} N at once");
            walker.wait(1000);
            assert_eq!(walker.take_events(), [], "{newtons} N on {corner:?}");
            assert!(trouble(&walker, part).is_some());
            assert!(clicks(&mut walker, "home"), "a foot is plausible, {newtons} N on {corner:?} or not");
            walker.sim.set_fault(part, None);
            walker.wait(1500);
            assert_eq!(quality(&walker, part), Quality::Live, "gone as it came");
        }
    }
}

#[test]
fn s6_without_a_dwell_to_wait_for_it_presses_nothing_either() {
    let mut bench = Bench::new(SimulatedSensors::default());
    bench.hasten();
    let part = SensorId { tile: TileId::new(0, 0), corner: Corner::NorthEast };
    bench.sim.set_fault(part, Some(SensorFault::Offset(Newtons(90.0))));
    bench.run(2);
    let found: Vec<_> = bench.assembler.troubles().collect();
    assert_eq!(found, [(part, Trouble::Offset)]);
    bench.run(3000);
    assert_eq!(bench.events, []);
}

#[test]
fn s9_a_floor_nobody_calibrated_starts_degraded_and_runs_nothing_that_must_be_held() {
    let floor = Floor::of(Geometry::of_paper_tiles(2, 2).unwrap());
    assert_eq!(floor.uncalibrated().count(), 16);
    let sim = SimFloor::new(&floor, SimConfig::default(), 3);
    // Tared, but with nominal gains for parts that deviate by a quarter.
    let mut tared = floor.clone();
    for (tare, tile) in tared.tare.iter_mut().zip(0..) {
        *tare = sim.support_forces(tile).unwrap();
    }
    let mut bench = Bench::with_floor(&tared, sim.clone());
    for corner in Corner::ALL {
        let quality = bench.quality(SensorId { tile: TileId::new(1, 0), corner });
        assert_eq!(quality, Quality::Degraded);
    }
    assert_eq!(bench.assembler.uncalibrated(), 16);
    bench.press(BUTTON, 150.0);
    bench.run(100);
    bench.lift(BUTTON);
    bench.run(100);
    assert_eq!(bench.events.first(), Some(&EventKind::Pressed), "what does no harm works");
    // A dead man's pedal in the same place, with a foot that would hold it.
    let hold = |bench: &mut Bench| {
        bench.run_pedal();
        bench.events.clear();
        bench.press(BUTTON, 150.0);
        bench.run(1000);
    };
    hold(&mut bench);
    let state = bench.snapshot().widgets[0];
    assert!(bench.events.is_empty() && !state.pressed, "{:?}, {state:?}", bench.events);
    assert_eq!(state.off, Some(OffReason::NotCalibrated));
    bench.engine.set_enabled("it", true).unwrap();
    bench.lift(BUTTON);
    bench.press(BUTTON, 150.0);
    bench.run(1000);
    assert_eq!(bench.events, [], "no app can switch it on");
    // The same floor, calibrated.
    let measured = underfoot_sim::calibrated(&floor, &sim, 3).unwrap();
    assert_eq!(measured.uncalibrated().count(), 0);
    let mut bench = Bench::with_floor(&measured, sim);
    hold(&mut bench);
    let state = bench.snapshot().widgets[0];
    assert!(state.pressed && state.off.is_none(), "{state:?}");
    assert_eq!(bench.assembler.uncalibrated(), 0);
    assert_eq!(bench.quality(SensorId { tile: TileId::new(1, 0), corner: Corner::SouthEast }), Quality::Live);
}

#[test]
fn s11_two_feet_on_one_tile_do_not_make_the_cursor_flicker() {
    let mut bench = Bench::new(SimulatedSensors::default());
    // Side by side on the south-west tile, each swaying by a twentieth against the other.
    let (left, right) = (BUTTON - Vec2::new(0.06, 0.0), BUTTON + Vec2::new(0.06, 0.0));
    for step in 1..=200_u8 {
        bench.feet = vec![foot(left, 350.0 * f32::from(step) / 200.0)];
        bench.run(2);
    }
    bench.run(500);
    let mut changes = 0;
    let mut last = None;
    for ms in 0..10_000_u32 {
        let sway = 0.05 * (ms as f32 * 0.006).sin();
        let landed = (ms as f32 / 100.0).min(1.0);
        bench.feet = vec![foot(left, 350.0 * (1.0 + sway)), foot(right, 350.0 * (1.0 - sway) * landed)];
        bench.run(1);
        let cursor = bench.snapshot().cursors[0].map(|cursor| cursor.contact);
        changes += u32::from(last.is_some() && cursor != last);
        last = cursor;
    }
    println!("two feet on one tile: {changes} changes of the cursor in 10 s");
    assert!(changes <= 10, "{changes} changes in 10 s");
}

#[test]
fn s11_a_foot_over_four_tiles_is_one_contact_within_its_stated_bound() {
    let mut worst: f32 = 0.0;
    for step in 0..25_u8 {
        let mut bench = Bench::new(SimulatedSensors::default());
        let at = Vec2::splat(0.304) + Vec2::new(f32::from(step % 5), f32::from(step / 5)) * 0.01 - 0.02;
        bench.press(at, 400.0);
        bench.run(100);
        let contacts = bench.contacts();
        assert_eq!(contacts.len(), 1, "at {at}: {contacts:?}");
        worst = worst.max(contacts[0].centroid.distance(at));
    }
    println!("a foot over four tiles: at worst {worst:.3} m off");
    assert!(worst < 0.05, "{worst} m: more than the paper's bound near edges");
}
