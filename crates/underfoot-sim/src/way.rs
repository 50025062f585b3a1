//! Polylines over the floor.

use glam::Vec2;

use super::track::turn_between;

/// A polyline.
pub(super) struct Polyline<'a> {
    points: &'a [Vec2],
    pub(super) length: f32,
}

impl<'a> Polyline<'a> {
    pub(super) fn new(points: &'a [Vec2]) -> Self {
        Self { points, length: points.windows(2).map(|pair| pair[0].distance(pair[1])).sum() }
    }

    /// Returns the point after `distance` metres and the heading there; the last point beyond the end.
    pub(super) fn at(&self, distance: f32) -> (Vec2, f32) {
        let mut left = distance;
        let mut last = (self.points.first().copied().unwrap_or_default(), 0.0);
        for pair in self.points.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let stretch = from.distance(to);
            if stretch > 0.0 {
                let heading = heading_of(to - from);
                if left < stretch {
                    return (from.lerp(to, left / stretch), heading);
                }
                last = (to, heading);
                left -= stretch;
            }
        }
        last
    }
}

/// Heading of a person who moves along `direction`.
fn heading_of(direction: Vec2) -> f32 {
    (-direction.x).atan2(direction.y)
}

/// Angle of the bend at `at`, in radians.
pub(super) fn bend(from: Vec2, at: Vec2, to: Vec2) -> f32 {
    turn_between(heading_of(at - from), heading_of(to - at)).abs()
}

/// Simplifies a polyline: keeps so many points that no other is farther than `off_m` from the lines between them.
///
/// # Source
/// Ramer 1972, Douglas and Peucker 1973: keeps the point of each stretch that is farthest from the straight line, and
/// continues on both sides of it.
pub(super) fn simplified(points: &[Vec2], off_m: f32) -> Vec<Vec2> {
    let Some(end) = points.len().checked_sub(1) else { return Vec::new() };
    let mut kept = vec![false; points.len()];
    // Iterative instead of recursive, because a line may be long.
    let mut stretches = vec![(0, end)];
    while let Some((first, last)) = stretches.pop() {
        (kept[first], kept[last]) = (true, true);
        let off = |index: usize| distance_from(points[index], points[first], points[last]);
        let farthest = (first + 1..last).max_by(|one, other| off(*one).total_cmp(&off(*other)));
        if let Some(index) = farthest.filter(|index| off(*index) > off_m) {
            stretches.extend([(first, index), (index, last)]);
        }
    }
    points.iter().zip(kept).filter(|(_, is_kept)| *is_kept).map(|(point, _)| *point).collect()
}

/// Distance of `point` from the line segment between two others.
fn distance_from(point: Vec2, from: Vec2, to: Vec2) -> f32 {
    let (along, beside) = (to - from, point - from);
    let share = (beside.dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
    beside.distance(along * share)
}

/// Removes the points nearer than `apart_m` to the previously kept one, then replaces the last kept point with the
/// end of the line.
pub(super) fn spaced(points: &[Vec2], apart_m: f32) -> Vec<Vec2> {
    let mut kept: Vec<Vec2> = Vec::new();
    for point in points {
        if kept.last().is_none_or(|last| last.distance(*point) >= apart_m) {
            kept.push(*point);
        }
    }
    if let (Some(end), Some(last)) = (points.last(), kept.last_mut()) {
        *last = *end;
    }
    kept
}

#[cfg(test)]
mod tests {
    use std::f32::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn a_way_is_followed_round_its_bends() {
        let points = [Vec2::ZERO, Vec2::X, Vec2::X, Vec2::ONE];
        let way = Polyline::new(&points);
        assert_eq!(way.length, 2.0);
        assert_eq!(way.at(0.25), (Vec2::new(0.25, 0.0), -FRAC_PI_2));
        assert_eq!(way.at(1.5), (Vec2::new(1.0, 0.5), 0.0));
        assert_eq!(way.at(99.0).0, Vec2::ONE);
        assert_eq!(Polyline::new(&[]).at(1.0).0, Vec2::ZERO);
        assert!((bend(points[0], points[1], points[3]) - FRAC_PI_2).abs() < 1e-6);
    }

    #[test]
    fn only_the_points_that_a_shape_needs_are_kept() {
        let corner = [Vec2::ZERO, Vec2::new(0.5, 0.01), Vec2::X, Vec2::new(1.0, 0.4), Vec2::ONE];
        assert_eq!(simplified(&corner, 0.05), [Vec2::ZERO, Vec2::X, Vec2::ONE]);
        assert_eq!(simplified(&corner, 0.005).len(), 4);
        assert_eq!(simplified(&[Vec2::X], 0.05), [Vec2::X]);
        assert!(simplified(&[], 0.05).is_empty());
        // A zigzag keeps every point, even with thousands of them.
        let zigzag: Vec<Vec2> = (0..5000).map(|k| Vec2::new(k as f32, (k % 2) as f32)).collect();
        assert_eq!(simplified(&zigzag, 0.05).len(), 5000);
    }

    #[test]
    fn points_that_are_near_the_one_before_count_as_one_and_the_end_stays() {
        let points = [0.0, 0.1, 0.5, 0.6, 0.7].map(|x| Vec2::X * x);
        assert_eq!(spaced(&points, 0.25), [Vec2::ZERO, Vec2::X * 0.7]);
        assert_eq!(spaced(&points[..2], 0.25), [Vec2::X * 0.1]);
        assert!(spaced(&[], 0.25).is_empty());
    }
}
