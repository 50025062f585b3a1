//! N1 to N8 and N12: packets that are lost, doubled, late or out of order, boards that restart, crystals that drift.
//!
//! Most run `underfoot session`, which senses a simulated floor through its raw packets in the floor's own time.

use std::time::Duration;

use serde_json::Value;
use underfoot::widget::EventKind;
use underfoot::wire::SensorPacket;

use super::session::session;
use super::tape::{self, BUTTON, CLICK, MIDDLE, PEDAL, Tape};

const PAGE: &str = r#"Layout(version: 1, regions: [(id: "page", at: (0, 2), size: (6, 4))], widgets: [
    (id: "drive", kind: "dead_man", at: (0.2, 2.2), size: (0.9, 0.9)),
    (id: "home", kind: "button", at: (2.2, 2.2), size: (0.9, 0.9)),
])"#;

/// A person holds `drive` for two seconds, from second 4.9 on, and then presses `home`.
const VISIT: &str = r#"Scenario(title: "Drive, then home", person: (mass_kg: 70, foot_m: 0.27), steps: [
    Wait(ms: 1200), Enter(from: South, at: (2.2, 0.5)), Press(widget: "drive", force_n: 140, hold_ms: 2000),
    Wait(ms: 500), Press(widget: "home", force_n: 140, hold_ms: 350), Wait(ms: 1200),
])"#;

/// Events of that visit without faults.
const WELL: [&str; 5] = ["drive pressed", "drive released", "home pressed", "home released", "home clicked"];

/// The floor's reports when that visit meets these faults.
fn visit(faults: &[&str]) -> Vec<Value> {
    let options: Vec<&str> = faults.iter().flat_map(|fault| ["--fault", fault]).collect();
    session(PAGE, VISIT, &options)
}

/// The greatest number of sensors that a line counts as degraded.
fn degraded(lines: &[Value]) -> u64 {
    lines.iter().filter_map(|line| line["degraded"].as_u64()).max().unwrap_or_default()
}

/// The time of the first such event, in seconds.
fn time_of(lines: &[Value], id: &str, event: EventKind) -> f64 {
    let line = lines.iter().find(|line| line["id"] == id && line["event"] == event.name());
    line.unwrap_or_else(|| panic!("no {event:?} of {id}: {lines:?}"))["t_s"].as_f64().unwrap()
}

#[test]
fn n1_random_losses_change_nothing_of_what_a_person_does() {
    for (faults, are_degraded) in [("loss=1%", false), ("loss=5%", false), ("loss=20%", true)] {
        let lines = visit(&[faults]);
        assert_eq!(tape::events(&lines), WELL, "{faults}");
        assert_eq!(degraded(&lines) > 0, are_degraded, "{faults}");
    }
}

#[test]
fn n2_bursts_of_up_to_90_ms_are_held_through() {
    for faults in ["bursts=1s:20ms", "bursts=1s:50ms", "bursts=1s:90ms"] {
        assert_eq!(tape::events(&visit(&[faults])), WELL, "{faults}");
    }
}

#[test]
fn n4_packets_that_overtake_each_other_change_nothing() {
    assert_eq!(tape::events(&visit(&["delay=30%:8ms"])), WELL);
}

#[test]
fn n5_packets_that_come_twice_count_once() {
    let (once, twice) = (visit(&[]), visit(&["duplicate=100%"]));
    assert_eq!(tape::events(&once), WELL);
    assert_eq!(once, twice, "to the digit");
}

#[test]
fn n6_a_sequence_number_that_wraps_leaves_no_trace() {
    let tapped = |sequence: u32| {
        let mut tape = Tape::on(BUTTON);
        tape.sequence = sequence;
        // Boards that have just started are accepted first.
        tape.wait(3000);
        tape.tap();
        let pressed = tape.seconds();
        tape.tap();
        (tape.play().events(), pressed)
    };
    let (plain, _) = tapped(5000);
    // It wraps in the middle of the first press.
    let (wrapped, _) = tapped(u32::MAX - 3000 - 140);
    assert_eq!(plain, [CLICK, CLICK].concat());
    assert_eq!(wrapped, plain);
}

#[test]
fn n6_after_a_reboot_a_loaded_control_must_first_be_seen_unloaded() {
    let mut tape = Tape::on(PEDAL);
    tape.wait(500);
    tape.press(MIDDLE, 150.0);
    tape.wait(1000);
    tape.sequence = 0;
    tape.wait(3000);
    tape.lift(MIDDLE);
    tape.wait(500);
    let lifted = tape.seconds();
    tape.press(MIDDLE, 150.0);
    tape.wait(1000);
    tape.lift(MIDDLE);
    tape.wait(200);
    let played = tape.play();
    assert_eq!(played.events(), ["it pressed", "it cancelled", "it pressed", "it released"]);
    let pressed = played.lines.iter().rfind(|line| line["event"] == "pressed").unwrap();
    assert!(pressed["t_s"].as_f64().unwrap() > lifted, "{pressed}");
}

#[test]
fn n7_packets_held_back_for_200_ms_cancel_what_is_held_and_press_nothing_old() {
    let lines = visit(&["stall=5.5s..5.7s"]);
    let ended = ["drive pressed", "drive cancelled", "home pressed", "home released", "home clicked"];
    assert_eq!(tape::events(&lines), ended);
    let cancelled = time_of(&lines, "drive", EventKind::Cancelled);
    assert!((5.5..5.621).contains(&cancelled), "within 120 ms: {cancelled} s");
    // A press during the outage is not pressed afterwards either.
    let lines = visit(&["stall=4.7s..5.5s"]);
    assert_eq!(tape::events(&lines), &ended[2..]);
}

/// One board's crystal is fast by 200 ppm and the other's slow: 48 ms apart after two minutes.
#[test]
fn n8_crystals_that_run_fast_or_slow_change_nothing() {
    let mut tape = Tape::on(BUTTON);
    let drifted = |packets: &mut Tape, millis: u64, begun: u64| {
        packets.wait_while(millis, |ms, packet| {
            let drift = (begun + ms) / 5;
            let early_or_late = Duration::from_micros(drift);
            let received = match packet.board {
                0 => packet.received + early_or_late,
                _ => packet.received.before(early_or_late),
            };
            Some(SensorPacket { received, ..packet })
        });
    };
    drifted(&mut tape, 120_000, 0);
    for step in 1..=40_u8 {
        tape.feet = vec![tape::foot(MIDDLE, 3.0 * f32::from(step))];
        drifted(&mut tape, 1, 120_000);
    }
    drifted(&mut tape, 300, 120_000);
    tape.feet.clear();
    drifted(&mut tape, 500, 120_300);
    let played = tape.play();
    assert_eq!(played.events(), CLICK);
    assert!(!played.lines.iter().any(|line| line["state"] == "lost" || line["state"] == "partial"));
}

/// No packet comes for 150 ms of every 500.
#[test]
fn n12_a_flapping_link_presses_nothing_until_it_has_been_clean_for_a_second() {
    let mut tape = Tape::on(BUTTON);
    tape.wait(1000);
    let flaps = |ms: u64, packet: SensorPacket| (ms % 500 >= 150).then_some(packet);
    tape.wait_while(1500, flaps);
    for step in 1..=40_u8 {
        tape.feet = vec![tape::foot(MIDDLE, 3.0 * f32::from(step))];
        tape.wait(1);
    }
    tape.wait_while(3000, flaps);
    let clean = tape.seconds();
    tape.lift(MIDDLE);
    tape.wait(1500);
    let steady = tape.seconds();
    tape.tap();
    let played = tape.play();
    assert_eq!(played.events(), CLICK, "after {steady} s, not before {clean} s");
    assert!(played.time_of("it pressed").unwrap() > steady);
    assert!(played.most("stale") > 0);
}
