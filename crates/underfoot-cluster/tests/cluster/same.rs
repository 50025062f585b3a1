//! What the gateway tells is what one computer for the whole floor tells.

use std::collections::{BTreeMap, BTreeSet};

use crate::hall::{AREAS, Hall, Program, say};
use crate::lines::Line;

/// Four people who together cross each border in both directions and work each control, `rounds` times.
fn crowd(rounds: usize) -> String {
    let steps = |enter: &str, round: &str, leave: &str| {
        format!("Wait(ms: 1500), {enter} {} {leave}", round.repeat(rounds))
    };
    let south = steps(
        "Enter(from: West, at: (2.4, 2.2)),",
        "Press(widget: \"ticket\", force_n: 140, hold_ms: 300), WalkTo(at: (6.1, 2.2)),
         Press(widget: \"drive\", force_n: 140, hold_ms: 700), WalkTo(at: (9.4, 2.2)), WalkTo(at: (2.4, 2.2)),",
        "Leave(to: West),",
    );
    let north = steps(
        "Enter(from: East, at: (9.4, 8.2)),",
        "Press(widget: \"door\", force_n: 140, hold_ms: 300), WalkTo(at: (2.7, 8.2)),
         Drag(widget: \"level\", from: 0.2, to: 0.8), WalkTo(at: (9.4, 8.2)),",
        "Leave(to: East),",
    );
    let west = steps(
        "Enter(from: West, at: (3.5, 4.9)),",
        "Press(widget: \"gate\", force_n: 140, hold_ms: 300), WalkTo(at: (4.7, 7.0)), WalkTo(at: (4.7, 4.2)), WalkTo(at: (3.5, 4.9)),",
        "Leave(to: West),",
    );
    let east = steps(
        "Enter(from: East, at: (10.5, 4.0)),",
        "WalkTo(at: (10.5, 7.0)), WalkTo(at: (7.0, 6.0)), WalkTo(at: (7.0, 4.0)), WalkTo(at: (10.5, 4.0)),",
        "Leave(to: East),",
    );
    let others: Vec<String> = [north, west, east].iter().map(|steps| format!("(steps: [{steps}])")).collect();
    format!("Scenario(title: \"Crowd\", steps: [{south}], others: [{}])", others.join(", "))
}

/// What was told of one floor.
struct Account {
    /// Each event: control, what, when, and which line.
    events: Vec<(String, String, f64, std::time::Instant)>,
    /// The contacts by their names: when and where.
    tracks: BTreeMap<u64, Vec<(f64, f64, f64)>>,
}

impl Account {
    fn of(lines: &[Line]) -> Self {
        let event = |line: &Line| line.done().map(|(id, done)| (id, done, line.t_s(), line.came));
        let mut tracks = BTreeMap::<_, Vec<_>>::new();
        for line in lines {
            for (id, x, y) in line.contacts().unwrap_or_default() {
                tracks.entry(id).or_default().push((line.t_s(), x, y));
            }
        }
        Self { events: lines.iter().filter_map(event).collect(), tracks }
    }

    /// Each control's events, for values in the order of their times.
    fn done(&self) -> Vec<(&str, &str)> {
        let mut all: Vec<_> =
            self.events.iter().map(|(id, done, _, _)| (id.as_str(), done.as_str())).collect();
        // Events of several controls at the same moment are in no order.
        all.sort_by_key(|(id, _)| *id);
        all
    }

    /// The nth event of each control and kind.
    fn moments(&self) -> BTreeMap<(String, String, usize), (f64, std::time::Instant)> {
        let mut counts = BTreeMap::<_, usize>::new();
        let numbered = self.events.iter().map(|(id, done, t_s, came)| {
            let count = counts.entry((id, done)).or_default();
            *count += 1;
            ((id.clone(), done.clone(), *count), (*t_s, *came))
        });
        numbered.collect()
    }
}

/// Where a contact was at `t_s`, between two of its reports.
fn at(track: &[(f64, f64, f64)], t_s: f64) -> Option<(f64, f64)> {
    let next = track.partition_point(|(time, _, _)| *time < t_s);
    let (before, after) = (track.get(next.checked_sub(1)?)?, track.get(next)?);
    let (span, past) = (after.0 - before.0, t_s - before.0);
    // It was told of all the time in between.
    (span < 0.025).then(|| {
        let share = past / span;
        (before.1 + (after.1 - before.1) * share, before.2 + (after.2 - before.2) * share)
    })
}

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    all[all.len() / 2]
}

fn quantile(all: &mut [f64], share: f64) -> f64 {
    all.sort_by(f64::total_cmp);
    all[((all.len() - 1) as f64 * share) as usize]
}

/// Lets people walk about for `rounds`, and compares what is told.
fn walk_about(rounds: usize) {
    let hall = Hall::open();
    let _nodes: Vec<Program> = AREAS.iter().map(|area| hall.node(area)).collect();
    let (session, port, single) = hall.single();
    let boards = hall.boards(hall.script(&crowd(rounds)), &[port]);
    AREAS.iter().for_each(|area| hall.await_live(area, 0));
    boards.finish();
    // The last events are on their way.
    std::thread::sleep(std::time::Duration::from_millis(300));
    let (joined, whole) = (Account::of(&hall.lines.all()), Account::of(&single.all()));
    session.stop();

    // The same events in the same order.
    say(&format!("{} events, {} contacts", whole.events.len(), whole.tracks.len()));
    assert!(whole.events.len() > 20 * rounds, "{:?}", whole.events);
    assert_eq!(joined.done(), whole.done());

    // At the same times, but for the start of their clocks.
    let (here, there) = (joined.moments(), whole.moments());
    let offset = median(there.iter().map(|(event, (t_s, _))| here[event].0 - t_s).collect());
    let mut apart: Vec<f64> =
        there.iter().map(|(event, (t_s, _))| (here[event].0 - t_s - offset).abs()).collect();
    let mut added: Vec<f64> = there
        .iter()
        .map(|(event, (_, came))| {
            let later = here[event].1;
            later.saturating_duration_since(*came).as_secs_f64()
                - came.saturating_duration_since(later).as_secs_f64()
        })
        .collect();
    say(&format!(
        "times apart: median {:.2} ms, most {:.2} ms",
        1e3 * quantile(&mut apart, 0.5),
        1e3 * quantile(&mut apart, 1.0)
    ));
    say(&format!(
        "added delay: median {:.2} ms, 99 % {:.2} ms, most {:.2} ms",
        1e3 * quantile(&mut added, 0.5),
        1e3 * quantile(&mut added, 0.99),
        1e3 * quantile(&mut added, 1.0)
    ));

    // The same contacts under other names, one for one.
    let mut names = BTreeSet::new();
    let mut distances = Vec::new();
    let mut unmatched = 0;
    for (id, track) in &joined.tracks {
        for &(t_s, x, y) in track {
            // The places of 2 ms before and after, too: so much may the times be apart.
            let near = |other: &[(f64, f64, f64)]| {
                (-4..=4)
                    .filter_map(|step| at(other, t_s - offset + f64::from(step) * 0.0005))
                    .map(|place| (place.0 - x).hypot(place.1 - y))
                    .min_by(f64::total_cmp)
            };
            let nearest = whole.tracks.iter().filter_map(|(other, track)| Some((near(track)?, *other)));
            match nearest.min_by(|one, other| one.0.total_cmp(&other.0)) {
                Some((distance, other)) if distance < 0.1 => {
                    distances.push(distance);
                    names.insert((*id, other));
                }
                _ => unmatched += 1,
            }
        }
    }
    say(&format!(
        "{} places: median {:.3} mm, 99 % {:.3} mm, most {:.3} mm apart; {unmatched} without a counterpart",
        distances.len(),
        1e3 * quantile(&mut distances, 0.5),
        1e3 * quantile(&mut distances, 0.99),
        1e3 * quantile(&mut distances, 1.0)
    ));
    say(&format!("{} names there, {} here, {} pairs", whole.tracks.len(), joined.tracks.len(), names.len()));
    assert_eq!((names.len(), joined.tracks.len()), (whole.tracks.len(), whole.tracks.len()));
    assert!(quantile(&mut distances, 1.0) <= 0.001);
    assert!(quantile(&mut apart, 1.0) <= 0.002);
}

#[test]
fn four_people_who_cross_all_borders_are_told_of_as_on_one_computer() {
    walk_about(1);
}

#[test]
#[ignore = "two minutes in real time"]
fn the_same_for_two_minutes() {
    walk_about(8);
}
