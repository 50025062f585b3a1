//! Two boards that send under each other's address: noticed from what their plates weigh.
//!
//! The floor file has what each sensor reads on the empty floor. Parts differ by a quarter, so what the sensors of a
//! board read there is as good as a signature: a board that fits another one's tares, while the other fits its own,
//! has changed places with it.

use crate::wire::Readings;

use super::board::BoardTrack;

/// Packets whose mean is compared: a sixteenth of a second, in which 2 mV of noise become a few millinewtons.
const BLOCK: u16 = 64;

/// By how much the middle one of a board's sensors must miss its tare for the board to be suspected, in newtons: less
/// than parts that differ by a quarter do under a plate of 6 N, more than one day's drift of the middle one (our choice).
const LEAST_N: f32 = 0.1;

/// Which share of what two boards miss their own tares by they may miss each other's by (our choice).
const SHARE: f32 = 0.25;

/// Blocks in a row that must say the same.
const AGREEING: u8 = 2;

/// Who has changed places with whom, as far as that is known.
#[derive(Clone, Debug)]
pub(super) struct Swaps {
    blocks: Vec<Block>,
    /// Each board's partner.
    found: Vec<Option<u16>>,
    /// How often `found` has changed.
    changes: u64,
    /// Space for sorting.
    misses: Vec<f32>,
}

/// What one board reads, averaged.
#[derive(Clone, Debug, Default)]
struct Block {
    sums: Vec<f32>,
    packets: u16,
    is_counts: bool,
    /// The means of the last whole block; NaN for channels that gave nothing.
    means: Vec<f32>,
    /// The partner it had in the last block, and in how many blocks in a row.
    seen: (Option<u16>, u8),
}

impl Swaps {
    pub(super) fn new(boards: &[BoardTrack]) -> Self {
        let most = boards.iter().map(BoardTrack::channel_count).max().unwrap_or(0);
        let block = |board: &BoardTrack| Block {
            sums: Vec::with_capacity(board.channel_count()),
            means: Vec::with_capacity(board.channel_count()),
            ..Block::default()
        };
        let blocks = boards.iter().map(block).collect();
        Self { blocks, found: vec![None; boards.len()], changes: 0, misses: Vec::with_capacity(most) }
    }

    /// Takes what board `number` reads.
    pub(super) fn note(&mut self, number: usize, readings: &Readings, boards: &[BoardTrack]) {
        // There is nobody to change places with.
        if boards.len() < 2 || !boards[number].has_known_tare() {
            return;
        }
        let block = &mut self.blocks[number];
        block.add(readings);
        if block.packets < BLOCK {
            return;
        }
        block.finish();
        let partner = self.partner(number, boards);
        let (last, times) = self.blocks[number].seen;
        let times = if last == partner { times.saturating_add(1) } else { 1 };
        self.blocks[number].seen = (partner, times);
        if times >= AGREEING && self.found[number] != partner {
            let one = u16::try_from(number).ok();
            for freed in [self.found[number], partner].into_iter().flatten() {
                self.found[usize::from(freed)] = None;
            }
            self.found[number] = partner;
            if let Some(partner) = partner {
                self.found[usize::from(partner)] = one;
            }
            self.changes += 1;
        }
    }

    /// The board whose tares board `number` fits, and which fits its own.
    fn partner(&mut self, number: usize, boards: &[BoardTrack]) -> Option<u16> {
        let Self { blocks, misses, .. } = self;
        let mut misfit = |reader: usize, place: usize| {
            let block = &blocks[reader];
            boards[place].misfit(&block.means, block.is_counts, misses)
        };
        let own = misfit(number, number).filter(|own| *own > LEAST_N)?;
        (0..boards.len()).filter(|other| *other != number).find_map(|other| {
            let apart = own + misfit(other, other)?;
            let exchanged = misfit(number, other)? + misfit(other, number)?;
            (exchanged < SHARE * apart).then(|| u16::try_from(other).ok()).flatten()
        })
    }

    /// The board that has changed places with board `number`.
    pub(super) fn of(&self, number: usize) -> Option<u16> {
        self.found.get(number).copied().flatten()
    }

    /// Each pair once, and how often the pairs have changed.
    pub(super) fn pairs(&self) -> (u64, impl Iterator<Item = (u16, u16)> + '_) {
        let pairs = (0..).zip(&self.found);
        (
            self.changes,
            pairs.filter_map(|(one, other)| other.filter(|other| one < *other).map(|other| (one, other))),
        )
    }
}

impl Block {
    fn add(&mut self, readings: &Readings) {
        self.sums.resize(readings.len(), 0.0);
        self.packets += 1;
        match readings {
            Readings::Counts(counts) => {
                self.is_counts = true;
                for (sum, count) in self.sums.iter_mut().zip(counts) {
                    *sum += count.map_or(f32::NAN, f32::from);
                }
            }
            Readings::Newtons(forces) => {
                self.is_counts = false;
                self.sums.iter_mut().zip(forces).for_each(|(sum, force)| *sum += force);
            }
        }
    }

    fn finish(&mut self) {
        let packets = f32::from(self.packets);
        self.means.clear();
        self.means.extend(self.sums.drain(..).map(|sum| sum / packets));
        self.packets = 0;
    }
}
