//! What is felt on tiles of neighbours, and what theirs is felt here.
//!
//! A control over a border belongs to one node. Its cues go to the neighbour under whose tiles they are felt too, at
//! once and by UDP, as the packets of boards near the border do. A cue that comes too late is not played: a foot would
//! take it for the answer to something else. Neighbours compare their clocks, since only by that is known how old a cue
//! is.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::Receiver;
use std::time::Duration;

use underfoot::feel::{Cue, MAX_SPOTS, Spot, SustainedCues};
use underfoot::floor::{Area, Floor, Geometry, TileBlock, TileId};
use underfoot::serve::Neighbours;
use underfoot::units::Instant;

use crate::gateway::NodeClock;
use crate::message::{Echo, Note, NoteCue, NoteLasting, NoteSpot, VERSION, decode, encode, fingerprint};

/// A cue older than this is not played. Clicks are felt as answers within 50 ms.
const MOST_AGE: Duration = Duration::from_millis(50);

/// Time between two notes while nothing happens: clocks are compared as often as with the gateway.
const QUIET: Duration = Duration::from_millis(50);

/// Time between two notes while something lasts; the renderer evens out what it hears in steps.
const LASTING: Duration = Duration::from_millis(4);

/// Most that lasts in one note, which fits in a datagram; of more, the rest is not felt over the border and is counted.
const MOST_LASTING: usize = 10;

/// Sends a note to the neighbour with this number; false if it could not be sent.
pub type SendNote = Box<dyn FnMut(usize, &[u8]) -> bool + Send>;

/// What crossed the borders, and what did not; counted since the start.
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
    /// Cues handed to neighbours.
    #[must_use]
    pub fn given(&self) -> u64 {
        self.given.load(Ordering::Relaxed)
    }

    /// Cues of neighbours that were felt here.
    #[must_use]
    pub fn felt(&self) -> u64 {
        self.felt.load(Ordering::Relaxed)
    }

    /// Cues of neighbours that were older than 50 ms, and not played.
    #[must_use]
    pub fn late(&self) -> u64 {
        self.late.load(Ordering::Relaxed)
    }

    /// Cues of neighbours that did not arrive.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost.load(Ordering::Relaxed)
    }

    /// Cues of neighbours that came before the clocks had been compared, and were not played.
    #[must_use]
    pub fn untimed(&self) -> u64 {
        self.untimed.load(Ordering::Relaxed)
    }

    /// Cues and lasting effects that could not be handed to a neighbour.
    #[must_use]
    pub fn unsent(&self) -> u64 {
        self.unsent.load(Ordering::Relaxed)
    }

    /// Notes that were not understood, or come from no neighbour on this floor.
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
    /// The last note to it, when that was sent, and the cues in all of them.
    sequence: u64,
    told: Option<Instant>,
    given: u64,
    /// Whether the last note told of something that lasts.
    told_lasting: bool,
    /// The number that it has drawn, the last note of it, when that came, and how many cues it had told of then.
    node: u64,
    heard: u64,
    came: Instant,
    echo: Option<Echo>,
    had: Option<u64>,
    clock: NodeClock,
    lasting: Vec<NoteLasting>,
}

impl Neighbour {
    fn new(area: &Area) -> Self {
        Self {
            area: area.id.clone(),
            tiles: area.tiles,
            sequence: 0,
            told: None,
            given: 0,
            told_lasting: false,
            node: 0,
            heard: 0,
            came: Instant::START,
            echo: None,
            had: None,
            clock: NodeClock::default(),
            lasting: Vec::new(),
        }
    }

    /// Forgets what was known of the program that served it before.
    fn meet(&mut self, node: u64) {
        let Self { area, tiles, sequence, told, given, told_lasting, .. } = self;
        let (area, tiles) = (std::mem::take(area), *tiles);
        let known = Area::new(&area, tiles);
        *self = Self {
            sequence: *sequence,
            told: *told,
            given: *given,
            told_lasting: *told_lasting,
            node,
            ..Self::new(&known)
        };
    }
}

/// The borders of one area.
pub struct Border {
    /// What all notes have in common.
    head: Note,
    /// What the node senses, and which of it is its own.
    geometry: Geometry,
    own: TileBlock,
    neighbours: Vec<Neighbour>,
    send: SendNote,
    notes: Receiver<Vec<u8>>,
    counters: Arc<BorderCounters>,
}

impl Border {
    /// The areas that `area` hands cues to, in the order of their numbers: those on whose tiles it senses feet. Those
    /// that do not say where they listen get none.
    pub fn neighbours<'f>(floor: &'f Floor, area: &Area) -> impl Iterator<Item = &'f Area> {
        let (sensed, id) = (area.sensed(&floor.geometry), area.id.clone());
        floor.areas.iter().filter(move |other| {
            let common = other.tiles.common(&sensed);
            other.id != id && other.listen.is_some() && common.columns > 0 && common.rows > 0
        })
    }

    /// The borders of `area`, whose node has drawn the number `node`. Notes go out by `send` and come in by `notes`.
    #[must_use]
    pub fn new(floor: &Floor, area: &Area, node: u64, send: SendNote, notes: Receiver<Vec<u8>>) -> Self {
        let head = Note {
            version: VERSION,
            floor: fingerprint(floor),
            area: area.id.clone(),
            node,
            ..Note::default()
        };
        Self {
            head,
            geometry: floor.geometry.part(&area.sensed(&floor.geometry)).unwrap_or(floor.geometry),
            own: area.tiles,
            neighbours: Self::neighbours(floor, area).map(Neighbour::new).collect(),
            send,
            notes,
            counters: Arc::default(),
        }
    }

    /// What is counted.
    #[must_use]
    pub fn counters(&self) -> Arc<BorderCounters> {
        Arc::clone(&self.counters)
    }

    /// Sends a note to neighbour number `number` at `now`.
    fn tell(&mut self, number: usize, cues: Vec<NoteCue>, lasting: Vec<NoteLasting>, now: Instant) {
        let neighbour = &mut self.neighbours[number];
        neighbour.sequence += 1;
        let note = Note {
            sequence: neighbour.sequence,
            sent: now.micros(),
            echo: neighbour.echo,
            earlier: neighbour.given,
            cues,
            lasting,
            ..self.head.clone()
        };
        let given = note.cues.len();
        (neighbour.told, neighbour.told_lasting) = (Some(now), !note.lasting.is_empty());
        neighbour.given += given as u64;
        let is_sent = (self.send)(number, &encode(&note));
        count(if is_sent { &self.counters.given } else { &self.counters.unsent }, given);
    }

    /// Takes a note that is there at `now`; the cues that are to be played with the frame of time `at` go into `cues`.
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
        // What was overtaken has been counted as lost.
        if note.sequence <= neighbour.heard {
            return;
        }
        (neighbour.heard, neighbour.came) = (note.sequence, now);
        neighbour.echo = Some(Echo { gateway: note.node, sent: note.sent, received: now.micros() });
        if let Some(echo) = note.echo.filter(|echo| echo.gateway == self.head.node) {
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

/// The tiles of `own` among `spots`, at most as many as a cue reaches.
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
        while let Ok(note) = self.notes.try_recv() {
            match decode::<Note>(&note) {
                Ok(note) => self.hear(&note, at, now, cues),
                Err(_) => count(&self.counters.refused, 1),
            }
        }
        for (number, neighbour) in (1_u32..).zip(&mut self.neighbours) {
            if now.since(neighbour.came) > MOST_AGE {
                neighbour.lasting.clear();
            }
            for one in &neighbour.lasting {
                // Names of feet here are small numbers.
                let key = one.key ^ number.rotate_right(5);
                let spots = spots_here(&one.spots, &self.geometry, &self.own);
                if sustained.try_push(one.sustained(key, spots)).is_err() {
                    count(&self.counters.refused, 1);
                }
            }
        }
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
    use std::sync::mpsc::{Sender, channel};
    use std::sync::{Mutex, PoisonError};

    use underfoot::feel::{Click, Hum, Lasting, Mode, SustainedCue};
    use underfoot::floor::Geometry;
    use underfoot::units::Newtons;

    use super::*;

    /// How far the clock of the east is ahead of that of the west.
    const AHEAD_MS: u64 = 70_000;

    type Wire = Arc<Mutex<Vec<Vec<u8>>>>;

    /// Two areas of 6 x 6 tiles beside each other.
    struct Pair {
        borders: [Border; 2],
        /// What each has sent and is on the way.
        wires: [Wire; 2],
        ends: [Sender<Vec<u8>>; 2],
    }

    impl Pair {
        fn new() -> Self {
            let area = |id: &str, number: u16| Area {
                listen: Some(([127, 0, 0, 1], 9000 + number).into()),
                ..Area::new(id, TileBlock { first: TileId::new(6 * number, 0), columns: 6, rows: 6 })
            };
            let floor = Floor::of(Geometry::of_paper_tiles(12, 6).unwrap())
                .with_areas(vec![area("west", 0), area("east", 1)]);
            let wires: [Wire; 2] = Default::default();
            let made = [0, 1].map(|number: usize| {
                let (end, notes) = channel();
                let wire = Arc::clone(&wires[number]);
                let send = move |to, note: &[u8]| {
                    assert_eq!(to, 0, "there is one neighbour");
                    wire.lock().unwrap_or_else(PoisonError::into_inner).push(note.to_vec());
                    true
                };
                (Border::new(&floor, &floor.areas[number], number as u64 + 1, Box::new(send), notes), end)
            });
            let [(west, to_west), (east, to_east)] = made;
            Self { borders: [west, east], wires, ends: [to_west, to_east] }
        }

        /// What is on the way from one arrives, or is lost.
        fn deliver(&self, from: usize, arrives: bool) {
            let sent = std::mem::take(&mut *self.wires[from].lock().unwrap());
            if arrives {
                sent.into_iter().for_each(|note| self.ends[1 - from].send(note).unwrap());
            }
        }

        /// What one takes when `ms` are over for the west.
        fn take(&mut self, who: usize, ms: u64) -> (Vec<Cue>, SustainedCues) {
            let now = Instant::from_millis(ms + AHEAD_MS * who as u64);
            let (mut cues, mut sustained) = Default::default();
            self.borders[who].take(now, now, &mut cues, &mut sustained);
            (cues, sustained)
        }

        /// Lets them hear each other, so that each knows the other's clock.
        fn compare_clocks(&mut self) {
            for ms in 1000..1200 {
                for who in [0, 1] {
                    self.deliver(1 - who, true);
                    self.take(who, ms);
                }
            }
        }
    }

    /// A click on tile (5, 2) of the west and (6, 2) of the east, of a control of the west, whose part has 10 columns.
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
        pair.compare_clocks();
        pair.borders[0].give(&[click(1300)], &SustainedCues::new(), Instant::from_millis(1300));
        pair.deliver(0, true);
        let (cues, _) = pair.take(1, 1302);
        // The east senses from column 2 on: column 6 is its fifth of ten.
        let cue = Cue { at: Instant::from_millis(1302 + AHEAD_MS), ..click(0) };
        let here = Spot { tile: 2 * 10 + 4, weight: 0.5 };
        assert_eq!(
            cues,
            [Cue { received: cue.at, spots: [here].into_iter().collect(), audio_gain: 0.0, ..cue }]
        );
        let (west, east) = (pair.borders[0].counters(), pair.borders[1].counters());
        assert_eq!((west.given(), east.felt(), east.late(), east.lost(), east.untimed()), (1, 1, 0, 0, 0));
        // Nothing of it comes back.
        pair.deliver(1, true);
        assert!(pair.take(0, 1303).0.is_empty());
    }

    #[test]
    fn a_cue_on_own_tiles_alone_stays_here() {
        let mut pair = Pair::new();
        pair.compare_clocks();
        let own = Cue { spots: [Spot { tile: 0, weight: 1.0 }].into_iter().collect(), ..click(1300) };
        pair.borders[0].give(&[own], &SustainedCues::new(), Instant::from_millis(1300));
        assert!(pair.wires[0].lock().unwrap().is_empty());
    }

    #[test]
    fn a_cue_that_is_late_or_lost_or_of_unknown_age_is_counted_and_not_played() {
        let mut pair = Pair::new();
        let give = |pair: &mut Pair, ms| {
            pair.borders[0].give(&[click(ms)], &SustainedCues::new(), Instant::from_millis(ms));
        };
        give(&mut pair, 900);
        pair.deliver(0, true);
        assert!(pair.take(1, 901).0.is_empty());
        pair.compare_clocks();
        give(&mut pair, 1300);
        pair.deliver(0, true);
        assert!(pair.take(1, 1351).0.is_empty(), "51 ms old");
        give(&mut pair, 1400);
        pair.deliver(0, true);
        assert_eq!(pair.take(1, 1449).0.len(), 1, "49 ms old");
        give(&mut pair, 1500);
        pair.deliver(0, false);
        give(&mut pair, 1600);
        pair.deliver(0, true);
        assert_eq!(pair.take(1, 1601).0.len(), 1);
        let east = pair.borders[1].counters();
        assert_eq!((east.felt(), east.late(), east.lost(), east.untimed(), east.refused()), (2, 1, 1, 1, 0));
    }

    #[test]
    fn what_lasts_is_felt_until_it_ends_or_nothing_is_heard_for_50_ms() {
        let mut pair = Pair::new();
        pair.compare_clocks();
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
            pair.borders[0].give(&[], &lasting, Instant::from_millis(ms));
            notes += pair.wires[0].lock().unwrap().len();
            pair.deliver(0, true);
            let (_, felt) = pair.take(1, ms);
            assert_eq!(felt.len(), 1, "{ms}");
            assert_eq!((felt[0].force, felt[0].spots.len()), (Newtons(80.0), 1));
            assert_ne!(felt[0].key, 7, "a foot here may have that name");
        }
        assert_eq!(notes, 5, "every 4 ms");
        pair.borders[0].give(&[], &SustainedCues::new(), Instant::from_millis(1320));
        pair.deliver(0, true);
        assert!(pair.take(1, 1320).1.is_empty(), "it has ended");
        pair.borders[0].give(&[], &lasting, Instant::from_millis(1400));
        pair.deliver(0, true);
        assert_eq!(pair.take(1, 1400).1.len(), 1);
        assert_eq!(pair.take(1, 1450).1.len(), 1);
        assert!(pair.take(1, 1451).1.is_empty(), "the neighbour is silent");
    }

    #[test]
    fn a_neighbour_that_starts_again_is_met_anew_and_strangers_are_refused() {
        let mut pair = Pair::new();
        pair.compare_clocks();
        let mut note = Note {
            node: 77,
            sequence: 1,
            cues: vec![NoteCue { at: 1_300_000, spots: vec![(6, 2, 1.0)], ..NoteCue::default() }],
            ..pair.borders[0].head.clone()
        };
        pair.ends[1].send(encode(&note)).unwrap();
        assert!(pair.take(1, 1300).0.is_empty(), "nothing is known of its clock");
        (note.floor, note.sequence) = (note.floor + 1, 2);
        pair.ends[1].send(encode(&note)).unwrap();
        pair.ends[1].send(b"{}".to_vec()).unwrap();
        pair.ends[1].send(b"{\"area\":\"nowhere\"".to_vec()).unwrap();
        pair.take(1, 1301);
        let east = pair.borders[1].counters();
        assert_eq!((east.untimed(), east.refused(), east.lost()), (1, 3, 0));
    }
}
