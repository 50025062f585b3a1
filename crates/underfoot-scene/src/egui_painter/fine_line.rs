//! Lines with soft edges, as textured meshes.

use egui::epaint::{Mesh, Vertex};
use egui::{
    self, Color32, ColorImage, Pos2, Stroke, TextureHandle, TextureId, TextureOptions, Vec2, pos2, vec2,
};

/// Maximum width of a line that is drawn as a textured strip, in points.
const WIDEST: f32 = 12.0;

/// Margin of the texture beyond the edges of a line, in points: the reach of soft edges.
const SOFT: f32 = 1.0;

/// Texture size: pixels across a line, and number of different widths.
const ACROSS: usize = 64;
const WIDTHS: usize = 64;

/// Mitre limit: maximum distance of a corner's tip, in half widths.
const MITRE: f32 = 2.0;

/// Draws each fine line as one strip of triangles with the texture of a line.
///
/// egui draws soft edges as separate triangles beside those of the line, which is three times the work. That matters
/// for thousands of lines, and for the arcs of dials, without a graphics card.
#[derive(Default)]
pub(super) struct FineLine {
    profile: Option<TextureHandle>,
}

impl FineLine {
    /// Whether lines of this width, in points, look good as a textured strip.
    pub(super) fn suits(width: f32) -> bool {
        width > 0.0 && width <= WIDEST
    }

    /// An open line through `points`; empty for less than two points.
    pub(super) fn mesh(&mut self, ctx: &egui::Context, points: &[Pos2], stroke: Stroke) -> Mesh {
        let profile = self
            .profile
            .get_or_insert_with(|| ctx.load_texture("fine lines", profile(), TextureOptions::LINEAR));
        strip(profile.id(), points, stroke)
    }
}

/// The share of a pixel at the distance `away` from the middle of a line of this width that the line covers.
fn coverage(width: f32, away: f32) -> f32 {
    let (half, low, high) = (0.5 * width, away - 0.5, away + 0.5);
    (high.min(half) - low.max(-half)).clamp(0.0, 1.0)
}

/// The texture: across a line from left to right, and from width 0 to the maximum width from top to bottom.
fn profile() -> ColorImage {
    let dots = (0..WIDTHS).flat_map(|row| {
        let width = WIDEST * row as f32 / (WIDTHS - 1) as f32;
        (0..ACROSS).map(move |column| {
            let share = (column as f32 + 0.5) / ACROSS as f32 - 0.5;
            let covered = coverage(width, share * (width + 2.0 * SOFT));
            Color32::from_white_alpha((255.0 * covered).round() as u8)
        })
    });
    ColorImage::new([ACROSS, WIDTHS], dots.collect())
}

fn strip(profile: TextureId, points: &[Pos2], Stroke { width, color }: Stroke) -> Mesh {
    let mut mesh = Mesh::with_texture(profile);
    if points.len() < 2 {
        return mesh;
    }
    mesh.reserve_vertices(2 * points.len());
    mesh.reserve_triangles(2 * points.len());
    let row = (width / WIDEST * (WIDTHS - 1) as f32 + 0.5) / WIDTHS as f32;
    let half = 0.5 * width + SOFT;
    let way = |from: usize, to: usize| match (points.get(from), points.get(to)) {
        (Some(from), Some(to)) => (*to - *from).normalized(),
        _ => Vec2::ZERO,
    };
    for (at, point) in points.iter().enumerate() {
        let before = if at > 0 { way(at - 1, at) } else { Vec2::ZERO };
        let aside = half * mitre(before, way(at, at + 1));
        mesh.vertices.push(Vertex { pos: *point - aside, uv: pos2(0.0, row), color });
        mesh.vertices.push(Vertex { pos: *point + aside, uv: pos2(1.0, row), color });
    }
    for first in (0..2 * points.len() as u32 - 2).step_by(2) {
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first + 1, first + 3, first + 2);
    }
    mesh
}

/// The offset from a corner to its edge, for edges at distance 1 from both directions: of length 1 / cos(half the
/// turn), at most `MITRE`.
fn mitre(before: Vec2, after: Vec2) -> Vec2 {
    let along = (before + after).normalized();
    let across = vec2(-along.y, along.x);
    // The cosine of half the turn; a direction of length zero counts as straight on.
    let straight = along.dot(if before == Vec2::ZERO { after } else { before });
    if across == Vec2::ZERO { vec2(-before.y, before.x) } else { across / straight.max(1.0 / MITRE) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_covers_as_much_as_it_is_wide() {
        let image = profile();
        for (row, dots) in image.pixels.chunks(ACROSS).enumerate() {
            let width = WIDEST * row as f32 / (WIDTHS - 1) as f32;
            let each = (width + 2.0 * SOFT) / ACROSS as f32;
            let covered: f32 = dots.iter().map(|dot| f32::from(dot.a()) / 255.0 * each).sum();
            assert!((covered - width).abs() < 0.03, "{covered} of {width}");
        }
    }

    #[test]
    fn a_strip_keeps_its_width_around_corners_and_never_sticks_out_far() {
        let stroke = Stroke::new(1.0, Color32::WHITE);
        let points = [pos2(0.0, 0.0), pos2(10.0, 0.0), pos2(10.0, 10.0), pos2(10.0, 10.0), pos2(10.5, 0.0)];
        let mesh = strip(TextureId::default(), &points, stroke);
        assert_eq!((mesh.vertices.len(), mesh.indices.len()), (10, 24));
        let width = |at: usize| mesh.vertices[2 * at].pos.distance(mesh.vertices[2 * at + 1].pos);
        assert_eq!(width(0), 3.0);
        assert!((width(1) - 3.0 * 2_f32.sqrt()).abs() < 1e-3, "a right angle");
        assert!((2..5).all(|at| (2.9..=6.1).contains(&width(at))), "{:?}", mesh.vertices);
        assert!(strip(TextureId::default(), &points[..1], stroke).is_empty());
    }
}
