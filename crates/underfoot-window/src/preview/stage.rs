//! The part of the window into which the floor is fitted: the same in every mode, so that the floor stays where it is.

use eframe::egui::Rect;

/// Width of a window, in points, from which the floor keeps its place beside the panels of all modes; in a narrower
/// one, it gets all the room that the present mode leaves.
const WIDE: f32 = 1010.0;

/// Widths, in points, that the panels of all modes need at each side of the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PanelWidths {
    /// The palette at the left.
    left: f32,
    /// The side panel or the inspector at the right, whichever is wider.
    right: f32,
}

impl Default for PanelWidths {
    fn default() -> Self {
        Self { left: 204.0, right: 330.0 }
    }
}

impl PanelWidths {
    /// Takes in the widths that the panels of Design mode have on the screen, in points.
    pub(super) fn note(&mut self, window: Rect, canvas: Rect) {
        self.left = self.left.max(canvas.left() - window.left()).min(0.3 * window.width());
        self.note_right(window, canvas);
    }

    /// Takes in the width of the panel at the right, in points.
    pub(super) fn note_right(&mut self, window: Rect, canvas: Rect) {
        self.right = self.right.max(window.right() - canvas.right()).min(0.4 * window.width());
    }

    /// The area for the floor within `canvas`, which the panels of the present mode leave free.
    ///
    /// `designs` tells whether the window has a Design mode, and `has_side` whether the panel at the right is wanted.
    pub(super) fn stage(self, window: Rect, canvas: Rect, designs: bool, has_side: bool) -> Rect {
        if !designs || window.width() < WIDE {
            return canvas;
        }
        let mut stage = canvas;
        stage.min.x = canvas.left().max(window.left() + self.left);
        if has_side {
            stage.max.x = canvas.right().min(window.right() - self.right);
        }
        // Panels that a user has widened may leave no room between the others.
        if stage.width() < 0.3 * window.width() { canvas } else { stage }
    }
}

/// The place of the floor in one frame.
pub(super) struct StageOfWindow {
    /// The whole window.
    pub(super) window: Rect,
    /// The part of it that bars and panels leave free; drawing the panels sets it.
    pub(super) canvas: Rect,
    pub(super) widths: PanelWidths,
    /// Whether the window has a Design mode.
    pub(super) designs: bool,
    /// Whether the panel at the right is wanted.
    pub(super) has_side: bool,
}

impl StageOfWindow {
    /// Whether the floor keeps its place in all modes.
    pub(super) fn is_wide(&self) -> bool {
        self.window.width() >= WIDE
    }

    /// The area for the floor, with a margin.
    pub(super) fn floor(&self) -> Rect {
        self.widths.stage(self.window, self.canvas, self.designs, self.has_side).shrink(6.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    fn area(left: f32, right: f32) -> Rect {
        Rect::from_min_max(pos2(left, 40.0), pos2(right, 740.0))
    }

    #[test]
    fn the_floor_gets_the_same_place_beside_the_panels_of_each_mode() {
        let window = area(0.0, 1280.0);
        let mut widths = PanelWidths::default();
        let designing = area(232.0, 926.0);
        widths.note(window, designing);
        assert_eq!(widths.stage(window, area(0.0, 956.0), true, true), designing);
        assert_eq!(widths.stage(window, designing, true, true), designing);
    }

    #[test]
    fn a_narrow_window_gives_the_floor_all_that_is_free() {
        let canvas = area(0.0, 640.0);
        assert_eq!(PanelWidths::default().stage(canvas, canvas, true, true), canvas);
    }

    #[test]
    fn panels_that_fill_the_window_still_leave_a_floor() {
        let window = area(0.0, 1100.0);
        let mut widths = PanelWidths::default();
        widths.note(window, area(320.0, 660.0));
        let canvas = area(300.0, 560.0);
        assert_eq!(widths.stage(window, canvas, true, true), canvas);
    }
}
