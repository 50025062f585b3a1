//! Boards behind serial ports of the program, here pseudo terminals.

use std::io::{BufRead, BufReader, Read, Write};
use std::os::fd::{AsRawFd, BorrowedFd};
use std::process::Stdio;
use std::thread;
use std::time::{Duration, Instant};

use nix::fcntl::{FcntlArg, FdFlag, fcntl};
use serialport::{SerialPort, TTYPort};

use crate::end_to_end::{Served, underfoot};

const FLOOR: &str = "Floor(columns: 1, rows: 1,\n    serial: [Serial(lines: Lines(full_scale: 1023))])\n";
const PAGE: &str = r#"Layout(version: 1, regions: [(id: "r", at: (0, 0), size: (1, 1))],
    widgets: [(id: "b", kind: "button", at: (0.1, 0.1), size: (0.8, 0.8))])"#;

/// A line of an empty tile of 120 counts a sensor, and of 560 more under a foot from second four on; some lines before
/// it are no text, and some are broken off.
fn line(ms: u64) -> Vec<u8> {
    let load = 560.0 * ((ms as f32 / 1000.0 - 4.0) / 0.12).clamp(0.0, 1.0);
    let noise = |salt: u64| (ms.wrapping_mul(2_654_435_761 * salt) >> 16 & 0xFFFF) as f32 / 65_536.0;
    let [sw, se, nw, ne] = [3, 5, 7, 11].map(|salt| 120.0 + load + noise(salt));
    let line = format!("{sw:.1} {se:.1} {nw:.1} {ne:.1}\n").into_bytes();
    match ms {
        500..3000 if ms.is_multiple_of(500) => vec![0xE6; 40],
        500..3000 if ms % 500 == 250 => line.into_iter().take(9).collect(),
        _ => line,
    }
}

/// Keeps the board's end of the terminal from the program under test, so that dropping it pulls the cable.
fn keep_from_programs(pad: &TTYPort) {
    // SAFETY: `pad` holds the descriptor open during the call.
    let end = unsafe { BorrowedFd::borrow_raw(pad.as_raw_fd()) };
    fcntl(end, FcntlArg::F_SETFD(FdFlag::FD_CLOEXEC)).unwrap();
}

// N16, N17
#[test]
fn a_foot_on_a_pad_presses_despite_garbage_and_a_pulled_cable_cancels_its_hold() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("floor.ron"), FLOOR).unwrap();
    std::fs::write(folder.path().join("page.ron"), PAGE).unwrap();
    let (mut pad, port) = TTYPort::pair().unwrap();
    keep_from_programs(&pad);
    let listen = format!("127.0.0.1:{}", crate::ports::free_port());
    let mut server = underfoot()
        .current_dir(folder.path())
        .args(["run", "page.ron", "--floor", "floor.ron", "--json", "--listen", &listen, "--wav", "out.wav"])
        .args(["--serial", &port.name().unwrap(), "--seconds", "20"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map(Served)
        .unwrap();
    let (out, mut log) = (server.0.stdout.take().unwrap(), server.0.stderr.take().unwrap());
    let sender = thread::spawn(move || {
        let begun = Instant::now();
        for ms in 0..7000 {
            // Without a reader, the bytes are lost.
            drop(pad.write_all(&line(ms)));
            thread::sleep(Duration::from_millis(ms).saturating_sub(begun.elapsed()));
        }
        // The cable is pulled with the end of the terminal.
        drop(pad);
    });
    let reader = thread::spawn(move || {
        let mut said = String::new();
        log.read_to_string(&mut said).map(|_| said)
    });
    let lines = BufReader::new(out).lines().map_while(Result::ok);
    let events = lines.filter_map(|line| serde_json::from_str::<serde_json::Value>(&line).ok());
    let names = ["pressed", "released", "cancelled", "clicked"];
    let of_button =
        events.filter(|event| event["id"] == "b" && names.iter().any(|name| event["event"] == *name));
    let told: Vec<String> = of_button.map(|event| event["event"].to_string()).collect();
    sender.join().unwrap();
    assert_eq!(told, ["\"pressed\"", "\"cancelled\""]);
    let said = reader.join().unwrap().unwrap();
    assert!(said.contains("is not understood") && said.contains("is gone"), "{said}");
    drop(port);
}

// N18
#[test]
fn a_port_of_the_floor_file_that_is_not_there_is_refused_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let floor = "Floor(columns: 1, rows: 1,\n    serial: [Serial(port: \"/nowhere/ttyACM0\")])\n";
    std::fs::write(folder.path().join("page.ron"), PAGE).unwrap();
    let run = |floor: &str, more: &[&str]| {
        std::fs::write(folder.path().join("floor.ron"), floor).unwrap();
        let output = underfoot()
            .current_dir(folder.path())
            .args(["run", "page.ron", "--floor", "floor.ron", "--seconds", "1", "--wav", "out.wav"])
            .args(["--listen", &format!("127.0.0.1:{}", crate::ports::free_port())])
            .args(more)
            .output()
            .unwrap();
        (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (is_good, said) = run(floor, &[]);
    assert!(!is_good && said.contains("there is no serial port /nowhere/ttyACM0"), "{said}");
    assert!(said.contains("floor.ron:2:"), "{said}");
    let (is_good, said) = run(FLOOR, &[]);
    assert!(!is_good && said.contains("--serial PORT"), "{said}");
    let (is_good, said) = run(FLOOR, &["--serial", "/nowhere/pad"]);
    assert!(!is_good && said.contains("/nowhere/pad") && said.contains("--await-ports"), "{said}");
    let (is_good, said) = run(floor, &["--await-ports"]);
    assert!(is_good && said.contains("waiting for it"), "{said}");
}
