//! A projector's picture in its window: points, pixels and shares of it.

use eframe::egui::{Pos2, Rect, Ui, vec2};
use glam::Vec2;

/// The picture of a projector, which fills its window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Picture {
    /// Its area in the window, in points.
    pub(super) area: Rect,
    pixels_per_point: f32,
}

impl Picture {
    /// The picture that fills the rest of `ui`.
    pub(super) fn filling(ui: &Ui) -> Self {
        Self { area: ui.available_rect_before_wrap(), pixels_per_point: ui.pixels_per_point() }
    }

    /// Width and height in points, at least 1.
    pub(super) fn size(&self) -> Vec2 {
        Vec2::new(self.area.width(), self.area.height()).max(Vec2::ONE)
    }

    /// Width over height.
    pub(super) fn shape(&self) -> f32 {
        self.size().x / self.size().y
    }

    /// The point at this share of width and height.
    pub(super) fn point(&self, share: Vec2) -> Pos2 {
        let at = share * self.size();
        self.area.min + vec2(at.x, at.y)
    }

    /// The share of width and height at this point.
    pub(super) fn share(&self, point: Pos2) -> Vec2 {
        let at = point - self.area.min;
        Vec2::new(at.x, at.y) / self.size()
    }

    /// The share of width and height that one pixel takes.
    pub(super) fn pixel(&self) -> Vec2 {
        (self.size() * self.pixels_per_point).recip()
    }

    /// Width and height of a pixel, in points.
    pub(super) fn pixel_points(&self) -> f32 {
        1.0 / self.pixels_per_point
    }
}
