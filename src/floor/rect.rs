//! An upright rectangle in floor metres.

use glam::Vec2;

/// An upright rectangle in floor metres.
///
/// It includes its west and south edges and excludes its east and north ones, so that no point belongs to two
/// neighbouring rectangles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rect {
    /// South-west corner.
    pub min: Vec2,
    /// North-east corner; a rectangle with `max` below `min` contains nothing.
    pub max: Vec2,
}

impl Rect {
    /// The rectangle between the south-west corner `min` and the north-east corner `max`.
    #[must_use]
    pub const fn new(min: Vec2, max: Vec2) -> Self {
        Self { min, max }
    }

    /// The rectangle with the south-west corner `min`, `size` metres wide and deep.
    #[must_use]
    pub fn from_min_size(min: Vec2, size: Vec2) -> Self {
        Self::new(min, min + size)
    }

    /// The rectangle of `size` around `centre`.
    #[must_use]
    pub fn from_centre_size(centre: Vec2, size: Vec2) -> Self {
        Self::from_min_size(centre - size * 0.5, size)
    }

    /// Returns width (east) and depth (north), in metres.
    #[must_use]
    pub fn size(self) -> Vec2 {
        self.max - self.min
    }

    /// Returns the centre.
    #[must_use]
    pub fn centre(self) -> Vec2 {
        (self.min + self.max) * 0.5
    }

    /// Whether `point` lies inside; false for NaN.
    #[must_use]
    pub fn contains(self, point: Vec2) -> bool {
        point.cmpge(self.min).all() && point.cmplt(self.max).all()
    }

    /// Whether the two share an area; touching edges do not count.
    #[must_use]
    pub fn overlaps(self, other: Self) -> bool {
        self.min.cmplt(other.max).all() && other.min.cmplt(self.max).all()
    }

    /// Returns the rectangle with every edge moved outwards by `by` metres (inwards if negative).
    #[must_use]
    pub fn grown(self, by: f32) -> Self {
        Self::new(self.min - Vec2::splat(by), self.max + Vec2::splat(by))
    }

    /// Returns the distance from `point` to the nearest point of the rectangle; zero inside.
    #[must_use]
    pub fn distance(self, point: Vec2) -> f32 {
        point.distance(point.clamp(self.min, self.max.max(self.min)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_never_both_claim_a_point() {
        let west = Rect::from_min_size(Vec2::ZERO, Vec2::ONE);
        let east = Rect::from_min_size(Vec2::X, Vec2::ONE);
        let seam = Vec2::new(1.0, 0.5);
        assert!(!west.contains(seam) && east.contains(seam));
        assert!(!west.overlaps(east));
        assert!(!west.contains(Vec2::NAN));
    }

    #[test]
    fn distance_is_zero_inside_and_grows_outside() {
        let rect = Rect::from_centre_size(Vec2::ZERO, Vec2::splat(2.0));
        assert_eq!(rect.distance(Vec2::new(0.5, -0.5)), 0.0);
        assert_eq!(rect.distance(Vec2::new(4.0, 5.0)), 5.0);
        assert!(rect.grown(1.0).contains(Vec2::splat(1.5)));
    }
}
