//! Selects the loaded tiles among the candidates.

use super::survey::Survey;
use super::tile_set::bits;
use super::{BLOCK, LoadedTiles, NONE};
use crate::sense::centroid::corners::is_possible;
use crate::sense::centroid::tile::LoadedTile;
use crate::sense::{ForceFrame, Quality};
use crate::units::Newtons;

impl LoadedTiles {
    /// Finds the candidates of blocks that need more than the sums: noisy blocks, and blocks with a lost sensor,
    /// which is replaced by an estimate.
    pub(super) fn reconsider(&mut self, frame: &ForceFrame) {
        let there = frame.forces.len().min(frame.quality.len()).min(self.survey.sums.len());
        for block in 0..self.survey.worst.len() {
            if !self.survey.has_lost(block) && !self.thresholds.is_noisy(block) {
                continue;
            }
            let Survey { sums, candidates, .. } = &mut self.survey;
            let candidates = &mut candidates.blocks_mut()[block];
            *candidates = 0;
            let from = block * BLOCK;
            let here = from..(from + BLOCK).min(there);
            let quality = frame.quality.get(here.clone()).unwrap_or_default();
            let sums = sums.get(here).unwrap_or_default();
            for (place, (&sum, quality)) in sums.iter().zip(quality).enumerate() {
                let is_lost = quality.iter().any(|&quality| quality >= Quality::Stale);
                let is_enough = self.thresholds.deciding(from + place, sum) >= self.thresholds.least();
                *candidates |= u16::from(is_enough || is_lost) << place;
            }
        }
    }

    /// Turns candidates into loaded tiles.
    pub(super) fn sift(&mut self, frame: &ForceFrame) {
        // The tiles of the last frame stay available until the new list is complete.
        std::mem::swap(&mut self.list, &mut self.last);
        self.list.clear();
        self.before.clear();
        let was_settled = std::mem::replace(&mut self.is_settled, true);
        let Self { survey, thresholds, place, listed, .. } = self;
        for (block, (listed, &candidates)) in
            listed.blocks_mut().iter_mut().zip(survey.candidates.blocks()).enumerate()
        {
            for gone in bits(*listed & !candidates) {
                let index = block * BLOCK + gone;
                place[index] = NONE;
                thresholds.note(index, survey.sums[index]);
            }
            *listed = candidates;
        }
        for block in 0..self.survey.worst.len() {
            let candidates = self.survey.candidates.blocks()[block];
            if candidates == 0 {
                continue;
            }
            let is_plain = was_settled && self.survey.is_live(block);
            for candidate in bits(candidates) {
                let index = block * BLOCK + candidate;
                let is_loaded = if is_plain { self.take(frame, index) } else { self.examine(frame, index) };
                if !is_loaded {
                    self.listed.remove(index as u32);
                }
            }
        }
        for (light, &listed) in self.survey.light.blocks_mut().iter_mut().zip(self.listed.blocks()) {
            *light &= !listed;
        }
    }

    /// Lists the tile at `index` if it is loaded, and returns whether it is; all its sensors are live, and it needs
    /// no state from its past.
    #[inline]
    fn take(&mut self, frame: &ForceFrame, index: usize) -> bool {
        let forces = &frame.forces[index];
        let (before, least) = self.least_of(index);
        let map = self.maps.get(index).and_then(Option::as_ref);
        let tile = LoadedTile::new(self.places[index], &self.geometry, forces, least, map);
        if before != NONE {
            self.thresholds.note(index, self.survey.sums[index]);
        }
        match tile {
            Some(tile) if is_possible(forces) => self.enlist(tile, before),
            _ => return false,
        }
        true
    }

    /// Like [`Self::take`], with sensors of any quality and past.
    #[inline(never)]
    fn examine(&mut self, frame: &ForceFrame, index: usize) -> bool {
        let past = self.last.get(self.place[index] as usize);
        let (forces, quality) = (frame.forces[index], frame.quality[index]);
        if quality == [Quality::Live; 4] && past.is_none_or(LoadedTile::is_settled) {
            return self.take(frame, index);
        }
        let (before, least) = self.least_of(index);
        let (carried, tile) = LoadedTile::of_any_quality(
            self.places[index],
            &self.geometry,
            (forces, quality, frame.may_start.get(index) == Some(&true)),
            least,
            self.maps.get(index).and_then(Option::as_ref),
            self.last.get(before as usize),
            self.dt,
        );
        if let Some(carried) = carried {
            // The reading of a lost sensor is not a load.
            self.survey.sums[index] = carried;
        }
        if before != NONE {
            self.thresholds.note(index, self.survey.sums[index]);
        }
        self.is_settled &= tile.as_ref().is_none_or(LoadedTile::is_settled);
        tile.is_some_and(|tile| {
            self.enlist(tile, before);
            true
        })
    }

    /// Position in the last frame's list of the tile at `index`, and its threshold; afterwards it is in no list.
    #[inline(always)]
    fn least_of(&mut self, index: usize) -> (u32, Newtons) {
        let before = std::mem::replace(&mut self.place[index], NONE);
        (before, self.thresholds.least_of(index, self.survey.sums[index], before != NONE, self.dt))
    }

    #[inline(always)]
    fn enlist(&mut self, mut tile: LoadedTile, before: u32) {
        let index = tile.index as usize;
        tile.noise_n = self.thresholds.noise_n(index);
        tile.left_n = self.thresholds.left_n(index, tile.wrench.force);
        self.place[index] = self.list.len() as u32;
        self.before.push(before);
        self.list.push(tile);
    }
}
