//! Projective maps between quadrilaterals, as between a projector's picture and a flat floor.

use glam::{DMat3, DVec2, DVec3};

/// A projective map of the plane: straight lines stay straight, parallel lines may meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Homography(DMat3);

/// Minimum cross product of two neighbouring sides, as a share of the largest squared distance between two corners: a
/// flatter quadrilateral would be invisible.
const FLATTEST: f64 = 1e-4;

impl Homography {
    /// The map from each corner of `from` to the same corner of `to`, both in order around.
    ///
    /// `None` unless both are convex and finite, in either direction around: otherwise the picture would be folded.
    ///
    /// # Source
    /// P. Heckbert, *Fundamentals of Texture Mapping and Image Warping* (1989), section 2.2.3: square to quadrilateral.
    pub(super) fn between(from: [DVec2; 4], to: [DVec2; 4]) -> Option<Self> {
        let from = from_square(from)?;
        let to = from_square(to)?;
        Some(Self(to * from.inverse()))
    }

    /// The image of `point`.
    pub(super) fn map(&self, point: DVec2) -> DVec2 {
        let mapped = self.0 * DVec3::new(point.x, point.y, 1.0);
        mapped.truncate() / mapped.z
    }
}

/// The map from the unit square's corners (0, 0), (1, 0), (1, 1), (0, 1) to these.
fn from_square(corners: [DVec2; 4]) -> Option<DMat3> {
    if !is_convex(corners) {
        return None;
    }
    let [a, b, c, d] = corners;
    let (side, other) = (b - c, d - c);
    let rest = a - b + c - d;
    let area = side.perp_dot(other);
    let (g, h) = (rest.perp_dot(other) / area, side.perp_dot(rest) / area);
    let columns = [b - a + b * g, d - a + d * h, a];
    Some(DMat3::from_cols(
        DVec3::new(columns[0].x, columns[0].y, g),
        DVec3::new(columns[1].x, columns[1].y, h),
        DVec3::new(columns[2].x, columns[2].y, 1.0),
    ))
}

/// Whether all corners are finite and bend the same way, none of them nearly straight.
pub(super) fn is_convex(corners: [DVec2; 4]) -> bool {
    let size = (0..4).flat_map(|one| (0..one).map(move |other| (one, other)));
    let size = size.map(|(one, other)| corners[one].distance_squared(corners[other])).fold(0.0, f64::max);
    let bends = [0, 1, 2, 3].map(|at| {
        let (before, here, after) = (corners[at], corners[(at + 1) % 4], corners[(at + 2) % 4]);
        (here - before).perp_dot(after - here)
    });
    let least = FLATTEST * size;
    corners.iter().all(|corner| corner.is_finite())
        && (bends.iter().all(|bend| *bend > least) || bends.iter().all(|bend| *bend < -least))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SQUARE: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];

    #[test]
    fn corners_go_to_corners_and_the_crossing_of_the_diagonals_to_theirs() {
        let to = [
            DVec2::new(100.0, 80.0),
            DVec2::new(900.0, 40.0),
            DVec2::new(1000.0, 700.0),
            DVec2::new(60.0, 600.0),
        ];
        let map = Homography::between(SQUARE, to).unwrap();
        for (from, to) in SQUARE.into_iter().zip(to) {
            assert!(map.map(from).distance(to) < 1e-9);
        }
        // The intersection of the lines a-c and b-d, by hand: a + s (c - a) with s from the cross products.
        let (ac, bd) = (to[2] - to[0], to[3] - to[1]);
        let s = (to[1] - to[0]).perp_dot(bd) / ac.perp_dot(bd);
        assert!(map.map(DVec2::splat(0.5)).distance(to[0] + ac * s) < 1e-9);
    }

    #[test]
    fn folded_flat_and_endless_corners_are_refused() {
        let [a, b, c, d] = SQUARE;
        for bad in
            [[a, c, b, d], [a, b, c, DVec2::new(0.9, 0.5)], [a, b, b, d], [a, b, DVec2::splat(f64::NAN), d]]
        {
            assert_eq!(Homography::between(SQUARE, bad), None, "{bad:?}");
        }
        assert!(Homography::between(SQUARE, [b, a, d, c]).is_some(), "mirrored");
    }

    proptest! {
        #[test]
        fn there_and_back_is_where_one_was(
            moved in prop::array::uniform8(-0.2..0.2), x in 0.0..1.0, y in 0.0..1.0,
        ) {
            let to: Vec<DVec2> = (0..4).map(|at| SQUARE[at] + DVec2::new(moved[2 * at], moved[2 * at + 1])).collect();
            let to = [to[0], to[1], to[2], to[3]].map(|corner| corner * 1000.0);
            let there = Homography::between(SQUARE, to).unwrap();
            let back = Homography::between(to, SQUARE).unwrap();
            prop_assert!(back.map(there.map(DVec2::new(x, y))).distance(DVec2::new(x, y)) < 1e-9);
        }
    }
}
