//! The floor as a widget.

use egui::accesskit::Role;
use egui::{Response, Sense, Ui, WidgetInfo};
use underfoot::engine::Snapshot;
use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot_scene::egui_painter::{self, Palette, ScreenFromFloor};
use underfoot_scene::scene::{self, Scene, Show, Theme, View};

/// Floor, feet and controls in an egui app: a drawing of a snapshot, without any effect on it.
///
/// Use one for each place that shows a floor, and keep it from frame to frame.
#[derive(Debug)]
pub struct FloorView {
    theme: Theme,
    show: Show,
    scene: Scene,
    palette: Palette,
}

impl FloorView {
    /// A view of these parts in these colours; [`Show::PROJECTOR`] is for a projector above the floor.
    #[must_use]
    pub fn new(theme: Theme, show: Show) -> Self {
        Self { theme, show, scene: Scene::new(), palette: Palette::default() }
    }

    /// Fills the remaining room in `ui` with the floor, upright and as large as possible.
    ///
    /// `snapshot` belongs to `layout`, like those of [`underfoot::runtime::SessionSnapshot`]. The returned map converts
    /// between floor and screen positions.
    pub fn ui(
        &mut self,
        ui: &mut Ui,
        geometry: &Geometry,
        layout: &Layout,
        snapshot: &Snapshot,
    ) -> (Response, ScreenFromFloor) {
        let show = self.show;
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Floor"));
        let map = ScreenFromFloor::fit(scene::extent(geometry, show), rect);
        if ui.is_rect_visible(rect) {
            let view = View { show, ..View::new(geometry, layout, snapshot, &self.theme) };
            scene::draw(&mut self.scene, &view);
            let painter = ui.painter_at(rect);
            painter.rect_filled(rect, 0.0, egui_painter::color(self.theme.canvas));
            egui_painter::paint(&painter, &mut self.palette, &self.scene, map);
        }
        (response, map)
    }
}
