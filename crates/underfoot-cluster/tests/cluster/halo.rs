//! Boards send to one computer, which forwards the packets that its neighbours need.

use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use underfoot::floor::{Floor, TileId};
use underfoot::layout::Layout;
use underfoot::runtime::{Session, SessionSnapshot};
use underfoot::sense::Quality;
use underfoot::source::{ForwardCounters, UdpSource};
use underfoot::wire::LinkState;

use crate::hall::{AREAS, Boards, Hall, STANDS_STILL_MS, layout, listening, script};
use crate::steady::while_time_is_kept;

/// One computer of the hall, in this process.
fn serve(floor: &Floor, id: &str) -> (Session, Arc<ForwardCounters>) {
    let area = floor.area(id).unwrap();
    let part = floor.part(area).unwrap();
    let source = UdpSource::bind(area.listen.unwrap(), &part).unwrap();
    let source = source.also_allowing(floor.forwarding_addresses(area));
    let (source, forwarded) = source.forwarding(&floor.forwardings(area)).unwrap();
    let clock = source.clock();
    let session = Session::source(source, clock).floor(part).layout(Layout::default());
    (session.realtime().start().unwrap(), forwarded)
}

/// Waits until `wanted` holds for the state of `session`.
fn await_state(session: &Session, what: &str, wanted: impl Fn(&SessionSnapshot) -> bool) -> SessionSnapshot {
    let end = Instant::now() + Duration::from_secs(10);
    loop {
        let snapshot = session.snapshot();
        if wanted(&snapshot) {
            return snapshot;
        }
        assert!(Instant::now() < end, "not {what}: {:?}", snapshot.floor.counters);
        thread::sleep(Duration::from_millis(20));
    }
}

/// The quality of `tile`.
fn quality(floor: &Floor, id: &str, snapshot: &SessionSnapshot, tile: (u16, u16)) -> Quality {
    let part = floor.part(floor.area(id).unwrap()).unwrap();
    let index = part.geometry.index(TileId::new(tile.0, tile.1)).unwrap();
    snapshot.floor.tiles[index].quality[0]
}

const EMPTY: &str = r#"Scenario(title: "Empty", steps: [Wait(ms: 20000)])"#;

#[test]
fn what_a_neighbour_forwards_is_sensed_and_its_death_marks_those_tiles_alone() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let floor = listening();
        let (east, _) = serve(&floor, "se");
        let (west, forwarded) = serve(&floor, "sw");
        let homes = |board| vec![floor.home(board).unwrap().listen.unwrap()];
        let targets: Vec<_> = floor.boards.iter().map(homes).collect();
        let _boards = Boards::start(&floor, script(EMPTY, &floor, &layout(&floor)), targets);
        // (4, 2) is the south-west's, near the border, on a board that only its home forwards to the south-east.
        let live = |snapshot: &SessionSnapshot| {
            snapshot.floor.counters.frames > 200 && quality(&floor, "se", snapshot, (4, 2)) == Quality::Live
        };
        await_state(&east, "live beyond the border", live);
        assert!(forwarded.sent() > 0);
        assert_eq!(forwarded.unsent(), 0);
        drop(west);
        let gone = |snapshot: &SessionSnapshot| quality(&floor, "se", snapshot, (4, 2)) == Quality::Stale;
        let snapshot = await_state(&east, "stale beyond the border", gone);
        assert_eq!(snapshot.floor.link, LinkState::Partial);
        for own in [(6, 2), (9, 4)] {
            assert_eq!(quality(&floor, "se", &snapshot, own), Quality::Live, "{own:?}");
        }
        // It recovers without a restart of the other.
        let (_west, _) = serve(&floor, "sw");
        await_state(&east, "live again", live);
    });
}

#[test]
fn a_board_that_sends_to_both_is_sensed_once() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let floor = listening();
        let (east, _) = serve(&floor, "se");
        let (_west, _) = serve(&floor, "sw");
        let both: Vec<_> = ["sw", "se"].iter().map(|id| floor.area(id).unwrap().listen.unwrap()).collect();
        let targets = vec![both; floor.boards.len()];
        let _boards = Boards::start(&floor, script(EMPTY, &floor, &layout(&floor)), targets);
        let told = await_state(&east, "sent twice", |snapshot| snapshot.floor.counters.duplicate > 1000);
        let counters = told.floor.counters;
        assert_eq!(quality(&floor, "se", &told, (4, 2)), Quality::Live);
        assert!(counters.restarts == 0 && counters.packets > counters.duplicate, "{counters:?}");
    });
}

#[test]
fn a_control_works_while_the_neighbour_that_senses_the_other_half_of_it_is_dead() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let hall = Hall::open();
        // No node serves the south-west, which is near the border.
        let _nodes: Vec<_> = AREAS.iter().filter(|area| **area != "sw").map(|area| hall.node(area)).collect();
        let press = r#"Scenario(title: "Drive", steps: [Wait(ms: 1500), Enter(from: East, at: (9.4, 8.2)),
        Press(widget: "door", force_n: 140, hold_ms: 300), Leave(to: East)])"#;
        let boards = hall.boards(hall.script(press), &[]);
        hall.await_live("se", 0);
        hall.await_live("ne", 0);
        let done = |what: &'static str| {
            move |line: &crate::lines::Line| {
                line.done().is_some_and(|(id, done)| (&*id, &*done) == ("door", what))
            }
        };
        hall.lines.find(0, "door pressed", done("pressed"));
        hall.lines.find(0, "door released", done("released"));
        boards.finish();
    });
}
