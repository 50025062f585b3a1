//! Cues between the nodes of neighbouring areas.

use std::ops::Range;
use std::sync::atomic::AtomicU64;
use std::sync::mpsc::sync_channel;
use std::sync::{Mutex, PoisonError};

use underfoot::feel::{Click, Hum, Lasting, Mode, SustainedCue};
use underfoot::floor::{Board, Corner, Geometry, SensorId};
use underfoot::source::Seal;
use underfoot::units::{HostClock, Newtons};

use super::*;
use crate::auth::{AuthRefusals, AuthSession, Key, Role};
use crate::node::{NeighbourSeal, NeighbourSession};

/// Offset of the east's clock against the west's.
const AHEAD_MS: u64 = 70_000;

type Wire = Arc<Mutex<Vec<Vec<u8>>>>;

/// One of the two nodes.
struct End {
    border: Border,
    seal: NeighbourSeal,
    session: NeighbourSession,
    /// Its clock, in microseconds.
    now: Arc<AtomicU64>,
    /// Datagrams on their way.
    wire: Wire,
    /// Datagrams that have arrived.
    arrived: Vec<Vec<u8>>,
}

impl End {
    fn new(floor: &Floor, number: usize, nonce: u64, key: &Key) -> Self {
        let now = Arc::<AtomicU64>::default();
        let shown = Arc::clone(&now);
        let clock: HostClock = Arc::new(move || Instant::from_micros(shown.load(Ordering::Relaxed)));
        let session = NeighbourSession::new(AuthSession::new(Role::Neighbour, key, nonce, 8), clock);
        let wire = Wire::default();
        let (to_wire, sealing) = (Arc::clone(&wire), session.clone());
        let send = move |to, note: &[u8]| {
            assert_eq!(to, 0, "there is one neighbour");
            let mut sealed = Vec::new();
            sealing.seal_note(note, &mut sealed);
            to_wire.lock().unwrap_or_else(PoisonError::into_inner).push(sealed);
            true
        };
        let (out, notes) = sync_channel(100);
        let border = Border::new(floor, &floor.areas[number], Box::new(send), notes);
        let seal = NeighbourSeal::new(session.clone(), out);
        Self { border, seal, session, now, wire, arrived: Vec::new() }
    }

    fn set_clock(&self, now: Instant) {
        self.now.store(now.micros(), Ordering::Relaxed);
    }

    /// Processes the datagrams that have arrived.
    fn take(&mut self, now: Instant) -> (Vec<Cue>, SustainedCues) {
        self.set_clock(now);
        for bytes in self.arrived.drain(..) {
            let _ = self.seal.open(&bytes);
        }
        let (mut cues, mut sustained) = Default::default();
        self.border.poll(now);
        self.border.take(now, now, &mut cues, &mut sustained);
        (cues, sustained)
    }
}

/// Two areas of 6 x 6 tiles beside each other.
struct Pair([End; 2]);

fn floor() -> Floor {
    let area = |id: &str, number: u16| Area {
        listen: Some(([127, 0, 0, 1], 9000 + number).into()),
        ..Area::new(id, TileBlock { first: TileId::new(6 * number, 0), columns: 6, rows: 6 })
    };
    Floor::of(Geometry::of_paper_tiles(12, 6).unwrap()).with_areas(vec![area("west", 0), area("east", 1)])
}

fn key() -> Key {
    Key::new([7; 32])
}

impl Pair {
    fn new() -> Self {
        let floor = floor();
        Self([0, 1].map(|number| End::new(&floor, number, number as u64 + 1, &key())))
    }

    /// Delivers the datagrams of one end, or drops them.
    fn deliver(&mut self, from: usize, arrives: bool) {
        let sent = std::mem::take(&mut *self.0[from].wire.lock().unwrap());
        if arrives {
            self.0[1 - from].arrived.extend(sent);
        }
    }

    /// Processes the datagrams of one end when the clock of the west shows `ms`.
    fn take(&mut self, who: usize, ms: u64) -> (Vec<Cue>, SustainedCues) {
        self.0[who].take(Instant::from_millis(ms + AHEAD_MS * who as u64))
    }

    /// Sends cues of the west.
    fn give(&mut self, cues: &[Cue], lasting: &SustainedCues, ms: u64) {
        let now = Instant::from_millis(ms);
        self.0[0].set_clock(now);
        self.0[0].border.give(cues, lasting, now);
    }

    fn counters(&self, who: usize) -> Arc<BorderCounters> {
        self.0[who].border.counters()
    }

    /// Exchanges notes for some milliseconds, so that each end knows the other's clock.
    fn compare_clocks(&mut self, span: Range<u64>) {
        for ms in span {
            for who in [0, 1] {
                self.deliver(1 - who, true);
                self.take(who, ms);
            }
        }
    }
}

/// A click on tile (5, 2) of the west and (6, 2) of the east, of a control of the west; the west's part has 10
/// columns.
fn click(at_ms: u64) -> Cue {
    let spots = [5, 6].map(|column| Spot { tile: 2 * 10 + column, weight: 0.5 });
    let mode = Mode { frequency_hz: 150.0, decay_s: 0.02, amplitude: 1.0 };
    Cue {
        at: Instant::from_millis(at_ms),
        spots: spots.into_iter().collect(),
        click: Click { level: Newtons(4.0), modes: [mode].into_iter().collect(), ..Click::default() },
        audio_gain: 1.0,
        ..Cue::default()
    }
}

#[test]
fn a_cue_is_felt_on_the_neighbour_s_tiles_with_its_next_frame() {
    let mut pair = Pair::new();
    pair.compare_clocks(1000..1200);
    pair.give(&[click(1300)], &SustainedCues::new(), 1300);
    pair.deliver(0, true);
    let (cues, _) = pair.take(1, 1302);
    // The east senses from column 2 on: column 6 is the fifth of its ten.
    let cue = Cue { at: Instant::from_millis(1302 + AHEAD_MS), ..click(0) };
    let here = Spot { tile: 2 * 10 + 4, weight: 0.5 };
    assert_eq!(cues, [Cue { received: cue.at, spots: [here].into_iter().collect(), audio_gain: 0.0, ..cue }]);
    let (west, east) = (pair.counters(0), pair.counters(1));
    assert_eq!((west.given(), east.felt(), east.late(), east.lost(), east.untimed()), (1, 1, 0, 0, 0));
    // No cue comes back.
    pair.deliver(1, true);
    assert!(pair.take(0, 1303).0.is_empty());
}

#[test]
fn computers_that_exchange_packets_exchange_notes() {
    // Areas of six columns in a row. The board of the second one covers all of the third as well. The fourth
    // senses tiles of the third, but is too far from the second to sense the second's own tiles.
    let area = |id: &str, number: u16| Area {
        listen: Some(([127, 0, 0, 1], 9000 + number).into()),
        ..Area::new(id, TileBlock { first: TileId::new(6 * number, 0), columns: 6, rows: 1 })
    };
    let areas = ["a", "b", "c", "d"].into_iter().zip(0..).map(|(id, number)| area(id, number)).collect();
    let mut floor = Floor::of(Geometry::of_paper_tiles(24, 1).unwrap()).with_areas(areas);
    let sensors = |tile| Corner::ALL.map(|corner| Some(SensorId { tile, corner }));
    let channels = (6..18).flat_map(|column| sensors(TileId::new(column, 0))).collect();
    floor.boards = vec![Board::new("/underfoot/board/0", channels)];
    let ids = |number: usize| -> Vec<&str> {
        Border::neighbours(&floor, &floor.areas[number]).into_iter().map(|area| &*area.id).collect()
    };
    assert_eq!((ids(1), ids(3)), (vec!["a", "c", "d"], vec!["b", "c"]));
}

#[test]
fn a_cue_on_own_tiles_alone_stays_here() {
    let mut pair = Pair::new();
    pair.compare_clocks(1000..1200);
    let own = Cue { spots: [Spot { tile: 0, weight: 1.0 }].into_iter().collect(), ..click(1300) };
    pair.give(&[own], &SustainedCues::new(), 1300);
    assert!(pair.0[0].wire.lock().unwrap().is_empty());
}

#[test]
fn a_cue_that_is_late_or_lost_is_counted_and_not_played() {
    let mut pair = Pair::new();
    let give = |pair: &mut Pair, ms| pair.give(&[click(ms)], &SustainedCues::new(), ms);
    pair.compare_clocks(1000..1200);
    give(&mut pair, 1300);
    pair.deliver(0, true);
    assert!(pair.take(1, 1351).0.is_empty(), "51 ms old");
    pair.compare_clocks(1352..1400);
    give(&mut pair, 1400);
    pair.deliver(0, true);
    assert_eq!(pair.take(1, 1449).0.len(), 1, "49 ms old");
    pair.compare_clocks(1450..1500);
    give(&mut pair, 1500);
    pair.deliver(0, false);
    give(&mut pair, 1600);
    pair.deliver(0, true);
    assert_eq!(pair.take(1, 1601).0.len(), 1);
    let east = pair.counters(1);
    assert_eq!((east.felt(), east.late(), east.lost(), east.untimed(), east.refused()), (2, 1, 1, 0, 0));
}

#[test]
fn what_lasts_is_felt_until_it_ends_or_nothing_is_heard_for_50_ms() {
    let mut pair = Pair::new();
    pair.compare_clocks(1000..1200);
    let hum = SustainedCue {
        key: 7,
        spots: click(0).spots,
        effect: Lasting::Hum(Hum { level: Newtons(2.0), hz: 100.0, noise: 0.0 }),
        force: Newtons(80.0),
        ..SustainedCue::default()
    };
    let lasting: SustainedCues = [hum].into_iter().collect();
    let mut notes = 0;
    for ms in 1300..1320 {
        pair.give(&[], &lasting, ms);
        notes += pair.0[0].wire.lock().unwrap().len();
        pair.deliver(0, true);
        let (_, felt) = pair.take(1, ms);
        assert_eq!(felt.len(), 1, "{ms}");
        assert_eq!((felt[0].force, felt[0].spots.len()), (Newtons(80.0), 1));
        assert_ne!(felt[0].key, 7, "a foot here may have that name");
    }
    assert_eq!(notes, 5, "every 4 ms");
    pair.give(&[], &SustainedCues::new(), 1320);
    pair.deliver(0, true);
    assert!(pair.take(1, 1320).1.is_empty(), "it has ended");
    pair.give(&[], &lasting, 1400);
    pair.deliver(0, true);
    assert_eq!(pair.take(1, 1400).1.len(), 1);
    assert_eq!(pair.take(1, 1450).1.len(), 1);
    assert!(pair.take(1, 1451).1.is_empty(), "the neighbour is silent");
}

/// A note of the west with a cue for tile (6, 2) of the east.
fn note(pair: &Pair) -> Note {
    let cue = NoteCue { at: 1_300_000, spots: vec![(6, 2, 1.0)], ..NoteCue::default() };
    Note { cues: vec![cue], ..pair.0[0].border.head.clone() }
}

#[test]
fn a_cue_that_comes_before_the_first_answer_is_not_played() {
    let mut pair = Pair::new();
    pair.give(&[click(900)], &SustainedCues::new(), 900);
    pair.deliver(0, true);
    assert!(pair.take(1, 901).0.is_empty());
    assert_eq!(pair.0[1].session.refusals(), AuthRefusals { unanswered: 1, ..AuthRefusals::default() });
}

#[test]
fn a_neighbour_that_starts_again_is_met_anew() {
    let mut pair = Pair::new();
    pair.compare_clocks(1000..1200);
    pair.0[0] = End::new(&floor(), 0, 77, &key());
    pair.give(&[click(1300)], &SustainedCues::new(), 1300);
    pair.deliver(0, true);
    assert!(pair.take(1, 1301).0.is_empty(), "it has not answered");
    pair.compare_clocks(1302..1400);
    pair.give(&[click(1400)], &SustainedCues::new(), 1400);
    pair.deliver(0, true);
    assert_eq!(pair.take(1, 1401).0.len(), 1);
    assert_eq!(pair.counters(1).lost(), 0);
}

#[test]
fn a_note_of_another_floor_or_of_no_neighbour_is_refused() {
    let mut pair = Pair::new();
    pair.compare_clocks(1000..1200);
    let good = note(&pair);
    let others = [
        Note { floor: good.floor + 1, ..good.clone() },
        Note { area: "nowhere".into(), ..good.clone() },
        Note { version: VERSION + 1, ..good.clone() },
    ];
    let send = |pair: &mut Pair, bytes: &[u8]| {
        pair.0[0].set_clock(Instant::from_millis(1300));
        assert!((pair.0[0].border.send)(0, bytes));
        pair.deliver(0, true);
        pair.take(1, 1300).0.len()
    };
    for other in &others {
        assert_eq!(send(&mut pair, &encode(other)), 0);
    }
    assert_eq!(send(&mut pair, b"{}"), 0);
    assert_eq!(pair.counters(1).refused(), 4);
    assert_eq!(send(&mut pair, &encode(&good)), 1);
}

// C5, C6
#[test]
fn a_note_without_the_key_or_for_the_second_time_moves_no_actuator() {
    let mut pair = Pair::new();
    pair.compare_clocks(1000..1200);
    let forger = End::new(&floor(), 0, 1, &Key::new([8; 32]));
    forger.set_clock(Instant::from_millis(1300));
    let good = encode(&note(&pair));
    let mut forged = Vec::new();
    forger.session.seal_note(&good, &mut forged);
    pair.0[0].set_clock(Instant::from_millis(1300));
    let mut sealed = Vec::new();
    pair.0[0].session.seal_note(&good, &mut sealed);
    for bytes in [&forged, &good, &sealed, &sealed] {
        pair.0[1].arrived.push(bytes.clone());
    }
    assert_eq!(pair.take(1, 1300).0.len(), 1, "the one that is genuine, once");
    let refused = AuthRefusals { forged: 1, malformed: 1, repeated: 1, ..AuthRefusals::default() };
    assert_eq!(pair.0[1].session.refusals(), refused);
}
