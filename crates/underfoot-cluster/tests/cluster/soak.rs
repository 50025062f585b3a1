//! Nodes that fail at random while people walk about.

use std::collections::BTreeMap;
use std::thread;
use std::time::{Duration, Instant};

use crate::hall::{AREAS, Hall, Program, say};
use crate::same::crowd;

/// Shortest duration of a round of the crowd, in seconds.
const ROUND_S: u64 = 20;

/// Random numbers from a fixed seed, so that a run can be repeated.
struct Random(u64);

impl Random {
    fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.0 >> 33) % end
    }
}

/// For the given seconds (or `UNDERFOOT_SOAK_S`), a fault befalls a node every one to four seconds; then people
/// leave.
#[test]
#[ignore = "ten minutes in real time"]
fn restarts_at_random_leave_no_ghost_and_no_hold() {
    let seconds =
        std::env::var("UNDERFOOT_SOAK_S").ok().and_then(|text| text.parse().ok()).unwrap_or(600_u64);
    let hall = Hall::open();
    let mut nodes: Vec<Program> = AREAS.iter().map(|area| hall.frail_node(area)).collect();
    let rounds = usize::try_from(seconds / ROUND_S + 1).unwrap();
    let boards = hall.boards(hall.script(&crowd(rounds)), &[]);
    AREAS.iter().for_each(|area| hall.await_live(area, 0));
    let (begun, mut random) = (Instant::now(), Random(1));
    let mut harms = BTreeMap::<&str, usize>::new();
    while begun.elapsed() < Duration::from_secs(seconds) {
        thread::sleep(Duration::from_millis(1000 + random.below(3000)));
        let number = random.below(4) as usize;
        let pause = Duration::from_millis(random.below(800));
        let harm = match random.below(5) {
            0 | 1 => {
                nodes[number].0.kill().unwrap();
                nodes[number].0.wait().unwrap();
                thread::sleep(pause);
                nodes[number] = hall.frail_node(AREAS[number]);
                "kill -9"
            }
            2 => {
                nodes[number].signal("-STOP");
                thread::sleep(pause);
                nodes[number].signal("-CONT");
                "SIGSTOP"
            }
            3 => {
                hall.links[number].cut();
                thread::sleep(pause);
                hall.links[number].mend();
                "cut"
            }
            _ => {
                nodes[number].signal("-USR1");
                "clock"
            }
        };
        *harms.entry(harm).or_default() += 1;
    }
    // All are back before people leave.
    boards.finish();
    thread::sleep(Duration::from_millis(60));
    let lines = hall.lines.all();
    let mut open = BTreeMap::<String, String>::new();
    let (mut presses, mut cancelled) = (0, 0);
    for (id, done) in lines.iter().filter_map(|line| line.done()) {
        match done.as_str() {
            "pressed" => {
                presses += 1;
                let before = open.insert(id.clone(), done);
                assert!(before.is_none(), "{id} was pressed twice");
            }
            "released" | "cancelled" => {
                cancelled += usize::from(done == "cancelled");
                assert!(open.remove(&id).is_some(), "{id} was {done}, and not pressed before");
            }
            _ => {}
        }
    }
    let contacts = lines.iter().rev().find_map(|line| line.contacts()).unwrap();
    let held = lines.iter().rev().find_map(|line| line.json["held"].as_array().cloned()).unwrap_or_default();
    let mut areas = BTreeMap::new();
    for (area, state) in lines.iter().filter_map(|line| line.area()) {
        areas.insert(area.to_owned(), state.to_owned());
    }
    say(&format!(
        "{} s, {harms:?}: {presses} presses, {cancelled} cancelled; at the end {} contacts, held {held:?}, {areas:?}",
        begun.elapsed().as_secs(),
        contacts.len()
    ));
    assert!(
        presses > 0 && contacts.is_empty() && held.is_empty() && open.is_empty(),
        "{contacts:?} {open:?}"
    );
}
