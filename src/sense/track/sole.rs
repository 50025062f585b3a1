//! The load of a standing sole on the tiles around it.
//!
//! A foot presses with heel and forefoot, a fixed distance apart; its centre of pressure divides the load between the
//! two. Each of them is a round patch. A child's sole is smaller in all its measures.

use super::params::sole::{
    ADULT_N, BLOTCH, BLOTCH_LEAST, FOREFOOT_HALF_M, HEEL_HALF_M, LEAST_SIZE, LENGTH_M, NOISE_N, SWAY_M,
};
use glam::DVec2;

use super::Cells;
use super::cell_of;
use super::patch::Slice;
use crate::sense::centroid::tile::LoadedTile;
use crate::sense::loaded::LoadedTiles;

/// Columns, and rows, of tiles around a contact.
const SIDE: usize = 3;

const AROUND: usize = SIDE * SIDE;

/// A standing foot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sole {
    /// Centre of pressure.
    pub centre: DVec2,
    /// Unit vector from heel to toes.
    pub heading: DVec2,
    /// Share of its load on the heel.
    pub on_heel: f64,
    /// In newtons.
    pub force: f64,
    /// Its length, in soles of an adult.
    pub size: f64,
}

impl Sole {
    /// The size of the soles of a person who weighs `weight` newtons: grown-up from [`ADULT_N`] on.
    pub(super) fn size_of(weight: f64) -> f64 {
        (weight / ADULT_N).cbrt().clamp(LEAST_SIZE, 1.0)
    }
}

/// The loads of the tiles around a contact.
#[derive(Clone, Debug)]
pub(super) struct LoadsAround {
    /// South-west corner of the tiles, and the size of each.
    corner: DVec2,
    pitch: DVec2,
    tiles: [Load; AROUND],
}

/// The load of one tile.
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    force: f64,
    /// Moment about the tile's middle (N m).
    moment: DVec2,
    /// Variance of the force (N²); infinite for a tile that is not observed.
    variance: f64,
}

impl LoadsAround {
    /// The loads of the contact with its centre of pressure at `centre` on `own` tiles: the nine around that point.
    /// Tiles of other contacts are not observed.
    pub(super) fn of(centre: DVec2, own: &[u32], tiles: &LoadedTiles, cells: &Cells) -> Self {
        let first = cell_of(centre, cells.pitch) - 1;
        let mut around = [Load { variance: NOISE_N * NOISE_N, ..Load::default() }; AROUND];
        for (at, load) in around.iter_mut().enumerate() {
            let (column, row) = (first.x + (at % SIDE) as i32, first.y + (at / SIDE) as i32);
            let Some(position) = tiles.find(column, row) else { continue };
            if own.contains(&(position as u32)) {
                *load = Load::of(&tiles.list()[position]);
            } else {
                load.variance = f64::INFINITY;
            }
        }
        Self { corner: first.as_dvec2() * cells.pitch, pitch: cells.pitch, tiles: around }
    }

    /// The loads of `soles` on the nine tiles around `centre`.
    #[cfg(test)]
    pub(super) fn pressed_by(soles: &[Sole], centre: DVec2, pitch: DVec2) -> Self {
        let corner = (cell_of(centre, pitch) - 1).as_dvec2() * pitch;
        let mut around = Self { corner, pitch, tiles: [Load::default(); AROUND] };
        let mut tiles = around.tiles;
        soles.iter().for_each(|sole| around.press(sole, &mut tiles));
        around.tiles = tiles.map(|load| Load { variance: NOISE_N * NOISE_N, ..load });
        around
    }

    /// Log likelihood of the loads if these soles press, up to a constant.
    pub(super) fn log_likelihood(&self, soles: &[Sole]) -> f64 {
        let mut expected = [Load::default(); AROUND];
        for sole in soles {
            self.press(sole, &mut expected);
        }
        let lever = self.pitch * 0.5;
        let (mut squares, mut determinant) = (0.0, 1.0);
        for (tile, expected) in self.tiles.iter().zip(&expected) {
            if tile.variance.is_infinite() {
                continue;
            }
            let force = tile.variance + expected.variance;
            let swaying = (SWAY_M * expected.force).powi(2);
            let moment = lever * lever * (0.36 * force) + swaying;
            let off = tile.moment - expected.moment;
            squares += (tile.force - expected.force).powi(2) / force
                + off.x * off.x / moment.x
                + off.y * off.y / moment.y;
            determinant *= force * moment.x * moment.y;
        }
        -0.5 * (squares + determinant.ln())
    }

    /// Adds the load of `sole`, and its variance.
    fn press(&self, sole: &Sole, expected: &mut [Load; AROUND]) {
        let along = sole.heading * (sole.size * LENGTH_M);
        let heel = sole.centre - along * (1.0 - sole.on_heel);
        let forefoot = sole.centre + along * sole.on_heel;
        for (place, half, share) in
            [(heel, HEEL_HALF_M, sole.on_heel), (forefoot, FOREFOOT_HALF_M, 1.0 - sole.on_heel)]
        {
            let half = sole.size * half;
            let force = sole.force * share;
            let at = place - self.corner;
            let slices = |along: f64, pitch: f64| -> [Slice; SIDE] {
                std::array::from_fn(|cell| {
                    Slice::new(cell as f64 * pitch, cell as f64 * pitch + pitch, along, half)
                })
            };
            let (columns, rows) = (slices(at.x, self.pitch.x), slices(at.y, self.pitch.y));
            for (expected, at) in expected.iter_mut().zip(0..) {
                let (east, north) = (&columns[at % SIDE], &rows[at / SIDE]);
                let on = east.share * north.share;
                if on <= 0.0 {
                    continue;
                }
                expected.force += force * on;
                expected.moment += DVec2::new(east.moment * north.share, east.share * north.moment) * force;
                expected.variance += (BLOTCH * force).powi(2) * (4.0 * on * (1.0 - on) + BLOTCH_LEAST);
            }
        }
    }
}

impl Load {
    fn of(tile: &LoadedTile) -> Self {
        let force = f64::from(tile.wrench.force);
        let noise = tile.loaded_noise_n();
        Self {
            force,
            moment: (tile.centroid - tile.centre).as_dvec2() * force,
            variance: NOISE_N * NOISE_N + noise * noise,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn soles_grow_with_the_weight_up_to_an_adults() {
        // The feet of a child of 24 kg are 18 cm long, those of an adult 26 cm.
        assert!((Sole::size_of(235.0) - 0.695).abs() < 0.001);
        assert_eq!((Sole::size_of(0.0), Sole::size_of(2000.0)), (LEAST_SIZE, 1.0));
    }
}
