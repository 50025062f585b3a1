//! S1 to S9 and S11 while a heavy foot stands beside a region and the other one taps and slides in it.
//!
//! The region is one button; each of a scene's six touches should press it once, and there should be no other press.

use underfoot::floor::{Geometry, SensorId};
use underfoot::sense::Trouble;
use underfoot_lab::experiment::{HeavyFoot, TapScene};
use underfoot_sim::SensorFault;

use super::scenes::{Break, Coupled, Tapped, offset, tapped, under_the_stance, under_the_taps};
use super::visits::{creeping, hum, newtons, nominal, plain, weak};

/// The people who tap, in both stances: 12 touches.
const PEOPLE: [u64; 1] = [1];
const TOUCHES: usize = 12;

/// Time at which sensors break: the person already stands there, but has not touched the region yet.
const STANDING_MS: u64 = 700;

type Place = fn(&TapScene, &Geometry) -> SensorId;

/// The sensors that are broken: one under the working foot, one under the standing foot.
const PLACES: [(&str, Place); 2] =
    [("under the taps", under_the_taps), ("under the stance", under_the_stance)];

/// Asserts that there is no press without a touch, that touches press once, and that at least `pressed` touches
/// press.
fn assert_pressed(what: &str, tapped: &Tapped, pressed: usize) {
    println!("{what}: {tapped}");
    let score = &tapped.score;
    assert_eq!((score.touches, score.out_of_nothing), (TOUCHES, 0), "{what}");
    assert!(score.pressed >= pressed, "{what}: {} of {TOUCHES} touches pressed", score.pressed);
    assert!(score.repeated <= 1, "{what}: {} pressed again", score.repeated);
    // At most once a second, and hardly ever without a reason.
    assert!(score.flips <= 2, "{what}: the cursor changed {} times during a touch", score.flips);
}

/// Breaks each place at each time, and passes the result to `check`.
fn broken(fault: SensorFault, check: impl Fn(&str, &Tapped)) {
    for (name, place) in PLACES {
        for from_ms in [1, STANDING_MS] {
            let broken = |scene: &TapScene, geometry: &Geometry| Break {
                sensor: place(scene, geometry),
                fault,
                from_ms,
                until_ms: u64::MAX,
            };
            check(&format!("{fault:?} {name} from {from_ms} ms on"), &tapped(PEOPLE, plain, broken));
        }
    }
}

#[test]
fn a_whole_floor_to_compare_with() {
    let tapped = tapped(PEOPLE, plain, |_, _| ());
    assert_pressed("whole", &tapped, TOUCHES);
    assert_eq!(tapped.troubles, []);
}

#[test]
fn s1_a_stuck_sensor() {
    broken(SensorFault::Stuck, |what, tapped| {
        // Before it is detected, a light touch beside it lacks the share of this sensor.
        assert_pressed(what, tapped, TOUCHES - 2);
        assert!(tapped.score.cursor.quantile(0.5).unwrap() < 0.02, "{what}");
    });
}

#[test]
fn s2_sensors_that_saturate_start_nothing_by_themselves() {
    let tapped = tapped(PEOPLE, weak, |_, _| ());
    // If the standing foot saturates the touched tile, no press may start.
    assert_pressed("weak parts", &tapped, TOUCHES - 4);
    assert_eq!(tapped.troubles, []);
    assert!(tapped.score.cursor.quantile(0.5).unwrap() < 0.02);
}

#[test]
fn s3_open_and_short_circuits() {
    broken(SensorFault::Open, |what, tapped| {
        assert_pressed(what, tapped, TOUCHES - 1);
        assert!(tapped.troubles.iter().all(|(_, trouble)| *trouble == Trouble::Open), "{what}");
    });
    broken(SensorFault::Short, |what, tapped| {
        // Under a standing foot a short circuit gives a lower bound: its tile starts no press until the foot lifts.
        assert_pressed(what, tapped, TOUCHES - 4);
    });
}

#[test]
fn s4_a_sensor_that_has_drifted_by_ten_newtons() {
    let mut rig = plain(PEOPLE[0]);
    let scene = TapScene::of(PEOPLE[0], HeavyFoot::Facing, rig.geometry()).unwrap();
    let part = under_the_taps(&scene, rig.geometry());
    for second in 0..600_u16 {
        rig.set_fault(part, Some(offset(f32::from(second) / 60.0)));
        rig.hold(1000, &[], |_| {});
    }
    let drifted = |_| rig.clone();
    let tapped = tapped(PEOPLE, drifted, |_, _| ());
    println!("drifted: {tapped}");
    assert_eq!((tapped.score.pressed, tapped.score.touches), (TOUCHES, TOUCHES));
    assert_eq!((tapped.score.out_of_nothing, tapped.score.repeated), (0, 0));
    assert_eq!(tapped.troubles, []);
}

#[test]
fn s5_parts_that_creep() {
    let tapped = tapped(PEOPLE, creeping, |_, _| ());
    assert_pressed("creeping", &tapped, TOUCHES);
    assert_eq!(tapped.troubles, []);
}

#[test]
fn s6_loads_out_of_nowhere() {
    for newtons in [50.0, 150.0, -30.0] {
        broken(offset(newtons), |what, tapped| {
            // Half a second of suspicion may suppress a touch or two.
            assert_pressed(what, tapped, TOUCHES - 2);
        });
    }
}

#[test]
fn s7_hum() {
    let mild = tapped(PEOPLE, newtons, |_, _| hum(1.0));
    assert_pressed("hum of 1 N", &mild, TOUCHES - 1);
    // Four times that hides touches of 30 N, but causes none.
    let bad = tapped(PEOPLE, newtons, |_, _| hum(4.0));
    println!("hum of 4 N: {bad}");
    assert_eq!(bad.score.out_of_nothing, 0);
}

#[test]
fn s8_actuators_felt_by_the_sensors() {
    let coupled = tapped(PEOPLE, newtons, |_, _| Coupled::new(0.1));
    assert_pressed("coupled", &coupled, TOUCHES);
    assert_eq!(coupled.score.repeated, 0);
}

#[test]
fn s9_a_floor_nobody_calibrated() {
    let tapped = tapped(PEOPLE, nominal, |_, _| ());
    assert_pressed("nominal", &tapped, TOUCHES - 2);
    assert_eq!(tapped.troubles, []);
}

#[test]
fn s11_both_feet_on_one_tile_or_on_four_do_not_make_the_cursor_flicker() {
    // A person facing the region without a gap has the toes on the touched tile.
    let tapped = tapped(3..7, plain, |_, _| ());
    println!("shared tiles: {tapped}");
    assert!(tapped.score.flips <= 1, "the cursor changed {} times during touches", tapped.score.flips);
    assert_eq!((tapped.score.out_of_nothing, tapped.score.repeated), (0, 0));
    assert!(tapped.score.pressed + 1 >= tapped.score.touches);
}
