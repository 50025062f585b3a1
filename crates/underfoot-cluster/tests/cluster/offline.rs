//! The comparison without sockets and clocks: four nodes and a gateway against one computer, frame by frame.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use underfoot::floor::{Board, Floor};
use underfoot::layout::Layout;
use underfoot::sense::Method;
use underfoot::serve::Server;
use underfoot::sink::{EventSink, wait_free};
use underfoot::source::{SensorSource, SourceError};
use underfoot::units::Instant;
use underfoot::wire::{LinkCounters, SensorPacket};
use underfoot_cluster::auth::Echo;
use underfoot_cluster::gateway::{Gateway, Output};
use underfoot_cluster::message::{NodeMessage, VERSION, fingerprint};
use underfoot_cluster::node::NodeSink;
use underfoot_sim::{Pace, SimulatedSource};

use crate::hall::{AREAS, Frames, floor, layout, say, script, source};
use crate::same::{crowd, distance};

/// Runs one computer that serves `part` of the hall, in which people walk about for `rounds`, and reports to `sink`.
fn serve(
    (whole, controls, rounds): (&Floor, &Layout, usize),
    part: &Floor,
    own: Layout,
    sink: impl EventSink + 'static,
) {
    let people = script(&crowd(rounds), whole, controls);
    let numbers = whole.boards.iter().map(|board| {
        let is_it = |own: &Board| own.address == board.address;
        part.boards.iter().position(is_it).and_then(|number| u16::try_from(number).ok())
    });
    let source = source(whole, people, Pace::FreeRunning);
    let source = Part { source, numbers: numbers.collect() };
    Server::new(part, own, Method::default(), source)
        .with_events(Box::new(sink))
        .run(&AtomicBool::new(false))
        .unwrap();
}

/// The board packets of a part of the hall, by that part's numbers.
struct Part {
    source: SimulatedSource,
    /// By the hall's numbers.
    numbers: Vec<Option<u16>>,
}

impl SensorSource for Part {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        loop {
            let Some(packet) = self.source.next(patience)? else { return Ok(None) };
            if let Some(board) = self.numbers[usize::from(packet.board)] {
                return Ok(Some(SensorPacket { board, ..packet }));
            }
        }
    }

    fn now(&self) -> Instant {
        self.source.now()
    }

    fn counters(&self) -> LinkCounters {
        self.source.counters()
    }
}

/// The messages of the node of an area; its clock is the simulated one.
fn messages(hall: (&Floor, &Layout, usize), area: &str, node: u64) -> Vec<NodeMessage> {
    let (floor, layout, _) = hall;
    // One every 2 ms, and some for events, in a round of half a minute.
    let (out, mut drafts) = wait_free(30_000 * hall.2);
    let area = floor.area(area).unwrap();
    let part = floor.part(area).unwrap();
    serve(hall, &part, layout.clone().part(area, &floor.geometry), NodeSink::new(out));
    let numbered = drafts.try_iter().zip(1..);
    let message = numbered.map(|(draft, sequence)| {
        let area = area.id.clone();
        let head = NodeMessage {
            version: VERSION,
            floor: fingerprint(floor),
            area,
            node,
            sequence,
            ..NodeMessage::default()
        };
        let told = draft.message(head);
        let sent = told.frame.unwrap_or(0) + 5000;
        let echo = Some(Echo { sent: sent - 200, received: sent });
        NodeMessage { sent, echo, ..told }
    });
    message.filter(|message| message.frame.is_some()).collect()
}

/// Runs people for `rounds`, and compares every event, and every contact of every frame.
fn compare(rounds: usize) {
    let floor = floor();
    let layout = layout(&floor);
    let hall = (&floor, &layout, rounds);
    let whole = Frames::default();
    serve(hall, &floor, layout.clone(), whole.clone());
    let (events, whole) = (whole.events(), whole.tracks());
    let mut all: Vec<NodeMessage> =
        AREAS.iter().zip(1..).flat_map(|(area, node)| messages(hall, area, node)).collect();
    all.sort_by_key(|message| message.sent);
    let mut gateway = Gateway::new(&floor, 9).unwrap();
    let mut joined = Frames::default();
    for message in all {
        let now = Instant::from_micros(message.sent + 200);
        gateway.take(message, now);
        gateway.advance(now).iter().filter_map(Output::report).for_each(|report| joined.report(report));
    }
    assert_eq!(gateway.counters().unpressed, 0, "each hold follows its press");
    // The same times, to the microsecond.
    say(&format!("{} events", events.len()));
    assert_eq!(joined.events(), events);
    let tracks = joined.tracks();
    let mut pairs = BTreeMap::new();
    let (mut places, mut apart, mut worst) = (0, 0, 0.0_f64);
    for (id, track) in &tracks {
        let near = |other: &[(f64, f64, f64)]| {
            let distances = track.iter().filter_map(|&(t_s, x, y)| distance(other, t_s, (x, y)));
            distances.filter(|distance| *distance < 0.001).count()
        };
        let (other, there) = whole.iter().max_by_key(|(_, other)| near(other)).unwrap();
        pairs.insert(*id, *other);
        let mut first = None;
        for &(t_s, x, y) in track {
            let distance = distance(there, t_s, (x, y)).unwrap_or(1.0);
            places += 1;
            worst = worst.max(distance);
            if distance > 0.001 {
                apart += 1;
                first.get_or_insert((t_s, x, y, distance));
            }
        }
        if let Some(first) = first {
            say(&format!("{id}, there {other}, of {} places: first apart {first:.4?}", track.len()));
        }
    }
    say(&format!(
        "{} contacts, {} there; {apart} of {places} places more than 1 mm apart, at most {:.2} mm",
        tracks.len(),
        whole.len(),
        worst * 1e3
    ));
    let others: BTreeSet<u64> = pairs.values().copied().collect();
    assert_eq!((tracks.len(), others.len()), (whole.len(), whole.len()));
    // The split of the load between two feet that share tiles may be decided a millisecond earlier or later: a node
    // processes the sensors of its tiles in another order. Measured over eight rounds: 4 of 821,479, by 1.5 mm.
    assert!(apart * 10_000 <= places, "{apart} of {places}");
    assert!(worst <= 0.01, "{worst} m");
}

#[test]
fn events_and_contacts_of_four_nodes_are_those_of_one_computer() {
    compare(1);
}

#[test]
#[ignore = "a minute or two of computing"]
fn the_same_for_eight_rounds() {
    compare(8);
}
