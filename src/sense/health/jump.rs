//! Loads that change faster than a body changes them.

use std::time::Duration;

use multiversion::multiversion;

use super::trouble::Sensor;
use crate::sense::{ForceFrame, Quality};
use crate::units::Instant;

/// Maximum change of the load of one tile within a millisecond (N) (our choice).
///
/// # Source
/// Walking loads a foot by 7 to 20 body weights a second (Winter 1991), that is 14 N a millisecond for 70 kg; running
/// on the heel in shoes by about 70 (Lieberman et al. 2010), 48 N a millisecond; a stamp stays below 20. Six times
/// the hardest of these leaves room for plates that ring, and is a third of the reading of four sensors that go from
/// zero to 60,000 counts (920 N of the nominal part). Running barefoot on the heel reaches 460 for a moment (the same
/// source) and may cause a false alarm: that ends a hold and presses nothing.
const MOST_N: f32 = 300.0;

/// Time for which the tile is faulty after that (our choice: ten times the settling time of a converter that was cut
/// off and is back, and the time-out of a silent board).
const SUSPECTED_FOR: Duration = Duration::from_millis(100);

/// If no sensor changes by more, its tile's load has not jumped, for any set of faulty sensors and any rounding.
const CALM_N: f32 = 0.9 * MOST_N / 4.0;

/// Number of tiles compared together.
const BLOCK: usize = 16;

/// Watches all tiles for jumps of their load.
#[derive(Clone, Debug)]
pub(super) struct Jumps {
    /// Time at which each tile was last read by itself, and each block of tiles at once; `None` before the first
    /// time.
    at: Vec<Option<Instant>>,
    blocks_at: Vec<Option<Instant>>,
    /// Readings at that time.
    forces: Vec<[f32; 4]>,
    /// Whether each sensor has been read for the present frame.
    news: Vec<[bool; 4]>,
    /// Blocks with a possible jump, or with a sensor that has not been read.
    stirred: Vec<usize>,
    /// Time until which each tile is faulty, and the latest of these times.
    suspected_until: Vec<Instant>,
    any_until: Instant,
    count: u64,
    /// The tile of the last jump and its height, in newtons.
    last: Option<(usize, f32)>,
}

impl Jumps {
    pub(super) fn new(tiles: usize) -> Self {
        Self {
            at: vec![None; tiles],
            blocks_at: vec![None; tiles.div_ceil(BLOCK)],
            forces: vec![[0.0; 4]; tiles],
            news: vec![[false; 4]; tiles],
            stirred: Vec::with_capacity(tiles.div_ceil(BLOCK)),
            suspected_until: vec![Instant::START; tiles],
            any_until: Instant::START,
            count: 0,
            last: None,
        }
    }

    /// For each sensor, four to a tile, whether it has been read for the present frame; the caller sets it.
    pub(super) fn news(&mut self) -> &mut [bool] {
        self.news.as_flattened_mut()
    }

    /// Whether each sensor has been read for the present frame, tile by tile.
    pub(super) fn read(&self) -> &[[bool; 4]] {
        &self.news
    }

    /// Marks tiles with a jump of their load as faulty for a while, regardless of their quality.
    ///
    /// Sensors known to be out do not count: the plate check finds a short, and the tile continues with the other
    /// three.
    pub(super) fn mark(&mut self, frame: &mut ForceFrame, sensors: &[[Sensor; 4]], now: Instant) {
        self.stirred.clear();
        settle(&mut self.forces, &frame.forces, &mut self.news, &mut self.blocks_at, now, &mut self.stirred);
        for place in 0..self.stirred.len() {
            let first = BLOCK * self.stirred[place];
            let tiles = frame.forces.iter().zip(sensors).enumerate().skip(first).take(BLOCK);
            for (tile, (&forces, sensors)) in tiles {
                self.compare(tile, forces, sensors, now);
                self.news[tile] = [false; 4];
            }
        }
        if now < self.any_until {
            for (quality, until) in frame.quality.iter_mut().zip(&self.suspected_until) {
                if now < *until {
                    *quality = [Quality::Faulty; 4];
                }
            }
        }
    }

    /// Compares the readings of `tile` with those before, if it has been read.
    fn compare(&mut self, tile: usize, forces: [f32; 4], sensors: &[Sensor; 4], now: Instant) {
        if self.news[tile] == [false; 4] {
            return;
        }
        let before = std::mem::replace(&mut self.forces[tile], forces);
        let at = self.at[tile].replace(now).max(self.blocks_at[tile / BLOCK]);
        let elapsed = at.map(|at| now.since(at));
        let changes = (0..4).filter(|&corner| !sensors[corner].is_out());
        let jump = changes.map(|corner| forces[corner] - before[corner]).sum::<f32>().abs();
        // After silence all holds are cancelled anyway, and a person may have stepped on.
        let spans = elapsed.filter(|elapsed| *elapsed < SUSPECTED_FOR);
        if spans.is_some_and(|elapsed| jump > MOST_N * (1e3 * elapsed.as_secs_f32()).max(1.0)) {
            self.suspected_until[tile] = now + SUSPECTED_FOR;
            self.any_until = self.any_until.max(now + SUSPECTED_FOR);
            self.count += 1;
            self.last = Some((tile, jump));
        }
    }

    /// Number of jumps, and the tile and height of the last one.
    pub(super) const fn found(&self) -> (u64, Option<(usize, f32)>) {
        (self.count, self.last)
    }
}

/// Stores the readings at `now` of each block of tiles, if all of its sensors have been read and no tile's load can
/// have jumped; adds the other blocks to `stirred`.
///
/// Compiled for each vector instruction set.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw+avx512dq", "x86_64+avx2", "aarch64+neon"))]
fn settle(
    before: &mut [[f32; 4]],
    forces: &[[f32; 4]],
    news: &mut [[bool; 4]],
    at: &mut [Option<Instant>],
    now: Instant,
    stirred: &mut Vec<usize>,
) {
    let blocks = before.chunks_mut(BLOCK).zip(forces.chunks(BLOCK)).zip(news.chunks_mut(BLOCK)).zip(at);
    for (block, (((before, forces), news), at)) in blocks.enumerate() {
        if is_calm(before.as_flattened(), forces.as_flattened(), news.as_flattened()) {
            before.copy_from_slice(forces);
            news.fill([false; 4]);
            *at = Some(now);
        } else {
            stirred.push(block);
        }
    }
}

/// Whether all of some sensors have been read, and no tile's load can have jumped.
#[inline(always)]
fn is_calm(before: &[f32], forces: &[f32], news: &[bool]) -> bool {
    let mut calm = true;
    for (before, now) in before.iter().zip(forces) {
        calm &= (now - before).abs() < CALM_N;
    }
    for news in news {
        calm &= news;
    }
    calm
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::Geometry;

    /// The milliseconds in which a tile with `newtons` on each sensor is faulty.
    fn suspected(newtons: impl IntoIterator<Item = Option<f32>>) -> Vec<usize> {
        let geometry = Geometry::of_paper_tiles(1, 1).unwrap();
        let (mut jumps, mut frame) = (Jumps::new(1), ForceFrame::empty(&geometry));
        let mut suspected = Vec::new();
        for (ms, newtons) in newtons.into_iter().enumerate() {
            frame.quality.fill([Quality::Live; 4]);
            if let Some(newtons) = newtons {
                frame.forces[0] = [0.25 * newtons; 4];
                jumps.news().fill(true);
            }
            jumps.mark(&mut frame, &[[Sensor::default(); 4]], Instant::from_millis(ms as u64));
            if frame.quality[0] == [Quality::Faulty; 4] {
                suspected.push(ms);
            }
        }
        suspected
    }

    #[test]
    fn a_jump_up_or_down_is_suspected_for_a_tenth_of_a_second() {
        let jump = |to: f32| (0..200).map(move |ms| Some(if ms < 50 { 450.0 } else { to }));
        assert_eq!(suspected(jump(1000.0)), (50..150).collect::<Vec<_>>());
        assert_eq!(suspected(jump(0.0)), (50..150).collect::<Vec<_>>());
        assert!(suspected(jump(700.0)).is_empty());
    }

    #[test]
    fn the_hardest_heel_strikes_are_believed() {
        for newtons_per_ms in [14.0, 48.0, 200.0] {
            let strike = (0..300).map(|ms| Some((newtons_per_ms * ms as f32).min(2500.0)));
            assert!(suspected(strike).is_empty(), "{newtons_per_ms} N a millisecond");
        }
    }

    #[test]
    fn what_came_during_a_gap_is_judged_by_its_length() {
        // 50 ms of lost packets while a foot lands with 20 N a millisecond.
        let gap = (0..200).map(|ms| (!(50..100).contains(&ms)).then_some((20.0 * ms as f32).min(1500.0)));
        assert!(suspected(gap).is_empty());
    }
}
