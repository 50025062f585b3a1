//! The window's contents as an app of eframe.

use eframe::egui::{self, Ui};

use super::app::App;
use super::projection::ConnectedScreens;

/// The screens connected to this computer; `None` if the system does not report them.
#[cfg(not(target_arch = "wasm32"))]
fn screens(frame: &eframe::Frame) -> Option<ConnectedScreens> {
    let window = frame.winit_window()?;
    let own = window.current_monitor();
    let own = own.and_then(|own| window.available_monitors().position(|screen| screen == own));
    Some(ConnectedScreens { count: window.available_monitors().count(), own })
}

/// A browser does not report its screens.
#[cfg(target_arch = "wasm32")]
fn screens(_: &eframe::Frame) -> Option<ConnectedScreens> {
    None
}

/// Fills the window behind everything: canvases keep their picture between frames.
fn draw_ground(ui: &Ui, colour: egui::Color32) {
    let ctx = ui.ctx();
    ctx.layer_painter(egui::LayerId::background()).rect_filled(ctx.viewport_rect(), 0.0, colour);
}

impl eframe::App for App {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.handle_close(ctx);
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        if self.projection.is_open() {
            self.projection.note_screens(screens(frame));
        }
        draw_ground(ui, underfoot_scene::egui_painter::color(self.appearance.theme().canvas));
        self.show(ui);
    }

    fn raw_input_hook(&mut self, ctx: &egui::Context, input: &mut egui::RawInput) {
        if input.viewport_id == egui::ViewportId::ROOT
            && self.window.turns.take(&mut input.events, self.is_designing())
        {
            ctx.request_repaint();
        }
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        underfoot_scene::egui_painter::color(self.appearance.theme().canvas).to_normalized_gamma_f32()
    }

    fn persist_egui_memory(&self) -> bool {
        false
    }
}
