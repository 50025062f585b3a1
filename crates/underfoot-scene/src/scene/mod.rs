//! Drawing of a floor: one description for windows, pictures and projectors.
//!
//! [`draw`] turns the floor's state into a [`Scene`], a list of [`Mark`]s in floor metres. Painters for egui and SVG
//! are small and independent of the controls; an app that projects the floor itself can have its own painter.
//!
//! ```
//! use underfoot_scene::scene::{self, Scene, Theme, View};
//! # use underfoot::{engine::Snapshot, floor::Geometry, layout::Layout};
//! # let layout = Layout { title: "Empty".into(), regions: vec![], stances: vec![], targets: vec![], pages: vec![], grounds: vec![], widgets: vec![] };
//! let mut scene = Scene::new();
//! let (geometry, snapshot) = (Geometry::default(), Snapshot::default());
//! scene::draw(&mut scene, &View::new(&geometry, &layout, &snapshot, &Theme::LIGHT));
//! assert!(scene.marks().len() >= 36, "at least the plates");
//! ```

mod board;
mod control;
mod face;
mod face_colours;
mod face_words;
mod feet;
mod fit;
mod ground;
mod icon;
mod layers;
mod mark;
mod names;
mod outline;
mod pieces;
#[cfg(test)]
mod readable_tests;
#[cfg(test)]
#[path = "../../../../tests/support/sample.rs"]
pub(crate) mod sample;
mod strip;
mod terrain;
#[cfg(test)]
mod tests;
mod theme;
mod view;
mod widths;

pub use board::Scene;
pub use face_colours::Faces;
pub use layers::TOLD;
pub use mark::{Anchor, Ink, Lettering, Mark, Paint, Span, Stroke};
pub use outline::{outline_of, sole};
pub use pieces::{TextDirection, TextPiece, in_drawn_order, pieces};
pub use theme::Theme;
pub use view::{Layer, PressBeside, Shoe, Show, Trail, View};
pub use widths::CAP_HEIGHT;

use glam::Vec2;

use underfoot::floor::{Geometry, Rect};

/// Width of the margin around the paper's floor, in metres.
const MARGIN_M: f32 = 0.085;

/// Width of this floor divided by that of the paper's: texts around a floor grow with it.
fn magnification(geometry: &Geometry) -> f32 {
    geometry.bounds().size().x / Geometry::default().bounds().size().x
}

/// True if `area` contains all of `cell`, within the rounding errors of metres.
fn holds(area: Rect, cell: Rect) -> bool {
    let area = area.grown(1e-4);
    cell.min.cmpge(area.min).all() && cell.max.cmple(area.max).all()
}

/// Returns the bounds of a drawing of this floor, in floor metres: the floor and the room for texts around it.
#[must_use]
pub fn extent(geometry: &Geometry, show: Show) -> Rect {
    let by = magnification(geometry);
    let margin = if show.ruler || show.header { MARGIN_M * by } else { 0.0 };
    let mut bounds = geometry.bounds().grown(margin);
    if show.header {
        bounds.max.y += strip::HEADER_M * by - margin;
    }
    if show.legend {
        bounds.min.y -= (strip::LEGEND_M - 0.02) * by;
    }
    bounds
}

/// Draws `view` into `scene`, replacing its contents.
///
/// The order follows a real floor: plates, the ground and the projected controls, the marks of sensors and actuators,
/// feet, and texts about all of them.
pub fn draw(scene: &mut Scene, view: &View<'_>) {
    let floor = view.geometry.bounds();
    let bounds = extent(view.geometry, view.show);
    scene.clear(bounds, view.theme.canvas);
    ground::plates(scene, view);
    terrain::draw(scene, view);
    ground::holes(scene, view);
    layers::health(scene, view);
    ground::unknown(scene, view);
    if view.show.ruler {
        ground::ruler(scene, view);
    }
    ground::regions(scene, view);
    ground::stances(scene, view);
    control::draw_all(scene, view);
    if view.show.actuators {
        ground::actuators(scene, view);
    }
    layers::tiles(scene, view);
    ground::sensors(scene, view);
    ground::chosen(scene, view);
    feet::shoes(scene, view);
    layers::trails(scene, view);
    layers::uncertainty(scene, view);
    let tags = if view.show.contacts { feet::contacts(scene, view) } else { Vec::new() };
    layers::ignored(scene, view, tags);
    let by = magnification(view.geometry);
    let wide = Geometry::default().bounds().size().x;
    if view.show.header {
        let south = Vec2::new(floor.min.x, floor.max.y);
        let strip = Rect::from_min_size(south, Vec2::new(wide, strip::HEADER_M));
        scene.magnified(south, by, |scene| strip::header(scene, view, strip));
    }
    if view.show.legend {
        let south = Vec2::new(floor.min.x, bounds.min.y);
        let strip = Rect::from_min_size(south, Vec2::new(wide, strip::LEGEND_M));
        scene.magnified(south, by, |scene| strip::legend(scene, view, strip));
    }
}
