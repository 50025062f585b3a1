//! `underfoot simulate` and the program that serves its packets: the floor file between them, and controls without
//! it.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use underfoot::floor::{Floor, Geometry};
use underfoot::schema::load_floor;
use underfoot_sim::{FloorBuild, FloorQuality};

use crate::end_to_end::{said, underfoot};
use crate::ports::free_port;

const PAGE: &str = r#"Layout(
    version: 1,
    regions: [(id: "floor", at: (0, 2), size: (6, 4))],
    stances: [(at: (2, 0), size: (2, 1))],
    widgets: [(id: "beam", kind: "dead_man", at: (0.2, 2.2), size: (0.6, 0.6))],
)"#;

/// A person who holds the beam for longer than a test waits.
const HOLD: &str = r#"Scenario(
    title: "A hold",
    person: (mass_kg: 70, foot_m: 0.27),
    steps: [
        Wait(ms: 1200),
        Enter(from: South, at: (2.2, 0.5)),
        Press(widget: "beam", force_n: 160, hold_ms: 60000),
    ],
)"#;

/// Time within which a person walks in and presses, on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// The output of a simulated floor without a receiver.
fn simulate(folder: &Path, more: &[&str]) -> Output {
    let to = format!("127.0.0.1:{}", free_port());
    underfoot()
        .current_dir(folder)
        .env("XDG_STATE_HOME", folder.join("state"))
        .args(["simulate", "--seconds", "0.1", "--send", &to])
        .args(more)
        .output()
        .unwrap()
}

/// The floor file of the command that it prints, and the command itself.
fn printed(output: &Output) -> (PathBuf, String) {
    let text = said(output);
    let command = text.lines().find_map(|line| line.strip_prefix("Serve this floor with: "));
    let command = command.unwrap_or_else(|| panic!("no command: {text}")).to_owned();
    let path = command.split(" --floor ").nth(1).unwrap().split(' ').next().unwrap().into();
    (path, command)
}

#[test]
fn a_simulated_floor_writes_the_file_that_fits_it() {
    let folder = tempfile::tempdir().unwrap();
    for (options, grid, seed) in [(&[] as &[&str], (6, 6), 1), (&["--grid", "8x6", "--seed", "5"], (8, 6), 5)]
    {
        let (path, command) = printed(&simulate(folder.path(), options));
        assert!(command.starts_with("underfoot run map --floor "), "{command}");
        assert!(command.contains(" --listen 127.0.0.1:"), "{command}");
        let wired = Floor::of(Geometry::of_paper_tiles(grid.0, grid.1).unwrap());
        let (_, fitted) = FloorBuild::of(FloorQuality::Slight, seed).in_use(&wired).unwrap();
        assert_eq!(load_floor(&path).unwrap(), fitted);
    }
}

#[test]
fn each_simulation_has_a_file_of_its_own_that_is_written_once() {
    let folder = tempfile::tempdir().unwrap();
    let (first, _) = printed(&simulate(folder.path(), &[]));
    let (other, _) = printed(&simulate(folder.path(), &["--seed", "2"]));
    let (again, _) = printed(&simulate(folder.path(), &[]));
    assert_eq!((first == other, first == again), (false, true));
    let files = std::fs::read_dir(first.parent().unwrap()).unwrap().count();
    assert_eq!(files, 2, "and no copies of what did not change");
}

#[test]
fn boards_that_send_newtons_need_no_laws() {
    let folder = tempfile::tempdir().unwrap();
    for options in [["--format", "newtons"], ["--quality", "ideal"]] {
        let (path, _) = printed(&simulate(folder.path(), &options));
        let floor = Floor { noiseless: options == ["--quality", "ideal"], ..Floor::default() };
        assert_eq!(load_floor(&path).unwrap(), floor, "{options:?}");
    }
}

#[test]
fn a_named_floor_file_is_written_there_and_fits_from_then_on() {
    let folder = tempfile::tempdir().unwrap();
    let (path, _) = printed(&simulate(folder.path(), &["--write-floor", "lab.ron"]));
    assert_eq!(path, Path::new("lab.ron"));
    let (path, _) = printed(&simulate(folder.path(), &["--floor", "lab.ron"]));
    assert_eq!(path, Path::new("lab.ron"));
    assert!(!folder.path().join("state").exists(), "nothing else is written");
}

#[test]
fn a_state_folder_that_cannot_be_written_stops_no_simulation() {
    let folder = tempfile::tempdir().unwrap();
    // A file in place of the folder.
    std::fs::write(folder.path().join("state"), "").unwrap();
    let output = simulate(folder.path(), &[]);
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("--write-floor") && said(&output).contains(" packets sent to "));
}

/// Ends with the test in any case.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The first line of JSON of a served floor for which `is_wanted` holds, while a person steps onto the beam.
fn served(folder: &Path, floor: Option<&Path>, is_wanted: impl Fn(&Value) -> bool) -> Option<Value> {
    std::fs::write(folder.join("page.ron"), PAGE).unwrap();
    std::fs::write(folder.join("hold.ron"), HOLD).unwrap();
    let address = format!("127.0.0.1:{}", free_port());
    let mut run = underfoot();
    run.current_dir(folder)
        .args(["run", "page.ron", "--listen", &address, "--json", "--no-osc", "--wav", "out.wav"]);
    if let Some(floor) = floor {
        run.arg("--floor").arg(floor);
    }
    let mut run = Running(run.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap());
    let mut feet = underfoot();
    feet.current_dir(folder).env("XDG_STATE_HOME", folder.join("state"));
    feet.args(["simulate", "page.ron", "--scenario", "hold.ron", "--send", &address]);
    let _feet = Running(feet.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap());
    let lines = BufReader::new(run.0.stdout.take().unwrap()).lines().map_while(Result::ok);
    let end = Instant::now() + PATIENCE;
    lines
        .take_while(|_| Instant::now() < end)
        .filter_map(|line| serde_json::from_str(&line).ok())
        .find(|line| is_wanted(line))
}

#[test]
fn the_printed_floor_file_lets_a_foot_hold_what_acts_while_it_is_held() {
    let folder = tempfile::tempdir().unwrap();
    let (path, _) = printed(&simulate(folder.path(), &[]));
    let held = served(folder.path(), Some(&path), |line| {
        line["held"][0] == "beam" || line["off"] == "not_calibrated"
    });
    assert_eq!(held.unwrap()["held"][0], "beam");
}

#[test]
fn without_a_floor_file_listeners_hear_why_the_beam_is_off() {
    let folder = tempfile::tempdir().unwrap();
    let told =
        served(folder.path(), None, |line| line["held"][0] == "beam" || line["event"] == "state").unwrap();
    assert_eq!((&told["id"], &told["off"]), (&"beam".into(), &"not_calibrated".into()), "{told}");
    assert!(told["off_text"].as_str().unwrap().contains("no floor file is given"), "{told}");
    assert_eq!(told["enabled"], false);
}

#[test]
fn the_built_in_session_says_nothing_of_calibration() {
    let folder = tempfile::tempdir().unwrap();
    let output = underfoot().current_dir(folder.path()).args(["session", "--out", "visit"]).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let log = std::fs::read_to_string(folder.path().join("visit/events.jsonl")).unwrap();
    for (name, text) in [("what it says", said(&output)), ("the event log", log)] {
        assert!(!text.contains("calibrat") || text.contains("\"uncalibrated\":0"), "{name}: {text}");
        assert!(!text.contains("not_calibrated"), "{name}: {text}");
    }
}

#[test]
fn an_option_for_the_layout_is_answered_with_where_it_stands() {
    let folder = tempfile::tempdir().unwrap();
    for command in ["simulate", "run", "session", "render", "check", "addresses"] {
        let output =
            underfoot().current_dir(folder.path()).args([command, "--layout", "map.ron"]).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{command}: {}", said(&output));
        assert!(said(&output).contains("leave out `--layout` and write map.ron alone"), "{}", said(&output));
    }
}

#[test]
fn check_takes_the_names_of_built_in_layouts() {
    let folder = tempfile::tempdir().unwrap();
    let output =
        underfoot().current_dir(folder.path()).args(["check", "map", "all_controls"]).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let output = underfoot().current_dir(folder.path()).args(["check", "mapp"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    // A file of that name has priority.
    std::fs::write(folder.path().join("map"), "Layout(").unwrap();
    let output = underfoot().current_dir(folder.path()).args(["check", "map"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
}

#[test]
fn addresses_of_ipv4_within_ipv6_are_understood_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| {
        let listen = format!("[::ffff:127.0.0.1]:{}", free_port());
        let first = ["run", "map", "--listen", &listen, "--no-osc", "--wav", "out.wav", "--seconds", "0.1"];
        underfoot().current_dir(folder.path()).args(first).args(more).output().unwrap()
    };
    let web = format!("[::ffff:127.0.0.1]:{}", free_port());
    let commands = format!("[::ffff:127.0.0.1]:{}", free_port());
    let good: [&[&str]; 4] = [
        &["--allow", "::ffff:127.0.0.1"],
        &["--allow", "::ffff:192.168.1.0/120"],
        &["--commands", &commands, "--allow-commands", "::ffff:127.0.0.0/104"],
        &["--web", &web],
    ];
    for options in good {
        let output = run(options);
        assert!(output.status.success(), "{options:?}: {}", said(&output));
        assert!(said(&output).contains("Listening on 127.0.0.1:"), "{options:?}: {}", said(&output));
    }
    for bad in ["::ffff:192.168.1.0/24", "::ffff:10.0.0.1/95", "::ffff:1.2.3/104"] {
        let output = run(&["--allow", bad]);
        assert_eq!(output.status.code(), Some(2), "{bad}: {}", said(&output));
        assert!(said(&output).contains("192.168.1.0/24"), "{bad}: {}", said(&output));
    }
}
