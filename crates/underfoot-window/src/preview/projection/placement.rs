//! The place of the floor on a projector's picture, as set by the user.

use glam::Vec2;

use super::homography::{Homography, is_convex};
use underfoot::floor::Rect;

/// The place of the floor on a projector's picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    /// The corners of the floor on the picture, as shares of its width and height from its upper left corner: first
    /// the upper left one of a picture that is neither turned nor mirrored, then clockwise. They may lie beyond the
    /// picture.
    pub(super) corners: [Vec2; 4],
    /// Whether the picture is projected from behind or over a mirror: east is left.
    pub(super) mirrored: bool,
    /// Number of quarter turns of the picture, clockwise, 0 to 3.
    pub(super) quarter_turns: u8,
}

/// Maximum distance of a corner beyond the picture, in picture sizes.
const BEYOND: f32 = 2.0;

impl Placement {
    /// The largest upright floor with the aspect ratio `floor` (width over height) on a picture with the aspect ratio
    /// `picture`, with a margin for the handles of the corners.
    pub(super) fn fit(floor: f32, picture: f32) -> Self {
        let share = 0.46 * Vec2::new((floor / picture).min(1.0), (picture / floor).min(1.0));
        let corners = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0), Vec2::ONE, Vec2::new(-1.0, 1.0)];
        let corners = corners.map(|corner| Vec2::splat(0.5) + corner * share);
        Self { corners, mirrored: false, quarter_turns: 0 }
    }

    /// The corners of `floor` in metres, in the order of [`Placement::corners`].
    pub(super) fn corners_of(&self, floor: Rect) -> [Vec2; 4] {
        let (min, max) = (floor.min, floor.max);
        // North-west, then clockwise, as the corners on the picture.
        let mut corners = [Vec2::new(min.x, max.y), max, Vec2::new(max.x, min.y), min];
        if self.mirrored {
            corners.swap(0, 1);
            corners.swap(2, 3);
        }
        corners.rotate_right(usize::from(self.quarter_turns % 4));
        corners
    }

    /// The map from floor metres to points of a picture of `size` points.
    ///
    /// `None` for corners that do not form a picture; [`Placement::moved`] prevents them.
    pub(super) fn floor_to_picture(&self, floor: Rect, size: Vec2) -> Option<Homography> {
        let from = self.corners_of(floor).map(|corner| corner.as_dvec2());
        Homography::between(from, self.corners.map(|corner| (corner * size).as_dvec2()))
    }

    /// The placement with the corner numbered `index` at `to`; unchanged if that would fold the picture.
    #[must_use]
    pub(super) fn moved(mut self, index: usize, to: Vec2) -> Self {
        let before = self;
        if let Some(corner) = self.corners.get_mut(index) {
            *corner = to.clamp(Vec2::splat(-BEYOND), Vec2::splat(1.0 + BEYOND));
        }
        if to.is_finite() && is_convex(self.corners.map(|corner| corner.as_dvec2())) { self } else { before }
    }

    /// This placement, if its corners form a picture and lie near it.
    ///
    /// # Errors
    /// Returns a sentence that describes the problem.
    pub(super) fn checked(self) -> Result<Self, String> {
        let within =
            |corner: &Vec2| (corner.min_element() >= -BEYOND) && (corner.max_element() <= 1.0 + BEYOND);
        if self.corners.iter().all(within) && is_convex(self.corners.map(|corner| corner.as_dvec2())) {
            Ok(self)
        } else {
            Err("its corners make no picture: they must be in order around, in shares of the picture".into())
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    fn floor() -> Rect {
        Rect::new(Vec2::ZERO, Vec2::new(1.824, 1.216))
    }

    #[test]
    fn mirrored_and_turned_floors_have_their_corners_where_they_belong() {
        let size = Vec2::new(1920.0, 1080.0);
        let upright = Placement::fit(1.5, 1920.0 / 1080.0);
        let at = |placement: Placement, x: f64, y: f64| {
            placement.floor_to_picture(floor(), size).unwrap().map(DVec2::new(x, y))
        };
        let corner = |index: usize| (upright.corners[index] * size).as_dvec2();
        let (north_west, south_west) = ((0.0, 1.216), (0.0, 0.0));
        let is = |one: DVec2, other: DVec2| assert!(one.distance(other) < 1e-3, "{one} {other}");
        is(at(upright, north_west.0, north_west.1), corner(0));
        is(at(upright, south_west.0, south_west.1), corner(3));
        let mirrored = Placement { mirrored: true, ..upright };
        is(at(mirrored, north_west.0, north_west.1), corner(1));
        for turns in 0..4 {
            let turned = Placement { quarter_turns: turns, ..upright };
            is(at(turned, north_west.0, north_west.1), corner(usize::from(turns)));
        }
    }

    #[test]
    fn a_corner_is_not_dragged_over_the_others() {
        let placement = Placement::fit(1.0, 1.6);
        let moved = placement.moved(0, Vec2::new(0.1, 0.2));
        assert_eq!(moved.corners[0], Vec2::new(0.1, 0.2));
        assert_eq!(moved.moved(0, Vec2::new(0.9, 0.9)), moved, "folded");
        assert_eq!(moved.moved(0, Vec2::NAN), moved);
        assert_eq!(moved.moved(7, Vec2::ZERO), moved);
    }
}
