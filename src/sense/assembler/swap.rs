//! Boards that send under each other's addresses: noticed from what their plates weigh.
//!
//! The floor file has what each sensor reads on the empty floor. Parts differ by a quarter, so what the sensors of a
//! board read there is as good as a signature. Boards each of which fits the next one's tares, and the last the
//! first one's, have changed places: two have been swapped, or more have moved on by one in a ring.

use crate::wire::Readings;

use super::board::BoardTrack;
use super::sample::Sample;

/// Every how many milliseconds what a board reads is looked at: what rests there changes no faster.
const EVERY: i64 = 8;

/// Looks whose mean is compared: within a sixteenth of a second, in which 2 mV of noise become a few millinewtons.
const BLOCK: i64 = 8;

/// By how much the middle one of a board's sensors must miss its tare for the board to be suspected, in newtons: less
/// than parts that differ by a quarter do under a plate of 6 N, more than one day's drift of the middle one (our
/// choice).
const LEAST_N: f32 = 0.1;

/// Which share of what the boards of a ring miss their own tares by they may miss the next one's by (our choice).
const SHARE: f32 = 0.25;

/// Places that a board which misses its own tares is compared with after each block: on a floor where all do, such as a
/// crowded one, each comparison with all would cost more than everything else (our choice).
const COMPARED: usize = 8;

/// Times in a row that a board, compared with all places, must seem to be in the same one.
const AGREEING: u8 = 2;

/// Who has changed places with whom, as far as that is known.
#[derive(Clone, Debug)]
pub(super) struct Swaps {
    blocks: Vec<Block>,
    /// For each board that is out of its place, the one in whose place it is.
    found: Vec<Option<u16>>,
    /// How often `found` has changed.
    changes: u64,
    /// Space for the ring that is looked at.
    ring: Vec<u16>,
    /// Space for sorting.
    misses: Vec<f32>,
}

/// What one board reads, averaged.
#[derive(Clone, Debug, Default)]
struct Block {
    sums: Vec<f32>,
    packets: u32,
    is_counts: bool,
    /// By how much it missed its own tares.
    own: f32,
    /// How many other places it has been compared with since it was last compared with all.
    compared: usize,
    /// The place that fits best among those, and by how much it misses that one's tares.
    nearest: Option<(f32, u16)>,
    /// The same, when it was last compared with all.
    best: Option<(f32, u16)>,
    /// The place that it seemed to be in then, if not its own, and how many times in a row.
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

    /// Takes what board `number` read in the millisecond of `slot`.
    pub(super) fn note(&mut self, number: usize, slot: i64, sample: &Sample, boards: &[BoardTrack]) {
        // Each board at a time of its own, for all at once would make one frame in 64 take twice as long.
        let turn = slot.wrapping_add(number as i64);
        // Alone, a board has no other to change places with.
        if turn % EVERY != 0 || boards.len() < 2 || !boards[number].has_known_tare() {
            return;
        }
        let block = &mut self.blocks[number];
        block.add(sample);
        // A block whose last packet is lost goes on to the end of the next.
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

    /// Compares what board `number` reads with some more places; whether it has been compared with all that it may be
    /// in.
    fn compare(&mut self, number: usize, mean: &Sample, boards: &[BoardTrack]) -> bool {
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

    /// The place that board `number` is in, if it is another one's and the ring closes, which is then in `self.ring`.
    fn place(&mut self, number: usize) -> Option<u16> {
        let Self { blocks, ring, .. } = self;
        ring.clear();
        let (mut apart, mut exchanged) = (0.0, 0.0);
        let mut reader = number;
        // A ring that closes elsewhere has not come back after as many steps as there are boards.
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

    /// Takes board `number` for one that is in the ring just looked at, or in its own place if there is none.
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

    /// The board in whose place board `number` is, if not in its own.
    pub(super) fn of(&self, number: usize) -> Option<u16> {
        self.found.get(number).copied().flatten()
    }

    /// Each board that is out of its place with the one in whose place it is, and how often that has changed.
    pub(super) fn places(&self) -> (u64, impl Iterator<Item = (u16, u16)> + '_) {
        let places = (0..).zip(&self.found);
        (self.changes, places.filter_map(|(one, place)| place.map(|place| (one, place))))
    }
}

impl Block {
    fn add(&mut self, sample: &Sample) {
        self.sums.resize(sample.len(), 0.0);
        self.packets += 1;
        self.is_counts = matches!(sample, Sample::Counts(_));
        match sample {
            Sample::Counts(counts) => counts.add_to(&mut self.sums),
            Sample::Newtons(forces) => {
                self.sums.iter_mut().zip(forces).for_each(|(sum, force)| *sum += force);
            }
        }
    }

    /// What each channel has read on average, if it gave something every time.
    fn finish(&mut self) -> Sample {
        let packets = self.packets as f32;
        let means = self.sums.drain(..).map(|sum| sum / packets);
        let mean = if self.is_counts {
            Readings::Counts(means.map(|mean| mean.is_finite().then(|| mean.round() as u16)).collect())
        } else {
            Readings::Newtons(means.collect())
        };
        self.packets = 0;
        Sample::new(&mean)
    }
}
