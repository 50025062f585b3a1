//! A hall with two areas, served by two processes like two computers in the field.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{ChildStderr, Stdio};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use serde_json::Value;

use crate::end_to_end::{Served, said, terminate, underfoot};
use crate::ports::free_port;

/// Two areas side by side.
const HALL: &str = r#"Floor(
    columns: 12,
    rows: 6,
    areas: [(id: "west", at: (0, 0), size: (6, 6)), (id: "east", at: (6, 0), size: (6, 6))],
)"#;

/// One button in each area and one on their border, with its centre in the east.
const BUTTONS: &str = r#"Layout(
    version: 1,
    title: "Hall",
    regions: [(id: "hall", at: (0, 3), size: (12, 3))],
    widgets: [
        (id: "ticket", kind: "button", at: (2, 3), size: (0.8, 0.8), label: "Ticket"),
        (id: "border", kind: "button", at: (5.7, 3), size: (0.8, 0.8), label: "Border"),
        (id: "door", kind: "button", at: (9, 3), size: (0.8, 0.8), label: "Door"),
    ],
)"#;

const VISIT: &str = r#"Scenario(
    title: "Across the hall",
    steps: [
        Wait(ms: 1200),
        Enter(from: West, at: (2.4, 2.2)),
        Press(widget: "ticket", force_n: 140, hold_ms: 300),
        WalkTo(at: (6.1, 2.2)),
        Press(widget: "border", force_n: 140, hold_ms: 300),
        WalkTo(at: (9.4, 2.2)),
        Press(widget: "door", force_n: 140, hold_ms: 300),
        Leave(to: East),
    ],
)"#;

/// One of the hall's computers.
struct Computer {
    process: Served,
    address: String,
    /// Reads its lines all the time.
    reader: JoinHandle<Vec<Value>>,
    /// Kept open; otherwise writing to standard error would fail.
    _chatter: BufReader<ChildStderr>,
}

impl Computer {
    fn start(folder: &Path, area: &[&str]) -> Self {
        let address = format!("127.0.0.1:{}", free_port());
        let mut process = underfoot()
            .args(["run", "hall_buttons.ron", "--floor", "hall.ron", "--listen", &address])
            .args(["--json", "--json-contacts", "--no-osc", "--wav", &format!("out{}.wav", area.concat())])
            .args(area)
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map(Served)
            .unwrap();
        let mut chatter = BufReader::new(process.0.stderr.take().unwrap());
        let mut line = String::new();
        chatter.read_line(&mut line).unwrap();
        assert!(line.starts_with("Listening on"), "{line}");
        let out = BufReader::new(process.0.stdout.take().unwrap());
        let parsed = |line: String| serde_json::from_str(&line).ok();
        let reader = thread::spawn(move || out.lines().map_while(Result::ok).filter_map(parsed).collect());
        Self { process, address, reader, _chatter: chatter }
    }

    /// Ends it and returns all its lines.
    fn told(self) -> Vec<Value> {
        terminate(&self.process.0);
        self.reader.join().unwrap()
    }
}

/// The events of controls, in order.
fn done(told: &[Value]) -> Vec<String> {
    let event = |line: &Value| Some(format!("{} {}", line["id"].as_str()?, line["event"].as_str()?));
    told.iter().filter_map(event).collect()
}

#[test]
fn two_computers_serve_a_hall_between_them() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (name, text) in [("hall.ron", HALL), ("hall_buttons.ron", BUTTONS), ("visit.ron", VISIT)] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let areas: [&[&str]; 3] = [&["--area", "west"], &["--area", "east"], &[]];
    let computers = areas.map(|area| Computer::start(folder, area));
    let addresses: Vec<&str> = computers.iter().map(|computer| computer.address.as_str()).collect();
    // Boards send to the computers concerned; these send to all, as through a switch.
    let simulated = underfoot()
        .args([
            "simulate",
            "hall_buttons.ron",
            "--quality",
            "paper",
            "--floor",
            "hall.ron",
            "--scenario",
            "visit.ron",
        ])
        .args(["--send", &addresses.join(",")])
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(simulated.status.success(), "{}", said(&simulated));
    // The last packets are on their way.
    thread::sleep(Duration::from_millis(200));
    let [west, east, whole] = computers.map(Computer::told);

    let of = |id: &str| ["pressed", "released", "clicked"].map(|event| format!("{id} {event}"));
    assert_eq!(done(&west), of("ticket"));
    assert_eq!(done(&east), [of("border"), of("door")].concat());
    assert_eq!(done(&whole), [of("ticket"), of("border"), of("door")].concat());

    // Each reports the feet in its own area, with their positions on the whole floor.
    let border_m = 6.0 * 0.304;
    let places = |told: &[Value]| -> Vec<f64> {
        let contacts = told.iter().filter_map(|line| line["contacts"].as_array()).flatten();
        contacts.filter_map(|contact| contact["x_m"].as_f64()).collect()
    };
    let (west, east) = (places(&west), places(&east));
    assert!(west.len() > 100 && east.len() > 100, "{} and {}", west.len(), east.len());
    assert!(west.iter().all(|east_m| *east_m < border_m + 1e-6), "{west:?}");
    assert!(east.iter().all(|east_m| *east_m >= border_m - 1e-6), "{east:?}");
}

#[test]
fn an_area_that_the_floor_lacks_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("hall.ron"), HALL).unwrap();
    let refused = underfoot()
        .args(["run", "--floor", "hall.ron", "--area", "north"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(!refused.status.success());
    assert!(said(&refused).contains("no area \"north\": there are west, east"), "{}", said(&refused));
}
