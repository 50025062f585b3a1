//! Marks in the true size of the floor, shown while corners are adjusted: the tiles' edges, cross-hairs at the
//! floor's corners, and a ring as wide as a foot is long.

use glam::Vec2;

use underfoot::floor::Geometry;
use underfoot::layout::Colour;
use underfoot_scene::scene::{Anchor, Ink, Lettering, Paint, Scene, Stroke, sole};

/// Diameter of the ring in metres: the length of a foot.
///
/// The ring is round, so that a real foot fits it heel to toe in every direction. A picture that is stretched in one
/// direction shows as a foot that fits along the floor and does not fit across it, also with a foot of another
/// length.
pub(super) const FOOT_M: f32 = 0.26;

/// Length of a cross-hair's arms, in metres: short enough for the floor beyond the corner.
const ARM_M: f32 = 0.10;

/// Width of lines in metres: two pixels of a picture of 1024 lines on a floor of 2 m.
const LINE_M: f32 = 0.004;

const BLACK: Colour = Colour::rgb(0, 0, 0);

/// The marks of one projector.
pub(super) struct AlignmentMarks {
    /// Colour of the lines.
    pub(super) line: Colour,
    /// Colour at the selected corner.
    pub(super) chosen: Colour,
    /// The corner of the floor that keys move, in floor metres.
    pub(super) corner: Vec2,
}

impl AlignmentMarks {
    /// Draws the marks into `scene`, replacing its contents.
    pub(super) fn draw(&self, scene: &mut Scene, geometry: &Geometry) {
        let bounds = geometry.bounds();
        scene.clear(bounds.grown(ARM_M), BLACK);
        self.grid(scene, geometry);
        let (min, max) = (bounds.min, bounds.max);
        for corner in [min, max, Vec2::new(min.x, max.y), Vec2::new(max.x, min.y)] {
            let is_chosen = corner.distance(self.corner) < 1e-4;
            let (colour, width_m) = if is_chosen { (self.chosen, 1.5 * LINE_M) } else { (self.line, LINE_M) };
            let line = Paint::stroke(Stroke::new(width_m, Ink::solid(colour)));
            for arm in [Vec2::new(ARM_M, 0.0), Vec2::new(0.0, ARM_M)] {
                scene.add_line(corner - arm, corner + arm, line);
            }
        }
        self.foot(scene, self.foot_at(geometry));
    }

    /// The edges of all tiles.
    fn grid(&self, scene: &mut Scene, geometry: &Geometry) {
        let (bounds, pitch_m) = (geometry.bounds(), geometry.pitch_m());
        let size = bounds.size();
        let line = Paint::stroke(Stroke::new(LINE_M, Ink::faint(self.line, 0.7)));
        for column in 0..=geometry.columns() {
            let south = bounds.min + Vec2::new(f32::from(column) * pitch_m.x, 0.0);
            scene.add_line(south, south + Vec2::new(0.0, size.y), line);
        }
        for row in 0..=geometry.rows() {
            let west = bounds.min + Vec2::new(0.0, f32::from(row) * pitch_m.y);
            scene.add_line(west, west + Vec2::new(size.x, 0.0), line);
        }
    }

    /// The middle of the ring: in the second tile from the selected corner along both edges, where that corner's
    /// moves are seen, or in the middle of a smaller floor.
    fn foot_at(&self, geometry: &Geometry) -> Vec2 {
        let bounds = geometry.bounds();
        let inwards = (1.5 * geometry.pitch_m()).min(0.5 * bounds.size());
        self.corner + inwards * (bounds.centre() - self.corner).signum()
    }

    /// The ring, with a sole in it and its diameter below.
    fn foot(&self, scene: &mut Scene, middle: Vec2) {
        let ink = Ink::solid(self.line);
        scene.add_circle(middle, 0.5 * FOOT_M, Paint::stroke(Stroke::new(1.5 * LINE_M, ink)));
        let faint = Paint::stroke(Stroke::new(0.5 * LINE_M, Ink::faint(self.line, 0.8)));
        scene.add_path(sole(middle, 0.0, FOOT_M, false), true, faint);
        let below = middle - Vec2::new(0.0, 0.5 * FOOT_M + 0.035);
        let lettering = Lettering::new(below, Anchor::Middle, 0.03, ink);
        scene.add_text(lettering, format_args!("{:.0} cm", 100.0 * FOOT_M));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot_scene::scene::Mark;

    fn drawn(corner: Vec2) -> Scene {
        let mut scene = Scene::new();
        let (line, chosen) = (Colour::rgb(255, 255, 255), Colour::rgb(255, 230, 0));
        AlignmentMarks { line, chosen, corner }.draw(&mut scene, &Geometry::default());
        scene
    }

    #[test]
    fn every_edge_between_tiles_is_drawn_from_side_to_side() {
        let (geometry, scene) = (Geometry::default(), drawn(Vec2::ZERO));
        let (size, pitch_m) = (geometry.bounds().size(), geometry.pitch_m());
        let lines: Vec<(Vec2, Vec2)> = scene
            .marks()
            .iter()
            .filter_map(|mark| match mark {
                Mark::Path { points, closed: false, .. } => match scene.points(*points) {
                    [from, to] => Some((*from, *to)),
                    _ => None,
                },
                _ => None,
            })
            .collect();
        for at in 0..=6 {
            let Vec2 { x, y } = at as f32 * pitch_m;
            let upright = (Vec2::new(x, 0.0), Vec2::new(x, size.y));
            let across = (Vec2::new(0.0, y), Vec2::new(size.x, y));
            for (from, to) in [upright, across] {
                let is_it = |line: &(Vec2, Vec2)| line.0.distance(from) < 1e-4 && line.1.distance(to) < 1e-4;
                assert!(lines.iter().any(is_it), "{from} to {to}");
            }
        }
        // A cross-hair goes through each corner, along both edges.
        for corner in [Vec2::ZERO, size, Vec2::new(0.0, size.y), Vec2::new(size.x, 0.0)] {
            let through = lines.iter().filter(|(from, to)| (0.5 * (*from + *to)).distance(corner) < 1e-4);
            assert_eq!(through.count(), 2, "{corner}");
        }
    }

    #[test]
    fn the_ring_is_as_wide_as_a_foot_is_long_and_stays_on_the_floor_near_the_selected_corner() {
        let bounds = Geometry::default().bounds();
        for corner in [bounds.min, bounds.max] {
            let scene = drawn(corner);
            let ring = scene.marks().iter().find_map(|mark| match mark {
                Mark::Ellipse { centre, radii, .. } => Some((*centre, *radii)),
                _ => None,
            });
            let (centre, radii) = ring.unwrap();
            assert_eq!(2.0 * radii, Vec2::splat(0.26));
            assert!(bounds.grown(-0.13).contains(centre), "{centre}");
            assert!(centre.distance(corner) < 0.7, "{centre} is far from {corner}");
            assert!(scene.texts().any(|(text, _)| text == "26 cm"));
        }
    }

    #[test]
    fn a_floor_of_one_tile_has_its_ring_in_the_middle() {
        let geometry = Geometry::of_paper_tiles(1, 1).unwrap();
        let (line, chosen) = (Colour::rgb(255, 255, 255), Colour::rgb(255, 230, 0));
        let marks = AlignmentMarks { line, chosen, corner: geometry.bounds().max };
        assert!(marks.foot_at(&geometry).distance(geometry.bounds().centre()) < 1e-4);
    }
}
