//! Feet and objects on the floor, and the load of each tile.

use glam::Vec2;
use smallvec::{SmallVec, smallvec};

use super::footprint::Print;
use underfoot::floor::{Geometry, TileId};
use underfoot::sense::TileLoad;
use underfoot::units::{Instant, Newtons};

/// A foot in its shoe, on the floor or above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Centre of the shoe, in floor metres.
    pub position: Vec2,
    /// Direction of the toes, in radians counter-clockwise from north.
    pub heading: f32,
    /// Length of the bare foot, in metres: 0.22 to 0.30 for people.
    pub length_m: f32,
    /// Force on the floor; zero or less if the foot is in the air.
    pub force: Newtons,
    /// Position of the load along the foot, from the heel (0) to the toes (1).
    pub roll: f32,
    /// True for a left foot; it does not affect the floor.
    pub left: bool,
}

impl Foot {
    /// Returns the centre of pressure in floor metres, on or off the floor.
    #[must_use]
    pub fn centre_of_pressure(&self) -> Vec2 {
        self.as_load().centre_of_pressure()
    }

    /// Returns the load on each tile; see [`Load::on_tiles`].
    #[must_use]
    pub fn on_tiles(&self, geometry: &Geometry) -> SmallVec<[TileLoad; 4]> {
        self.as_load().on_tiles(geometry)
    }

    /// Returns the foot as a load.
    #[must_use]
    pub const fn as_load(&self) -> Load {
        Load {
            print: Print::Shoe { length_m: self.length_m, roll: self.roll },
            position: self.position,
            heading: self.heading,
            force: self.force,
        }
    }
}

/// A load on the floor: a foot, or a simple shape for an experiment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Shape of the contact area.
    pub print: Print,
    /// The print's origin, in floor metres.
    pub position: Vec2,
    /// Direction of the print's y axis, in radians counter-clockwise from north.
    pub heading: f32,
    /// Force on the floor.
    pub force: Newtons,
}

impl Load {
    /// Returns the centre of pressure in floor metres, on or off the floor.
    #[must_use]
    pub fn centre_of_pressure(&self) -> Vec2 {
        self.position + Vec2::from_angle(self.heading).rotate(self.print.centre_of_pressure())
    }

    /// Returns the load on each tile, in tile-index order; empty for a load in the air, off the floor or not finite.
    ///
    /// Tiles share a cell over a seam by area. A gap between plates belongs to the tile on its side. Cells beyond the
    /// floor's edge, and those over missing tiles, load no tile. If half of the load or more is over the floor, the cells on the floor carry the
    /// whole force (the rest overhangs). If less is over the floor, the force decreases to zero in proportion,
    /// because the foot then stands mainly beside the floor.
    #[must_use]
    pub fn on_tiles(&self, geometry: &Geometry) -> SmallVec<[TileLoad; 4]> {
        self.parts(geometry).into_iter().map(|part| part.load).collect()
    }

    /// Like [`Load::on_tiles`], with the twist of each tile.
    pub(super) fn parts(&self, geometry: &Geometry) -> SmallVec<[TilePart; 4]> {
        let finite = self.position.is_finite() && self.heading.is_finite() && self.force.is_finite();
        if !finite || self.force <= Newtons::ZERO {
            return SmallVec::new();
        }
        let turn = Vec2::from_angle(self.heading);
        let half = self.print.half_size();
        if !half.is_finite() {
            return SmallVec::new();
        }
        // Axis-aligned bounding box of the rotated print.
        let reach = Vec2::new(
            turn.x.abs() * half.x + turn.y.abs() * half.y,
            turn.y.abs() * half.x + turn.x.abs() * half.y,
        );
        let (low, high) = (self.position - reach, self.position + reach);
        if let (Some(tile), true) =
            (geometry.tile_under(low), geometry.tile_under(low) == geometry.tile_under(high))
        {
            let variance = self.print.variance();
            // Product of inertia in the floor's axes, from the variances along the print's axes.
            let lean = turn.x * turn.y * (variance.x - variance.y);
            return smallvec![self.part(geometry, tile, 1.0, self.centre_of_pressure(), lean)];
        }
        self.straddling(geometry, turn, low, high)
    }

    fn straddling(&self, geometry: &Geometry, turn: Vec2, low: Vec2, high: Vec2) -> SmallVec<[TilePart; 4]> {
        let Some(mut window) = Window::around(geometry, low, high) else { return SmallVec::new() };
        self.print
            .for_each_cell(|cell| window.add(self.position + turn.rotate(cell.at), cell.size, cell.share));
        window.clear_holes(geometry);
        let carried = window.total();
        let scale = 1.0 / carried.max(0.5);
        window
            .parts()
            .map(|(tile, share, at, lean)| self.part(geometry, tile, share * scale, at, lean))
            .collect()
    }

    fn part(&self, geometry: &Geometry, tile: TileId, share: f32, at: Vec2, lean: f32) -> TilePart {
        let index = geometry.index(tile).unwrap_or_default();
        TilePart { load: TileLoad { tile, index, force: self.force * share, centroid: at }, lean }
    }
}

/// The part of a load on one tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TilePart {
    pub(super) load: TileLoad,
    /// Mean product of the pressure's distances east and north of its centroid (m²): a foot along a tile's diagonal
    /// twists the tile even if its centroid is at the centre.
    pub(super) lean: f32,
}

/// Source of feet, moment by moment.
pub trait FootDriver: Send {
    /// Fills `feet` with the feet on the floor, or above it with zero force, at the moment `at`.
    ///
    /// Clears `feet` first. Call it with increasing times. Returns false, with `feet` empty, after the end of the
    /// performance.
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool;
}

/// The tiles that a print may touch, with the share of the load on each.
struct Window {
    first: TileId,
    /// South-west corner of the first tile.
    origin: Vec2,
    per_pitch: Vec2,
    columns: usize,
    rows: usize,
    /// For each tile: share of the load, share times position from `origin`, and share times x times y.
    sums: SmallVec<[(f32, Vec2, f32); 16]>,
}

impl Window {
    /// The tiles under an axis-aligned box with two given corners; `None` if none of them is on the floor.
    fn around(geometry: &Geometry, low: Vec2, high: Vec2) -> Option<Self> {
        let pitch_m = geometry.pitch_m();
        let TileId { column, row } = geometry.first();
        let corner = Vec2::new(f32::from(column), f32::from(row));
        let last = corner + Vec2::new(f32::from(geometry.columns() - 1), f32::from(geometry.rows() - 1));
        let first = (low / pitch_m).floor().max(corner);
        let end = (high / pitch_m).floor().min(last);
        (first.cmple(end).all()).then(|| {
            let size = (end - first).as_usizevec2() + 1;
            Self {
                first: TileId::new(first.x as u16, first.y as u16),
                origin: first * pitch_m,
                per_pitch: 1.0 / pitch_m,
                columns: size.x,
                rows: size.y,
                sums: smallvec![(0.0, Vec2::ZERO, 0.0); size.x * size.y],
            }
        })
    }

    /// Adds a cell to the tiles under it; treats the cell's edges as axis-aligned.
    #[inline(always)] // Runs for each cell of each foot, each millisecond; a call costs more than the work.
    fn add(&mut self, at: Vec2, size: Vec2, share: f32) {
        let at = at - self.origin;
        let (low, high) = (at - size * 0.5, at + size * 0.5);
        let (west, east) = (line(low.x, self.per_pitch.x), line(high.x, self.per_pitch.x));
        let (south, north) = (line(low.y, self.per_pitch.y), line(high.y, self.per_pitch.y));
        if west == east && south == north {
            self.add_to(west, south, share, at);
            return;
        }
        self.add_cut(low, high, share);
    }

    /// Adds a cell across a seam.
    #[inline(never)]
    fn add_cut(&mut self, low: Vec2, high: Vec2, share: f32) {
        for (column, part_x, x) in split(low.x, high.x, self.per_pitch.x) {
            for (row, part_y, y) in split(low.y, high.y, self.per_pitch.y) {
                self.add_to(column, row, share * part_x * part_y, Vec2::new(x, y));
            }
        }
    }

    /// Removes the loads over missing tiles.
    fn clear_holes(&mut self, geometry: &Geometry) {
        if geometry.missing().is_empty() {
            return;
        }
        for (index, sum) in self.sums.iter_mut().enumerate() {
            let (column, row) = ((index % self.columns) as u16, (index / self.columns) as u16);
            if geometry.is_missing(TileId::new(self.first.column + column, self.first.row + row)) {
                *sum = (0.0, Vec2::ZERO, 0.0);
            }
        }
    }

    #[inline]
    fn add_to(&mut self, column: i32, row: i32, share: f32, at: Vec2) {
        let (Ok(column), Ok(row)) = (usize::try_from(column), usize::try_from(row)) else { return };
        if column < self.columns && row < self.rows {
            let (total, moment, product) = &mut self.sums[row * self.columns + column];
            *total += share;
            *moment += at * share;
            *product += at.x * at.y * share;
        }
    }

    fn total(&self) -> f32 {
        self.sums.iter().map(|(share, ..)| share).sum()
    }

    /// Tile, share, centroid, and mean product of the distances from the centroid.
    fn parts(&self) -> impl Iterator<Item = (TileId, f32, Vec2, f32)> + '_ {
        let loaded = self.sums.iter().enumerate().filter(|(_, (share, ..))| *share > 0.0);
        loaded.map(|(index, (share, moment, product))| {
            let (column, row) = (index % self.columns, index / self.columns);
            let tile = TileId::new(self.first.column + column as u16, self.first.row + row as u16);
            let at = *moment / *share;
            (tile, *share, self.origin + at, *product / *share - at.x * at.y)
        })
    }
}

/// Column or row of a window at a distance from its origin; -1 for all positions before the origin.
#[inline]
fn line(distance: f32, per_pitch: f32) -> i32 {
    // A cast truncates towards zero, so this is a floor function, far cheaper on processors without an instruction for
    // it.
    ((distance * per_pitch).max(-0.5) + 1.0) as i32 - 1
}

/// Splits an interval at the seam that it crosses: column or row, share and midpoint of each piece.
///
/// Cells are smaller than tiles, so an interval crosses at most one seam.
fn split(low: f32, high: f32, per_pitch: f32) -> [(i32, f32, f32); 2] {
    let (first, last) = (line(low, per_pitch), line(high, per_pitch));
    if first == last {
        return [(first, 1.0, 0.5 * (low + high)), (first, 0.0, low)];
    }
    let seam = last as f32 / per_pitch;
    let before = ((seam - low) / (high - low)).clamp(0.0, 1.0);
    [(first, before, 0.5 * (low + seam)), (last, 1.0 - before, 0.5 * (seam + high))]
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use proptest::prelude::*;

    use super::*;

    fn foot(position: Vec2, heading: f32, roll: f32) -> Foot {
        Foot { position, heading, length_m: 0.27, force: Newtons(700.0), roll, left: false }
    }

    fn sum(loads: &[TileLoad]) -> (f32, Vec2) {
        let force: f32 = loads.iter().map(|load| load.force.0).sum();
        (force, loads.iter().map(|load| load.centroid * load.force.0).sum::<Vec2>() / force)
    }

    proptest! {
        #[test]
        fn tiles_carry_the_whole_foot_at_its_centre_of_pressure(
            x in 0.2f32..1.6, y in 0.2f32..1.6, heading in 0.0..TAU, roll in 0.0f32..=1.0,
        ) {
            // 20 cm from the floor's edge the 28 cm shoe is entirely on it.
            let foot = foot(Vec2::new(x, y), heading, roll);
            let loads = foot.on_tiles(&Geometry::default());
            let (force, at) = sum(&loads);
            prop_assert!(loads.len() <= 4, "a shoe is shorter than a tile");
            prop_assert!((force - 700.0).abs() < 0.1, "{force}");
            prop_assert!(at.distance(foot.centre_of_pressure()) < 1e-4, "{at}");
            for load in &loads {
                let cell = underfoot::floor::Rect::from_centre_size(
                    Geometry::default().centre(load.tile), Vec2::splat(0.304 + 1e-5));
                prop_assert!(cell.contains(load.centroid), "{load:?}");
            }
        }
    }

    #[test]
    fn a_foot_on_a_cross_of_seams_loads_four_tiles() {
        let cross = Vec2::splat(2.0 * 0.304);
        let loads = foot(cross, 0.3, 0.4).on_tiles(&Geometry::default());
        let tiles: Vec<_> = loads.iter().map(|load| (load.tile.column, load.tile.row)).collect();
        assert_eq!(tiles, [(1, 1), (2, 1), (1, 2), (2, 2)]);
    }

    #[test]
    fn load_passes_over_a_seam_without_steps() {
        // A foot parallel to the seam, moved sideways in steps of a tenth of a millimetre.
        let geometry = Geometry::default();
        let west = |step: usize| {
            let x = 0.55 + step as f32 * 1e-4;
            let loads = foot(Vec2::new(x, 0.456), 0.0, 0.4).on_tiles(&geometry);
            loads.iter().filter(|load| load.tile.column == 1).map(|load| load.force.0).sum::<f32>()
        };
        let shares: Vec<f32> = (0..1200).map(west).collect();
        assert_eq!(shares[0], 700.0);
        assert_eq!(shares[1199], 0.0);
        let steepest = shares.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
        // 700 N over 11 cm are a mean of 0.64 N per step, and a little more in the middle of the sole.
        assert!(steepest < 1.2, "{steepest}");
    }

    #[test]
    fn a_foot_hanging_over_the_edge_presses_with_all_its_force_until_it_stands_beside() {
        let geometry = Geometry::default();
        let force_at = |x: f32| sum(&foot(Vec2::new(x, 0.9), 0.0, 0.4).on_tiles(&geometry)).0;
        assert!((force_at(0.005) - 700.0).abs() < 0.1, "more than half of it is on the floor");
        assert!((50.0..650.0).contains(&force_at(-0.02)), "{}", force_at(-0.02));
        assert!(foot(Vec2::new(-0.2, 0.9), 0.0, 0.4).on_tiles(&geometry).is_empty());
        assert!(foot(Vec2::new(40.0, 0.9), 0.0, 0.4).on_tiles(&geometry).is_empty());
    }

    #[test]
    fn a_foot_across_the_diagonal_leans_the_same_whether_or_not_its_cells_are_counted() {
        // On one tile the value comes from the print's variance; just across a seam it comes from the cells.
        let geometry = Geometry::default();
        let load = |x: f32| Load {
            print: Print::Ellipse { half_m: Vec2::new(0.02, 0.1) },
            position: Vec2::new(x, 0.456),
            heading: 0.25 * std::f32::consts::PI,
            force: Newtons(700.0),
        };
        let one = load(0.456).parts(&geometry);
        let [whole] = one[..] else { panic!("on one tile: {one:?}") };
        let expected = -0.5 * (0.1f32 * 0.1 - 0.02 * 0.02) / 4.0;
        assert!((whole.lean / expected - 1.0).abs() < 0.01, "{} for {expected}", whole.lean);
        // The bounding box crosses the seam, but no cell does.
        let over = load(0.608 - 0.075).parts(&geometry);
        let [counted] = over[..] else { panic!("on one tile: {over:?}") };
        assert!((counted.lean / expected - 1.0).abs() < 0.05, "{} for {expected}", counted.lean);
    }

    #[test]
    fn heading_turns_the_toes_counter_clockwise_from_north() {
        let west = foot(Vec2::ONE, TAU / 4.0, 1.0);
        let toes = west.centre_of_pressure() - west.position;
        assert!(toes.x < -0.05 && toes.y.abs() < 1e-3, "{toes}");
    }

    #[test]
    fn nonsense_presses_on_nothing() {
        let geometry = Geometry::default();
        for broken in [
            foot(Vec2::NAN, 0.0, 0.4),
            foot(Vec2::ONE, f32::INFINITY, 0.4),
            Foot { force: Newtons(f32::NAN), ..foot(Vec2::ONE, 0.0, 0.4) },
            Foot { force: Newtons(-5.0), ..foot(Vec2::ONE, 0.0, 0.4) },
            Foot { length_m: f32::NAN, ..foot(Vec2::ONE, 0.0, 0.4) },
        ] {
            assert!(broken.on_tiles(&geometry).is_empty(), "{broken:?}");
        }
    }

    #[test]
    fn a_foot_beside_a_hole_hangs_over_it_as_over_the_floor_s_edge() {
        let hole = underfoot::floor::TileBlock { first: TileId::new(1, 1), columns: 1, rows: 1 };
        let ring = Geometry::of_paper_tiles(3, 3).unwrap().with_uneven(&[hole], &[]).unwrap();
        let seen = |x: f32| {
            let loads = foot(Vec2::new(x, 0.456), 0.0, 0.4).on_tiles(&ring);
            let tiles: Vec<_> = loads.iter().map(|load| (load.tile.column, load.tile.row)).collect();
            (sum(&loads).0, tiles)
        };
        let (force, tiles) = seen(0.304 - 0.005);
        assert!((force - 700.0).abs() < 0.1 && tiles == [(0, 1)], "{force} N on {tiles:?}");
        assert!(seen(0.456).1.is_empty(), "nobody stands on a hole");
    }

    #[test]
    fn rectangular_tiles_carry_the_whole_foot() {
        let size = Vec2::new(0.511, 0.316);
        let geometry = Geometry::of_plates(4, 6, size, size, 0.039).unwrap();
        let foot = foot(Vec2::new(1.05, 0.95), 0.7, 0.4);
        let loads = foot.on_tiles(&geometry);
        let (force, at) = sum(&loads);
        assert!((force - 700.0).abs() < 0.1 && at.distance(foot.centre_of_pressure()) < 1e-4, "{at}");
        assert!(loads.iter().all(|load| geometry.cell(load.tile).grown(1e-5).contains(load.centroid)));
    }

    #[test]
    fn small_tiles_share_a_foot_among_many() {
        let geometry = Geometry::new(20, 20, 0.05, 0.05, 0.005).unwrap();
        let foot = foot(Vec2::splat(0.5), 0.4, 0.4);
        let loads = foot.on_tiles(&geometry);
        assert!(loads.len() > 10, "{}", loads.len());
        let (force, at) = sum(&loads);
        assert!((force - 700.0).abs() < 0.1 && at.distance(foot.centre_of_pressure()) < 1e-4);
    }
}
