//! How near the floor is seen.

use eframe::egui::{Pos2, Rect, Vec2, vec2};

use crate::egui_painter::ScreenFromFloor;
use crate::floor;

/// The nearest, in times of the whole floor: a tile fills the view of a floor of 24 x 16.
const NEAREST: f32 = 16.0;

/// How near the floor is seen and which part of it; at first, all of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Zoom {
    by: f32,
    /// The middle of the view from the middle of the floor, in points of the whole floor's view.
    off: Vec2,
}

impl Default for Zoom {
    fn default() -> Self {
        Self { by: 1.0, off: Vec2::ZERO }
    }
}

impl Zoom {
    /// How many times larger than as a whole.
    pub(super) fn by(&self) -> f32 {
        self.by
    }

    /// Whether less than all of it is seen.
    pub(super) fn is_closer(&self) -> bool {
        self.by > 1.001
    }

    /// From floor to screen; `bounds` is what is seen as a whole.
    pub(super) fn map(&self, bounds: floor::Rect, screen: Rect) -> ScreenFromFloor {
        let middle = screen.center() - self.off * self.by;
        ScreenFromFloor::fit(bounds, Rect::from_center_size(middle, screen.size() * self.by))
    }

    /// Sees it `by` times as large; what is under `pointer` stays there.
    pub(super) fn about(&mut self, pointer: Pos2, by: f32, bounds: floor::Rect, screen: Rect) {
        if !by.is_finite() || by <= 0.0 {
            return;
        }
        let under = self.map(bounds, screen).floor(pointer);
        self.by = (self.by * by).clamp(1.0, NEAREST);
        let moved = self.map(bounds, screen).point(under) - pointer;
        self.pan(-moved, screen);
    }

    /// Moves what is seen by `way` points, as far as there is floor.
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
