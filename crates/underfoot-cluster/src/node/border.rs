//! Haptic cues that cross the border to a neighbour's tiles, in both directions.
//!
//! A control on a border belongs to one node. That node sends its cues to each neighbour that shares their tiles, at
//! once and by UDP, like the packets of boards near the border. A late cue is dropped: a foot would feel it as the
//! answer to something else. Neighbours compare their clocks, because only then is the age of a cue known. Notes
//! travel in envelopes of [`crate::auth`], so that only computers of the floor move its actuators.

use std::collections::HashSet;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::Receiver;
use std::time::Duration;

use underfoot::feel::{Cue, MAX_SPOTS, Spot, SustainedCues};
use underfoot::floor::{Area, Floor, Geometry, TileBlock, TileId};
use underfoot::serve::Neighbours;
use underfoot::units::Instant;

use crate::auth::{Echo, EnvelopeHead};
use crate::gateway::NodeClock;
use crate::message::{Note, NoteCue, NoteLasting, NoteSpot, VERSION, decode, encode, fingerprint};

/// Greatest age of a cue that is still played: a click within 50 ms feels like an answer to the foot.
const MOST_AGE: Duration = Duration::from_millis(50);

/// Interval between two notes without any cue: clocks are compared as often as with the gateway.
const QUIET: Duration = Duration::from_millis(50);

/// Interval between two notes during a sustained cue; the renderer smooths these steps.
const LASTING: Duration = Duration::from_millis(4);

/// Greatest number of sustained cues in one note, so that it fits in a datagram; further ones are left out and
/// counted.
const MOST_LASTING: usize = 10;

/// Sends a note in an envelope to the neighbour with this number; returns false on failure.
pub type SendNote = Box<dyn FnMut(usize, &[u8]) -> bool + Send>;

/// An accepted note.
#[derive(Clone, Debug, PartialEq)]
pub struct ReceivedNote {
    /// Its sender, number and time.
    pub head: EnvelopeHead,
    /// The message that it answers.
    pub echo: Option<Echo>,
    /// The content of the note.
    pub body: Vec<u8>,
}

/// Counts of cues that crossed the borders and of those that failed to, since the start.
#[derive(Debug, Default)]
pub struct BorderCounters {
    given: AtomicU64,
    felt: AtomicU64,
    late: AtomicU64,
    lost: AtomicU64,
    untimed: AtomicU64,
    unsent: AtomicU64,
    refused: AtomicU64,
}

impl BorderCounters {
    /// Cues sent to neighbours.
    #[must_use]
    pub fn given(&self) -> u64 {
        self.given.load(Ordering::Relaxed)
    }

    /// Cues of neighbours played here.
    #[must_use]
    pub fn felt(&self) -> u64 {
        self.felt.load(Ordering::Relaxed)
    }

    /// Cues of neighbours that were older than 50 ms and therefore dropped.
    #[must_use]
    pub fn late(&self) -> u64 {
        self.late.load(Ordering::Relaxed)
    }

    /// Cues of neighbours that did not arrive.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost.load(Ordering::Relaxed)
    }

    /// Cues of neighbours that came before the clocks had been compared and were therefore dropped.
    #[must_use]
    pub fn untimed(&self) -> u64 {
        self.untimed.load(Ordering::Relaxed)
    }

    /// Cues and sustained cues that could not be sent to a neighbour.
    #[must_use]
    pub fn unsent(&self) -> u64 {
        self.unsent.load(Ordering::Relaxed)
    }

    /// Notes that could not be parsed, or that come from another sender than a neighbour on this floor.
    #[must_use]
    pub fn refused(&self) -> u64 {
        self.refused.load(Ordering::Relaxed)
    }
}

fn count(counter: &AtomicU64, by: usize) {
    counter.fetch_add(by as u64, Ordering::Relaxed);
}

/// One neighbour.
#[derive(Debug)]
struct Neighbour {
    area: String,
    tiles: TileBlock,
    /// The time of the last note to it, and the number of cues in all of them.
    told: Option<Instant>,
    given: u64,
    /// Whether the last note held a sustained cue.
    told_lasting: bool,
    /// Its nonce, the number and arrival of its last note, and the number of cues that it had counted by then.
    node: u64,
    heard: u64,
    came: Instant,
    had: Option<u64>,
    clock: NodeClock,
    lasting: Vec<NoteLasting>,
}

impl Neighbour {
    fn new(area: &Area) -> Self {
        Self {
            area: area.id.clone(),
            tiles: area.tiles,
            told: None,
            given: 0,
            told_lasting: false,
            node: 0,
            heard: 0,
            came: Instant::START,
            had: None,
            clock: NodeClock::default(),
            lasting: Vec::new(),
        }
    }

    /// Resets all state that belongs to the previous node of this area.
    fn meet(&mut self, node: u64) {
        let Self { area, tiles, told, given, told_lasting, .. } = self;
        let (area, tiles) = (std::mem::take(area), *tiles);
        let known = Area::new(&area, tiles);
        *self = Self { told: *told, given: *given, told_lasting: *told_lasting, node, ..Self::new(&known) };
    }
}

/// The borders of one area.
pub struct Border {
    /// The fields that all notes have in common.
    head: Note,
    /// The geometry of the part that the node senses, and its own tiles.
    geometry: Geometry,
    own: TileBlock,
    neighbours: Vec<Neighbour>,
    send: SendNote,
    notes: Receiver<ReceivedNote>,
    counters: Arc<BorderCounters>,
}

impl Border {
    /// The areas with which the node of `area` exchanges notes, in the order of their numbers: those on whose tiles
    /// it senses feet, and those with which it exchanges packets of boards. Areas without an address to listen on are
    /// left out.
    #[must_use]
    pub fn neighbours<'f>(floor: &'f Floor, area: &Area) -> Vec<&'f Area> {
        let sensed = area.sensed(&floor.geometry);
        let to: HashSet<SocketAddr> = floor.forwardings(area).into_iter().flat_map(|one| one.to).collect();
        let from: HashSet<&str> = floor.forwarders(area).into_iter().map(|one| one.id.as_str()).collect();
        let is_neighbour = |other: &&Area| {
            let touches = !other.tiles.common(&sensed).is_empty();
            let sends = other.listen.is_some_and(|listen| to.contains(&listen));
            other.id != area.id && other.listen.is_some() && (touches || sends || from.contains(&*other.id))
        };
        floor.areas.iter().filter(is_neighbour).collect()
    }

    /// The borders of `area`. `send` sends notes, and `notes` receives them.
    #[must_use]
    pub fn new(floor: &Floor, area: &Area, send: SendNote, notes: Receiver<ReceivedNote>) -> Self {
        let head =
            Note { version: VERSION, floor: fingerprint(floor), area: area.id.clone(), ..Note::default() };
        Self {
            head,
            geometry: floor.geometry.part(&area.sensed(&floor.geometry)).unwrap_or(floor.geometry),
            own: area.tiles,
            neighbours: Self::neighbours(floor, area).into_iter().map(Neighbour::new).collect(),
            send,
            notes,
            counters: Arc::default(),
        }
    }

    /// The counters.
    #[must_use]
    pub fn counters(&self) -> Arc<BorderCounters> {
        Arc::clone(&self.counters)
    }

    /// Sends a note to neighbour number `number` at `now`.
    fn tell(&mut self, number: usize, cues: Vec<NoteCue>, lasting: Vec<NoteLasting>, now: Instant) {
        let neighbour = &mut self.neighbours[number];
        let note = Note { earlier: neighbour.given, cues, lasting, ..self.head.clone() };
        let given = note.cues.len();
        (neighbour.told, neighbour.told_lasting) = (Some(now), !note.lasting.is_empty());
        neighbour.given += given as u64;
        let is_sent = (self.send)(number, &encode(&note));
        count(if is_sent { &self.counters.given } else { &self.counters.unsent }, given);
    }

    /// Processes a note that arrived by `now`; appends its cues, which play with the frame of time `at`, to `cues`.
    fn hear(&mut self, note: &Note, at: Instant, now: Instant, cues: &mut Vec<Cue>) {
        let Some(neighbour) = self.neighbours.iter_mut().find(|neighbour| neighbour.area == note.area) else {
            return count(&self.counters.refused, 1);
        };
        if note.version != VERSION || note.floor != self.head.floor {
            return count(&self.counters.refused, 1);
        }
        if neighbour.node != note.node {
            neighbour.meet(note.node);
        }
        // An overtaken note has already been counted as lost.
        if note.sequence <= neighbour.heard {
            return;
        }
        (neighbour.heard, neighbour.came) = (note.sequence, now);
        if let Some(echo) = note.echo {
            neighbour.clock.note(&echo, note.sent, now);
        }
        let lost = neighbour.had.map_or(0, |had| note.earlier.saturating_sub(had));
        count(&self.counters.lost, usize::try_from(lost).unwrap_or(usize::MAX));
        neighbour.had = Some(note.earlier.saturating_add(note.cues.len() as u64));
        neighbour.lasting.clone_from(&note.lasting);
        neighbour.lasting.truncate(MOST_LASTING);
        for cue in &note.cues {
            let Some(caused) = neighbour.clock.here(cue.at) else {
                count(&self.counters.untimed, 1);
                continue;
            };
            if now.since(caused) > MOST_AGE {
                count(&self.counters.late, 1);
                continue;
            }
            count(&self.counters.felt, 1);
            cues.push(cue.cue(at, spots_here(&cue.spots, &self.geometry, &self.own)));
        }
    }
}

/// The tiles of `block` among `spots`.
fn spots_there(spots: &[Spot], geometry: &Geometry, block: &TileBlock) -> Vec<NoteSpot> {
    let there = spots.iter().filter_map(|spot| {
        let tile = (usize::from(spot.tile) < geometry.tile_count())
            .then(|| geometry.tile_at_index(spot.tile.into()))
            .filter(|tile| spot.weight > 0.0 && block.contains(*tile))?;
        Some((tile.column, tile.row, spot.weight))
    });
    there.collect()
}

/// The tiles of `own` among `spots`, at most as many as a cue can have.
fn spots_here<'s>(
    spots: &'s [NoteSpot],
    geometry: &'s Geometry,
    own: &'s TileBlock,
) -> impl Iterator<Item = Spot> + 's {
    let here = spots.iter().filter_map(move |&(column, row, weight)| {
        let tile = Some(TileId::new(column, row)).filter(|tile| own.contains(*tile))?;
        let index = u16::try_from(geometry.index(tile)?).ok()?;
        Some(Spot { tile: index, weight: if weight > 0.0 { weight.min(1.0) } else { 0.0 } })
    });
    here.take(MAX_SPOTS)
}

impl Neighbours for Border {
    fn give(&mut self, cues: &[Cue], sustained: &SustainedCues, now: Instant) {
        for number in 0..self.neighbours.len() {
            let (geometry, neighbour) = (&self.geometry, &self.neighbours[number]);
            let there = |spots: &[Spot]| {
                Some(spots_there(spots, geometry, &neighbour.tiles)).filter(|there| !there.is_empty())
            };
            let cues: Vec<_> =
                cues.iter().filter_map(|cue| Some(NoteCue::of(cue, there(&cue.spots)?))).collect();
            let is_due = neighbour.told.is_none_or(|told| now.since(told) >= LASTING);
            let lasts = sustained.iter().any(|one| there(&one.spots).is_some());
            let lasting_changes = if lasts { is_due } else { neighbour.told_lasting };
            if cues.is_empty() && !lasting_changes {
                continue;
            }
            let mut lasting: Vec<_> =
                sustained.iter().filter_map(|one| Some(NoteLasting::of(one, there(&one.spots)?))).collect();
            count(&self.counters.unsent, lasting.len().saturating_sub(MOST_LASTING));
            lasting.truncate(MOST_LASTING);
            self.tell(number, cues, lasting, now);
        }
    }

    fn take(&mut self, at: Instant, now: Instant, cues: &mut Vec<Cue>, sustained: &mut SustainedCues) {
        while let Ok(ReceivedNote { head, echo, body }) = self.notes.try_recv() {
            match decode::<Note>(&body) {
                Ok(note) => self.hear(&note.in_envelope(&head, echo), at, now, cues),
                Err(_) => count(&self.counters.refused, 1),
            }
        }
        for (number, neighbour) in (1_u32..).zip(&mut self.neighbours) {
            if now.since(neighbour.came) > MOST_AGE {
                neighbour.lasting.clear();
            }
            for one in &neighbour.lasting {
                // Keys of this node's own feet are small numbers.
                let key = one.key ^ number.rotate_right(5);
                let spots = spots_here(&one.spots, &self.geometry, &self.own);
                if sustained.try_push(one.sustained(key, spots)).is_err() {
                    count(&self.counters.refused, 1);
                }
            }
        }
    }

    fn poll(&mut self, now: Instant) {
        for number in 0..self.neighbours.len() {
            let told = self.neighbours[number].told;
            if told.is_none_or(|told| now.since(told) >= QUIET) {
                self.tell(number, Vec::new(), Vec::new(), now);
            }
        }
    }
}

#[cfg(test)]
mod tests {
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
        assert_eq!(
            cues,
            [Cue { received: cue.at, spots: [here].into_iter().collect(), audio_gain: 0.0, ..cue }]
        );
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
}
