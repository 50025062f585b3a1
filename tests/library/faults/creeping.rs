//! S4 a zero that drifts, S5 creep under a standing person.

use underfoot::floor::{Corner, SensorId, TileId};
use underfoot::sense::Trouble;
use underfoot::units::Newtons;
use underfoot::widget::EventKind;
use underfoot_sim::{PartConfig, SensorFault, SimulatedSensors};

use super::bench::{BUTTON, Bench};

const TILE: TileId = TileId::new(0, 0);

/// Drift of `total` newtons over `seconds` on the corners given.
fn drift(bench: &mut Bench, corners: &[Corner], total: f32, seconds: u64) {
    for tenth in 0..seconds * 10 {
        let offset = Newtons(total * tenth as f32 / (seconds * 10) as f32);
        for &corner in corners {
            bench.sim.set_fault(SensorId { tile: TILE, corner }, Some(SensorFault::Offset(offset)));
        }
        bench.run(100);
    }
}

#[test]
fn s4_drift_on_an_empty_floor_is_followed_and_presses_nothing() {
    for corners in [&Corner::ALL[..1], &Corner::ALL[..]] {
        let mut bench = Bench::new(SimulatedSensors::default());
        drift(&mut bench, corners, 10.0, 600);
        assert_eq!(bench.events, []);
        let forces = bench.snapshot().tiles[0].forces;
        assert!(forces.iter().all(|force| force.abs() < 1.0), "10 N away, now {forces:?}");
        assert_eq!(bench.assembler.troubles().count(), 0);
        let fastest = bench.assembler.drift().flatten().map(|zero| zero.0).fold(0.0, f32::max);
        assert!(fastest <= 10.1, "one newton a minute at most: {fastest} N");
    }
}

#[test]
fn what_a_tare_leaves_is_gone_in_a_second_and_what_rests_there_is_not() {
    let mut bench = Bench::new(SimulatedSensors::default());
    let off = |bench: &mut Bench, offsets: [f32; 4]| {
        for (corner, offset) in Corner::ALL.into_iter().zip(offsets) {
            let fault = SensorFault::Offset(Newtons(offset));
            bench.sim.set_fault(SensorId { tile: TILE, corner }, Some(fault));
        }
        bench.run(1000);
        bench.snapshot().tiles[0].forces
    };
    let tared = off(&mut bench, [0.6, -0.5, 0.4, 0.8]);
    assert!(tared.iter().all(|force| force.abs() < 0.1), "{tared:?}");
    // A light thing on one corner: the tare absorbs only a newton of it.
    let laid = off(&mut bench, [2.6, -0.5, 0.4, 0.8]);
    assert!(laid[0] > 1.2, "{laid:?}");
    assert_eq!(bench.events, []);
}

#[test]
fn s4_drift_too_fast_to_follow_presses_nothing_either() {
    let mut bench = Bench::new(SimulatedSensors::default());
    // The whole tile by 30 N a corner, twice the force of a press, in five minutes.
    drift(&mut bench, &Corner::ALL, 30.0, 300);
    assert_eq!(bench.events, []);
}

#[test]
fn s5_a_foot_that_stands_and_creeps_is_neither_lost_nor_gained_nor_zeroed() {
    // Parts with a known law, so that only the creep crosses the threshold.
    let parts = PartConfig { creep: 0.05, deviation: 0.0, ..PartConfig::default() };
    let mut bench = Bench::tared_at_start(SimulatedSensors::Counts(parts));
    // Below the threshold of 60 N at first, above it after some minutes of creep.
    bench.press(BUTTON, 52.0);
    bench.stay(BUTTON, 52.0, 600, |_, _, _| {});
    let force: f32 = bench.contacts().iter().map(|contact| contact.force.0).sum();
    assert!(force > 60.0, "or nothing is shown: {force} N");
    assert_eq!(bench.events, [], "gained");
    assert!(bench.assembler.drift().flatten().all(|zero| zero.0.abs() < 0.5), "zeroed");
    // Pressed well above it, it is kept and then released by the lift.
    bench.press(BUTTON, 150.0);
    bench.run(60);
    assert_eq!(bench.events, [EventKind::Pressed]);
    bench.stay(BUTTON, 150.0, 300, |_, _, _| {});
    assert_eq!(bench.events, [EventKind::Pressed], "lost");
    bench.lift(BUTTON);
    bench.run(200);
    assert_eq!(bench.events, [EventKind::Pressed, EventKind::Released, EventKind::Clicked]);
}

#[test]
fn s4_drift_beyond_a_fifth_of_the_range_is_a_trouble() {
    // For boards that send newtons, the range is the nominal 406 N: the limit is 81 N, 81 minutes away. To shorten
    // the test, it uses a sensor of 20 N.
    use underfoot::floor::{Calibration, Floor, Geometry};
    use underfoot_sim::{SimConfig, SimFloor};
    let mut floor = Floor::of(Geometry::of_paper_tiles(2, 2).unwrap());
    let weak = Calibration::exponential(0.5, 0.738);
    floor.calibration.fill([weak; 4]);
    let sim = SimFloor::new(&floor, SimConfig::ideal(), 3);
    let mut bench = Bench::with_floor(&floor, sim);
    bench.run_with(360_000, |ms, channel, force| {
        if channel == (0, 0) {
            *force += 6.0 * ms as f32 / 360_000.0;
        }
    });
    let found: Vec<_> = bench.assembler.troubles().collect();
    assert_eq!(found, [(SensorId { tile: TILE, corner: Corner::SouthWest }, Trouble::Drifted)]);
    assert_eq!(bench.events, []);
}
