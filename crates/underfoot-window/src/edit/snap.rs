//! Snapping of places: to neighbours, equal gaps, tiles, half tiles and round numbers; and the edge of the floor.

use glam::{DVec2, Vec2};

use super::spacing::equal_places;
use underfoot::floor::{Geometry, Rect};

/// The steps of round numbers, in metres east and north, for a layout in units of `unit_m` metres on a floor with this
/// `geometry`: 0.05 tiles, or 1 cm.
#[must_use]
pub fn round_step_m(unit_m: DVec2, geometry: &Geometry) -> Vec2 {
    if unit_m == DVec2::ONE { Vec2::splat(0.01) } else { 0.05 * geometry.pitch_m() }
}

/// The origin of a guide line; among the lines within reach, the first variant wins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SnapReason {
    /// An edge of a neighbour.
    Edge,
    /// The middle of a neighbour.
    Centre,
    /// The same gap to a neighbour as another one.
    Spacing,
    /// The seam between two tiles.
    Tile,
    /// The middle of a tile.
    HalfTile,
    /// A round number: a multiple of [`SnapGrid::step_m`]. It attracts from any distance.
    Round,
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

/// Overhang that rounding errors explain, in metres.
const STOP_M: f32 = 1e-4;

/// Edges of a rectangle: those that are dragged, all of them if it moves as a whole; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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

    /// Whether any of them is dragged.
    #[must_use]
    pub fn is_any(self) -> bool {
        self.west || self.east || self.south || self.north
    }

    /// `area` stopped at the edges of `bounds`, and the edges that stopped there. A whole rectangle keeps its size
    /// and moves back; one that is larger than `bounds` starts at their south-west corner.
    #[must_use]
    pub fn stopped(self, area: Rect, bounds: Rect) -> (Rect, Self) {
        let low = (bounds.min - area.min).max(Vec2::ZERO);
        let high = (area.max - bounds.max).max(Vec2::ZERO);
        let stopped = Self {
            west: self.west && low.x > STOP_M,
            east: self.east && high.x > STOP_M,
            south: self.south && low.y > STOP_M,
            north: self.north && high.y > STOP_M,
        };
        let area = if self == Self::ALL {
            let back = area.min - high;
            let min = back.max(bounds.min);
            Rect::new(min, min + area.size())
        } else {
            let own = |is_own: bool, to: f32, at: f32| if is_own { to } else { at };
            let min = Vec2::new(
                own(stopped.west, bounds.min.x, area.min.x),
                own(stopped.south, bounds.min.y, area.min.y),
            );
            let max = Vec2::new(
                own(stopped.east, bounds.max.x, area.max.x),
                own(stopped.north, bounds.max.y, area.max.y),
            );
            Rect::new(min, max)
        };
        (area, stopped)
    }

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
    /// Neighbours with whose edges and middles the area comes in line, in floor metres.
    pub neighbours: &'a [Rect],
    /// Neighbours to which gaps become equal, in floor metres.
    pub row: &'a [Rect],
    /// Maximum distance of a line, in metres.
    pub reach_m: f32,
    /// The steps of round numbers, in metres east and north, as [`round_step_m`].
    pub step_m: Vec2,
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
        let (pitch, step_m) = (self.geometry.pitch_m()[axis], self.step_m[axis]);
        let round = |length: f32| (length / step_m).round() * step_m;
        let is_round = |length: f32| (length - round(length)).abs() < 1e-4;
        // Where tiles are the unit, their lines must leave the number in the file round.
        let keeps_round = |at: f32, to: f32| !(is_round(pitch) && low && high) || is_round(min + to - at);
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
            let half = 0.5 * pitch;
            let lines = [(SnapReason::Tile, pitch), (SnapReason::HalfTile, half)];
            for (reason, step) in lines {
                let to = (at / step).round() * step;
                if keeps_round(at, to) {
                    offer(reason, at, to);
                }
            }
        }
        if low && high {
            for place in equal_places(axis, area, self.row) {
                offer(SnapReason::Spacing, min, place);
            }
        }
        let best = best.or_else(|| match (low, high) {
            (true, _) => Some((SnapReason::Round, round(min) - min, round(min))),
            // The size becomes round, also behind an edge that is not.
            (false, true) => {
                let to = min + round(max - min).max(step_m);
                Some((SnapReason::Round, to - max, to))
            }
            (false, false) => None,
        });
        best.map(|(reason, by, at_m)| (by, SnapGuide { is_upright: axis == 0, at_m, reason }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Vec2 = Vec2::new(0.18, 0.16);

    fn snap(at: Vec2, neighbours: &[Rect], reach_m: f32) -> (Vec2, Vec<SnapReason>) {
        let geometry = Geometry::default();
        let step_m = round_step_m(geometry.pitch_m().as_dvec2(), &geometry);
        let grid = SnapGrid { geometry: &geometry, neighbours, row: &[], reach_m, step_m };
        let (area, guides) = grid.snap(Rect::from_min_size(at, SIZE), Edges::ALL);
        assert!((area.size() - SIZE).abs().max_element() < 1e-6, "what is moved keeps its size");
        (area.min, guides.into_iter().map(|guide| guide.reason).collect())
    }

    #[test]
    fn the_stronger_line_wins_over_the_nearer_one() {
        // 0.305 is 1 mm from the tile's edge; 0.402 is 1.32 tiles and in reach of none.
        let (at, reasons) = snap(Vec2::new(0.305, 0.402), &[], 0.005);
        assert!((at - Vec2::new(0.304, 1.3 * 0.304)).length() < 1e-6, "{at}");
        assert_eq!(reasons, [SnapReason::Tile, SnapReason::Round]);
        let neighbour = Rect::from_min_size(Vec2::new(0.311, 0.9), SIZE);
        let (at, reasons) = snap(Vec2::new(0.305, 0.402), &[neighbour], 0.01);
        assert!((at.x - 0.311).abs() < 1e-6);
        assert_eq!(reasons[0], SnapReason::Edge);
    }

    #[test]
    fn middles_meet_middles_and_far_from_all_lines_numbers_are_round() {
        let wide = Rect::from_centre_size(Vec2::new(0.68, 1.3), Vec2::new(0.5, 0.16));
        let (at, reasons) = snap(Vec2::new(0.592, 0.42), &[wide], 0.004);
        assert!((at.x + 0.5 * SIZE.x - 0.68).abs() < 1e-6, "{at}");
        assert_eq!(reasons, [SnapReason::Centre, SnapReason::Round]);
        let (at, reasons) = snap(Vec2::new(0.423, 0.433), &[], 0.001);
        assert!((at - Vec2::new(1.4, 1.4) * 0.304).length() < 1e-6, "{at}");
        assert_eq!(reasons, [SnapReason::Round; 2]);
    }

    #[test]
    fn only_the_dragged_edge_moves() {
        let geometry = Geometry::default();
        let grid = SnapGrid {
            geometry: &geometry,
            neighbours: &[],
            row: &[],
            reach_m: 0.01,
            step_m: Vec2::splat(0.01),
        };
        let east = Edges { east: true, west: false, south: false, north: false };
        let area = Rect::new(Vec2::new(0.31, 0.31), Vec2::new(0.603, 0.5));
        let (snapped, guides) = grid.snap(area, east);
        assert_eq!((snapped.min, guides.len()), (area.min, 1));
        assert!((snapped.max.x - 0.608).abs() < 1e-6);
        let folded = east.moved(area, Vec2::new(-9.0, 0.0), 0.05);
        assert!((folded.size().x - 0.05).abs() < 1e-6, "an edge does not pass the one opposite");
    }

    #[test]
    fn a_dragged_edge_gives_a_round_size() {
        let geometry = Geometry::default();
        let grid = SnapGrid {
            geometry: &geometry,
            neighbours: &[],
            row: &[],
            reach_m: 0.001,
            step_m: Vec2::splat(0.01),
        };
        let east = Edges { east: true, west: false, south: false, north: false };
        let area = Rect::new(Vec2::new(0.313, 0.31), Vec2::new(0.5571, 0.5));
        let (snapped, _) = grid.snap(area, east);
        assert!((snapped.size().x - 0.24).abs() < 1e-6, "{snapped:?}");
    }

    #[test]
    fn the_floor_stops_an_area_and_names_the_edge() {
        let bounds = Rect::new(Vec2::ZERO, Vec2::splat(2.0));
        let over = Rect::from_min_size(Vec2::new(1.9, -0.3), Vec2::splat(0.4));
        let (moved, edges) = Edges::ALL.stopped(over, bounds);
        assert!((moved.min - Vec2::new(1.6, 0.0)).length() < 1e-6 && moved.size() == over.size());
        assert_eq!((edges.east, edges.south, edges.west, edges.north), (true, true, false, false));
        let corner = Edges { east: true, north: true, west: false, south: false };
        let drawn = Rect::new(Vec2::splat(1.5), Vec2::new(2.5, 1.8));
        let (cut, edges) = corner.stopped(drawn, bounds);
        assert_eq!(cut, Rect::new(Vec2::splat(1.5), Vec2::new(2.0, 1.8)));
        assert!(edges.east && !edges.north);
        let (same, none) = Edges::ALL.stopped(cut, bounds);
        assert!(same == cut && !none.is_any());
    }
}
