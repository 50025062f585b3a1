//! Swapped boards: the walk that finds them.

use std::io::{BufRead, BufReader};
use std::process::Stdio;

use underfoot::floor::Floor;
use underfoot::glam::Vec2;
use underfoot_sim::SimFloor;

use super::end_to_end::underfoot;
use super::sender::{Sender, simulated, small_floor, standing};
use crate::ports::free_port;

/// The floor with two boards that send under each other's address, and a person who steps on the first tile of the
/// first row and then on that of the second, for half a second each, repeatedly.
fn walk(sim: &mut SimFloor, ms: u32) {
    let pitch = 0.304;
    let feet = match ms % 4000 {
        1000..1600 => vec![standing(Vec2::new(0.5 * pitch, 0.5 * pitch))],
        3000..3600 => vec![standing(Vec2::new(0.5 * pitch, 1.5 * pitch))],
        _ => Vec::new(),
    };
    sim.step(&feet);
}

/// Row N11.
#[test]
fn a_walk_finds_boards_that_have_changed_places_and_keeps_the_floor_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let kept = folder.path().join("kept.ron");
    let wired = small_floor();
    let address = format!("127.0.0.1:{}", free_port());
    let mut walked = underfoot()
        .args(["wiring", "--grid", "3x2", "--wait", "20", "--listen", &address, "--out"])
        .arg(&kept)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = BufReader::new(walked.stderr.take().unwrap());
    let mut line = String::new();
    said.read_line(&mut line).unwrap();
    assert!(line.starts_with("Listening on"), "{line}");
    let sim = simulated(&wired);
    let mut swapped: Floor = wired.clone();
    let [first, second] = &mut swapped.boards[..] else { panic!("two boards") };
    std::mem::swap(&mut first.address, &mut second.address);
    let _boards = Sender::start(&swapped, sim, address.parse().unwrap(), walk);
    let output = walked.wait_with_output().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{printed}");
    assert!(printed.contains("0 boards where the floor file has them, 2 elsewhere"), "{printed}");
    assert!(printed.contains("/underfoot/board/1 is where /underfoot/board/0 should be"), "{printed}");
    let found = underfoot::schema::load_floor(&kept).unwrap();
    let addresses =
        |floor: &Floor| floor.boards.iter().map(|board| board.address.clone()).collect::<Vec<_>>();
    assert_eq!(addresses(&found), addresses(&swapped));
}

#[test]
fn the_pictures_of_a_floor_name_the_input_of_each_sensor() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    for (floor, line, pin) in [
        ("arduino/pad", "0,/underfoot/board/0,A3,0,0,ne,0.2700,0.2700", "A3"),
        ("pico/floor", "0,/underfoot/board/0,U4 CH7,3,1,ne,", "GP14 (pin 19)"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let output = underfoot()
            .args(["wiring", "--picture", &format!("{root}/firmware/{floor}.ron"), "--out"])
            .arg(folder.path().join("wires.svg"))
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let read = |file: &str| std::fs::read_to_string(folder.path().join(file)).unwrap();
        assert!(read("wires.csv").contains(line), "{}", read("wires.csv"));
        assert!(read("wires-circuit.svg").contains(pin), "{floor}");
        assert!(read("wires.svg").contains("aria-label"), "{floor}");
    }
}

#[test]
fn a_board_with_more_channels_than_the_inputs_of_its_sort_is_refused() {
    let output = underfoot().args(["wiring", "--picture", "paper", "--pins", "arduino"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("/underfoot/board/0 has 24 channels, and each Arduino has 16 inputs"), "{said}");
    assert!(!output.status.success());
}
