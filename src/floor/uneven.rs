//! The tiles of a floor that differ from the others.

use std::sync::{Mutex, PoisonError};

use glam::Vec2;

use super::{SensorPlaces, TileId};

/// A plate that differs from the others of its floor. It lies in the middle of its cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnPlate {
    /// Its tile.
    pub tile: TileId,
    /// Width and depth, in metres; at most one pitch.
    pub size: Vec2,
    /// The places of its sensors.
    pub sensors: SensorPlaces,
}

/// The missing tiles of a floor, and the plates that differ from the others; sorted by tile.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct UnevenTiles {
    missing: Vec<TileId>,
    plates: Vec<OwnPlate>,
}

/// The tables in use.
static KNOWN: Mutex<Vec<&'static UnevenTiles>> = Mutex::new(Vec::new());

impl UnevenTiles {
    /// Returns the table of these tiles, in any order; `None` if there are none.
    ///
    /// A table stays in memory until the program ends, so that geometries can be copied, also by the sensing thread;
    /// equal ones share their memory, and a program reads few floors.
    pub(super) fn of(mut missing: Vec<TileId>, mut plates: Vec<OwnPlate>) -> Option<&'static Self> {
        missing.sort_unstable();
        missing.dedup();
        plates.sort_by_key(|plate| plate.tile);
        if missing.is_empty() && plates.is_empty() {
            return None;
        }
        let table = Self { missing, plates };
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(same) = known.iter().find(|one| ***one == table) {
            return Some(same);
        }
        let table: &'static Self = Box::leak(Box::new(table));
        known.push(table);
        Some(table)
    }

    /// Whether the floor has a hole instead of `tile`.
    pub(super) fn is_missing(&self, tile: TileId) -> bool {
        self.missing.binary_search(&tile).is_ok()
    }

    /// Returns the plate of `tile`, if it differs from the others.
    pub(super) fn plate(&self, tile: TileId) -> Option<&OwnPlate> {
        let at = self.plates.binary_search_by_key(&tile, |plate| plate.tile).ok()?;
        self.plates.get(at)
    }

    /// Returns the missing tiles, column by column.
    pub(super) fn missing(&self) -> &[TileId] {
        &self.missing
    }

    /// Returns the plates that differ from the others.
    pub(super) fn plates(&self) -> &[OwnPlate] {
        &self.plates
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_tables_are_kept_once() {
        let holes = || vec![TileId::new(3, 1), TileId::new(1, 1), TileId::new(3, 1)];
        let table = UnevenTiles::of(holes(), Vec::new()).unwrap();
        assert!(std::ptr::eq(table, UnevenTiles::of(holes(), Vec::new()).unwrap()));
        assert_eq!(table.missing(), [TileId::new(1, 1), TileId::new(3, 1)]);
        assert!(table.is_missing(TileId::new(3, 1)) && !table.is_missing(TileId::new(1, 3)));
        assert_eq!(UnevenTiles::of(Vec::new(), Vec::new()), None);
    }
}
