//! A control that is off has a reason, in all cases.

use std::time::Duration;

use underfoot::engine::{Engine, Ignored, Snapshot};
use underfoot::floor::{Corner, Floor, FloorFile, Geometry, SensorId};
use underfoot::layout::Layout;
use underfoot::sense::{Assembler, CalibrationFault, ForceFrame, Method, Quality, Tare};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::OffReason;
use underfoot::wire::{Readings, SensorPacket};
use underfoot_sim::{self as sim, SensorFault, SimConfig, SimFloor};

use crate::support::{Walker, page};

/// Two controls that act while they are held, on separate tiles, and a button.
fn controls() -> Layout {
    page(
        r#"Layout(version: 1,
            regions: [(id: "left", at: (0, 2), size: (3, 4)), (id: "right", at: (3, 2), size: (3, 4))],
            stances: [(at: (2, 0), size: (2, 1))],
            widgets: [
                (id: "drive", kind: "dead_man", at: (2.1, 2.1), size: (0.8, 0.8)),
                (id: "beam", kind: "dead_man", at: (4.1, 2.1), size: (0.8, 0.8)),
                (id: "home", kind: "button", at: (1.1, 4.1), size: (0.8, 0.8)),
            ])"#,
    )
}

/// The reasons of these controls, in this order.
fn reasons(engine: &Engine, ids: [&str; 3]) -> [Option<OffReason>; 3] {
    let mut snapshot = Snapshot::default();
    engine.snapshot(&mut snapshot);
    ids.map(|id| {
        let state = engine.control_state(id).unwrap();
        let off = state.off.map(|off| off.reason);
        let shown = snapshot.widgets[engine.layout().widget_index(id).unwrap()].off;
        assert_eq!(off, shown, "{id}: state and snapshot say the same");
        assert_eq!(state.enabled, !off.is_some_and(OffReason::is_lasting), "{id}");
        off
    })
}

const ALL: [&str; 3] = ["drive", "beam", "home"];

#[test]
fn controls_that_feet_can_press_have_no_reason() {
    let mut walker = Walker::on(controls());
    assert_eq!(reasons(&walker.engine, ALL), [None; 3]);
    walker.stand(Newtons(600.0));
    walker.step_onto("drive", Newtons(150.0));
    // Time for a deliberate foot to settle, plus the dwell.
    walker.wait(600);
    assert!(walker.engine.control("drive").unwrap().is_engaged());
    assert_eq!(reasons(&walker.engine, ["drive", "home", "drive"]), [None; 3]);
}

#[test]
fn before_the_first_frame_the_floor_is_waited_for() {
    let engine = Engine::new(Geometry::default(), controls(), Method::default());
    assert_eq!(reasons(&engine, ALL), [Some(OffReason::Waiting); 3]);
}

#[test]
fn an_app_that_switches_a_control_off_is_the_reason() {
    let mut walker = Walker::on(controls());
    walker.engine.set_enabled("drive", false).unwrap();
    walker.engine.set_enabled("home", false).unwrap();
    let disabled = Some(OffReason::Disabled);
    assert_eq!(reasons(&walker.engine, ALL), [disabled, None, disabled]);
    walker.engine.set_enabled("drive", true).unwrap();
    walker.engine.set_enabled("home", true).unwrap();
    assert_eq!(reasons(&walker.engine, ALL), [None; 3]);
}

#[test]
fn boards_that_fall_silent_are_the_reason_until_they_are_heard_again() {
    let mut walker = Walker::on(controls());
    walker.connected = false;
    walker.wait(200);
    assert_eq!(reasons(&walker.engine, ALL), [Some(OffReason::LinkLost); 3]);
    walker.connected = true;
    walker.wait(200);
    assert_eq!(reasons(&walker.engine, ALL), [None; 3]);
}

#[test]
fn a_tile_with_two_broken_sensors_switches_its_own_controls_off() {
    let mut walker = Walker::on(controls());
    let tile = walker.geometry().tile_under(walker.engine.layout().widgets[0].area.centre()).unwrap();
    // A plate with three sensors still works; with two, the position of a foot is unknown.
    for corner in [Corner::SouthWest, Corner::NorthEast] {
        walker.sim.set_fault(SensorId { tile, corner }, Some(SensorFault::Open));
    }
    walker.wait(1000);
    assert_eq!(reasons(&walker.engine, ALL), [Some(OffReason::SensorTrouble), None, None]);
}

#[test]
fn only_one_control_that_acts_while_it_is_held_is_on_while_it_is_held() {
    let mut walker = Walker::on(controls());
    walker.stand(Newtons(600.0));
    walker.step_onto("drive", Newtons(150.0));
    // Time for a deliberate foot to settle, plus the dwell.
    walker.wait(600);
    assert!(walker.engine.control("drive").unwrap().is_engaged());
    assert_eq!(reasons(&walker.engine, ALL), [None, Some(OffReason::OtherHeld), None]);
    walker.lift();
    walker.wait(100);
    assert_eq!(reasons(&walker.engine, ALL), [None; 3]);
}

#[test]
fn what_is_wrong_with_the_floor_file_switches_off_what_acts_while_it_is_held() {
    let faults = [
        (CalibrationFault::Missing, OffReason::NotCalibrated),
        (CalibrationFault::OtherFloor, OffReason::OtherFloor),
        (CalibrationFault::BoardsSwapped, OffReason::BoardsSwapped),
    ];
    for (fault, reason) in faults {
        let mut engine = Engine::new(Geometry::default(), controls(), Method::default())
            .with_floor_file(FloorFile::new("hall.ron"));
        let mut frame = ForceFrame::empty(&Geometry::default());
        frame.calibration_fault = Some(fault);
        engine.step(&frame);
        assert_eq!(reasons(&engine, ALL), [Some(reason), Some(reason), None]);
        let text = engine.control_state("beam").unwrap().off.unwrap().text;
        assert!(text.contains("hall.ron"), "{text}");
        frame.calibration_fault = None;
        frame.at = frame.at + Duration::from_millis(1);
        engine.step(&frame);
        assert_eq!(reasons(&engine, ALL), [None; 3]);
    }
}

#[test]
fn an_app_s_own_reason_comes_before_those_of_the_floor() {
    let mut engine = Engine::new(Geometry::default(), controls(), Method::default());
    let mut frame = ForceFrame::empty(&Geometry::default());
    frame.calibration_fault = Some(CalibrationFault::Missing);
    frame.quality.fill([Quality::Stale; 4]);
    engine.step(&frame);
    engine.set_enabled("drive", false).unwrap();
    let expected = [OffReason::Disabled, OffReason::NotCalibrated, OffReason::LinkLost].map(Some);
    assert_eq!(reasons(&engine, ALL), expected);
}

#[test]
fn a_control_whose_every_tile_is_suspected_is_off() {
    let mut engine = Engine::new(Geometry::default(), controls(), Method::default());
    let mut frame = ForceFrame::empty(&Geometry::default());
    let tile = engine.geometry().tile_under(engine.layout().widgets[0].area.centre()).unwrap();
    frame.may_start[engine.geometry().index(tile).unwrap()] = false;
    engine.step(&frame);
    assert_eq!(reasons(&engine, ALL), [Some(OffReason::SensorTrouble), None, None]);
}

#[test]
fn a_press_on_a_control_that_is_off_is_ignored_for_that_reason() {
    let mut walker = Walker::on(controls());
    walker.engine.set_enabled("home", false).unwrap();
    walker.step_onto("home", Newtons(150.0));
    walker.wait(100);
    walker.lift();
    walker.wait(100);
    assert_eq!(walker.ignored(), [("home".into(), Ignored::Off(OffReason::Disabled))]);
}

/// An uncalibrated floor with boards that send `readings`, one list for each millisecond.
fn fault_after(readings: &[Vec<Readings>]) -> Option<CalibrationFault> {
    let floor = Floor::of(Geometry::of_paper_tiles(2, 2).unwrap());
    let mut assembler = Assembler::with_tare(&floor, Tare::FromFloor);
    let mut fault = None;
    for (sequence, readings) in (1..).zip(readings) {
        let received = Instant::from_millis(u64::from(sequence));
        for (board, readings) in (0..).zip(readings) {
            assembler.take(&SensorPacket { board, sequence, received, readings: readings.clone() });
        }
        while let Some(frame) = assembler.ready() {
            fault = frame.calibration_fault;
        }
    }
    fault
}

#[test]
fn no_type_of_a_later_packet_makes_a_board_that_sends_counts_calibrated() {
    let wired = Floor::of(Geometry::of_paper_tiles(2, 2).unwrap());
    let mut counts = SimFloor::new(&wired, SimConfig::default(), 1);
    let mut newtons = SimFloor::new(&wired, SimConfig::ideal(), 1);
    let counts: Vec<Vec<Readings>> = (0..50).map(|_| counts.step(&[]).to_vec()).collect();
    let newtons: Vec<Vec<Readings>> = (0..50).map(|_| newtons.step(&[]).to_vec()).collect();
    // Boards that calibrate themselves.
    assert_eq!(fault_after(&newtons), None);
    assert_eq!(fault_after(&counts), Some(CalibrationFault::Missing));
    assert_eq!(fault_after(&[counts, newtons].concat()), Some(CalibrationFault::Missing));
}

#[test]
fn a_simulated_floor_that_went_through_the_lab_lacks_nothing() {
    let wired = Floor::of(Geometry::of_paper_tiles(2, 2).unwrap());
    for config in [SimConfig::default(), SimConfig::ideal()] {
        let mut sim = SimFloor::new(&wired, config, 5);
        let floor = sim::calibrated(&wired, &sim, 5).unwrap();
        let mut assembler = Assembler::with_tare(&floor, Tare::FromFloor);
        let mut frames = 0;
        for sequence in 1..=500 {
            let received = Instant::from_millis(u64::from(sequence));
            for (board, readings) in (0..).zip(sim.step(&[])) {
                assembler.take(&SensorPacket { board, sequence, received, readings: readings.clone() });
            }
            while let Some(frame) = assembler.ready() {
                assert_eq!(frame.calibration_fault, None);
                frames += 1;
            }
        }
        assert!(frames > 490, "{frames}");
    }
}

/// A reason missing from one of them would appear there as an unknown word or number.
#[test]
fn every_reason_stands_in_the_page_and_in_the_bindings() {
    let read =
        |path: &str| std::fs::read_to_string(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let page = read("docs/osc-and-tuio.md");
    let header = read("bindings/c/underfoot.h");
    let types = read("bindings/python/underfoot/_types.py");
    let package = read("bindings/web/src/index.d.ts");
    for (number, reason) in (1..).zip(OffReason::ALL) {
        let name = reason.name();
        assert!(page.contains(&format!("| `{name}` |")), "{name} has no row");
        assert!(
            header.contains(&format!("UF_OFF_{} = {number},", name.to_uppercase())),
            "{name} is not in C"
        );
        assert!(types.contains(&format!("    \"{name}\",")), "{name} is not in Python");
        assert!(package.contains(&format!("\"{name}\"")), "{name} is not in the package for the web");
    }
    let rows = page.lines().skip_while(|line| !line.starts_with("| word | why |")).skip(2);
    let words = rows.take_while(|line| line.starts_with('|')).count();
    assert_eq!(words, OffReason::ALL.len(), "the page has a row for something else");
}

/// The same for presses that a control ignored.
#[test]
fn every_reason_of_an_ignored_press_stands_in_the_page_and_in_the_bindings() {
    let read =
        |path: &str| std::fs::read_to_string(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let (page, types) = (read("docs/osc-and-tuio.md"), read("bindings/python/underfoot/_types.py"));
    let package = read("bindings/web/src/index.d.ts");
    for name in Ignored::all().map(Ignored::name) {
        assert!(page.contains(&format!("| `{name}` |")), "{name} has no row");
        assert!(types.contains(&format!("    \"{name}\",")), "{name} is not in Python");
        assert!(package.contains(&format!("\"{name}\"")), "{name} is not in the package for the web");
    }
}
