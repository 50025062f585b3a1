//! Groups of loaded tiles that touch each other.

use std::ops::Range;

use crate::floor::Geometry;
use crate::sense::loaded::{LoadedTiles, TileSet};

/// Groups of loaded tiles that touch along an edge or at a corner.
#[derive(Clone, Debug)]
pub(in crate::sense) struct Clusters {
    /// Positions in the list of loaded tiles, one cluster after the other.
    members: Vec<u32>,
    spans: Vec<Range<usize>>,
    /// The cluster of each loaded tile, and of each of the last frame.
    of: Vec<u32>,
    of_last: Vec<u32>,
    /// Loaded tiles without a cluster so far.
    unassigned: TileSet,
    /// The tiles of the present cluster, by their places in tile-index order.
    found: Vec<u32>,
}

impl Clusters {
    /// Reserves room for every tile of a floor, so that finding clusters never allocates.
    pub(in crate::sense) fn new(geometry: &Geometry) -> Self {
        let tiles = geometry.tile_count().min(4096);
        Self {
            members: Vec::with_capacity(tiles),
            spans: Vec::with_capacity(tiles),
            of: Vec::with_capacity(tiles),
            of_last: Vec::with_capacity(tiles),
            unassigned: TileSet::new(geometry),
            found: Vec::with_capacity(tiles),
        }
    }

    /// Finds the clusters of `tiles`, in the order of their first tile.
    pub(in crate::sense) fn update(&mut self, tiles: &LoadedTiles) {
        let Self { members, spans, of, of_last, unassigned, found } = self;
        std::mem::swap(of, of_last);
        of.resize(tiles.list().len(), 0);
        members.clear();
        spans.clear();
        unassigned.clone_from(tiles.listed());
        for block in 0..unassigned.block_count() {
            while let Some(first) = unassigned.pop(block) {
                let (cluster, start) = (spans.len() as u32, members.len());
                // The tiles found are also the queue of tiles whose neighbours are still to be examined.
                found.clear();
                found.push(first);
                let mut next = 0;
                while let Some(&index) = found.get(next) {
                    next += 1;
                    let Some(position) = tiles.position(index) else { continue };
                    members.push(position);
                    of[position as usize] = cluster;
                    for neighbour in unassigned.around(index) {
                        unassigned.remove(neighbour.index);
                        found.push(neighbour.index);
                    }
                }
                spans.push(start..members.len());
            }
        }
    }

    /// The cluster of the last frame that contained the tile at position `before` of its list; `None` past its end.
    #[inline]
    pub(in crate::sense) fn of_last(&self, before: u32) -> Option<u32> {
        self.of_last.get(before as usize).copied()
    }

    /// Range of one cluster among the members of all; `None` past the last.
    pub(in crate::sense) fn span(&self, cluster: usize) -> Option<Range<usize>> {
        self.spans.get(cluster).cloned()
    }

    /// One cluster as positions in the list of loaded tiles; `None` past the last.
    pub(in crate::sense) fn get(&self, cluster: usize) -> Option<&[u32]> {
        self.members.get(self.span(cluster)?)
    }

    /// Each cluster as positions in the list of loaded tiles.
    pub(in crate::sense) fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> {
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
        let mut clusters = Clusters::new(&geometry);
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
