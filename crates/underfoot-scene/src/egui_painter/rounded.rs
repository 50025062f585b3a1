//! Boxes with round corners as few triangles.
//!
//! Without a graphics card, each triangle costs as much as a hundred pixels. egui draws each quarter circle in eight
//! steps and each edge with a separate soft border; on a page of a hundred controls that is more than half of the
//! frame.

use std::f32::consts::FRAC_PI_2;

use egui::epaint::{Color32, Mesh};
use egui::{Pos2, Rect, Stroke, Vec2, pos2};

/// The outline of a rounded box.
pub(super) struct Rounded {
    /// Clockwise from the right end of its upper side, for each point of the outline: the centre of its corner's
    /// circle, the outward direction of the corner, and the direction from the centre to the point.
    rim: Vec<(Pos2, Vec2, Vec2)>,
    radius: f32,
    /// Width of a soft edge, in points: one pixel.
    soft: f32,
}

impl Rounded {
    /// A box with corners of `radius` points, on a screen with `pixels_per_point`.
    pub(super) fn new(rect: Rect, radius: f32, pixels_per_point: f32) -> Self {
        let soft = 1.0 / pixels_per_point;
        let radius = radius.clamp(0.0, 0.5 * rect.size().min_elem().max(0.0));
        let steps = steps(radius * pixels_per_point);
        let core = rect.shrink(radius);
        let corners = [core.right_top(), core.right_bottom(), core.left_bottom(), core.left_top()];
        let rim = corners.into_iter().zip(OUT).zip(0_u8..).flat_map(|((corner, out), quarter)| {
            (0..=steps).map(move |step| {
                let turn = f32::from(quarter) - 1.0 + step as f32 / steps as f32;
                (corner, out, Vec2::angled(FRAC_PI_2 * turn))
            })
        });
        Self { rim: rim.collect(), radius, soft }
    }

    /// The outline, moved outwards by `off` points.
    fn at(&self, off: f32) -> impl Iterator<Item = Pos2> {
        let reach = self.radius + off;
        // Inside the centre of its circle, a corner is a sharp one.
        self.rim.iter().map(move |(corner, out, way)| *corner + reach.max(0.0) * *way + reach.min(0.0) * *out)
    }

    /// Fills the box. A line along the edge makes a soft edge of the filling unnecessary.
    pub(super) fn fill(&self, mesh: &mut Mesh, color: Color32, edge_is_hidden: bool) {
        let inset = if edge_is_hidden { 0.0 } else { -0.5 * self.soft };
        let first = mesh.vertices.len() as u32;
        self.at(inset).for_each(|point| mesh.colored_vertex(point, color));
        // In strips from right to left, from top to bottom: slivers from one point would touch every pixel several
        // times.
        let count = self.rim.len() as u32;
        let half = count / 2;
        // The first half of the rim goes down the right side, the second half up the left side.
        for row in 0..half - 1 {
            let (right, below) = (first + row, first + row + 1);
            let (left, left_below) = (first + count - 1 - row, first + count - 2 - row);
            mesh.add_triangle(right, below, left);
            mesh.add_triangle(below, left_below, left);
        }
        if !edge_is_hidden {
            self.ring(mesh, (inset, color), (-inset, Color32::TRANSPARENT));
        }
    }

    /// Draws a line along the edge, half of it on each side.
    pub(super) fn stroke(&self, mesh: &mut Mesh, stroke: Stroke) {
        let Stroke { width, color } = stroke;
        let clear = Color32::TRANSPARENT;
        if width <= 1.6 * self.soft {
            // A triangular profile over `half` on each side, with the peak min(width / half, 1): up to one pixel, it
            // has the line's total ink.
            let half = 0.5 * (width + self.soft);
            let peak = color.gamma_multiply((width / half).min(1.0));
            self.ring(mesh, (-half, clear), (0.0, peak));
            self.ring(mesh, (0.0, peak), (half, clear));
        } else {
            let (inner, outer) = (0.5 * (width - self.soft), 0.5 * (width + self.soft));
            self.ring(mesh, (-outer, clear), (-inner, color));
            self.ring(mesh, (-inner, color), (inner, color));
            self.ring(mesh, (inner, color), (outer, clear));
        }
    }

    /// Draws a shade around the box that fades out linearly within `reach` points.
    pub(super) fn halo(&self, mesh: &mut Mesh, reach: f32, color: Color32) {
        self.ring(mesh, (0.0, color), (reach, Color32::TRANSPARENT));
    }

    /// Draws the area between two lines along the edge, each at its distance outside the edge and with its own
    /// colour.
    fn ring(&self, mesh: &mut Mesh, inner: (f32, Color32), outer: (f32, Color32)) {
        let first = mesh.vertices.len() as u32;
        for (near, far) in self.at(inner.0).zip(self.at(outer.0)) {
            mesh.colored_vertex(near, inner.1);
            mesh.colored_vertex(far, outer.1);
        }
        let count = self.rim.len() as u32;
        for at in 0..count {
            let (here, next) = (first + 2 * at, first + 2 * ((at + 1) % count));
            mesh.add_triangle(here, here + 1, next);
            mesh.add_triangle(here + 1, next + 1, next);
        }
    }
}

/// The outward directions of the corners, clockwise from the upper right.
const OUT: [Vec2; 4] =
    [Vec2::new(1.0, -1.0), Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0)];

/// Number of steps of a quarter circle for a deviation of at most a seventh of a pixel.
fn steps(radius_px: f32) -> usize {
    // The sagitta of an arc of pi / 2n is r (1 - cos(pi / 4n)), about 0.31 r / n^2.
    ((0.31 * radius_px / 0.14).sqrt().ceil() as usize).clamp(1, 24)
}

/// `rect` with its sides on pixel edges, or on pixel centres under a line of an odd number of pixels.
pub(super) fn on_pixels(rect: Rect, stroke: f32, pixels_per_point: f32) -> Rect {
    let is_odd = (stroke * pixels_per_point).round() as u32 % 2 == 1;
    let shift = if is_odd { 0.5 } else { 0.0 };
    let to = |x: f32| ((x * pixels_per_point - shift).round() + shift) / pixels_per_point;
    Rect::from_min_max(pos2(to(rect.min.x), to(rect.min.y)), pos2(to(rect.max.x), to(rect.max.y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ink of a mesh, in square points of full opacity.
    fn ink(mesh: &Mesh) -> f32 {
        let area = |corners: &[u32]| {
            let [a, b, c] = [0, 1, 2].map(|at| mesh.vertices[corners[at] as usize]);
            let (ab, ac) = (b.pos - a.pos, c.pos - a.pos);
            let opacity =
                [a, b, c].map(|vertex| f32::from(vertex.color.a()) / 255.0).iter().sum::<f32>() / 3.0;
            0.5 * (ab.x * ac.y - ab.y * ac.x).abs() * opacity
        };
        mesh.indices.chunks(3).map(area).sum()
    }

    const RECT: Rect = Rect { min: pos2(10.0, 20.0), max: pos2(110.0, 80.0) };

    fn drawn(radius: f32, draw: impl Fn(&Rounded, &mut Mesh)) -> Mesh {
        let mut mesh = Mesh::default();
        draw(&Rounded::new(RECT, radius, 1.0), &mut mesh);
        mesh
    }

    #[test]
    fn boxes_cover_what_they_should() {
        for radius in [0.0_f32, 4.0, 15.0, 30.0, 900.0] {
            let round = radius.min(30.0);
            let area = 6000.0 - (4.0 - std::f32::consts::PI) * round * round;
            for hidden in [true, false] {
                let filled = ink(&drawn(radius, |it, mesh| it.fill(mesh, Color32::WHITE, hidden)));
                assert!((filled - area).abs() < 0.004 * area, "{radius}: {filled} of {area}");
            }
            let around = 320.0 - (8.0 - 2.0 * std::f32::consts::PI) * round;
            for width in [0.7, 1.0, 2.0, 6.0] {
                let stroke = Stroke::new(width, Color32::WHITE);
                let inked = ink(&drawn(radius, |it, mesh| it.stroke(mesh, stroke)));
                assert!((inked - around * width).abs() < 0.03 * around * width, "{radius} {width}: {inked}");
            }
            let shade = ink(&drawn(radius, |it, mesh| it.halo(mesh, 9.0, Color32::WHITE)));
            assert!(shade > 0.5 * 9.0 * around, "{shade}");
        }
    }

    #[test]
    fn a_controls_face_takes_few_triangles() {
        let mesh = drawn(15.0, |it, mesh| {
            it.halo(mesh, 9.0, Color32::BLACK);
            it.fill(mesh, Color32::WHITE, true);
            it.stroke(mesh, Stroke::new(1.1, Color32::BLACK));
        });
        assert!(mesh.indices.len() / 3 < 250, "{}", mesh.indices.len() / 3);
    }

    #[test]
    fn edges_lie_on_pixels() {
        let rect = Rect::from_min_max(pos2(0.3, 0.3), pos2(9.6, 9.6));
        assert_eq!(on_pixels(rect, 0.0, 1.0), Rect::from_min_max(pos2(0.0, 0.0), pos2(10.0, 10.0)));
        assert_eq!(on_pixels(rect, 1.0, 1.0), Rect::from_min_max(pos2(0.5, 0.5), pos2(9.5, 9.5)));
    }
}
