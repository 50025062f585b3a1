//! The gateway reports the same as one computer for the whole floor.

use std::collections::{BTreeMap, BTreeSet};

use crate::hall::{AREAS, Hall, Program, STANDS_STILL_MS, say};
use crate::lines::Line;
use crate::steady::while_time_is_kept;

/// Four people who together cross each border in both directions and operate each control, `rounds` times.
pub(crate) fn crowd(rounds: usize) -> String {
    let steps = |enter: &str, round: &str, leave: &str| {
        format!("Wait(ms: 1500), {enter} {} {leave}", round.repeat(rounds))
    };
    let south = steps(
        "Enter(from: West, at: (2.4, 2.2)),",
        "Press(widget: \"ticket\", force_n: 140, hold_ms: 300), WalkTo(at: (6.1, 2.2)),
         Wait(ms: 800), Press(widget: \"drive\", force_n: 110, hold_ms: 700), WalkTo(at: (9.4, 2.2)), WalkTo(at: (2.4, 2.2)),",
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
        "WalkTo(at: (10.5, 7.0)), WalkTo(at: (8.4, 6.0)), WalkTo(at: (8.4, 4.4)), WalkTo(at: (10.5, 4.0)),",
        "Leave(to: East),",
    );
    let others: Vec<String> = [north, west, east].iter().map(|steps| format!("(steps: [{steps}])")).collect();
    format!("Scenario(title: \"Crowd\", steps: [{south}], others: [{}])", others.join(", "))
}

/// The reports of one floor.
struct Account {
    /// Each event: control, kind, time, and time of arrival.
    events: Vec<(String, String, f64, std::time::Instant)>,
    /// The contacts by their numbers: times and positions.
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

    /// The same with as few contact reports as a gateway sends, a hundred times a second.
    fn thinned(self) -> Self {
        let thin = |track: Vec<_>| track.into_iter().step_by(10).collect();
        Self { tracks: self.tracks.into_iter().map(|(id, track)| (id, thin(track))).collect(), ..self }
    }

    /// Each control's events, in the order of their times.
    fn done(&self) -> Vec<(&str, &str)> {
        let mut all: Vec<_> =
            self.events.iter().map(|(id, done, _, _)| (id.as_str(), done.as_str())).collect();
        // Events of several controls at the same time have no order.
        all.sort_by_key(|(id, _)| *id);
        // The number of reported values of a moving slider depends on the start of its rate limit.
        all.dedup_by(|next, last| next == last && next.1 == "changed");
        all
    }

    /// Prints each event with its time, to find differences.
    fn say(&self, name: &str) {
        for (id, done, t_s, _) in &self.events {
            say(&format!("{name}: {t_s:.4} s {id} {done}"));
        }
    }

    /// The nth event of each control and kind.
    fn moments(&self) -> BTreeMap<(String, String, usize), (f64, std::time::Instant)> {
        let mut counts = BTreeMap::<_, usize>::new();
        let lasting = self.events.iter().filter(|(_, done, _, _)| done != "changed");
        let numbered = lasting.map(|(id, done, t_s, came)| {
            let count = counts.entry((id, done)).or_default();
            *count += 1;
            ((id.clone(), done.clone(), *count), (*t_s, *came))
        });
        numbered.collect()
    }
}

/// The distance of `place` from the path of a contact from 2 ms before `t_s` to 2 ms after it; `None` if it was not
/// there.
pub(crate) fn distance(track: &[(f64, f64, f64)], t_s: f64, place: (f64, f64)) -> Option<f64> {
    const APART_S: f64 = 0.002;
    let first = track.partition_point(|(time, _, _)| *time < t_s - APART_S);
    let end = track.partition_point(|(time, _, _)| *time <= t_s + APART_S);
    let way = &track[first..end];
    let along = way.windows(2).map(|pair| {
        let [(_, x, y), (_, to_x, to_y)] = [pair[0], pair[1]];
        let (dx, dy, px, py) = (to_x - x, to_y - y, place.0 - x, place.1 - y);
        let share = ((px * dx + py * dy) / (dx * dx + dy * dy).max(1e-12)).clamp(0.0, 1.0);
        (px - share * dx).hypot(py - share * dy)
    });
    along.chain(way.iter().map(|(_, x, y)| (place.0 - x).hypot(place.1 - y))).min_by(f64::total_cmp)
}

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    all[all.len() / 2]
}

fn quantile(all: &mut [f64], share: f64) -> f64 {
    all.sort_by(f64::total_cmp);
    all[((all.len() - 1) as f64 * share) as usize]
}

/// The difference between the reports of two accounts of the same floor, in seconds, metres and numbers.
struct Difference {
    /// For each event, the difference of its times, and the delay of the first account's report.
    apart_s: Vec<f64>,
    added_s: Vec<f64>,
    /// For each position of a contact, its distance from the path of its counterpart; some have none.
    places_m: Vec<f64>,
    unmatched: usize,
    /// Number of contacts; those with one counterpart in the other account; the other's lasting ones.
    names: usize,
    others: usize,
    lasting: usize,
}

impl Difference {
    /// The differences of `here` from `there`.
    fn of(here: &Account, there: &Account) -> Self {
        // The same times, but for the start of their clocks.
        let (moments, others) = (here.moments(), there.moments());
        let offset = median(others.iter().map(|(event, (t_s, _))| moments[event].0 - t_s).collect());
        let apart = |event, t_s: f64| (moments[event].0 - t_s - offset).abs();
        for (event, (t_s, _)) in others.iter().filter(|(event, (t_s, _))| apart(event, *t_s) > 0.002) {
            say(&format!("{event:?} at {t_s:.4} s is at {:.4} s here", moments[event].0 - offset));
        }
        let apart_s = others.iter().map(|(event, (t_s, _))| apart(event, *t_s)).collect();
        let added = |(event, (_, came)): (_, &(f64, std::time::Instant))| {
            let later = moments[event].1;
            later.saturating_duration_since(*came).as_secs_f64()
                - came.saturating_duration_since(later).as_secs_f64()
        };
        let added_s = others.iter().map(added).collect();

        // The same contacts with other numbers, one for one.
        let mut pairs = BTreeMap::new();
        let (mut places_m, mut unmatched) = (Vec::new(), 0);
        for (id, track) in &here.tracks {
            let times = track.iter().map(|&(t_s, x, y)| (t_s - offset, (x, y)));
            let shared = |other: &[(f64, f64, f64)]| {
                let near = times.clone().filter_map(|(t_s, place)| distance(other, t_s, place));
                near.filter(|apart| *apart < 0.05).count()
            };
            let Some((other, most)) = there.tracks.iter().max_by_key(|(_, track)| shared(track)) else {
                continue;
            };
            pairs.insert(*id, *other);
            let apart: Vec<_> = times.clone().map(|(t_s, place)| (t_s, distance(most, t_s, place))).collect();
            let further = |&&(_, apart): &&(f64, Option<f64>)| apart.is_none_or(|apart| apart > 0.001);
            if let Some((first, _)) = apart.iter().find(further) {
                let count = apart.iter().filter(further).count();
                let worst = apart.iter().filter_map(|(_, apart)| *apart).fold(0.0, f64::max);
                say(&format!(
                    "{id}, there {other}, is elsewhere for {count} of {} places, from {first:.3} s on, by {:.1} mm",
                    apart.len(),
                    1e3 * worst
                ));
            }
            unmatched += apart.iter().filter(|(_, apart)| apart.is_none()).count();
            places_m.extend(apart.into_iter().filter_map(|(_, apart)| apart));
        }
        let others: BTreeSet<u64> = pairs.values().copied().collect();
        // Contacts of a few milliseconds may be missing from reports 100 times a second.
        let lasting = there.tracks.iter().filter(|(_, track)| track.len() > 30);
        for (id, track) in lasting.clone().filter(|(id, _)| !others.contains(id)) {
            say(&format!(
                "{id} there, from {:.3?} to {:.3?}, is nobody here",
                track[0],
                track[track.len() - 1]
            ));
        }
        Self {
            apart_s,
            added_s,
            places_m,
            unmatched,
            names: pairs.len(),
            others: others.len(),
            lasting: lasting.count(),
        }
    }

    fn say(&mut self, what: &str) {
        let ms = |all: &mut [f64], share| 1e3 * quantile(all, share);
        say(&format!(
            "{what}: times {:.2} ms apart in the middle, at most {:.2}; told {:.2} ms later, 99 % {:.2}, at most {:.2}",
            ms(&mut self.apart_s, 0.5),
            ms(&mut self.apart_s, 1.0),
            ms(&mut self.added_s, 0.5),
            ms(&mut self.added_s, 0.99),
            ms(&mut self.added_s, 1.0)
        ));
        let near = self.places_m.iter().filter(|apart| **apart <= 0.001).count();
        say(&format!(
            "{what}: {} places, {near} within 1 mm; 99 % within {:.3} mm, at most {:.3}; {} without a counterpart",
            self.places_m.len(),
            ms(&mut self.places_m, 0.99),
            ms(&mut self.places_m, 1.0),
            self.unmatched
        ));
        say(&format!(
            "{what}: {} names, which are {} there, where {} last",
            self.names, self.others, self.lasting
        ));
    }
}

/// Runs people for `rounds`, and compares the reports; contacts, places and times only if `is_exact`, for which the
/// machine must have time for six computers.
fn walk_about(rounds: usize, is_exact: bool) {
    let hall = Hall::open();
    let nodes: Vec<Program> = AREAS.iter().map(|area| hall.node(area)).collect();
    // Two computers for the whole floor differ as well: each derives the millisecond of a packet from its arrival.
    let singles: Vec<_> = (0..1 + usize::from(is_exact)).map(|_| hall.single()).collect();
    let ports: Vec<u16> = singles.iter().map(|(_, port, ..)| *port).collect();
    let boards = hall.boards(hall.script(&crowd(rounds)), &ports);
    AREAS.iter().for_each(|area| hall.await_live(area, 0));
    boards.finish();
    // The last events are on their way.
    std::thread::sleep(std::time::Duration::from_millis(300));
    let accounts = singles.into_iter().map(|(session, _, lines, frames)| {
        let floor = session.snapshot().floor.clone();
        floor.ignored.iter().for_each(|press| say(&press.to_string()));
        let counters = floor.counters;
        say(&format!(
            "one computer: {} packets lost, {} late, {} jumps, {} slips",
            counters.lost, counters.late, counters.jumps, counters.slips
        ));
        session.stop();
        Account { tracks: frames.tracks(), ..Account::of(&lines.all()) }
    });
    let mut accounts: Vec<Account> = accounts.collect();
    // Programs print their counters at their end.
    nodes.into_iter().for_each(Program::end);
    let joined = Account::of(&hall.lines.all());
    let twin = accounts.drain(1..).next().map(Account::thinned);
    let whole = &accounts[0];

    // The same events in the same order.
    say(&format!("{} events, {} contacts", whole.events.len(), whole.tracks.len()));
    assert!(whole.done().len() > 13 * rounds, "{:?}", whole.done());
    if joined.done() != whole.done() {
        joined.say("joined");
        whole.say("one computer");
    }
    assert_eq!(joined.done(), whole.done());
    let mut difference = Difference::of(&joined, whole);
    difference.say("four nodes");
    let Some(twin) = twin else { return };
    Difference::of(&twin, whole).say("one computer again");

    // The millisecond of a packet can decide whether a foot counts as one or two. On equal frames, `offline` demands
    // equal contacts.
    let Difference { mut apart_s, mut places_m, unmatched, names, others, lasting, .. } = difference;
    let most = lasting / 100;
    assert!(others + most >= names, "two names here are one there");
    assert!(others + most >= lasting, "one name here is two there");
    assert!(unmatched * 100 <= places_m.len());
    assert!(quantile(&mut places_m, 0.99) <= 0.001);
    assert!(quantile(&mut apart_s, 1.0) <= 0.002);
}

#[test]
fn events_of_four_people_who_cross_all_borders_are_those_of_one_computer() {
    while_time_is_kept(STANDS_STILL_MS, || walk_about(1, false));
}

/// With `UNDERFOOT_NETNS`, each node runs in a network namespace of its own.
#[test]
#[ignore = "two minutes in real time"]
fn the_same_for_two_minutes_with_names_places_and_times() {
    while_time_is_kept(STANDS_STILL_MS, || walk_about(8, true));
}
