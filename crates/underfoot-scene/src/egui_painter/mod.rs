//! Draws a scene with egui: for the window, and for the widget that the crate `underfoot-egui` offers to other apps.

mod batches;
mod fields;
mod fine_line;
mod patches;
mod rounded;
mod transform;
mod warped;

pub use transform::ScreenFromFloor;
pub use warped::paint_warped;

use egui::epaint::{self, CircleShape, EllipseShape, Mesh, PathShape, PathStroke, TextShape};
use egui::{Color32, FontFamily, FontId, Pos2, Rect, Shape, pos2, vec2};
use glam::Vec2;
use smallvec::SmallVec;

use self::batches::Batches;
use self::fields::FieldImages;
use self::fine_line::FineLine;
use self::patches::{BoxLook, Patches};
use self::rounded::{Rounded, on_pixels};
use crate::scene::{Anchor, Ink, Lettering, Mark, Paint, Scene, Stroke, TextPiece, outline_of, pieces};
use underfoot::floor;
use underfoot::layout::Colour;

/// Maximum radius for which egui has textures of discs, in points: two triangles each.
const LARGEST_DISC: f32 = 8.0;

/// The cached textures from frame to frame: one palette for each place where a scene is drawn.
#[derive(Default)]
pub struct Palette {
    line: FineLine,
    fields: FieldImages,
    patches: Patches,
    batches: Batches,
}

/// Draws `scene`, placed by `map`.
pub fn paint(painter: &egui::Painter, palette: &mut Palette, scene: &Scene, map: ScreenFromFloor) {
    palette.fields.begin();
    palette.batches.begin(painter.clip_rect().intersect(map.rect(scene.bounds())));
    let mut brush = Brush { painter, palette, map, points: Vec::new() };
    for mark in scene.marks() {
        brush.mark(scene, mark);
    }
    palette.batches.draw(painter);
    palette.fields.end();
}

/// Converts a colour to egui's type.
#[must_use]
pub fn color(colour: Colour) -> Color32 {
    Color32::from_rgb(colour.red, colour.green, colour.blue)
}

/// Converts an ink with its opacity to egui's colour.
fn ink_color(ink: Ink) -> Color32 {
    let alpha = (ink.opacity.clamp(0.0, 1.0) * 255.0).round() as u8;
    Color32::from_rgba_unmultiplied(ink.colour.red, ink.colour.green, ink.colour.blue, alpha)
}

impl std::fmt::Debug for Palette {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Palette").finish_non_exhaustive()
    }
}

struct Brush<'a> {
    painter: &'a egui::Painter,
    palette: &'a mut Palette,
    map: ScreenFromFloor,
    points: Vec<Pos2>,
}

impl Brush<'_> {
    /// Draws a shape that stays within its bounds.
    fn add(&mut self, shape: impl Into<Shape>) {
        self.palette.batches.add(shape, 0.0);
    }

    fn mark(&mut self, scene: &Scene, mark: &Mark) {
        match mark {
            Mark::Box { area, radius_m, paint } => {
                self.rounded(self.map.rect(*area), radius_m * self.map.scale(), paint);
                self.dashes(scene, mark, paint);
            }
            Mark::Ellipse { centre, radii, paint } => {
                let centre = self.map.point(*centre);
                let radius = vec2(radii.x, radii.y) * self.map.scale();
                let (fill, stroke) = (fill(paint), self.plain_stroke(paint));
                // egui strokes ellipses outside their edge, boxes along it.
                let radius = (radius - egui::Vec2::splat(0.5 * stroke.width)).max(egui::Vec2::splat(0.1));
                if radius.x == radius.y && radius.x > LARGEST_DISC {
                    let area = Rect::from_center_size(centre, 2.0 * radius + egui::Vec2::splat(stroke.width));
                    self.rounded(area, f32::INFINITY, paint);
                } else if radius.x == radius.y {
                    self.add(CircleShape { center: centre, radius: radius.x, fill, stroke });
                } else {
                    self.add(EllipseShape { center: centre, radius, fill, stroke, angle: 0.0 });
                }
                self.dashes(scene, mark, paint);
            }
            Mark::Path { points, closed, paint } => {
                self.points.clear();
                self.points.extend(scene.points(*points).iter().map(|point| self.map.point(*point)));
                if let Some(ink) = paint.fill {
                    self.fan(ink_color(ink));
                }
                let stroke = self.plain_stroke(paint);
                if !closed && FineLine::suits(stroke.width) {
                    let mesh = self.palette.line.mesh(self.painter.ctx(), &self.points, stroke);
                    self.add(Shape::mesh(mesh));
                } else if stroke.width > 0.0 {
                    let stroke = PathStroke::from(stroke);
                    let (points, closed, width) = (self.points.clone(), *closed, stroke.width);
                    let path = PathShape { points, closed, fill: Color32::TRANSPARENT, stroke };
                    // The tip of a sharp corner is some line widths long.
                    self.palette.batches.add(path, 4.0 * width);
                }
                self.dashes(scene, mark, paint);
            }
            Mark::Field { area, columns, inks } => self.field(*area, *columns, scene.inks(*inks)),
            Mark::Band { points, reach, near, far } => {
                let [near, far] = [near, far].map(|ink| ink_color(*ink));
                self.band(scene.points(*points), *reach, near, far);
            }
            Mark::Text { letters, lettering } => self.text(scene.letters(*letters), lettering),
            Mark::Halo { area, radius_m, reach_m, ink } => {
                let (scale, pixels) = (self.map.scale(), self.pixels_per_point());
                let (rect, radius) = (on_pixels(self.map.rect(*area), 0.0, pixels), radius_m * scale);
                let (reach, ink) = (reach_m * scale, ink_color(*ink));
                let look = BoxLook::halo(radius, reach, ink, pixels);
                let mesh = self.palette.patches.mesh(self.painter.ctx(), rect, look).unwrap_or_else(|| {
                    let mut mesh = Mesh::default();
                    Rounded::new(rect, radius, pixels).halo(&mut mesh, reach, ink);
                    mesh
                });
                self.add(Shape::mesh(mesh));
            }
        }
    }

    fn pixels_per_point(&self) -> f32 {
        self.painter.pixels_per_point()
    }

    /// A box with round corners; an infinite radius makes a circle.
    fn rounded(&mut self, rect: Rect, radius: f32, paint: &Paint) {
        let (fill, stroke) = (fill(paint), self.plain_stroke(paint));
        let is_round = radius == f32::INFINITY;
        let rect = if is_round { rect } else { on_pixels(rect, stroke.width, self.pixels_per_point()) };
        if !is_round {
            let radius = radius.min(0.5 * rect.size().min_elem()).max(0.0);
            let look = BoxLook::filled(radius, fill, stroke, self.pixels_per_point());
            if let Some(mesh) = self.palette.patches.mesh(self.painter.ctx(), rect, look) {
                self.add(Shape::mesh(mesh));
                return;
            }
        }
        let shape = Rounded::new(rect, radius, self.pixels_per_point());
        let mut mesh = Mesh::default();
        if fill != Color32::TRANSPARENT {
            let edge_is_hidden = stroke.width * self.pixels_per_point() >= 1.0 && stroke.color.a() >= 150;
            shape.fill(&mut mesh, fill, edge_is_hidden);
        }
        if stroke.width > 0.0 {
            shape.stroke(&mut mesh, stroke);
        }
        if !mesh.is_empty() {
            self.add(Shape::mesh(mesh));
        }
    }

    /// A rectangle of varying colour: an image with one pixel for each point of its grid, scaled up.
    fn field(&mut self, area: floor::Rect, columns: u32, inks: &[Ink]) {
        let size = [columns as usize, inks.len() / columns as usize];
        let colors = inks.iter().map(|ink| ink_color(*ink));
        let texture = self.palette.fields.show(self.painter.ctx(), size, colors);
        // From the middle of the outermost pixels; rows begin in the south.
        let margin = vec2(0.5 / size[0] as f32, 0.5 / size[1] as f32);
        let (west, east, south, north) = (margin.x, 1.0 - margin.x, margin.y, 1.0 - margin.y);
        let uv = Rect::from_min_max(pos2(west, north), pos2(east, south));
        self.add(Shape::image(texture, self.map.rect(area), uv, Color32::WHITE));
    }

    /// The area between a line and the same line moved by `reach`.
    fn band(&mut self, points: &[Vec2], reach: Vec2, near: Color32, far: Color32) {
        let mut mesh = Mesh::default();
        for (at, point) in (0..).zip(points) {
            mesh.colored_vertex(self.map.point(*point), near);
            mesh.colored_vertex(self.map.point(*point + reach), far);
            if at > 0 {
                let first = 2 * at - 2;
                mesh.add_triangle(first, first + 1, first + 2);
                mesh.add_triangle(first + 1, first + 3, first + 2);
            }
        }
        self.add(Shape::mesh(mesh));
    }

    /// The interior of a path, as triangles around the mean of its points.
    fn fan(&mut self, color: Color32) {
        let count = self.points.len() as u32;
        let sum = self.points.iter().fold(egui::Vec2::ZERO, |sum, point| sum + point.to_vec2());
        let mut mesh = Mesh::default();
        mesh.colored_vertex((sum / count as f32).to_pos2(), color);
        for (at, point) in (0..count).zip(&self.points) {
            mesh.colored_vertex(*point, color);
            mesh.add_triangle(0, at + 1, (at + 1) % count + 1);
        }
        self.add(Shape::mesh(mesh));
    }

    fn stroke(&self, stroke: &Stroke) -> egui::Stroke {
        // A thinner line would fade away.
        egui::Stroke::new((stroke.width_m * self.map.scale()).max(0.7), ink_color(stroke.ink))
    }

    /// The outline, unless it is dashed.
    fn plain_stroke(&self, paint: &Paint) -> egui::Stroke {
        match &paint.stroke {
            Some(stroke) if stroke.dash.is_none() => self.stroke(stroke),
            _ => egui::Stroke::NONE,
        }
    }

    /// Draws the outline if it is dashed.
    fn dashes(&mut self, scene: &Scene, mark: &Mark, paint: &Paint) {
        let Some((stroke, (on, off))) = paint.stroke.and_then(|stroke| Some((stroke, stroke.dash?))) else {
            return;
        };
        let (map, scale) = (self.map, self.map.scale());
        self.points.clear();
        outline_of(scene, mark, |point| self.points.push(map.point(point)));
        let dashes = Shape::dashed_line(&self.points, self.stroke(&stroke), on * scale, off * scale);
        dashes.into_iter().for_each(|dash| self.add(dash));
    }

    fn text(&mut self, letters: &str, lettering: &Lettering) {
        // Quarter steps keep the glyph atlas small while the window is resized.
        let size = (lettering.size_m * self.map.scale() * 4.0).floor() / 4.0;
        if size < 3.0 {
            return;
        }
        let color = ink_color(lettering.ink);
        let font = FontId::new(size, FontFamily::Proportional);
        let set = |piece: TextPiece<'_>| {
            let galley = self.painter.layout_no_wrap(piece.text.into_owned(), font.clone(), color);
            // Each piece may have its own font; all share one base line.
            let base = galley.rows.first().and_then(|row| row.glyphs.first()).map_or(size, |it| it.pos.y);
            (galley, base)
        };
        let pieces: SmallVec<[_; 1]> = pieces(letters, lettering.direction).into_iter().map(set).collect();
        let width: f32 = pieces.iter().map(|(galley, _)| galley.size().x).sum();
        let mut along = match lettering.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * width,
            Anchor::End => -width,
        };
        // egui rotates clockwise and about the upper left corner.
        let turn = epaint::emath::Rot2::from_angle(-lettering.turn_rad);
        for (galley, base) in pieces {
            let corner = turn * vec2(along, -base);
            along += galley.size().x;
            let mut shape = TextShape::new(self.map.point(lettering.at) + corner, galley, color);
            shape.angle = -lettering.turn_rad;
            if lettering.strong {
                // The font has one weight; drawing the text twice makes its soft edges heavier.
                self.add(shape.clone());
            }
            self.add(shape);
        }
    }
}

fn fill(paint: &Paint) -> Color32 {
    paint.fill.map_or(Color32::TRANSPARENT, ink_color)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::sample::{at_rest, map, others, step_on};
    use crate::scene::{self, Show, Theme, View};

    /// Number of draw calls for a page of `count` controls with all layers and one foot.
    fn draw_calls(count: usize) -> usize {
        let (mut layout, geometry) = (map(), floor::Geometry::default());
        let shipped = std::mem::take(&mut layout.widgets);
        let kinds = shipped.iter().map(|widget| widget.behaviour.clone()).chain(others());
        let kinds: Vec<_> = kinds.collect();
        layout.widgets.extend(kinds.iter().cycle().take(count).enumerate().map(|(number, behaviour)| {
            let corner = Vec2::new((number % 10) as f32, (number / 10) as f32) * 0.18;
            let area = floor::Rect::from_min_size(corner + 0.01, Vec2::splat(0.15));
            let behaviour = behaviour.clone();
            underfoot::layout::Widget { area, behaviour, ..shipped[0].clone() }
        }));
        let mut snapshot = at_rest(&layout);
        step_on(&mut snapshot, 1, Vec2::new(0.9, 0.9), 400.0, Vec2::X);
        let mut show = Show::WINDOW;
        Show::LAYERS.iter().for_each(|(_, layer)| *layer(&mut show) = true);
        let mut scene = Scene::new();
        let view = View { show, ..View::new(&geometry, &layout, &snapshot, &Theme::LIGHT) };
        scene::draw(&mut scene, &view);
        let screen = Rect::from_min_size(Pos2::ZERO, egui::Vec2::splat(1000.0));
        let map = ScreenFromFloor::fit(scene.bounds(), screen);
        let input = egui::RawInput { screen_rect: Some(screen), ..Default::default() };
        let (ctx, mut palette) = (egui::Context::default(), Palette::default());
        let mut output = ctx.run_ui(input, |ui| paint(ui.painter(), &mut palette, &scene, map));
        output.textures_delta.clear();
        ctx.tessellate(output.shapes, 1.0).len()
    }

    #[test]
    fn a_hundred_controls_take_fewer_draw_calls_than_controls() {
        let (few, many) = (draw_calls(20), draw_calls(100));
        assert!(few < 25 && many < 50, "{few} for twenty, {many} for a hundred");
    }

    /// The texts that are drawn for one line, from left to right, with the positions of their base lines.
    fn painted(text: &str, lettering: Lettering) -> Vec<(String, Pos2)> {
        let mut scene = Scene::new();
        scene.clear(floor::Rect::from_min_size(Vec2::ZERO, Vec2::ONE), Colour::rgb(0, 0, 0));
        scene.add_text(lettering, format_args!("{text}"));
        let screen = Rect::from_min_size(Pos2::ZERO, egui::Vec2::splat(1000.0));
        let map = ScreenFromFloor::fit(scene.bounds(), screen);
        let mut palette = Palette::default();
        let input = egui::RawInput { screen_rect: Some(screen), ..Default::default() };
        let mut output = egui::Context::default().run_ui(input, |ui| {
            paint(ui.painter(), &mut palette, &scene, map);
        });
        output.textures_delta.clear();
        let texts = output.shapes.iter().filter_map(|shape| match &shape.shape {
            Shape::Text(text) => {
                let base = text.galley.rows.first()?.glyphs.first()?.pos.y;
                Some((text.galley.job.text.clone(), text.pos + vec2(0.0, base)))
            }
            _ => None,
        });
        let mut texts: Vec<_> = texts.collect();
        texts.sort_by(|one, other| one.1.x.total_cmp(&other.1.x));
        texts
    }

    fn lettering(anchor: Anchor) -> Lettering {
        Lettering::new(Vec2::splat(0.5), anchor, 0.04, Ink::solid(Colour::rgb(255, 255, 255)))
    }

    #[test]
    fn words_from_the_right_are_painted_so_with_numbers_as_they_are() {
        let texts = painted("חדר בית 12", lettering(Anchor::Middle));
        let words: Vec<&str> =
            texts.iter().map(|(text, _)| text.trim()).filter(|text| !text.is_empty()).collect();
        assert_eq!(words, ["12", "בית", "חדר"]);
        assert!(
            texts.iter().all(|(_, at)| (at.y - texts[0].1.y).abs() < 0.01),
            "on one base line: {texts:?}"
        );
        assert!((texts[0].1.y - 500.0).abs() < 1.0, "at the place asked for: {texts:?}");
    }

    #[test]
    fn a_line_of_several_pieces_is_anchored_as_a_whole() {
        let start = painted("Go בית now", lettering(Anchor::Start));
        let end = painted("Go בית now", lettering(Anchor::End));
        let width = start[0].1.x - end[0].1.x;
        assert!((start[0].1.x - 500.0).abs() < 1.0 && width > 100.0, "{start:?} {end:?}");
        let middle = painted("Go בית now", lettering(Anchor::Middle));
        assert!((middle[0].1.x - (500.0 - 0.5 * width)).abs() < 1.0, "{middle:?}");
    }

    #[test]
    fn a_latin_line_is_one_text() {
        assert_eq!(painted("Zoom 12 %", lettering(Anchor::Start)).len(), 1);
    }
}
