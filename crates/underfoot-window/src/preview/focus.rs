//! The keyboard focus: its order, with the controls on the floor first, and the ring around it.

use eframe::egui::{Id, Key, LayerId, Order, Stroke, StrokeKind, Ui};

use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// The state of the keyboard focus.
#[derive(Default)]
pub(super) struct FocusRing {
    /// Whether a key moved the focus last, so that the ring is wanted.
    is_led_by_keys: bool,
}

impl FocusRing {
    /// Puts `first`, in this order, before all widgets of this frame. Call it before any of them is added.
    pub(super) fn begin(&mut self, ui: &Ui, first: &[Id]) {
        let layer = ui.layer_id();
        ui.memory_mut(|memory| first.iter().for_each(|id| memory.interested_in_focus(*id, layer)));
        let moves = [Key::Tab, Key::F6, Key::ArrowUp, Key::ArrowDown, Key::ArrowLeft, Key::ArrowRight];
        ui.input(|i| {
            if moves.iter().any(|key| i.key_pressed(*key)) {
                self.is_led_by_keys = true;
            } else if i.pointer.any_pressed() {
                self.is_led_by_keys = false;
            }
        });
    }

    /// Draws the ring around the widget with the focus, above everything. Call it after all widgets.
    pub(super) fn show(&self, ui: &Ui, theme: &Theme) {
        let focused = ui.memory(|memory| memory.focused()).filter(|_| self.is_led_by_keys);
        let Some(response) = focused.and_then(|id| ui.ctx().read_response(id)) else { return };
        let layer = LayerId::new(Order::Foreground, Id::unique("focus ring"));
        let painter = ui.ctx().layer_painter(layer).with_clip_rect(response.interact_rect.expand(5.0));
        // A dark and a light line: one of them contrasts with any background.
        let area = response.rect.intersect(response.interact_rect).expand(1.0);
        painter.rect_stroke(area, 6, Stroke::new(2.5, color(theme.cursor)), StrokeKind::Outside);
        painter.rect_stroke(area, 6, Stroke::new(1.0, color(theme.plate)), StrokeKind::Inside);
    }
}
