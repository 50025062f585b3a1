//! Rectangles of tiles.

use std::fmt;
use std::ops::Range;

use super::TileId;

/// A rectangle of adjacent tiles: a whole floor, or a part of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TileBlock {
    /// The tile in the south-west corner.
    pub first: TileId,
    /// Number of columns; a block without columns has no tile.
    pub columns: u16,
    /// Number of rows; a block without rows has no tile.
    pub rows: u16,
}

impl TileBlock {
    /// Returns the columns, from west to east, up to 65,535.
    #[must_use]
    pub const fn column_range(&self) -> Range<u16> {
        self.first.column..self.first.column.saturating_add(self.columns)
    }

    /// Returns the rows, from south to north, up to 65,535.
    #[must_use]
    pub const fn row_range(&self) -> Range<u16> {
        self.first.row..self.first.row.saturating_add(self.rows)
    }

    /// Whether the block contains `tile`.
    #[must_use]
    pub fn contains(&self, tile: TileId) -> bool {
        self.column_range().contains(&tile.column) && self.row_range().contains(&tile.row)
    }

    /// Returns all tiles, row by row from the south-west.
    pub fn tiles(&self) -> impl Iterator<Item = TileId> + use<> {
        let columns = self.column_range();
        self.row_range().flat_map(move |row| columns.clone().map(move |column| TileId::new(column, row)))
    }

    /// Returns the block with `tiles` more on each side, within the range of tile numbers.
    #[must_use]
    pub fn grown(&self, tiles: u16) -> Self {
        let wider = |range: Range<u16>| range.start.saturating_sub(tiles)..range.end.saturating_add(tiles);
        Self::of_ranges(&wider(self.column_range()), &wider(self.row_range()))
    }

    /// Returns the tiles that are in both; an empty block if there are none.
    #[must_use]
    pub fn common(&self, other: &Self) -> Self {
        let both = |one: Range<u16>, other: Range<u16>| one.start.max(other.start)..one.end.min(other.end);
        Self::of_ranges(
            &both(self.column_range(), other.column_range()),
            &both(self.row_range(), other.row_range()),
        )
    }

    /// Whether the block has no tile.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.columns == 0 || self.rows == 0
    }

    fn of_ranges(columns: &Range<u16>, rows: &Range<u16>) -> Self {
        Self {
            first: TileId::new(columns.start, rows.start),
            columns: columns.end.saturating_sub(columns.start),
            rows: rows.end.saturating_sub(rows.start),
        }
    }
}

impl fmt::Display for TileBlock {
    /// The text gives the first tile, except for a block in the floor's corner.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { first, columns, rows } = self;
        write!(f, "{columns} x {rows} tiles")?;
        if *first == TileId::new(0, 0) { Ok(()) } else { write!(f, " from {first}") }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn block() -> impl Strategy<Value = TileBlock> {
        (0..9_u16, 0..9_u16, 0..6_u16, 0..6_u16).prop_map(|(column, row, columns, rows)| TileBlock {
            first: TileId::new(column, row),
            columns,
            rows,
        })
    }

    proptest! {
        #[test]
        fn blocks_are_sets_of_tiles(one in block(), other in block(), margin in 0..3_u16, column in 0..20_u16, row in 0..20_u16) {
            let tile = TileId::new(column, row);
            let within = |block: &TileBlock| block.tiles().any(|other| other == tile);
            prop_assert_eq!(one.contains(tile), within(&one));
            prop_assert_eq!(one.is_empty(), one.tiles().next().is_none());
            prop_assert_eq!(one.common(&other).contains(tile), within(&one) && within(&other));
            if !one.is_empty() {
                let near = |at: u16, range: Range<u16>| at + margin >= range.start && at < range.end + margin;
                prop_assert_eq!(
                    one.grown(margin).contains(tile),
                    near(column, one.column_range()) && near(row, one.row_range())
                );
            }
        }
    }
}
