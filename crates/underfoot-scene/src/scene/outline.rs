//! Outlines as points: of controls, of shoes, of arrows.

use std::f32::consts::{PI, TAU};

use glam::Vec2;

use super::{Mark, Scene};
use underfoot::floor::Rect;

/// Calls `visit` with points around a mark, and with the first one again at the end of a closed outline; not for
/// text.
///
/// For painters that divide outlines into dashes themselves.
pub fn outline_of(scene: &Scene, mark: &Mark, visit: impl FnMut(Vec2)) {
    match *mark {
        Mark::Box { area, radius_m, .. } | Mark::Halo { area, radius_m, .. } => {
            box_arc(area, radius_m, 1.0).for_each(visit);
        }
        Mark::Ellipse { centre, radii, .. } => {
            ellipse_arc(Rect::from_centre_size(centre, 2.0 * radii), 1.0).for_each(visit);
        }
        Mark::Field { area, .. } => box_arc(area, 0.0, 1.0).for_each(visit),
        Mark::Band { points, reach, .. } => {
            let points = scene.points(points);
            let far = points.iter().rev().map(|point| *point + reach);
            points.iter().copied().chain(far).chain(points.first().copied()).for_each(visit);
        }
        Mark::Path { points, closed, .. } => {
            let points = scene.points(points);
            let back = points.first().filter(|_| closed);
            points.iter().chain(back).copied().for_each(visit);
        }
        Mark::Text { .. } => {}
    }
}

/// Number of steps along a quarter of a circle.
const QUARTER_STEPS: usize = 8;

/// The first `share` (0 to 1) of the outline of a rounded rectangle, clockwise from the middle of its north side.
///
/// With a radius of half of a square's side this is a circle.
pub(super) fn box_arc(area: Rect, radius_m: f32, share: f32) -> impl Iterator<Item = Vec2> {
    let half = (area.size() * 0.5).max(Vec2::ZERO);
    let radius = radius_m.clamp(0.0, half.min_element());
    let centre = area.centre();
    let core = half - radius;
    // Corners clockwise from the north-east, each with the start angle of its arc.
    let corners = [(1.0, 1.0, 0.5 * PI), (1.0, -1.0, 0.0), (-1.0, -1.0, -0.5 * PI), (-1.0, 1.0, PI)];
    let arcs = corners.into_iter().flat_map(move |(east, north, begin)| {
        let corner = centre + core * Vec2::new(east, north);
        (0..=QUARTER_STEPS).map(move |step| {
            let angle = begin - 0.5 * PI * step as f32 / QUARTER_STEPS as f32;
            corner + radius * Vec2::from_angle(angle)
        })
    });
    let start = centre + Vec2::new(0.0, half.y);
    let length = 4.0 * (core.x + core.y) + TAU * radius;
    cut(std::iter::once(start).chain(arcs).chain(std::iter::once(start)), share * length)
}

/// The first `share` (0 to 1) of the outline of an ellipse, clockwise from its north.
pub(super) fn ellipse_arc(area: Rect, share: f32) -> impl Iterator<Item = Vec2> {
    const STEPS: usize = 48;
    let (centre, radii) = (area.centre(), area.size() * 0.5);
    let steps = ((share.clamp(0.0, 1.0) * STEPS as f32).ceil() as usize).max(1);
    (0..=steps).map(move |step| {
        let angle = 0.5 * PI - TAU * share.clamp(0.0, 1.0) * step as f32 / steps as f32;
        centre + radii * Vec2::from_angle(angle)
    })
}

/// The first part of a path, up to `length` along it.
fn cut(points: impl Iterator<Item = Vec2>, length: f32) -> impl Iterator<Item = Vec2> {
    let mut left = length;
    let mut last = None;
    points.map_while(move |point| {
        if left < 0.0 {
            return None;
        }
        let from = last.unwrap_or(point);
        let step = from.distance(point);
        let reached = if step > left { from.lerp(point, left / step) } else { point };
        // Returns one more point at the end of the length, then none.
        left = if step > left { -1.0 } else { left - step };
        last = Some(point);
        Some(reached)
    })
}

/// A right shoe's sole, clockwise from the heel: across (outwards positive) and along, in shoe lengths.
const SOLE: [(f32, f32); 18] = [
    (0.00, -0.50),
    (-0.095, -0.47),
    (-0.128, -0.38),
    (-0.108, -0.25),
    (-0.104, -0.10),
    (-0.135, 0.05),
    (-0.170, 0.21),
    (-0.160, 0.35),
    (-0.105, 0.46),
    (-0.025, 0.50),
    (0.065, 0.472),
    (0.140, 0.38),
    (0.180, 0.25),
    (0.177, 0.12),
    (0.145, -0.05),
    (0.130, -0.22),
    (0.134, -0.38),
    (0.098, -0.47),
];

/// Number of steps between two points of [`SOLE`].
const SOLE_STEPS: usize = 4;

/// The sole of a right shoe (mirrored for a left one) around `middle`; `heading_rad` is the direction of the toes,
/// counter-clockwise from north.
pub fn sole(middle: Vec2, heading_rad: f32, length_m: f32, left: bool) -> impl Iterator<Item = Vec2> {
    let turn = Vec2::from_angle(heading_rad);
    let side = if left { -1.0 } else { 1.0 };
    (0..SOLE.len() * SOLE_STEPS).map(move |step| {
        let at = |offset: usize| {
            let (across, along) = SOLE[(step / SOLE_STEPS + SOLE.len() + offset - 1) % SOLE.len()];
            Vec2::new(across, along)
        };
        let share = (step % SOLE_STEPS) as f32 / SOLE_STEPS as f32;
        let point = catmull_rom([at(0), at(1), at(2), at(3)], share) * Vec2::new(side, 1.0);
        middle + turn.rotate(point * length_m)
    })
}

/// The Catmull-Rom curve from the second to the third of four points, at `share`.
fn catmull_rom([before, from, to, after]: [Vec2; 4], share: f32) -> Vec2 {
    let (one, two, three) = (share, share * share, share * share * share);
    0.5 * (2.0 * from
        + (to - before) * one
        + (2.0 * before - 5.0 * from + 4.0 * to - after) * two
        + (3.0 * from - before - 3.0 * to + after) * three)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(points: &[Vec2]) -> f32 {
        points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    #[test]
    fn a_share_of_the_way_round_is_that_share_of_its_length() {
        let area = Rect::from_min_size(Vec2::ZERO, Vec2::new(0.4, 0.2));
        let whole = length(&box_arc(area, 0.03, 1.0).collect::<Vec<_>>());
        assert!((whole - (2.0 * (0.34 + 0.14) + TAU * 0.03)).abs() < 1e-3, "{whole}");
        for share in [0.1, 0.25, 0.5, 0.9] {
            let part = length(&box_arc(area, 0.03, share).collect::<Vec<_>>());
            assert!((part - share * whole).abs() < 2e-3, "{share}: {part} of {whole}");
        }
        let quarter: Vec<_> = ellipse_arc(area, 0.25).collect();
        assert!(quarter.last().unwrap().distance(Vec2::new(0.4, 0.1)) < 1e-6);
    }

    #[test]
    fn a_sole_is_as_long_as_its_shoe_and_points_where_it_heads() {
        let north: Vec<_> = sole(Vec2::ZERO, 0.0, 0.28, false).collect();
        let (low, high) =
            north.iter().fold((0.0_f32, 0.0_f32), |(low, high), p| (low.min(p.y), high.max(p.y)));
        assert!((high - low - 0.28).abs() < 0.003, "{}", high - low);
        // After a quarter turn to the left, the toes are in the west.
        let west: Vec<_> = sole(Vec2::ZERO, 0.5 * PI, 0.28, false).collect();
        let toe = north.iter().position(|p| p.y == high).unwrap();
        assert!((west[toe].x + high).abs() < 1e-6);
    }

    #[test]
    fn all_of_a_sole_is_seen_from_its_mean_point() {
        for left in [false, true] {
            let points: Vec<_> = sole(Vec2::ZERO, 0.3, 0.28, left).collect();
            let mean = points.iter().copied().sum::<Vec2>() / points.len() as f32;
            let turns: Vec<bool> = (0..points.len())
                .map(|at| (points[at] - mean).perp_dot(points[(at + 1) % points.len()] - mean) > 0.0)
                .collect();
            assert!(turns.iter().all(|turn| *turn == turns[0]), "the fan folds over itself");
        }
    }
}
