//! Zoom and pan of the floor view.

use eframe::egui::{Pos2, Rect, Vec2, vec2};

use underfoot::floor;
use underfoot_scene::egui_painter::ScreenFromFloor;

/// Maximum zoom relative to the whole floor: a tile fills the view of a floor of 24 x 16.
const NEAREST: f32 = 16.0;

/// Zoom factor and position of the view; initially the whole floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Zoom {
    by: f32,
    /// Offset of the view's middle from the floor's middle, in points at zoom 1.
    off: Vec2,
}

impl Default for Zoom {
    fn default() -> Self {
        Self { by: 1.0, off: Vec2::ZERO }
    }
}

impl Zoom {
    /// The zoom factor; 1 shows the whole floor.
    pub(super) fn by(&self) -> f32 {
        self.by
    }

    /// Whether the view shows only a part of the floor.
    pub(super) fn is_closer(&self) -> bool {
        self.by > 1.001
    }

    /// The transform from floor to screen; `bounds` is the area at zoom 1.
    pub(super) fn map(&self, bounds: floor::Rect, screen: Rect) -> ScreenFromFloor {
        let middle = screen.center() - self.off * self.by;
        ScreenFromFloor::fit(bounds, Rect::from_center_size(middle, screen.size() * self.by))
    }

    /// Multiplies the zoom by `by`; the point of the floor under `pointer` stays there.
    pub(super) fn about(&mut self, pointer: Pos2, by: f32, bounds: floor::Rect, screen: Rect) {
        if !by.is_finite() || by <= 0.0 {
            return;
        }
        let under = self.map(bounds, screen).floor(pointer);
        self.by = (self.by * by).clamp(1.0, NEAREST);
        let moved = self.map(bounds, screen).point(under) - pointer;
        self.pan(-moved, screen);
    }

    /// Moves the view by `way` points, limited to the floor.
    pub(super) fn pan(&mut self, way: Vec2, screen: Rect) {
        let most = 0.5 * screen.size() * (1.0 - 1.0 / self.by);
        let off = self.off - way / self.by;
        self.off = vec2(off.x.clamp(-most.x, most.x), off.y.clamp(-most.y, most.y));
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;

    #[test]
    fn what_is_under_the_pointer_stays_and_the_floor_never_leaves_the_view() {
        let bounds = floor::Rect::new(glam::Vec2::ZERO, glam::Vec2::new(1.8, 1.8));
        let screen = Rect::from_min_size(pos2(20.0, 30.0), vec2(900.0, 700.0));
        let mut zoom = Zoom::default();
        assert_eq!(zoom.map(bounds, screen), ScreenFromFloor::fit(bounds, screen));
        let pointer = pos2(420.0, 300.0);
        let under = zoom.map(bounds, screen).floor(pointer);
        zoom.about(pointer, 3.0, bounds, screen);
        assert!(zoom.is_closer() && zoom.map(bounds, screen).floor(pointer).distance(under) < 1e-3);
        zoom.pan(vec2(1e6, -1e6), screen);
        let shown = zoom.map(bounds, screen).rect(bounds);
        assert!(shown.intersects(screen));
        zoom.about(pointer, 1e-9, bounds, screen);
        assert_eq!(zoom, Zoom::default());
        zoom.about(pointer, f32::NAN, bounds, screen);
        assert_eq!(zoom, Zoom::default());
    }
}
