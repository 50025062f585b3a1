//! Wear of a ground, and its recovery.

use glam::{UVec2, Vec2};

use crate::floor::Rect;
use crate::units::Instant;

/// Wear of a sheet on an even grid of points, and its recovery: broken ice, packed snow.
///
/// Recovery is computed when a point is read, so that an unused ground costs nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Relief {
    area: Rect,
    columns: u32,
    rows: u32,
    points: Vec<Point>,
    recovery: Recovery,
}

/// The recovery of a worn sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Recovery {
    /// Time from fully worn to whole, in seconds; `None`: never.
    pub(super) seconds: Option<f32>,
    /// Whether recovery is fast at first, as ice grows (Stefan's law: thickness is proportional to the square root of
    /// time), or linear.
    pub(super) is_ice: bool,
}

/// One point: its remaining thickness (squared for ice, so that it grows linearly) at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Point {
    whole: f32,
    at: Instant,
}

/// Distance of the points, in metres, except on very large floors.
const GRID_M: f32 = 0.04;

/// Maximum number of points along one side.
const MOST: u32 = 257;

impl Relief {
    /// A whole sheet over `area`.
    pub(super) fn new(area: Rect, recovery: Recovery) -> Self {
        let count = |length: f32| ((length / GRID_M).ceil() as u32 + 1).clamp(2, MOST);
        let (columns, rows) = (count(area.size().x), count(area.size().y));
        let points = vec![Point { whole: 1.0, at: Instant::START }; (columns * rows) as usize];
        Self { area, columns, rows, points, recovery }
    }

    /// Its area.
    #[must_use]
    pub const fn area(&self) -> Rect {
        self.area
    }

    /// Number of points eastwards, and of points northwards; the outermost lie on the area's edges.
    #[must_use]
    pub const fn size(&self) -> (u32, u32) {
        (self.columns, self.rows)
    }

    /// Wear of the point in this column and row at `now`, 0 to 1; 0 beyond the grid.
    #[must_use]
    pub fn depth(&self, column: u32, row: u32, now: Instant) -> f32 {
        if column >= self.columns {
            return 0.0;
        }
        self.points
            .get((row * self.columns + column) as usize)
            .map_or(0.0, |point| 1.0 - self.whole(point, now))
    }

    /// Wear at the point of the grid nearest to `at`.
    #[must_use]
    pub fn depth_at(&self, at: Vec2, now: Instant) -> f32 {
        let grid = self.grid(at).round().max(Vec2::ZERO).as_uvec2();
        self.depth(grid.x.min(self.columns.saturating_sub(1)), grid.y.min(self.rows.saturating_sub(1)), now)
    }

    /// Wears the sheet at `at` by `amount`, a share of its whole thickness; the wear falls with the distance, to 1/e
    /// at `reach_m`.
    pub(super) fn wear(&mut self, at: Vec2, amount: f32, reach_m: f32, now: Instant) {
        let spacing = self.spacing();
        let reach = Vec2::splat(2.2 * reach_m) / spacing;
        let middle = self.grid(at);
        let last = UVec2::new(self.columns - 1, self.rows - 1);
        let low = (middle - reach).ceil().max(Vec2::ZERO).as_uvec2();
        let high = (middle + reach).floor().max(Vec2::ZERO).as_uvec2().min(last);
        let (recovery, columns) = (self.recovery, self.columns);
        for row in low.y..=high.y {
            for column in low.x..=high.x {
                let away = (UVec2::new(column, row).as_vec2() - middle) * spacing / reach_m;
                let share = amount * (-away.length_squared()).exp();
                if let Some(point) = self.points.get_mut((row * columns + column) as usize) {
                    let whole = (recovery.whole(point, now) - share).max(0.0);
                    *point = Point { whole: if recovery.is_ice { whole * whole } else { whole }, at: now };
                }
            }
        }
    }

    /// Copies `other` without new memory.
    pub(super) fn copy(&mut self, other: &Self) {
        (self.area, self.columns, self.rows) = (other.area, other.columns, other.rows);
        self.recovery = other.recovery;
        self.points.clone_from(&other.points);
    }

    fn whole(&self, point: &Point, now: Instant) -> f32 {
        self.recovery.whole(point, now)
    }

    fn spacing(&self) -> Vec2 {
        self.area.size() / Vec2::new((self.columns - 1) as f32, (self.rows - 1) as f32)
    }

    /// `at` in steps of the grid.
    fn grid(&self, at: Vec2) -> Vec2 {
        (at - self.area.min) / self.spacing()
    }
}

impl Recovery {
    fn whole(self, point: &Point, now: Instant) -> f32 {
        let grown = self.seconds.map_or(0.0, |seconds| now.since(point.at).as_secs_f32() / seconds.max(1e-3));
        let whole = (point.whole + grown).min(1.0);
        if self.is_ice { whole.sqrt() } else { whole }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(seconds: Option<f32>, is_ice: bool) -> Relief {
        Relief::new(Rect::new(Vec2::ZERO, Vec2::new(1.8, 0.9)), Recovery { seconds, is_ice })
    }

    #[test]
    fn wear_is_deepest_where_it_acts_and_ends_nearby() {
        let mut relief = sheet(None, true);
        let now = Instant::from_millis(10);
        let at = Vec2::new(0.6, 0.4);
        relief.wear(at, 0.5, 0.1, now);
        assert!((relief.depth_at(at, now) - 0.5).abs() < 0.05);
        assert!(relief.depth_at(at + Vec2::X * 0.1, now) < 0.25);
        assert_eq!(relief.depth_at(at + Vec2::X * 0.4, now), 0.0);
        for _ in 0..10 {
            relief.wear(at, 0.5, 0.1, now);
        }
        assert!(relief.depth_at(at, now) <= 1.0);
        // A place off the sheet or NaN wears no visible point, and does no harm.
        relief.wear(Vec2::new(-9.0, 99.0), 0.5, 0.1, now);
        relief.wear(Vec2::NAN, 0.5, 0.1, now);
    }

    #[test]
    fn ice_comes_back_fast_at_first_and_snow_evenly() {
        for (is_ice, quarter) in [(true, 0.5), (false, 0.75)] {
            let mut relief = sheet(Some(100.0), is_ice);
            let at = Vec2::new(0.6, 0.4);
            for _ in 0..20 {
                relief.wear(at, 1.0, 0.1, Instant::START);
            }
            assert!((relief.depth_at(at, Instant::from_millis(25_000)) - quarter).abs() < 0.02);
            assert_eq!(relief.depth_at(at, Instant::from_millis(100_000)), 0.0);
        }
    }
}
