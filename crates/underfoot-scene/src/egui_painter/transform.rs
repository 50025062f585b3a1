//! The transform from floor metres to screen points and back.

use egui::{Pos2, Rect, pos2, vec2};
use glam::Vec2;

use underfoot::floor;

/// The transform from floor metres to screen points and back: north is up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenFromFloor {
    /// The floor's south-west corner on the screen.
    origin: Pos2,
    /// Points per metre.
    scale: f32,
}

impl ScreenFromFloor {
    /// The largest upright view of `bounds` in the middle of `screen`.
    #[must_use]
    pub fn fit(bounds: floor::Rect, screen: Rect) -> Self {
        let size = bounds.size().max(Vec2::splat(1e-3));
        // A minimal window must not reduce the scale to zero.
        let scale = (screen.width() / size.x).min(screen.height() / size.y).max(1.0);
        let middle = bounds.centre();
        let origin = screen.center() - vec2(middle.x * scale, -middle.y * scale);
        Self { origin, scale }
    }

    /// Points per metre.
    #[must_use]
    pub fn scale(self) -> f32 {
        self.scale
    }

    /// Converts a position from floor metres to points.
    #[must_use]
    pub fn point(self, floor: Vec2) -> Pos2 {
        pos2(self.origin.x + floor.x * self.scale, self.origin.y - floor.y * self.scale)
    }

    /// Converts an area from floor metres to points.
    #[must_use]
    pub fn rect(self, floor: floor::Rect) -> Rect {
        Rect::from_two_pos(self.point(floor.min), self.point(floor.max))
    }

    /// Converts a position from points to floor metres.
    #[must_use]
    pub fn floor(self, screen: Pos2) -> Vec2 {
        Vec2::new(screen.x - self.origin.x, self.origin.y - screen.y) / self.scale
    }

    /// Converts a displacement from points to floor metres.
    #[must_use]
    pub fn floor_vector(self, screen: egui::Vec2) -> Vec2 {
        Vec2::new(screen.x, -screen.y) / self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_floor_fits_keeps_its_shape_and_maps_back() {
        let bounds = floor::Rect::new(Vec2::new(-0.1, -0.2), Vec2::new(1.9, 1.8));
        let screen = Rect::from_min_size(pos2(100.0, 50.0), vec2(800.0, 600.0));
        let map = ScreenFromFloor::fit(bounds, screen);
        assert_eq!(map.scale(), 300.0);
        let shown = map.rect(bounds);
        assert!(screen.expand(0.01).contains_rect(shown));
        assert!((shown.center() - screen.center()).length() < 1e-3);
        let north = map.point(Vec2::new(0.0, 1.0));
        assert!(north.y < map.point(Vec2::ZERO).y, "north is up");
        assert!(map.floor(map.point(Vec2::new(0.4, 1.2))).distance(Vec2::new(0.4, 1.2)) < 1e-5);
        assert!(map.floor_vector(vec2(30.0, 30.0)).distance(Vec2::new(0.1, -0.1)) < 1e-6);
    }
}
