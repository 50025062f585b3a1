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
mod tests;
