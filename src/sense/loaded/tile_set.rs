//! Sets of tiles.

use super::BLOCK;
use crate::floor::Geometry;

/// Number of additional blocks behind the tiles: a read of adjacent bits extends over that many.
const BEHIND: usize = 2;

/// A set of tiles of one floor, one bit for each; three reads find a tile's neighbours in the set.
#[derive(Clone, Debug)]
pub(in crate::sense) struct TileSet {
    /// Blocks of [`BLOCK`] tiles in tile-index order, between enough empty blocks that every tile has all its
    /// neighbours' bits.
    blocks: Vec<u16>,
    /// Number of blocks before the first tile's.
    before: usize,
    columns: u32,
    /// Position of the bit of the first tile's south-western neighbour.
    south_west: usize,
}

/// A tile beside another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sense) struct Neighbour {
    /// Its place in tile-index order.
    pub index: u32,
    /// Offset in columns and rows from the other one: -1 to 1 each.
    pub east: i32,
    pub north: i32,
}

impl TileSet {
    /// The empty set of a floor's tiles.
    pub(in crate::sense) fn new(geometry: &Geometry) -> Self {
        let columns = u32::from(geometry.columns());
        let before = (columns as usize + 1).div_ceil(BLOCK);
        let blocks = before + geometry.tile_count().div_ceil(BLOCK) + before + BEHIND;
        let south_west = before * BLOCK - columns as usize - 1;
        Self { blocks: vec![0; blocks], before, columns, south_west }
    }

    pub(in crate::sense) fn clone_from(&mut self, other: &Self) {
        self.blocks.clone_from(&other.blocks);
    }

    /// The blocks of the floor's tiles; the last may have unused bits.
    pub(super) fn blocks(&self) -> &[u16] {
        &self.blocks[self.before..self.before + self.block_count()]
    }

    pub(super) fn blocks_mut(&mut self) -> &mut [u16] {
        let behind = self.before + self.block_count();
        &mut self.blocks[self.before..behind]
    }

    /// Removes the tile at `index`.
    pub(in crate::sense) fn remove(&mut self, index: u32) {
        self.blocks[self.before + index as usize / BLOCK] &= !(1 << (index as usize % BLOCK));
    }

    /// Removes and returns the first tile of a block.
    pub(in crate::sense) fn pop(&mut self, block: usize) -> Option<u32> {
        let bits = &mut self.blocks[self.before + block];
        let first = (*bits != 0).then(|| bits.trailing_zeros())?;
        *bits &= *bits - 1;
        Some((block * BLOCK) as u32 + first)
    }

    /// Number of blocks of a floor's tiles.
    pub(in crate::sense) fn block_count(&self) -> usize {
        self.blocks.len() - 2 * self.before - BEHIND
    }

    /// Sets this to the tiles that may have one of `others` around them; only tiles at the floor's edges may have
    /// none.
    pub(super) fn surround(&mut self, others: &Self) {
        let (south_west, columns) = (self.south_west, self.columns as usize);
        let rows = [0, 1, 2].map(|row| south_west + row * columns);
        for (block, surrounding) in self.blocks_mut().iter_mut().enumerate() {
            let mut bits = 0;
            for row in rows {
                let at = row + block * BLOCK;
                let from = &others.blocks[at / BLOCK..][..3];
                let three =
                    u64::from(from[0]) | u64::from(from[1]) << BLOCK | u64::from(from[2]) << (2 * BLOCK);
                let west = three >> (at % BLOCK);
                bits |= west | west >> 1 | west >> 2;
            }
            *surrounding = bits as u16;
        }
    }

    /// The tiles of the set among the eight around the one at `index`, in tile-index order.
    #[inline]
    pub(in crate::sense) fn around(&self, index: u32) -> impl Iterator<Item = Neighbour> + use<> {
        let (south_west, columns) = (self.south_west + index as usize, self.columns);
        let south = self.three_from(south_west);
        let here = self.three_from(south_west + columns as usize);
        let north = self.three_from(south_west + 2 * columns as usize);
        let mut left = south | (here & 0b101) << 3 | north << 6;
        if left != 0 {
            // Beyond the ends of a row lie the ends of other rows.
            let column = index % columns;
            left &= if column == 0 { 0b110_110_110 } else { 0b111_111_111 };
            left &= if column + 1 == columns { 0b011_011_011 } else { 0b111_111_111 };
        }
        std::iter::from_fn(move || {
            let bit = (left != 0).then(|| left.trailing_zeros())?;
            left &= left - 1;
            let (row, column) = (bit / 3, bit % 3);
            Some(Neighbour {
                index: index + row * columns + column - columns - 1,
                east: column as i32 - 1,
                north: row as i32 - 1,
            })
        })
    }

    /// The bits of three adjacent tiles.
    #[inline(always)]
    fn three_from(&self, at: usize) -> u32 {
        let block = at / BLOCK;
        let (next, first) = (self.blocks[block + 1], self.blocks[block]);
        (u32::from(next) << BLOCK | u32::from(first)) >> (at % BLOCK) & 0b111
    }
}

/// The positions of the set bits of `block`, in order.
#[inline]
pub(super) fn bits(mut block: u16) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (block != 0).then(|| block.trailing_zeros())?;
        block &= block - 1;
        Some(bit as usize)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_around_a_tile_is_on_the_floor_and_in_the_set() {
        for (columns, rows) in [(1, 1), (1, 5), (5, 1), (2, 2), (16, 3), (17, 4), (31, 33)] {
            let geometry = Geometry::of_paper_tiles(columns, rows).unwrap();
            let mut set = TileSet::new(&geometry);
            for index in (0..geometry.tile_count()).filter(|index| index % 3 != 1) {
                set.blocks_mut()[index / BLOCK] |= 1 << (index % BLOCK);
            }
            for index in 0..geometry.tile_count() {
                let here = geometry.tile_at_index(index);
                let expected: Vec<_> = geometry
                    .tiles()
                    .filter(|tile| tile.column.abs_diff(here.column).max(tile.row.abs_diff(here.row)) == 1)
                    .map(|tile| Neighbour {
                        index: geometry.index(tile).unwrap() as u32,
                        east: i32::from(tile.column) - i32::from(here.column),
                        north: i32::from(tile.row) - i32::from(here.row),
                    })
                    .filter(|neighbour| neighbour.index % 3 != 1)
                    .collect();
                assert_eq!(
                    set.around(index as u32).collect::<Vec<_>>(),
                    expected,
                    "{here:?} of {columns} x {rows}"
                );
            }
        }
    }

    #[test]
    fn every_tile_beside_one_of_the_others_is_found_at_once() {
        let geometry = Geometry::of_paper_tiles(21, 9).unwrap();
        let (mut others, mut near) = (TileSet::new(&geometry), TileSet::new(&geometry));
        for index in [0, 45, 46, 100, 188] {
            others.blocks_mut()[index / BLOCK] |= 1 << (index % BLOCK);
        }
        near.surround(&others);
        for index in 0..geometry.tile_count() {
            let holds = |set: &TileSet| set.blocks()[index / BLOCK] >> (index % BLOCK) & 1 == 1;
            let has_one = others.around(index as u32).next().is_some();
            let is_inside = (1..20).contains(&(index % 21)) && !holds(&others);
            assert!(if is_inside { holds(&near) == has_one } else { holds(&near) || !has_one }, "{index}");
        }
    }

    #[test]
    fn what_is_taken_out_is_out() {
        let mut set = TileSet::new(&Geometry::of_paper_tiles(5, 7).unwrap());
        set.blocks_mut()[2] = 0b111;
        set.remove(33);
        assert_eq!(set.blocks(), [0, 0, 0b101]);
        assert_eq!([set.pop(2), set.pop(2), set.pop(2)], [Some(32), Some(34), None]);
        assert_eq!(bits(0b1000_0000_0010_0001).collect::<Vec<_>>(), [0, 5, 15]);
    }
}
