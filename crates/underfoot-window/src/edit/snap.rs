//! Snapping of places: to tiles, half tiles, multiples of five centimetres, and neighbours.

use glam::Vec2;

use underfoot::floor::{Geometry, Rect};

/// The finest grid, in metres: half of 10 cm, the recommended minimum width of a target.
pub const FINE_M: f32 = 0.05;

/// The origin of a guide line; among the lines within reach, the first variant wins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SnapReason {
    /// An edge of a neighbour.
    Edge,
    /// The middle of a neighbour.
    Centre,
    /// The seam between two tiles.
    Tile,
    /// The middle of a tile.
    HalfTile,
    /// A multiple of [`FINE_M`] from the floor's south-west corner.
    Fine,
}

/// A line to which an area snapped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapGuide {
    /// Whether it runs from south to north; otherwise from west to east.
    pub is_upright: bool,
    /// Its position, in metres from the west or south side of the floor.
    pub at_m: f32,
    /// Its origin.
    pub reason: SnapReason,
}

/// The edges of a rectangle that are dragged; all of them if it moves as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edges {
    /// The western one.
    pub west: bool,
    /// The eastern one.
    pub east: bool,
    /// The southern one.
    pub south: bool,
    /// The northern one.
    pub north: bool,
}

impl Edges {
    /// The whole rectangle.
    pub const ALL: Self = Self { west: true, east: true, south: true, north: true };

    /// `area` with these edges moved by `by`; an edge stops `least` before the opposite one.
    #[must_use]
    pub fn moved(self, area: Rect, by: Vec2, least: f32) -> Rect {
        if self == Self::ALL {
            return Rect::new(area.min + by, area.max + by);
        }
        let (mut min, mut max) = (area.min, area.max);
        if self.west {
            min.x = (min.x + by.x).min(max.x - least);
        }
        if self.east {
            max.x = (max.x + by.x).max(min.x + least);
        }
        if self.south {
            min.y = (min.y + by.y).min(max.y - least);
        }
        if self.north {
            max.y = (max.y + by.y).max(min.y + least);
        }
        Rect::new(min, max)
    }
}

/// The lines for snapping.
#[derive(Clone, Copy, Debug)]
pub struct SnapGrid<'a> {
    /// The floor.
    pub geometry: &'a Geometry,
    /// Neighbours, in floor metres.
    pub neighbours: &'a [Rect],
    /// Maximum distance of a line, in metres.
    pub reach_m: f32,
}

impl SnapGrid<'_> {
    /// `area` snapped to the best lines in reach, and those lines: at most one upright and one level line.
    #[must_use]
    pub fn snap(&self, area: Rect, edges: Edges) -> (Rect, Vec<SnapGuide>) {
        let x = self.along(0, area, edges.west, edges.east);
        let y = self.along(1, area, edges.south, edges.north);
        let by = |found: Option<(f32, SnapGuide)>| found.map_or(0.0, |(by, _)| by);
        // This cannot make the area too small: lines are nearer than any target is wide.
        let moved = edges.moved(area, Vec2::new(by(x), by(y)), 0.0);
        (moved, [x, y].into_iter().flatten().map(|(_, guide)| guide).collect())
    }

    /// The displacement along one axis, and its guide line.
    fn along(&self, axis: usize, area: Rect, low: bool, high: bool) -> Option<(f32, SnapGuide)> {
        let (min, max) = (area.min[axis], area.max[axis]);
        let mut own = Vec::with_capacity(3);
        own.extend(low.then_some((min, false)));
        own.extend(high.then_some((max, false)));
        own.extend((low && high).then_some((0.5 * (min + max), true)));
        let mut best: Option<(SnapReason, f32, f32)> = None;
        let mut offer = |reason: SnapReason, from: f32, to: f32| {
            let by = to - from;
            let is_better = |(other, far, _): (SnapReason, f32, f32)| {
                reason < other || (reason == other && by.abs() < far.abs() - 1e-6)
            };
            if by.abs() <= self.reach_m && best.is_none_or(is_better) {
                best = Some((reason, by, to));
            }
        };
        let pitch = self.geometry.pitch_m();
        for &(at, is_middle) in &own {
            for other in self.neighbours {
                let (low, high) = (other.min[axis], other.max[axis]);
                if is_middle {
                    offer(SnapReason::Centre, at, 0.5 * (low + high));
                } else {
                    offer(SnapReason::Edge, at, low);
                    offer(SnapReason::Edge, at, high);
                }
            }
            offer(SnapReason::Tile, at, (at / pitch).round() * pitch);
            offer(SnapReason::HalfTile, at, (at / pitch * 2.0).round() * 0.5 * pitch);
            if !is_middle {
                offer(SnapReason::Fine, at, (at / FINE_M).round() * FINE_M);
            }
        }
        best.map(|(reason, by, at_m)| (by, SnapGuide { is_upright: axis == 0, at_m, reason }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Vec2 = Vec2::new(0.18, 0.16);

    fn snap(at: Vec2, neighbours: &[Rect], reach_m: f32) -> (Vec2, Vec<SnapReason>) {
        let geometry = Geometry::default();
        let grid = SnapGrid { geometry: &geometry, neighbours, reach_m };
        let (area, guides) = grid.snap(Rect::from_min_size(at, SIZE), Edges::ALL);
        assert!((area.size() - SIZE).abs().max_element() < 1e-6, "what is moved keeps its size");
        (area.min, guides.into_iter().map(|guide| guide.reason).collect())
    }

    #[test]
    fn the_stronger_line_wins_over_the_nearer_one() {
        // 0.305 is 1 mm from the tile's edge and 5 mm from 0.30.
        let (at, reasons) = snap(Vec2::new(0.305, 0.402), &[], 0.01);
        assert!((at - Vec2::new(0.304, 0.4)).length() < 1e-6, "{at}");
        assert_eq!(reasons, [SnapReason::Tile, SnapReason::Fine]);
        let neighbour = Rect::from_min_size(Vec2::new(0.311, 0.9), SIZE);
        let (at, reasons) = snap(Vec2::new(0.305, 0.402), &[neighbour], 0.01);
        assert!((at.x - 0.311).abs() < 1e-6);
        assert_eq!(reasons[0], SnapReason::Edge);
    }

    #[test]
    fn middles_meet_middles_and_far_lines_do_nothing() {
        let wide = Rect::from_centre_size(Vec2::new(0.68, 1.3), Vec2::new(0.5, 0.16));
        let (at, reasons) = snap(Vec2::new(0.592, 0.42), &[wide], 0.004);
        assert!((at.x + 0.5 * SIZE.x - 0.68).abs() < 1e-6, "{at}");
        assert_eq!(reasons, [SnapReason::Centre]);
        assert_eq!(snap(Vec2::new(0.423, 0.433), &[], 0.001), (Vec2::new(0.423, 0.433), vec![]));
    }

    #[test]
    fn only_the_dragged_edge_moves() {
        let geometry = Geometry::default();
        let grid = SnapGrid { geometry: &geometry, neighbours: &[], reach_m: 0.01 };
        let east = Edges { east: true, west: false, south: false, north: false };
        let area = Rect::new(Vec2::new(0.31, 0.31), Vec2::new(0.603, 0.5));
        let (snapped, guides) = grid.snap(area, east);
        assert_eq!((snapped.min, guides.len()), (area.min, 1));
        assert!((snapped.max.x - 0.608).abs() < 1e-6);
        let folded = east.moved(area, Vec2::new(-9.0, 0.0), 0.05);
        assert!((folded.size().x - 0.05).abs() < 1e-6, "an edge does not pass the one opposite");
    }
}
