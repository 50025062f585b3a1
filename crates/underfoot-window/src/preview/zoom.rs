//! Zoom and pan of the floor view.

use eframe::egui::{Pos2, Rect, Vec2, vec2};

use underfoot::floor;
use underfoot_scene::egui_painter::ScreenFromFloor;

/// Maximum zoom relative to the whole floor: a tile fills the view of a floor of 24 x 16.
const NEAREST: f32 = 16.0;

/// Minimum zoom relative to the whole floor, for a view that panels cover nearly all of.
const FARTHEST: f32 = 0.05;

/// The part of the screen for the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ViewRoom {
    /// The area into which the whole floor is fitted at zoom 1: the same whatever panels are open.
    pub(super) stage: Rect,
    /// The area in which the floor can be seen; panels may cover a part of the stage.
    pub(super) free: Rect,
}

impl ViewRoom {
    /// The zoom at which the whole floor fills the free area.
    fn filling(&self, bounds: floor::Rect) -> f32 {
        let scale = |screen: Rect| ScreenFromFloor::fit(bounds, screen).scale();
        let by = scale(self.free) / scale(self.stage);
        if by.is_finite() { by.clamp(FARTHEST, NEAREST) } else { 1.0 }
    }
}

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

    /// The view of the whole floor in the free area.
    pub(super) fn fitted(bounds: floor::Rect, room: ViewRoom) -> Self {
        let by = room.filling(bounds);
        Self { by, off: (room.stage.center() - room.free.center()) / by }
    }

    /// Whether both show the same, to half a point.
    pub(super) fn is_close_to(&self, other: Self) -> bool {
        (self.by - other.by).abs() < 1e-3 && (self.off - other.off).length() < 0.5
    }

    /// The transform from floor to screen; `bounds` is the area at zoom 1.
    pub(super) fn map(&self, bounds: floor::Rect, stage: Rect) -> ScreenFromFloor {
        let middle = stage.center() - self.off * self.by;
        ScreenFromFloor::fit(bounds, Rect::from_center_size(middle, stage.size() * self.by))
    }

    /// Multiplies the zoom by `by`; the point of the floor under `pointer` stays there.
    pub(super) fn about(&mut self, pointer: Pos2, by: f32, bounds: floor::Rect, room: ViewRoom) {
        if !by.is_finite() || by <= 0.0 {
            return;
        }
        let under = self.map(bounds, room.stage).floor(pointer);
        self.by = (self.by * by).clamp(room.filling(bounds).min(1.0), NEAREST);
        let moved = self.map(bounds, room.stage).point(under) - pointer;
        self.pan(-moved, room);
    }

    /// Moves the view by `way` points: as far as the floor extends beyond the free area, and as far as panels cover
    /// it.
    pub(super) fn pan(&mut self, way: Vec2, room: ViewRoom) {
        let ViewRoom { stage, free } = room;
        let size = stage.size() * self.by;
        let wished = stage.center() - self.off * self.by - 0.5 * size + way;
        let limited = |wished: f32, at_rest: f32, low: f32, high: f32, size: f32| {
            let ends = [at_rest, low, high - size];
            let least = ends.into_iter().fold(f32::INFINITY, f32::min);
            let most = ends.into_iter().fold(f32::NEG_INFINITY, f32::max);
            wished.max(least).min(most)
        };
        let x = limited(wished.x, stage.left(), free.left(), free.right(), size.x);
        let y = limited(wished.y, stage.top(), free.top(), free.bottom(), size.y);
        let off = stage.center().to_vec2() - vec2(x, y) - 0.5 * size;
        // A view that did not move keeps no rounding errors.
        self.off = if off.length() < 1e-2 { Vec2::ZERO } else { off / self.by };
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;

    fn bounds() -> floor::Rect {
        floor::Rect::new(glam::Vec2::ZERO, glam::Vec2::new(1.8, 1.8))
    }

    fn uncovered() -> ViewRoom {
        let screen = Rect::from_min_size(pos2(20.0, 30.0), vec2(900.0, 700.0));
        ViewRoom { stage: screen, free: screen }
    }

    #[test]
    fn what_is_under_the_pointer_stays_and_the_floor_never_leaves_the_view() {
        let (bounds, room) = (bounds(), uncovered());
        let screen = room.stage;
        let mut zoom = Zoom::default();
        assert_eq!(zoom.map(bounds, screen), ScreenFromFloor::fit(bounds, screen));
        let pointer = pos2(420.0, 300.0);
        let under = zoom.map(bounds, screen).floor(pointer);
        zoom.about(pointer, 3.0, bounds, room);
        assert!(!zoom.is_close_to(Zoom::fitted(bounds, room)));
        assert!(zoom.map(bounds, screen).floor(pointer).distance(under) < 1e-3);
        zoom.pan(vec2(1e6, -1e6), room);
        let shown = zoom.map(bounds, screen).rect(bounds);
        assert!(shown.intersects(screen));
        zoom.about(pointer, 1e-9, bounds, room);
        assert_eq!(zoom, Zoom::default());
        zoom.about(pointer, f32::NAN, bounds, room);
        assert_eq!(zoom, Zoom::default());
        zoom.pan(vec2(40.0, -9.0), room);
        assert_eq!(zoom, Zoom::default(), "the whole floor needs no moving");
    }

    #[test]
    fn a_covered_part_of_the_floor_can_be_moved_or_fitted_into_view() {
        let (bounds, mut room) = (bounds(), uncovered());
        room.free.max.x -= 300.0;
        let mut zoom = Zoom::default();
        assert!(!zoom.is_close_to(Zoom::fitted(bounds, room)));
        let shown = |zoom: &Zoom| zoom.map(bounds, room.stage).rect(bounds);
        zoom.pan(vec2(-1e4, 1e4), room);
        let corner = shown(&zoom).right_bottom();
        assert!(room.free.expand(0.1).contains(corner), "{corner} in {}", room.free);
        zoom = Zoom::fitted(bounds, room);
        assert!(
            room.free.expand(0.1).contains_rect(shown(&zoom)) && zoom.is_close_to(Zoom::fitted(bounds, room))
        );
        // Without the cover, the fitted view is the usual one.
        assert_eq!(Zoom::fitted(bounds, uncovered()), Zoom::default());
    }
}
