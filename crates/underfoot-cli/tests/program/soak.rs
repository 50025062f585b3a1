//! A floor that runs for a long time: its use of the machine does not grow.
#![cfg(target_os = "linux")]

use std::fs::File;
use std::process::{Child, Stdio};
use std::time::Duration;

use underfoot::floor::Floor;
use underfoot::schema;
use underfoot::sense::Method;
use underfoot::serve::{Ended, Server};
use underfoot::units::Instant;
use underfoot_sim::{Foot, FootDriver, Pace, Scenario, Script, SimConfig, SimFloor, SimulatedSource};

use super::end_to_end::{Served, underfoot};
use super::output::{ended, memory_kb};
use crate::ports::free_port;

/// The resources of a process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Holdings {
    memory_kb: u64,
    descriptors: usize,
    threads: usize,
}

impl Holdings {
    /// Of the process `id`, such as "self".
    fn of(id: &str) -> Self {
        let count = |folder: &str| std::fs::read_dir(format!("/proc/{id}/{folder}")).unwrap().count();
        Self { memory_kb: memory_kb(id), descriptors: count("fd"), threads: count("task") }
    }
}

/// Compares the resources at the end of each part, of which the first is for warming up.
fn expect_flat(parts: &[Holdings]) {
    let (first, last) = (parts[0], parts[parts.len() - 1]);
    println!("first {first:?}, last {last:?}, {} parts", parts.len());
    // A megabyte: far less than one allocation per frame would add in a minute, more than the allocator's own
    // variation.
    assert!(last.memory_kb <= first.memory_kb + 1024, "{parts:?}");
    assert_eq!((last.descriptors, last.threads), (first.descriptors, first.threads), "{parts:?}");
}

/// A script that restarts at its end, up to a time on the floor's clock.
struct Repeated {
    script: Script,
    until: Instant,
    begun: Instant,
}

impl FootDriver for Repeated {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        feet.clear();
        if at.since(self.begun) > self.script.duration() {
            self.begun = at;
        }
        self.script.feet_at(Instant::START + at.since(self.begun), feet);
        at < self.until
    }
}

/// The shipped session, repeated for `hours` in the floor's own time; returns the resources after each hour.
fn hours_of_floor_time(hours: u64) -> Vec<Holdings> {
    const HOUR_S: u64 = 3600;
    let floor = Floor::default();
    let kinds = schema::Kinds::builtin();
    let layout = schema::builtin_layout("map").unwrap();
    let layout = schema::parse_layout(layout, "map", &kinds, &floor.geometry).unwrap().layout;
    let script =
        Scenario::parse("session", Scenario::SESSION).unwrap().resolve(&layout, &floor.geometry).unwrap();
    let until = Instant::from_millis(1000 * HOUR_S * hours);
    let repeated = Repeated { script, until, begun: Instant::START };
    let sim = SimFloor::new(&floor, SimConfig::default(), 1);
    let source = SimulatedSource::new(sim, Box::new(repeated), Pace::FreeRunning);
    let mut server = Server::new(&floor, layout, Method::default(), source);
    let mut parts = Vec::new();
    while server.turn().unwrap() == Ended::No {
        let done = server.engine().now().since(Instant::START).as_secs() / HOUR_S;
        if done as usize > parts.len() {
            parts.push(Holdings::of("self"));
            println!("{done} h: {:?}", parts[parts.len() - 1]);
        }
    }
    parts
}

/// Row R4.
#[test]
#[ignore = "ten hours of floor time take most of one"]
fn ten_hours_of_floor_time_take_no_more_than_one() {
    expect_flat(&hours_of_floor_time(10));
}

/// Row R4. An hour of real time: the real program, real packets, two outputs, and occasional faults.
#[test]
#[ignore = "takes an hour"]
fn an_hour_of_packets_takes_no_more_than_its_first_five_minutes() {
    const MINUTES: u64 = 60;
    const VISITS: usize = 200;
    /// Minutes until buffers have reached their size: most of the growth comes in the second one.
    const WARM_UP: usize = 5;
    let folder = tempfile::tempdir().unwrap();
    let (scenario, told) = (folder.path().join("hour.ron"), folder.path().join("told.jsonl"));
    // A visit takes some twenty seconds; the last ones come after the hour.
    let visit = "Enter(from: South, at: (2.2, 0.5)), Press(widget: \"home\", force_n: 140, hold_ms: 400), \
                 Sidestep(at: (4.0, 0.5)), Drag(widget: \"zoom\", from: 0.2, to: 0.8), Leave(to: East), Wait(ms: 3000),";
    let steps = format!("Wait(ms: 1200), {}", visit.repeat(VISITS));
    std::fs::write(&scenario, format!("Scenario(title: \"An hour of visits\", steps: [{steps}])")).unwrap();
    let address = format!("127.0.0.1:{}", free_port());
    let mut server = underfoot()
        .args(["run", "map", "--json", "--osc", "127.0.0.1:9", "--listen", &address])
        .args(["--fault", "nemesis=1:3600s:6"])
        .stdout(File::create(&told).unwrap())
        .stderr(Stdio::null())
        .spawn()
        .map(Served)
        .unwrap();
    let mut boards = underfoot()
        .args(["simulate", "map", "--quality", "paper", "--send", &address, "--scenario"])
        .arg(&scenario)
        .stderr(Stdio::null())
        .spawn()
        .map(Served)
        .unwrap();
    let mut parts = Vec::new();
    for minute in 1..=MINUTES {
        std::thread::sleep(Duration::from_secs(60));
        assert!(!is_over(&mut boards.0), "the boards ended in minute {minute}");
        assert!(!is_over(&mut server.0), "the server ended in minute {minute}: {parts:?}");
        parts.push(Holdings::of(&server.0.id().to_string()));
        println!("{minute} min: {:?}", parts[parts.len() - 1]);
    }
    drop(boards);
    assert_eq!(ended(server), Some(0));
    let clicks = std::fs::read_to_string(&told).unwrap().matches("clicked").count();
    println!("{clicks} clicks");
    // Of some 180: faults of all kinds may cost a part of them.
    assert!(clicks > 90, "{clicks}");
    expect_flat(&parts[WARM_UP - 1..]);
}

fn is_over(process: &mut Child) -> bool {
    process.try_wait().unwrap().is_some()
}
