//! S1 to S12: sensors that break, drift or disagree, under feet.

use underfoot::floor::{Calibration, Corner};
use underfoot::glam::Vec2;
use underfoot::units::Newtons;
use underfoot::wire::{Readings, SensorPacket};
use underfoot_sim::{PartConfig, SensorFault, SimulatedSensors};

use super::tape::{BUTTON, CLICK, MIDDLE, PEDAL, Tape, foot};
use crate::end_to_end::{channels, underfoot};

/// Presses the middle of a tile like a working foot, with a varying force.
fn work(tape: &mut Tape) {
    for force in [250.0, 200.0, 250.0, 200.0] {
        tape.press(MIDDLE, force);
        tape.wait(500);
    }
    tape.lift(MIDDLE);
    tape.wait(300);
}

#[test]
fn s1_a_stuck_sensor_is_named_under_a_foot_and_its_tile_still_presses() {
    let mut tape = Tape::on(BUTTON);
    tape.set_fault(Corner::SouthEast, Some(SensorFault::Stuck));
    tape.wait(2000);
    work(&mut tape);
    tape.tap();
    let played = tape.play();
    assert_eq!(played.troubles(), [(Some("se".into()), "stuck".into())]);
    assert_eq!(played.events(), [CLICK, CLICK].concat());
}

#[test]
fn s2_a_stamp_beyond_the_range_presses_nothing_while_it_lasts_or_lightens() {
    // On the corner's sensor, which saturates at 400 N.
    let on_sensor = Vec2::splat(0.02);
    let stamped = |force: f32| {
        let mut tape = Tape::on(BUTTON);
        tape.press(on_sensor, force);
        tape.wait(200);
        tape.press(on_sensor, 100.0);
        tape.wait(300);
        tape.lift(on_sensor);
        tape.wait(1500);
        let over = tape.seconds();
        tape.tap();
        (tape.play(), over)
    };
    let (played, over) = stamped(3000.0);
    assert_eq!(played.events(), CLICK, "the tap behind it");
    assert!(played.time_of("it pressed").unwrap() > over);
    assert_eq!(stamped(200.0).0.events(), [CLICK, CLICK].concat(), "in its range it would have pressed");
}

/// Parts that end at 123 N.
fn weak() -> SimulatedSensors {
    let nominal = Calibration::exponential(0.5, 1.1);
    SimulatedSensors::Counts(PartConfig { nominal, ..PartConfig::default() })
}

#[test]
fn s2_a_sensor_that_saturates_under_a_press_keeps_it() {
    let mut tape = Tape::on_parts(BUTTON, weak(), true);
    // Beside a sensor, which carries more than half of it: 50 N at first, then 180.
    let at = Vec2::splat(0.06);
    tape.press(at, 80.0);
    tape.wait(100);
    for force in (100_u16..=300).step_by(20).chain((100..300).rev().step_by(20)) {
        tape.press(at, force.into());
        tape.wait(20);
    }
    let lifted = tape.seconds();
    tape.lift(at);
    tape.wait(300);
    let played = tape.play();
    assert_eq!(played.events(), CLICK);
    assert!(played.time_of("it released").unwrap() > lifted);
}

#[test]
fn s3_circuits_that_open_or_short_are_named_at_once_and_press_nothing() {
    for (fault, name) in [(SensorFault::Open, "open"), (SensorFault::Short, "short")] {
        let mut tape = Tape::on(BUTTON);
        tape.set_fault(Corner::NorthEast, Some(fault));
        tape.wait(1000);
        let broken = tape.seconds();
        tape.tap();
        let played = tape.play();
        assert_eq!(played.troubles(), [(Some("ne".into()), name.into())]);
        assert_eq!(played.events(), CLICK, "{name}: three sensors are enough");
        assert!(played.time_of("it pressed").unwrap() > broken);
    }
}

/// Ten newtons in ten minutes is a newton a minute; here are two minutes of it, and a tap.
#[test]
fn s4_a_zero_that_drifts_presses_nothing_and_shows_no_foot() {
    let mut tape = Tape::on(BUTTON);
    for tenth in 0..1200_u16 {
        let offset = Newtons(f32::from(tenth) / 600.0);
        Corner::ALL.iter().for_each(|&corner| tape.set_fault(corner, Some(SensorFault::Offset(offset))));
        tape.wait(100);
    }
    let drifted = tape.seconds();
    tape.tap();
    let played = tape.play();
    assert!(played.contacts(0.0, drifted).iter().all(Vec::is_empty), "8 N in all, and nobody");
    assert_eq!((played.events(), played.troubles()), (CLICK.map(String::from).into(), vec![]));
}

#[test]
fn s5_parts_that_creep_under_a_standing_foot_gain_no_press_and_lose_none() {
    let parts = PartConfig { creep: 0.05, deviation: 0.0, ..PartConfig::default() };
    let mut tape = Tape::on_parts(BUTTON, SimulatedSensors::Counts(parts), true);
    // A minute below the press threshold (60 N), a minute far above.
    tape.press(MIDDLE, 50.0);
    tape.stay(MIDDLE, 50.0, 60);
    let light = tape.seconds();
    tape.press(MIDDLE, 150.0);
    tape.stay(MIDDLE, 150.0, 60);
    let lifted = tape.seconds();
    tape.lift(MIDDLE);
    tape.wait(300);
    let played = tape.play();
    assert_eq!(played.events(), CLICK);
    assert!(played.time_of("it pressed").unwrap() >= light, "none gained");
    assert!(played.time_of("it released").unwrap() > lifted, "none lost");
}

#[test]
fn s6_a_load_out_of_nowhere_presses_nothing() {
    let mut tape = Tape::on(&BUTTON.replace("size: (1, 1))", "size: (1, 1), dwell_ms: 0)"));
    tape.set_fault(Corner::SouthWest, Some(SensorFault::Offset(Newtons(80.0))));
    tape.wait(2000);
    tape.set_fault(Corner::SouthWest, None);
    tape.wait(2000);
    let before = tape.seconds();
    tape.tap();
    let played = tape.play();
    assert_eq!(played.events(), CLICK, "the tap of somebody, afterwards");
    assert!(played.time_of("it pressed").unwrap() > before);
}

/// 50 Hz of 5 N on every sensor, for a minute of which a foot stands for half.
#[test]
fn s7_hum_makes_no_event_of_its_own() {
    let mut tape = Tape::on_parts(BUTTON, SimulatedSensors::Newtons(PartConfig::default()), true);
    let mut hum = |ms: u64, mut packet: SensorPacket| {
        let hum = 5.0 * (ms as f32 * 0.05 * std::f32::consts::TAU).sin();
        if let Readings::Newtons(forces) = &mut packet.readings {
            forces.iter_mut().for_each(|force| *force += hum);
        }
        Some(packet)
    };
    tape.wait_while(30_000, &mut hum);
    for step in 1..=40_u8 {
        tape.feet = vec![foot(MIDDLE, 3.0 * f32::from(step))];
        tape.wait_while(1, |_, packet| hum(step.into(), packet));
    }
    tape.wait_while(30_000, &mut hum);
    let lifted = tape.seconds();
    tape.feet.clear();
    tape.wait_while(300, &mut hum);
    let played = tape.play();
    assert_eq!(played.events(), CLICK);
    assert!(played.time_of("it released").unwrap() > lifted);
}

/// The click that the program plays for a press, on the sensors of its own tile: a tenth of the actuator's 40 N on
/// each.
#[test]
fn s8_a_click_that_its_own_sensors_feel_triggers_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let wav = folder.path().join("click.wav");
    let output = underfoot().args(["feel", "crisp_click", "--wav"]).arg(&wav).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let (rate, samples) = channels(&wav);
    let click: Vec<f32> =
        samples[0].iter().step_by(rate as usize / 1000).map(|sample| sample * 4.0).collect();
    let peak = click.iter().fold(0.0_f32, |most, force| most.max(force.abs()));
    assert!(peak > 0.2, "or nothing is shown: {peak} N per sensor");

    let tapped = |coupled: &[f32]| {
        let mut tape = Tape::on_parts(BUTTON, SimulatedSensors::Newtons(PartConfig::default()), true);
        tape.wait(500);
        tape.press(MIDDLE, 75.0);
        // Pressed after 20 ms above 60 N: the click begins with the press as the program detects it.
        tape.wait_while(1000, |ms, mut packet| {
            if let (0, Readings::Newtons(forces)) = (packet.board, &mut packet.readings) {
                let felt = coupled.get(ms as usize).copied().unwrap_or_default();
                forces.iter_mut().take(4).for_each(|force| *force += felt);
            }
            Some(packet)
        });
        tape.lift(MIDDLE);
        tape.wait(500);
        tape.play()
    };
    let (alone, coupled) = (tapped(&[]), tapped(&click));
    assert_eq!(alone.events(), CLICK);
    assert_eq!(coupled.events(), CLICK);
    assert_eq!(alone.time_of("it pressed"), coupled.time_of("it pressed"));
}

#[test]
fn s9_a_floor_without_calibration_runs_nothing_that_must_be_held_and_says_so() {
    let tapped = |page: &str, is_calibrated| {
        let mut tape = Tape::on_parts(page, SimulatedSensors::default(), is_calibrated);
        tape.wait(2000);
        tape.press(MIDDLE, 150.0);
        tape.wait(1000);
        tape.lift(MIDDLE);
        tape.wait(300);
        tape.play()
    };
    let pedal = tapped(PEDAL, false);
    assert_eq!(pedal.events(), Vec::<String>::new());
    assert_eq!(pedal.most("uncalibrated"), 16, "all sensors of the floor");
    assert_eq!(tapped(PEDAL, true).events(), ["it pressed", "it released"], "calibrated, it runs");
    assert_eq!(tapped(BUTTON, false).events(), CLICK, "a button may be pressed all the same");
}

#[test]
fn s10_an_object_left_on_a_control_presses_nothing_and_is_let_go_of() {
    let mut tape = Tape::on(BUTTON);
    tape.press(MIDDLE, 100.0);
    tape.wait(63_000);
    tape.lift(MIDDLE);
    tape.wait(300);
    tape.tap();
    let played = tape.play();
    assert_eq!(played.events(), [&["it pressed", "it cancelled"][..], &CLICK].concat());
    let cancelled = played.time_of("it cancelled").unwrap();
    assert!((59.0..63.0).contains(&cancelled), "after a minute: {cancelled} s");
}

#[test]
fn s11_a_foot_over_four_tiles_is_one_contact_within_five_centimetres() {
    let mut tape = Tape::on(BUTTON);
    let mut places = Vec::new();
    for step in 0..9_u8 {
        let at = Vec2::splat(0.304) + Vec2::new(f32::from(step % 3), f32::from(step / 3)) * 0.02 - 0.02;
        tape.press(at, 400.0);
        tape.wait(200);
        let from = tape.seconds();
        tape.wait(200);
        places.push((at, from, tape.seconds()));
        tape.lift(at);
        tape.wait(300);
    }
    let played = tape.play();
    for (at, from, until) in places {
        let contacts = played.contacts(from, until);
        assert!(contacts.len() > 10, "{contacts:?}");
        for found in contacts {
            assert!(matches!(found[..], [one] if one.distance(at) < 0.05), "at {at}: {found:?}");
        }
    }
}

/// A button with the guard Confirm in its own region: the other foot, which carries more, stands outside.
const CONFIRMED: &str = r#"Layout(version: 1, regions: [(id: "one", at: (0, 0), size: (1, 1))],
    widgets: [(id: "it", kind: "button", guard: Confirm, at: (0, 0), size: (1, 1))])"#;

/// Both feet leave the floor at once while one of them confirms.
#[test]
fn s12_somebody_who_jumps_confirms_nothing() {
    let confirmed = |jumps: bool| {
        let mut tape = Tape::on(CONFIRMED);
        let stance = foot(Vec2::new(0.46, 0.46), 500.0);
        let both = |tape: &mut Tape, standing: f32, working: f32| {
            let (before_standing, before_working) = (
                tape.feet.first().map_or(0.0, |foot| foot.force.0),
                tape.feet.get(1).map_or(0.0, |foot| foot.force.0),
            );
            for step in 1..=40_u8 {
                let share = f32::from(step) / 40.0;
                let between = |from: f32, to: f32| from + (to - from) * share;
                let mut standing_foot = stance;
                standing_foot.force = Newtons(between(before_standing, standing));
                tape.feet = vec![standing_foot, foot(MIDDLE, between(before_working, working))];
                tape.wait(1);
            }
        };
        both(&mut tape, 500.0, 0.0);
        tape.wait(3000);
        both(&mut tape, 500.0, 120.0);
        tape.wait(300);
        both(&mut tape, 500.0, 0.0);
        tape.wait(300);
        both(&mut tape, 500.0, 120.0);
        tape.wait(300);
        both(&mut tape, if jumps { 0.0 } else { 500.0 }, 0.0);
        tape.feet.truncate(usize::from(!jumps));
        tape.wait(500);
        tape.play().events()
    };
    let has = |events: &[String], what: &str| events.iter().any(|event| event == what);
    let (jumped, stayed) = (confirmed(true), confirmed(false));
    assert!(has(&stayed, "it clicked"), "{stayed:?}");
    assert!(!has(&jumped, "it clicked") && has(&jumped, "it cancelled"), "{jumped:?}");
}

#[test]
fn s2_parts_too_weak_for_feet_press_nothing_by_themselves() {
    let mut tape = Tape::on_parts(BUTTON, weak(), true);
    // On the other tiles, which have no control.
    for at in [Vec2::new(0.456, 0.152), Vec2::new(0.456, 0.456), Vec2::new(0.152, 0.456)] {
        tape.press(at, 700.0);
        tape.wait(600);
        tape.lift(at);
        tape.wait(200);
    }
    assert_eq!(tape.play().events(), Vec::<String>::new());
}
