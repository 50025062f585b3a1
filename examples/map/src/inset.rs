//! The size of the small floor in the window, and the part of the floor that it shows.

use eframe::egui::{Rect, Vec2, pos2, vec2};
use underfoot::floor::{self, Geometry};
use underfoot::layout::Layout;

/// Least size of a control's smallest side, in points: enough for a mouse or a finger to hit, and for a label.
const CONTROL: f32 = 40.0;

/// Margin around controls, regions and stances, in metres.
const AROUND_M: f32 = 0.06;

/// Greatest share of the window's width and height for the small floor.
const MOST: Vec2 = vec2(0.5, 0.55);

/// The visible part of a floor, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Northwards from the floor's southern edge.
    height_m: f32,
    width_m: f32,
    /// The smallest side of a control.
    control_m: f32,
}

impl Part {
    /// The part with all controls, regions and stances of a layout: the whole width, and as far north as they reach.
    pub fn of(geometry: &Geometry, layout: &Layout) -> Self {
        let whole = geometry.bounds().size();
        let controls = layout.widgets.iter().map(|widget| widget.area);
        let regions = layout.regions.iter().map(|region| region.area);
        let stances = layout.stances.iter().map(|stance| stance.area);
        let north = controls.clone().chain(regions).chain(stances).map(|area: floor::Rect| area.max.y);
        let north = north.fold(0.0, f32::max) + AROUND_M;
        let sides = controls.map(|area| (area.max - area.min).min_element());
        let control_m = sides.fold(f32::INFINITY, f32::min).clamp(0.02, 1.0);
        Self { height_m: north.min(whole.y), width_m: whole.x, control_m }
    }

    /// Its size in a window of this size, so that its smallest control can be pressed if the window has room for
    /// that.
    pub fn size(&self, window: Vec2) -> Vec2 {
        let wanted = CONTROL / self.control_m;
        let [most_x, most_y] = [MOST.x * window.x / self.width_m, MOST.y * window.y / self.height_m];
        wanted.min(most_x).min(most_y) * vec2(self.width_m, self.height_m)
    }

    /// The place of the whole floor such that this part of it fills `shown`: its southern edge is that of `shown`.
    pub fn whole(&self, geometry: &Geometry, shown: Rect) -> Rect {
        let height = shown.width() * geometry.bounds().size().y / self.width_m;
        Rect::from_min_max(pos2(shown.left(), shown.bottom() - height), shown.max)
    }
}

#[cfg(test)]
mod tests {
    use underfoot::schema::{self, Kinds};

    use super::*;

    fn part() -> (Geometry, Part) {
        let geometry = floor::Floor::default().geometry;
        let text = include_str!("../atlas.ron");
        let layout = schema::parse_layout(text, "atlas.ron", &Kinds::builtin(), &geometry).unwrap().layout;
        (geometry, Part::of(&geometry, &layout))
    }

    #[test]
    fn the_smallest_control_can_be_pressed_in_the_usual_window() {
        let (_, part) = part();
        let size = part.size(vec2(1280.0, 800.0));
        assert!(part.control_m * size.x / part.width_m >= CONTROL - 0.1, "{size}");
        // The atlas ends 3.3 tiles from the south: the north of the floor is hidden.
        assert!(part.height_m < 0.6 * part.width_m, "{part:?}");
    }

    #[test]
    fn a_small_window_keeps_room_for_its_map() {
        let (_, part) = part();
        for window in [vec2(1280.0, 800.0), vec2(640.0, 480.0), vec2(400.0, 900.0)] {
            let size = part.size(window);
            assert!(size.x <= 0.5 * window.x + 0.1 && size.y <= 0.55 * window.y + 0.1, "{size} in {window}");
            assert!((size.x / size.y - part.width_m / part.height_m).abs() < 1e-3, "{size}");
        }
    }

    #[test]
    fn its_southern_edge_stays_and_its_scale_is_that_of_its_width() {
        let (geometry, part) = part();
        let shown = Rect::from_min_size(pos2(700.0, 400.0), part.size(vec2(1280.0, 800.0)));
        let whole = part.whole(&geometry, shown);
        assert_eq!((whole.left_bottom(), whole.right()), (shown.left_bottom(), shown.right()));
        let bounds = geometry.bounds().size();
        assert!((whole.height() / whole.width() - bounds.y / bounds.x).abs() < 1e-3);
    }
}
