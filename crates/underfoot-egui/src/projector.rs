//! A second window for a projector above the floor.

use egui::{Color32, Context, ViewportBuilder, ViewportId};
use underfoot::floor::Geometry;
use underfoot::runtime::SessionSnapshot;
use underfoot_scene::scene::{Show, Theme};

use crate::FloorView;

/// The image for a projector above the floor: controls and their states, on black, in a window of its own.
#[derive(Debug)]
pub struct Projector {
    view: FloorView,
    is_on: bool,
}

impl Projector {
    /// A projector that is on from the start, or not.
    #[must_use]
    pub fn new(is_on: bool) -> Self {
        Self { view: FloorView::new(Theme::DARK.projected(), Show::PROJECTOR), is_on }
    }

    /// Opens the window, or closes it.
    pub fn toggle(&mut self) {
        self.is_on = !self.is_on;
    }

    /// Draws the window while it is on; closing the window turns it off. Call it with each frame of the app.
    pub fn show(&mut self, context: &Context, geometry: &Geometry, snapshot: &SessionSnapshot) {
        if !self.is_on {
            return;
        }
        let builder = ViewportBuilder::default().with_title("Floor").with_inner_size([800.0, 800.0]);
        let id = ViewportId::from_hash_of("underfoot projector");
        let is_closed = context.show_viewport_immediate(id, builder, |ui, _| {
            ui.painter().rect_filled(ui.max_rect(), 0.0, Color32::BLACK);
            self.view.ui(ui, geometry, &snapshot.layout, &snapshot.floor);
            ui.input(|input| input.viewport().close_requested())
        });
        self.is_on = !is_closed;
    }
}
