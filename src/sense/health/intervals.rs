//! The time between two samples of each tile's board, where it is longer than a frame.

use std::ops::Range;

/// Maximum number of frames between two samples, with lost ones: three periods at 10 Hz.
const MOST_FRAMES: f32 = 300.0;

/// Time between the samples of all tiles; all are 1 ms apart unless the floor has boards at another rate.
#[derive(Clone, Debug, Default)]
pub(super) struct SampleIntervals {
    /// In milliseconds, at least 1; empty if all are 1.
    ms: Vec<f32>,
    /// Whether each sensor has been read since the last visit to its tile, and as of the present visit.
    news: Vec<[bool; 4]>,
    visited: Vec<[bool; 4]>,
}

impl SampleIntervals {
    /// Sets the intervals of some of `tiles` tiles; the others have 1 ms.
    pub(super) fn set(&mut self, tiles: usize, intervals: impl Iterator<Item = (usize, f32)>) {
        let mut ms = vec![1.0; tiles];
        for (tile, interval) in intervals {
            if let Some(ms) = ms.get_mut(tile) {
                *ms = interval.max(*ms);
            }
        }
        let is_any_longer = ms.iter().any(|ms| *ms > 1.0);
        let tiles = if is_any_longer { tiles } else { 0 };
        self.ms = if is_any_longer { ms } else { Vec::new() };
        self.news.resize(tiles, [false; 4]);
        self.visited.resize(tiles, [false; 4]);
    }

    /// Whether all boards sample at least once a frame.
    pub(super) const fn are_all_one(&self) -> bool {
        self.ms.is_empty()
    }

    /// Time between two samples of a tile, in milliseconds; at least 1.
    pub(super) fn ms(&self, tile: usize) -> f32 {
        self.ms.get(tile).copied().unwrap_or(1.0)
    }

    /// Number of frames within which a tile has its next sample, with two lost ones in between; 1 for a tile that has
    /// one in each frame.
    pub(super) fn frames(&self, tile: usize) -> u32 {
        match self.ms(tile) {
            ms if ms > 1.0 => (3.0 * ms).min(MOST_FRAMES) as u32,
            _ => 1,
        }
    }

    /// Notes which sensors have been read for the present frame.
    pub(super) fn note_news(&mut self, read: &[[bool; 4]]) {
        let all = self.news.as_flattened_mut().iter_mut().zip(read.as_flattened());
        all.for_each(|(news, read)| *news |= read);
    }

    /// Visits `tiles`: their news are those since the last visit.
    pub(super) fn visit(&mut self, tiles: Range<usize>) {
        let (news, visited) = (&mut self.news[tiles.clone()], &mut self.visited[tiles]);
        visited.copy_from_slice(news);
        news.fill([false; 4]);
    }

    /// Whether each sensor had been read between the last two visits to its tile.
    pub(super) fn visited(&self) -> &[[bool; 4]] {
        &self.visited
    }
}
