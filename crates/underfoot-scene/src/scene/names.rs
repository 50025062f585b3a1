//! Names of parts of the floor: readable on bare plates, on plates under load, and on simulated grounds.

use glam::Vec2;

use super::mark::{Anchor, Ink, Lettering, Paint};
use super::widths::{CAP_HEIGHT, width};
use super::{Scene, Theme, View, ground, terrain};
use underfoot::floor::Rect;
use underfoot::layout::Colour;

/// Opacity of the plate under a name on a simulated ground.
const PLATE: f32 = 0.9;

/// Returns `wish` as far as it is readable on any plate of this theme.
pub(super) fn ink(theme: &Theme, wish: Colour) -> Ink {
    let loaded = |plate: Colour| plate.mix(theme.load, ground::MOST_LOAD);
    let tinted = |plate: Colour| plate.mix(theme.accent, ground::TINT);
    // The tint of a region lies under the load where it fills a tile, over it elsewhere.
    let wish = theme.legible(wish, loaded(tinted(theme.plate)));
    // A colour that is readable there is readable on a plate at rest, which differs more from the theme's ink.
    Ink::solid(theme.legible(wish, tinted(loaded(theme.plate))))
}

/// Writes `name` on one line within the width `room_m`, between the lettering's size and `smallest_m`, all in metres.
pub(super) fn write(
    scene: &mut Scene,
    view: &View<'_>,
    lettering: Lettering,
    name: &str,
    (room_m, smallest_m): (f32, f32),
) {
    let size = Vec2::new((width(name) * lettering.size_m).min(room_m), CAP_HEIGHT * lettering.size_m);
    let west = match lettering.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * size.x,
        Anchor::End => -size.x,
    };
    let area = Rect::from_min_size(lettering.at + Vec2::new(west, 0.0), size).grown(0.008);
    // In high contrast a load under a zone would be too light for any ink.
    let is_strict = view.theme.least_contrast() > 5.0;
    if !name.is_empty() && (is_strict || terrain::is_under(view, area)) {
        scene.add_box(area, 0.010, Paint::fill(Ink::faint(view.theme.plate, PLATE)));
    }
    scene.add_line_of(lettering, name, room_m, smallest_m);
}
