//! Detects boards that send under each other's addresses by the readings of their empty plates.
//!
//! The floor file holds the reading of each sensor on the empty floor. Parts differ by a quarter, so the readings of
//! a board's sensors form a signature. A set of boards has changed places if each fits the tares of the next and the
//! last fits those of the first: two boards have been swapped, or more have moved on by one in a ring.

use crate::wire::Readings;

use super::board::BoardTrack;
use super::sample::BoardSample;

/// Interval at which a board's readings enter the mean, in milliseconds: the empty plates change no faster.
const EVERY: i64 = 8;

/// Number of readings in a mean: within a sixteenth of a second, which reduces 2 mV of noise to a few millinewtons.
const BLOCK: i64 = 8;

/// Median distance of a board's sensors from their tares above which the board is suspect (N): less than that of
/// parts that differ by a quarter under a plate of 6 N, more than one day's median drift (our choice).
const LEAST_N: f32 = 0.1;

/// Maximum distance of a ring's boards from the next board's tares, as a share of that from their own tares (our
/// choice).
const SHARE: f32 = 0.25;

/// Number of places with which a board far from its own tares is compared after each block. On a floor where all
/// boards are, such as a crowded one, each comparison with all places would take longer than the rest of the work
/// (our choice).
const COMPARED: usize = 8;

/// Number of consecutive comparisons with all places that must agree on the same place.
const AGREEING: u8 = 2;

/// The boards that have changed places, as far as known.
#[derive(Clone, Debug)]
pub(super) struct Swaps {
    blocks: Vec<Block>,
    /// For each misplaced board, the board whose place it occupies.
    found: Vec<Option<u16>>,
    /// Number of changes of `found`.
    changes: u64,
    /// Space for the ring under examination.
    ring: Vec<u16>,
    /// Space for sorting.
    misses: Vec<f32>,
}

/// The kind of a board's readings.
#[derive(Clone, Copy, Debug, Default)]
enum SampleKind {
    #[default]
    Newtons,
    Counts,
    Scaled,
}

/// Mean of one board's readings.
#[derive(Clone, Debug, Default)]
struct Block {
    sums: Vec<f32>,
    packets: u32,
    kind: SampleKind,
    /// Distance from its own tares (N).
    own: f32,
    /// Number of other places compared since the last full comparison.
    compared: usize,
    /// The best of these places, and the distance from its tares.
    nearest: Option<(f32, u16)>,
    /// The same at the last full comparison.
    best: Option<(f32, u16)>,
    /// The place found then, if not its own, and the number of consecutive times.
    seen: (Option<u16>, u8),
}

impl Swaps {
    pub(super) fn new(boards: &[BoardTrack]) -> Self {
        let most = boards.iter().map(BoardTrack::lane_count).max().unwrap_or(0);
        let block = |board: &BoardTrack| Block {
            sums: Vec::with_capacity(board.channel_count()),
            ..Block::default()
        };
        Self {
            blocks: boards.iter().map(block).collect(),
            found: vec![None; boards.len()],
            changes: 0,
            ring: Vec::with_capacity(boards.len()),
            misses: Vec::with_capacity(most),
        }
    }

    /// The slot that stands for sample `count` of board `number` at its own rate: each enters the mean.
    pub(super) const fn turn(&self, number: usize, count: i64) -> i64 {
        (EVERY * count).wrapping_sub(number as i64)
    }

    /// Takes the readings of board `number` in the millisecond of `slot`.
    pub(super) fn note(&mut self, number: usize, slot: i64, sample: &BoardSample, boards: &[BoardTrack]) {
        // Each board has its own turn: all at once would double the time of one frame in 64.
        let turn = slot.wrapping_add(number as i64);
        // A single board cannot change places.
        if turn % EVERY != 0 || boards.len() < 2 || !boards[number].has_known_tare() {
            return;
        }
        let block = &mut self.blocks[number];
        block.add(sample);
        // A block with a lost last packet continues to the end of the next one.
        if turn / EVERY % BLOCK != 0 {
            return;
        }
        let mean = block.finish();
        if !self.compare(number, &mean, boards) {
            return;
        }
        let place = self.place(number);
        let (last, times) = self.blocks[number].seen;
        let times = if last == place { times.saturating_add(1) } else { 1 };
        self.blocks[number].seen = (place, times);
        if times >= AGREEING && self.found[number] != place {
            self.believe(number);
        }
    }

    /// Compares the readings of board `number` with some more places; returns whether the comparison covers all
    /// possible places.
    fn compare(&mut self, number: usize, mean: &BoardSample, boards: &[BoardTrack]) -> bool {
        let Self { blocks, misses, .. } = self;
        let block = &mut blocks[number];
        let mut misfit = |place: usize, below: Option<f32>| boards[place].misfit(mean, below, misses);
        block.own = misfit(number, None).unwrap_or(0.0);
        if block.own <= LEAST_N {
            (block.compared, block.nearest, block.best) = (0, None, None);
            return true;
        }
        let others = boards.len() - 1;
        let until = (block.compared + COMPARED).min(others);
        for step in block.compared..until {
            let place = (number + 1 + step) % boards.len();
            let below = block.nearest.map(|(least, _)| least);
            if let Some((by, place)) = misfit(place, below).zip(u16::try_from(place).ok()) {
                block.nearest = Some((by, place));
            }
        }
        block.compared = until;
        if until < others {
            return false;
        }
        block.compared = 0;
        block.best = block.nearest.take().filter(|(by, _)| *by < block.own);
        true
    }

    /// The place of board `number`, if it is another board's and the ring closes; the ring is then in `self.ring`.
    fn place(&mut self, number: usize) -> Option<u16> {
        let Self { blocks, ring, .. } = self;
        ring.clear();
        let (mut apart, mut exchanged) = (0.0, 0.0);
        let mut reader = number;
        // A ring that closes without this board has not returned to it after as many steps as there are boards.
        for _ in 0..blocks.len() {
            let (by, place) = blocks[reader].best?;
            ring.push(u16::try_from(reader).ok()?);
            apart += blocks[reader].own;
            exchanged += by;
            reader = usize::from(place);
            if reader == number {
                return ring.get(1).copied().filter(|_| exchanged < SHARE * apart);
            }
        }
        None
    }

    /// Marks board `number` as a member of the ring just examined, or as in its own place if there is none.
    fn believe(&mut self, number: usize) {
        let Self { found, ring, .. } = self;
        let is_found = self.blocks[number].seen.0.is_some();
        if !is_found {
            ring.clear();
            ring.extend(u16::try_from(number).ok());
        }
        for member in ring.iter() {
            let mut next = Some(*member);
            while let Some(freed) = next {
                next = found[usize::from(freed)].take();
            }
        }
        if is_found {
            let following = ring.iter().cycle().skip(1);
            ring.iter().zip(following).for_each(|(one, next)| found[usize::from(*one)] = Some(*next));
        }
        self.changes += 1;
    }

    /// The board whose place board `number` occupies, if not its own.
    pub(super) fn of(&self, number: usize) -> Option<u16> {
        self.found.get(number).copied().flatten()
    }

    /// The number of changes, and each misplaced board with the board whose place it occupies.
    pub(super) fn places(&self) -> (u64, impl Iterator<Item = (u16, u16)> + '_) {
        let places = (0..).zip(&self.found);
        (self.changes, places.filter_map(|(one, place)| place.map(|place| (one, place))))
    }
}

impl Block {
    fn add(&mut self, sample: &BoardSample) {
        self.sums.resize(sample.len(), 0.0);
        self.packets += 1;
        self.kind = match sample {
            BoardSample::Counts(_) => SampleKind::Counts,
            BoardSample::Scaled(_) => SampleKind::Scaled,
            BoardSample::Newtons(_) => SampleKind::Newtons,
        };
        match sample {
            BoardSample::Counts(counts) => counts.add_to(&mut self.sums),
            BoardSample::Scaled(forces) | BoardSample::Newtons(forces) => {
                self.sums.iter_mut().zip(forces).for_each(|(sum, force)| *sum += force);
            }
        }
    }

    /// Mean reading of each channel, if it has one in every packet.
    fn finish(&mut self) -> BoardSample {
        let packets = self.packets as f32;
        let means = self.sums.drain(..).map(|sum| sum / packets);
        let mean = match self.kind {
            SampleKind::Counts => {
                Readings::Counts(means.map(|mean| mean.is_finite().then(|| mean.round() as u16)).collect())
            }
            SampleKind::Scaled => Readings::Scaled(means.collect()),
            SampleKind::Newtons => Readings::Newtons(means.collect()),
        };
        self.packets = 0;
        BoardSample::new(&mean)
    }
}
