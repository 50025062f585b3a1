//! The part of the window into which the floor is fitted: the same whatever mode and panels are open, so that the
//! floor stays where it is. Panels cover a part of it where the window has no room beside it; in a window in a hand, the
//! floor fills what the open panel leaves.

use eframe::egui::Rect;

use super::handheld::{PanelSheet, WindowHold};
use super::zoom::ViewRoom;

/// Width of a window, in points, that has room for the floor between the panels of all modes.
pub(super) const WIDE: f32 = 1010.0;

/// Width of a window, in points, that has room for the floor beside one panel; narrower ones show panels over it.
pub(super) const BESIDE: f32 = 669.0;

/// Margin around the floor, in points.
const MARGIN: f32 = 6.0;

/// Width of the inspector in a wide window, in points.
pub(super) const INSPECTOR_PX: f32 = 340.0;

/// Widths, in points, that the panels of all modes need at each side of the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PanelWidths {
    /// The palette at the left of a wide window.
    left: f32,
    /// The side panel or the inspector at the right, whichever is wider.
    right: f32,
}

impl Default for PanelWidths {
    fn default() -> Self {
        Self { left: 204.0, right: INSPECTOR_PX }
    }
}

impl PanelWidths {
    /// The part of `room` that stays free when all panels are open.
    fn stage(self, room: Rect, designs: bool) -> Rect {
        let width = room.width();
        let mut stage = room;
        // Panels that a user has widened leave room for the floor.
        if width >= WIDE && designs {
            stage.min.x += self.left.min(0.3 * width);
        }
        if width >= BESIDE {
            stage.max.x -= self.right.min(if width >= WIDE { 0.4 } else { 0.5 } * width);
        }
        stage
    }
}

/// The place of the floor in one frame.
pub(super) struct StageOfWindow {
    /// The part of the window between the bars of all modes.
    room: Rect,
    /// The part of it that panels leave free; drawing the panels sets it.
    pub(super) canvas: Rect,
    pub(super) widths: PanelWidths,
    /// Whether the window has a Design mode.
    designs: bool,
    /// Whether the panel at the right is wanted.
    pub(super) has_side: bool,
    hold: WindowHold,
}

impl StageOfWindow {
    /// The stage in `room`, the part of the window between the bars of all modes.
    pub(super) fn new(room: Rect, widths: PanelWidths, designs: bool, has_side: bool) -> Self {
        Self { room, canvas: room, widths, designs, has_side, hold: WindowHold::Desk }
    }

    /// The same in a window that is held so.
    pub(super) fn held(self, hold: WindowHold) -> Self {
        Self { hold, ..self }
    }

    /// The place of the open panel in a window in a hand that has no room beside the floor.
    pub(super) fn sheet(&self) -> Option<PanelSheet> {
        self.hold.sheet(self.room)
    }

    /// Whether the window has room for the panels of all modes; a narrow one shows one panel at a time, at the right.
    pub(super) fn is_wide(&self) -> bool {
        self.room.width() >= WIDE
    }

    /// Maximum width of a panel, in points: half of a narrow window stays with the floor.
    pub(super) fn widest(&self) -> f32 {
        0.5 * self.room.width()
    }

    /// Takes in the widths that the panels beside `free` have on the screen.
    pub(super) fn note(&mut self, free: Rect) {
        if self.is_wide() && self.designs {
            self.widths.left = self.widths.left.max(free.left() - self.room.left());
        }
        self.note_right(free);
    }

    /// Takes in the width of the panel at the right of `free`.
    pub(super) fn note_right(&mut self, free: Rect) {
        if self.sheet().is_some() {
            return;
        }
        self.widths.right = self.widths.right.max(self.room.right() - free.right());
    }

    /// The area for the floor, and the part of the window in which it can be seen.
    pub(super) fn view_room(&self) -> ViewRoom {
        if self.sheet().is_some() {
            let free = self.canvas.shrink(MARGIN);
            return ViewRoom { stage: free, free };
        }
        let stage = self.widths.stage(self.room, self.designs);
        let mut free = self.canvas;
        free.min.x = free.left().max(stage.left());
        if self.has_side {
            free.max.x = free.right().min(stage.right());
        }
        ViewRoom { stage: stage.shrink(MARGIN), free: free.shrink(MARGIN) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    fn area(left: f32, right: f32) -> Rect {
        Rect::from_min_max(pos2(left, 40.0), pos2(right, 740.0))
    }

    fn seen(width: f32, canvas: Rect) -> ViewRoom {
        let mut stage = StageOfWindow::new(area(0.0, width), PanelWidths::default(), true, true);
        stage.canvas = canvas;
        stage.view_room()
    }

    #[test]
    fn the_floor_has_the_same_place_whatever_panels_are_open() {
        for width in [640.0, 900.0, 1280.0, 2560.0] {
            let alone = seen(width, area(0.0, width));
            for canvas in
                [area(204.0, width - INSPECTOR_PX), area(0.0, 0.5 * width), area(0.5 * width, width)]
            {
                assert_eq!(seen(width, canvas).stage, alone.stage, "{width}");
            }
            assert!(alone.stage.width() >= 0.5 * width - 2.0 * MARGIN, "{width}: {}", alone.stage.width());
        }
    }

    #[test]
    fn a_wide_window_leaves_room_for_all_panels_and_a_narrow_one_shows_them_over_the_floor() {
        let wide = seen(1280.0, area(204.0, 1280.0 - INSPECTOR_PX));
        assert_eq!((wide.stage, wide.free), (area(204.0, 1280.0 - INSPECTOR_PX).shrink(MARGIN), wide.stage));
        let narrow = seen(640.0, area(0.0, 320.0));
        assert_eq!(narrow.stage, area(0.0, 640.0).shrink(MARGIN));
        assert_eq!(narrow.free, area(0.0, 320.0).shrink(MARGIN));
    }

    #[test]
    fn panels_that_a_user_has_widened_still_leave_a_floor() {
        let mut stage = StageOfWindow::new(area(0.0, 1100.0), PanelWidths::default(), true, true);
        stage.note(area(520.0, 560.0));
        assert!(stage.view_room().stage.width() > 0.25 * 1100.0);
    }
}
