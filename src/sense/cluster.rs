//! Groups of loaded tiles that touch each other.

use std::ops::Range;

use super::loaded::{AROUND, LoadedTiles};

/// Groups of loaded tiles that touch along an edge or at a corner.
#[derive(Clone, Debug, Default)]
pub(super) struct Clusters {
    /// Positions in the list of loaded tiles, one cluster after the other.
    members: Vec<u32>,
    spans: Vec<Range<usize>>,
    seen: Vec<bool>,
}

impl Clusters {
    /// Room for every tile of a floor, so that finding clusters never allocates.
    pub(super) fn with_capacity(tiles: usize) -> Self {
        let tiles = tiles.min(4096);
        Self {
            members: Vec::with_capacity(tiles),
            spans: Vec::with_capacity(tiles),
            seen: Vec::with_capacity(tiles),
        }
    }

    /// Finds the clusters of `tiles`, in the order of their first tile.
    pub(super) fn update(&mut self, tiles: &LoadedTiles) {
        let list = tiles.list();
        self.members.clear();
        self.spans.clear();
        self.seen.clear();
        self.seen.resize(list.len(), false);
        for first in 0..list.len() {
            if std::mem::replace(&mut self.seen[first], true) {
                continue;
            }
            // The cluster's own members are the queue of tiles still to look around from.
            let start = self.members.len();
            self.members.push(first as u32);
            let mut next = start;
            while let Some(&member) = self.members.get(next) {
                next += 1;
                let tile = list[member as usize].tile;
                for (east, north) in AROUND {
                    let found = tiles.find(i32::from(tile.column) + east, i32::from(tile.row) + north);
                    if let Some(neighbour) = found
                        && !std::mem::replace(&mut self.seen[neighbour], true)
                    {
                        self.members.push(neighbour as u32);
                    }
                }
            }
            self.spans.push(start..self.members.len());
        }
    }

    /// One cluster as positions in the list of loaded tiles; `None` past the last.
    pub(super) fn get(&self, cluster: usize) -> Option<&[u32]> {
        self.members.get(self.spans.get(cluster)?.clone())
    }

    /// Each cluster as positions in the list of loaded tiles.
    pub(super) fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        self.spans.iter().map(|span| &self.members[span.clone()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::{Geometry, TileId};
    use crate::sense::ForceFrame;
    use crate::sense::loaded::LoadThreshold;

    fn clusters_of(side: u16, loaded: &[(u16, u16)]) -> Vec<usize> {
        let geometry = Geometry::of_paper_tiles(side, side).unwrap();
        let mut frame = ForceFrame::empty(&geometry);
        for &(column, row) in loaded {
            frame.forces[geometry.index(TileId::new(column, row)).unwrap()] = [10.0; 4];
        }
        let mut tiles = LoadedTiles::new(geometry, LoadThreshold::default());
        tiles.update(&frame);
        let mut clusters = Clusters::with_capacity(geometry.tile_count());
        clusters.update(&tiles);
        clusters.iter().map(<[u32]>::len).collect()
    }

    #[test]
    fn tiles_that_touch_at_a_corner_belong_together() {
        assert_eq!(clusters_of(6, &[(0, 0), (1, 1)]), [2]);
        assert_eq!(clusters_of(6, &[(1, 0), (0, 1)]), [2]);
    }

    #[test]
    fn the_floors_edge_does_not_wrap_around() {
        assert_eq!(clusters_of(6, &[(5, 0), (0, 1)]), [1, 1]);
        assert_eq!(clusters_of(6, &[(5, 5), (0, 0)]), [1, 1]);
    }

    #[test]
    fn a_ring_is_one_cluster_and_its_island_another() {
        let ring: Vec<_> = (0..5)
            .flat_map(|i| (0..5).map(move |j| (i, j)))
            .filter(|&(i, j)| i == 0 || j == 0 || i == 4 || j == 4 || (i, j) == (2, 2))
            .collect();
        assert_eq!(clusters_of(96, &ring), [16, 1]);
    }
}
