//! A set-up at the terminal, by answers on the input of the program.

use std::io::Write;
use std::path::Path;
use std::process::Stdio;

use underfoot::floor::Floor;
use underfoot::schema::load_floor;

use super::end_to_end::underfoot;
use super::sender::{Sender, simulated, small_floor};
use crate::ports::free_port;

/// Runs the set-up in `folder` with these answers, a line each; returns what it prints.
fn set_up(folder: &Path, options: &[&str], answers: &[&str]) -> String {
    let mut program = underfoot()
        .current_dir(folder)
        .args(["setup", "--seconds", "2"])
        .args(options)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = program.stdin.take().unwrap();
    input.write_all(format!("{}\n", answers.join("\n")).as_bytes()).unwrap();
    drop(input);
    let output = program.wait_with_output().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{printed}\n{}", String::from_utf8_lossy(&output.stderr));
    printed
}

#[test]
fn boards_of_the_network_are_found_and_get_the_sensors_of_the_shape_that_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let wired = small_floor();
    let address = format!("127.0.0.1:{}", free_port());
    let _boards =
        Sender::start(&wired, simulated(&wired), address.parse().unwrap(), |sim, _| _ = sim.step(&[]));
    // Look for boards, then the shape: what is offered first, after an answer that is none. The end of the answers
    // leaves.
    let printed = set_up(folder.path(), &["--listen", &address], &["", "", "many", "", "3x2"]);
    assert!(printed.contains("/underfoot/board/1: 12 channels of counts"), "{printed}");
    assert!(printed.contains("expected a number from 1 to 5"), "{printed}");
    assert!(printed.contains("The floor is in floor.ron."), "{printed}");
    let floor = load_floor(&folder.path().join("floor.ron")).unwrap();
    let wires = |floor: &Floor| -> Vec<_> {
        floor.boards.iter().map(|board| (board.address.clone(), board.channels.clone())).collect()
    };
    assert_eq!((floor.geometry, wires(&floor)), (wired.geometry, wires(&wired)));
}

#[test]
fn nothing_is_asked_of_a_floor_that_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let address = format!("127.0.0.1:{}", free_port());
    let printed = set_up(folder.path(), &["--listen", &address], &["1", "5", "8"]);
    assert!(printed.contains("No board sends to"), "{printed}");
    assert!(printed.contains("There is no floor.ron yet: choose the floor's shape first."), "{printed}");
    assert!(!folder.path().join("floor.ron").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_display_the_window_points_to_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let mut program = underfoot();
    program.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").current_dir(folder.path());
    let output = program.args(["setup", "--window"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && said.contains("leave out --window"), "{said}");
    assert!(std::fs::read_dir(folder.path()).unwrap().next().is_none(), "nothing is written");
}

#[cfg(unix)]
#[test]
fn a_board_that_sends_lines_of_text_is_found_with_its_columns_and_the_file_reads_it() {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::Duration;

    use serialport::{SerialPort, TTYPort};
    use underfoot::floor::{SerialWire, TextNumbers};

    let folder = tempfile::tempdir().unwrap();
    let (mut pad, port) = TTYPort::pair().unwrap();
    let name = port.name().unwrap();
    let stop = Arc::<AtomicBool>::default();
    let is_over = Arc::clone(&stop);
    let sender = std::thread::spawn(move || {
        for line in 0_u32.. {
            let noise = |salt: u32| line.wrapping_mul(2_654_435_761_u32.wrapping_mul(salt)) >> 30;
            let [sw, se, nw, ne] = [3, 5, 7, 11].map(|salt| 500 + noise(salt));
            let text = format!("t {} {sw},{se},{nw},{ne}\r\n", 10 * line);
            // Without a reader, the bytes are lost.
            drop(pad.write_all(text.as_bytes()));
            std::thread::sleep(Duration::from_millis(10));
            if is_over.load(Ordering::Relaxed) {
                break;
            }
        }
    });
    let address = format!("127.0.0.1:{}", free_port());
    let options = ["--listen", &address, "--serial", &name];
    // Boards; other tiles, one of them with a side of 30 cm and sensors 2 cm inside; the tare; the end.
    let answers = ["1", "2", "5", "1", "1", "30", "", "", "6", "8"];
    let printed = set_up(folder.path(), &options, &answers);
    stop.store(true, Ordering::Relaxed);
    sender.join().unwrap();
    assert!(printed.contains("(lines of text): 4 channels of counts in lines of text"), "{printed}");
    assert!(!printed.contains("That did not succeed"), "{printed}");
    let floor = load_floor(&folder.path().join("floor.ron")).unwrap();
    let [SerialWire { port: Some(port), baud, lines: Some(lines) }] = &floor.serial[..] else {
        panic!("{:?}", floor.serial)
    };
    assert_eq!(
        (port.to_string(), *baud, lines.board, &lines.columns[..]),
        (name, 115_200, 0, &[3, 4, 5, 6][..])
    );
    assert!(matches!(lines.numbers, TextNumbers::Counts { full_scale: 1023.0, .. }), "{lines:?}");
    assert!(floor.tared.is_some(), "the file reads the board that was found");
}
