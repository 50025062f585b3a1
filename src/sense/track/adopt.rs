//! Which foot a loaded tile belongs to, and feet that land where nobody reaches.

use glam::DVec2;

use super::foot::{EAST, FORCE, Foot, LANDS_S, NORTH};
use super::landing::Landing;
use super::{NOBODY, Tracker, first_of_least};
use crate::sense::loaded::LoadedTiles;

/// Largest distance between the feet of somebody who stands, in metres.
const ASTRIDE_M: f64 = 0.5;

impl Tracker {
    /// Finds who reaches which tile, gives tiles nobody reaches to the nearest foot that
    /// may have grown onto them, and lets new feet land on the rest.
    pub(super) fn adopt(&mut self, tiles: &LoadedTiles) {
        let list = tiles.list();
        self.owner.clear();
        self.owner.resize(list.len(), NOBODY);
        for (which, foot) in self.feet.iter().enumerate() {
            for &position in &foot.tiles {
                self.owner[position as usize] = which as u32;
            }
        }
        self.orphans.clear();
        self.orphans
            .extend((0..list.len() as u32).filter(|&position| self.owner[position as usize] == NOBODY));
        self.orphans.sort_unstable_by(|&a, &b| {
            let force = |position: u32| list[position as usize].wrench.force;
            force(b).total_cmp(&force(a)).then(a.cmp(&b))
        });
        self.find_keepers(tiles);
        for orphan in 0..self.orphans.len() {
            let position = self.orphans[orphan];
            let tile = &list[position as usize];
            let centroid = tile.centroid.as_dvec2();
            let force = f64::from(tile.wrench.force);
            let beyond = |foot: &Foot| {
                foot.beyond(centroid).min(foot.lands_about(centroid)).min(foot.rims(centroid, force))
            };
            // What was loaded already is no newcomer: it stays with the nearest of those who had it.
            let from = self.keepers.partition_point(|&(kept, _)| kept < position);
            let keepers = self.keepers[from..].iter().take_while(|&&(kept, _)| kept == position);
            let away = keepers.map(|&(_, which)| {
                let which = which as usize;
                (self.feet[which].centre().distance(centroid), which)
            });
            let nearest = away.min_by(first_of_least).or_else(|| {
                // Who may have grown onto it has its centre of pressure within a stride.
                let feet = self.near.around(centroid).map(|which| (beyond(&self.feet[which]), which));
                feet.filter(|&(beyond, _)| beyond < 0.0).min_by(first_of_least)
            });
            match nearest {
                Some((_, which)) => {
                    let foot = &mut self.feet[which];
                    foot.tiles.push(position);
                    if foot.age == 0.0 {
                        // A foot that lands on several tiles at once: its middle is theirs.
                        let whole = foot.force() + force;
                        let centre = foot.centre() + (centroid - foot.centre()) * (force / whole);
                        foot.state[FORCE] = whole;
                        foot.state[EAST] = centre.x;
                        foot.state[NORTH] = centre.y;
                        self.near.moved(which, centre);
                    }
                    self.owner[position as usize] = which as u32;
                }
                None => {
                    let mut foot = Foot::new(self.name(), force, centroid, 0.02);
                    foot.landing = self.landing_at(centroid);
                    foot.tiles.push(position);
                    self.owner[position as usize] = self.feet.len() as u32;
                    self.near.add(foot.centre());
                    self.feet.push(foot);
                }
            }
        }
    }

    /// Finds, for each tile nobody reaches now, those who had it in the last frame.
    fn find_keepers(&mut self, tiles: &LoadedTiles) {
        self.keepers.clear();
        if self.orphans.is_empty() {
            return;
        }
        for (which, foot) in (0..).zip(&self.feet) {
            let had = foot.past.loads.iter().filter_map(|load| tiles.position(load.index));
            let orphans = had.filter(|&position| self.owner[position as usize] == NOBODY);
            self.keepers.extend(orphans.map(|position| (position, which)));
        }
        self.keepers.sort_unstable();
    }

    /// Beside whom a foot that lands at `place` does so, if somebody stands still there.
    fn landing_at(&self, place: DVec2) -> Option<Landing> {
        let near = self.near.around(place).map(|which| (self.feet[which].centre().distance(place), which));
        let (_, host) = near.filter(|&(distance, _)| distance < ASTRIDE_M).min_by(first_of_least)?;
        let host = &self.feet[host];
        (host.lingers() && !host.shared).then_some(Landing { host: host.id, from: host.home })
    }

    /// Gives feet that have just landed, and are guessed to be beside all loaded tiles, the tiles they were noticed on.
    pub(super) fn keep_in_touch(&mut self, tiles: &LoadedTiles) {
        for foot in &mut self.feet {
            if foot.tiles.is_empty() && foot.age < LANDS_S {
                foot.tiles.extend(foot.past.loads.iter().filter_map(|load| tiles.position(load.index)));
            }
        }
    }
}
