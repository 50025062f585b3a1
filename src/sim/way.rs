//! Ways over the floor along straight lines.

use glam::Vec2;

use super::track::turn_between;

/// A way along straight lines.
pub(super) struct Way<'a> {
    points: &'a [Vec2],
    pub(super) length: f32,
}

impl<'a> Way<'a> {
    pub(super) fn new(points: &'a [Vec2]) -> Self {
        Self { points, length: points.windows(2).map(|pair| pair[0].distance(pair[1])).sum() }
    }

    /// The place after `distance` metres, and the heading of the way there; the last place after its end.
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

/// The heading of somebody who moves along `direction`.
fn heading_of(direction: Vec2) -> f32 {
    (-direction.x).atan2(direction.y)
}

/// How sharply the way turns at `at`, in radians.
pub(super) fn bend(from: Vec2, at: Vec2, to: Vec2) -> f32 {
    turn_between(heading_of(at - from), heading_of(to - at)).abs()
}

#[cfg(test)]
mod tests {
    use std::f32::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn a_way_is_followed_round_its_bends() {
        let points = [Vec2::ZERO, Vec2::X, Vec2::X, Vec2::ONE];
        let way = Way::new(&points);
        assert_eq!(way.length, 2.0);
        assert_eq!(way.at(0.25), (Vec2::new(0.25, 0.0), -FRAC_PI_2));
        assert_eq!(way.at(1.5), (Vec2::new(1.0, 0.5), 0.0));
        assert_eq!(way.at(99.0).0, Vec2::ONE);
        assert_eq!(Way::new(&[]).at(1.0).0, Vec2::ZERO);
        assert!((bend(points[0], points[1], points[3]) - FRAC_PI_2).abs() < 1e-6);
    }
}
