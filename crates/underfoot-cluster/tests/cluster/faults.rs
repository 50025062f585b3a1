//! Nodes that die and freeze while a foot holds a control.

use std::time::{Duration, Instant};

use crate::hall::{AREAS, Hall, Program, say};
use crate::lines::Line;

/// Somebody who holds the control over the border again and again; the node of the south-east decides it.
fn holding(times: usize) -> String {
    let hold = "Wait(ms: 500), Press(widget: \"drive\", force_n: 110, hold_ms: 2500),".repeat(times);
    format!(
        "Scenario(title: \"Holding\", steps: [Wait(ms: 1500), Enter(from: South, at: (6.1, 2.2)), {hold} Leave(to: South)])"
    )
}

/// A hall in which somebody holds `drive`.
struct Fault {
    hall: Hall,
    nodes: Vec<Program>,
}

impl Fault {
    fn new() -> Self {
        let hall = Hall::open();
        let nodes = AREAS.iter().map(|area| hall.node(area)).collect();
        Self { hall, nodes }
    }

    /// Waits for the next press, and half a second more.
    fn await_hold(&self) {
        let from = self.hall.lines.len();
        self.hall.lines.find(from, "pressed", |line| is(line, "pressed"));
        std::thread::sleep(Duration::from_millis(500));
    }

    /// Does `harm` to the south-east's node; how long it took until everything it held was told to be over.
    fn measure(&mut self, harm: impl Fn(&mut Program)) -> Duration {
        let from = self.hall.lines.len();
        let begun = Instant::now();
        harm(&mut self.nodes[1]);
        let cancelled = self.hall.lines.find(from, "cancelled", |line| is(line, "cancelled"));
        let released = self
            .hall
            .lines
            .find(from, "held: []", |line| line.json["held"].as_array().is_some_and(Vec::is_empty));
        self.hall.lines.find(from, "lost", |line| line.area() == Some(("se", "lost")));
        cancelled.came.max(released.came).saturating_duration_since(begun)
    }

    /// Whether since line `from` nothing was pressed or done that was not pressed anew.
    fn check_quiet(&self, from: usize) {
        let mut is_pressed = false;
        for line in self.hall.lines.all().iter().skip(from) {
            let Some((id, done)) = line.done() else { continue };
            assert_eq!(id, "drive");
            match done.as_str() {
                "pressed" => is_pressed = true,
                "released" | "clicked" => assert!(is_pressed, "{line:?}"),
                _ => {}
            }
        }
    }
}

fn is(line: &Line, what: &str) -> bool {
    line.done().is_some_and(|(id, done)| id == "drive" && done == what)
}

fn tell(what: &str, mut all: Vec<Duration>) {
    all.sort();
    let ms = |one: Duration| one.as_secs_f64() * 1e3;
    say(&format!(
        "{what}: {} rounds, cancelled after {:.0} ms at least, {:.0} median, {:.0} at most",
        all.len(),
        ms(all[0]),
        ms(all[all.len() / 2]),
        ms(all[all.len() - 1])
    ));
    assert!(all[all.len() - 1] <= Duration::from_millis(150), "{all:?}");
}

fn killed(rounds: usize) {
    let mut fault = Fault::new();
    let _boards = fault.hall.boards(fault.hall.script(&holding(3 * rounds + 3)), &[]);
    AREAS.iter().for_each(|area| fault.hall.await_live(area, 0));
    let mut all = Vec::new();
    for _ in 0..rounds {
        fault.await_hold();
        let from = fault.hall.lines.len();
        all.push(fault.measure(|node| {
            node.0.kill().unwrap();
            node.0.wait().unwrap();
        }));
        let back = fault.hall.lines.len();
        fault.nodes[1] = fault.hall.node("se");
        fault.hall.await_live("se", back);
        fault.check_quiet(from);
    }
    tell("kill -9", all);
}

fn frozen(rounds: usize) {
    let mut fault = Fault::new();
    let _boards = fault.hall.boards(fault.hall.script(&holding(3 * rounds + 3)), &[]);
    AREAS.iter().for_each(|area| fault.hall.await_live(area, 0));
    let mut all = Vec::new();
    for _ in 0..rounds {
        fault.await_hold();
        let from = fault.hall.lines.len();
        all.push(fault.measure(|node| node.signal("-STOP")));
        std::thread::sleep(Duration::from_millis(400));
        let back = fault.hall.lines.len();
        fault.nodes[1].signal("-CONT");
        fault.hall.await_live("se", back);
        fault.check_quiet(from);
    }
    tell("SIGSTOP", all);
}

#[test]
fn what_a_killed_node_held_is_cancelled_and_it_comes_back_without_ghosts() {
    killed(1);
}

#[test]
fn what_a_frozen_node_held_is_cancelled_and_it_comes_back_without_ghosts() {
    frozen(1);
}

#[test]
#[ignore = "minutes in real time"]
fn twenty_killed_nodes() {
    killed(20);
}

#[test]
#[ignore = "minutes in real time"]
fn twenty_frozen_nodes() {
    frozen(20);
}
