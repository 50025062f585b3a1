//! Feet as contacts.

use super::params::dormant::{PLACE_M, REPORTED};
use super::params::output::{
    AMBIGUOUS_M, FITS, INFLATION, LEAST_N, LOST_M, OTHERS_MISREAD, STRAYED_M, TOGETHER_M,
};
use glam::Vec2;

use super::state::{EAST, NORTH, Track};
use super::{Cells, Tracker};
use crate::sense::contact::{Covariance, TileLoad};
use crate::sense::loaded::LoadedTiles;
use crate::sense::pool::ContactPool;
use crate::sense::tile::LoadedTile;
use crate::units::Newtons;

impl Tracker {
    /// Fills `pool` with the feet as they are now.
    pub(super) fn describe(&mut self, tiles: &LoadedTiles, pool: &mut ContactPool) {
        let list = tiles.list();
        pool.clear();
        for foot in &mut self.tracks {
            if !foot.shared {
                (foot.nis, foot.misfit) = (0.0, 0.0);
            }
            // Predictions that keep failing say that the feet are not what the filter takes them for.
            let variance = foot.covariance[EAST][EAST].max(foot.covariance[NORTH][NORTH]);
            let inflation = (1.0 + INFLATION * foot.nis).min(LOST_M * LOST_M / variance).max(1.0);
            foot.ambiguous = if foot.shared {
                foot.beyond_filter || inflation * variance > AMBIGUOUS_M * AMBIGUOUS_M
            } else {
                foot.explanation.is_open()
            };
            let contact = pool.add(foot.id);
            contact.centroid = foot.centre().as_vec2();
            contact.force = Newtons(foot.force() as f32);
            contact.velocity = foot.velocity().as_vec2();
            // Of two feet of which one was taken to stand still, neither is where it is said to be if the loads do not
            // fit. That is told; the filter goes on by its own uncertainty.
            let strayed_m = STRAYED_M * (foot.misfit - FITS).max(0.0).sqrt().sqrt();
            let is_guess = foot.shared && (inflation * variance).sqrt().hypot(strayed_m) > AMBIGUOUS_M;
            contact.ambiguous = foot.ambiguous || is_guess;
            let mut covariance = if foot.shared {
                Covariance {
                    xx: (inflation * foot.covariance[EAST][EAST]) as f32,
                    xy: (inflation * foot.covariance[EAST][NORTH]) as f32,
                    yy: (inflation * foot.covariance[NORTH][NORTH]) as f32,
                }
            } else {
                Covariance::default()
            };
            if !foot.shared {
                let left: f32 = foot.tiles.iter().map(|&position| list[position as usize].left_n).sum();
                contact.force = Newtons((contact.force.0 - left).max(LEAST_N));
            }
            for &position in &foot.tiles {
                let tile = &list[position as usize];
                let (mut share, load) = part_of(foot, tile, &self.cells);
                if foot.shared {
                    // What the others' loads are misread by is known in part, from when they stood alone.
                    share += (1.0 - share) * OTHERS_MISREAD;
                }
                if load.force.0 > 0.0 {
                    contact.tiles.push(load);
                }
                contact.quality = contact.quality.max(tile.quality);
                covariance += self.uncertainty.covariance(
                    tiles.geometry(),
                    tile,
                    share,
                    contact.centroid,
                    contact.force.0,
                );
            }
            if contact.tiles.is_empty() {
                // Its patch has come to lie beside every tile that could carry it.
                contact.tiles.extend(foot.tiles.first().map(|&position| {
                    let tile = &list[position as usize];
                    let force = Newtons(tile.wrench.force.min(contact.force.0));
                    TileLoad { tile: tile.tile, index: tile.index as usize, force, centroid: tile.centroid }
                }));
            }
            covariance += Covariance::isotropic(strayed_m as f32);
            if foot.landed_together {
                covariance += Covariance::isotropic(TOGETHER_M);
            }
            if !foot.shared {
                covariance += Covariance::isotropic(foot.explanation.hidden_m() as f32);
            }
            contact.covariance = covariance;
            contact.finish();
        }
        for dormant in &self.dormant {
            let Some(existing) = self.tracks.iter().find(|foot| foot.id == dormant.existing) else {
                continue;
            };
            let contact = pool.add(dormant.foot.id);
            contact.centroid = dormant.foot.centre().as_vec2();
            contact.force = Newtons((REPORTED * existing.force()) as f32);
            contact.velocity = Vec2::ZERO;
            contact.ambiguous = true;
            contact.covariance = Covariance::isotropic(PLACE_M as f32);
            contact.tiles.extend(existing.tiles.iter().map(|&position| {
                let tile = &list[position as usize];
                let force = Newtons(tile.wrench.force * REPORTED as f32);
                TileLoad { tile: tile.tile, index: tile.index as usize, force, centroid: tile.centroid }
            }));
            contact.finish();
        }
        pool.sort_by_id();
    }
}

/// What `foot` presses on `tile`: as a share of the tile's load, and in newtons.
fn part_of(foot: &Track, tile: &LoadedTile, cells: &Cells) -> (f32, TileLoad) {
    let whole = TileLoad {
        tile: tile.tile,
        index: tile.index as usize,
        force: Newtons(tile.wrench.force),
        centroid: tile.centroid,
    };
    if !foot.shared {
        return (1.0, whole);
    }
    let on = foot.on(cells.of(tile));
    let force = (foot.force() * on.share()) as f32;
    let share = (force / tile.wrench.force).min(1.0);
    let arm = if on.share() > 1e-6 { (on.moment() / on.share()).as_vec2() } else { Vec2::ZERO };
    (share, TileLoad { force: Newtons(force.min(tile.wrench.force)), centroid: tile.centre + arm, ..whole })
}
