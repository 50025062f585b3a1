//! Boxes with round corners as nine pieces of a small texture each.
//!
//! Without a graphics card, a triangle costs as much as a hundred pixels, and the soft edge of a round corner takes
//! dozens of triangles. As a textured piece it takes two. One texture holds a box's corners, one pixel of each side
//! and one of its inside, which are stretched, for all boxes with the same look, whatever their size.

use std::collections::HashMap;

use egui::epaint::Mesh;
use egui::{Color32, ColorImage, Context, Rect, Stroke, TextureHandle, TextureOptions, pos2, vec2};

/// Side of the texture, in pixels.
const SIDE: usize = 512;

/// Maximum side of a corner in the texture, in pixels; few boxes have larger ones.
const LARGEST: usize = 48;

/// Resolution of radii and widths, in parts of a pixel.
const PARTS: f32 = 16.0;

/// The look of a box, independent of its size. Lengths are in parts of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct BoxLook {
    radius: u16,
    line: Line,
    fill: Color32,
    color: Color32,
}

/// The edge of a box, in parts of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Line {
    /// A line of this width along the edge, half of it on each side; 0 for none.
    Stroke(u16),
    /// A shade that fades out linearly over this distance.
    Halo(u16),
}

/// The place of a look in the texture: its upper left corner, and the side of one of its corners, in pixels.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: [usize; 2],
    corner: usize,
}

/// The images of boxes, in one texture.
#[derive(Default)]
pub(super) struct Patches {
    texture: Option<TextureHandle>,
    places: HashMap<BoxLook, Place>,
    /// The place of the next image, and the height of its row.
    next: [usize; 2],
    row: usize,
    /// The first frame in which the texture was full. The images of that frame must stay, because it is painted at
    /// its end.
    full_in: Option<u64>,
    /// Whether the images are moved off the pixels after they are drawn.
    pub(super) are_warped: bool,
}

impl BoxLook {
    /// A box with corners of `radius` points, filled, with a line along its edge.
    pub(super) fn filled(radius: f32, fill: Color32, stroke: Stroke, pixels_per_point: f32) -> Self {
        let line = Line::Stroke(if stroke.width > 0.0 { parts(stroke.width * pixels_per_point) } else { 0 });
        Self { radius: parts(radius * pixels_per_point), line, fill, color: stroke.color }
    }

    /// A shade around such a box.
    pub(super) fn halo(radius: f32, reach: f32, color: Color32, pixels_per_point: f32) -> Self {
        let line = Line::Halo(parts(reach * pixels_per_point));
        Self { radius: parts(radius * pixels_per_point), line, fill: Color32::TRANSPARENT, color }
    }

    /// The reach of ink outside the edge, and the depth inside it beyond which the colour is constant, in pixels.
    fn reach(&self) -> (f32, f32) {
        let radius = f32::from(self.radius) / PARTS;
        match self.line {
            Line::Stroke(width) => {
                let half = 0.5 * f32::from(width) / PARTS + 0.5;
                (half, radius.max(half))
            }
            Line::Halo(reach) => (f32::from(reach) / PARTS, radius.max(0.5)),
        }
    }

    /// The depth of ink inside a straight edge without a filling, in pixels.
    fn line_depth(&self) -> f32 {
        match self.line {
            Line::Stroke(width) => 0.5 * f32::from(width) / PARTS + 0.5,
            Line::Halo(_) => 0.0,
        }
    }

    /// The colour of a pixel with its middle `off` pixels outside the edge.
    fn ink(&self, off: f32) -> Color32 {
        let scaled = |color: Color32, share: f32| color.gamma_multiply(share.clamp(0.0, 1.0));
        match self.line {
            Line::Halo(_) if off < 0.0 => Color32::TRANSPARENT,
            Line::Halo(reach) => scaled(self.color, 1.0 - off * PARTS / f32::from(reach.max(1))),
            Line::Stroke(width) => {
                let width = f32::from(width) / PARTS;
                // A triangular profile over `half` pixels on each side, with the peak min(width / half, 1): up to one
                // pixel, it has the line's total ink.
                let half = 0.5 * (width + 1.0);
                let line = if width <= 0.0 {
                    0.0
                } else if width <= 1.6 {
                    (width / half).min(1.0) * (1.0 - off.abs() / half)
                } else {
                    half - off.abs()
                };
                let fill = scaled(self.fill, 0.5 - off);
                over(fill, scaled(self.color, line))
            }
        }
    }

    /// The image: two corners, and between them one pixel for each side.
    fn picture(&self, corner: usize, edge: f32) -> ColorImage {
        let side = 2 * corner + 1;
        let radius = f32::from(self.radius) / PARTS;
        // The distance from the outer edge, the same from both sides.
        let inwards = |at: usize| at.min(side - 1 - at) as f32 + 0.5 - edge;
        let dots = (0..side * side).map(|dot| {
            let (x, y) = (inwards(dot % side), inwards(dot / side));
            let off = if x < radius && y < radius {
                vec2(radius - x, radius - y).length() - radius
            } else {
                -x.min(y)
            };
            self.ink(off)
        });
        ColorImage::new([side, side], dots.collect())
    }
}

/// Composites `above` over `below`.
fn over(below: Color32, above: Color32) -> Color32 {
    let left = 1.0 - f32::from(above.a()) / 255.0;
    let mixed = |below: u8, above: u8| (f32::from(above) + left * f32::from(below)).round() as u8;
    Color32::from_rgba_premultiplied(
        mixed(below.r(), above.r()),
        mixed(below.g(), above.g()),
        mixed(below.b(), above.b()),
        mixed(below.a(), above.a()),
    )
}

/// A length in parts of a pixel.
fn parts(pixels: f32) -> u16 {
    (pixels * PARTS).round() as u16
}

impl Patches {
    /// A box around `rect`, with its sides all on pixel edges or all on pixel centres; `None` if it needs another
    /// method.
    pub(super) fn mesh(&mut self, ctx: &Context, rect: Rect, look: BoxLook) -> Option<Mesh> {
        let scale = ctx.pixels_per_point();
        let (beyond, within) = look.reach();
        // Round to pixel edges or centres, which removes earlier rounding errors.
        let on_halves = |x: f32| 0.5 * (2.0 * x * scale).round();
        let outer = |x: f32| (on_halves(x) - beyond).floor();
        let (left, top) = (outer(rect.left()), outer(rect.top()));
        let (width, height) = (-outer(-rect.right()) - left, -outer(-rect.bottom()) - top);
        let edge = on_halves(rect.left()) - left;
        let corner = (edge + within).ceil();
        if !(width >= 1.0 && height >= 1.0 && corner >= 1.0 && corner <= LARGEST as f32) {
            return None;
        }
        let place = self.place(ctx, look, corner as usize, edge)?;
        let mut mesh = Mesh::with_texture(self.texture.as_ref()?.id());
        let is_hollow = look.ink(-within - 1.0) == Color32::TRANSPARENT;
        let columns = pieces(width, place.corner as f32, place.at[0] as f32);
        let rows = pieces(height, place.corner as f32, place.at[1] as f32);
        let point = |x: f32, y: f32| pos2((left + x) / scale, (top + y) / scale);
        let dot = |u: f32, v: f32| pos2(u / SIDE as f32, v / SIDE as f32);
        // Pixels without ink take as long as others, so the sides of a box without a filling are as deep as its line.
        let deep = if is_hollow { (edge + look.line_depth()).ceil() } else { f32::INFINITY };
        for (row, down) in rows.into_iter().enumerate() {
            for (column, across) in columns.into_iter().enumerate() {
                let is_inside = row == 1 && column == 1;
                let [x, x_end, u, u_end] = if row == 1 { outer_part(across, column, deep) } else { across };
                let [y, y_end, v, v_end] = if column == 1 { outer_part(down, row, deep) } else { down };
                if x_end > x && y_end > y && !(is_inside && is_hollow) {
                    let area = Rect::from_min_max(point(x, y), point(x_end, y_end));
                    let uv = Rect::from_min_max(dot(u, v), dot(u_end, v_end));
                    mesh.add_rect_with_uv(area, uv, Color32::WHITE);
                }
            }
        }
        Some(mesh)
    }

    /// The place of the image of this look; creates the image if necessary.
    fn place(&mut self, ctx: &Context, look: BoxLook, corner: usize, edge: f32) -> Option<Place> {
        let frame = ctx.cumulative_frame_nr();
        if self.full_in.is_some_and(|full| full != frame) {
            self.places.clear();
            (self.next, self.row, self.full_in) = ([0, 0], 0, None);
        }
        if let Some(place) = self.places.get(&look) {
            return Some(*place);
        }
        // One pixel between neighbours keeps them apart where an image is drawn with an offset.
        let side = 2 * corner + 2;
        if self.next[0] + side > SIDE {
            self.next = [0, self.next[1] + self.row];
            self.row = 0;
        }
        if self.next[1] + side > SIDE {
            self.full_in = Some(frame);
            return None;
        }
        let at = self.next;
        self.next[0] += side;
        self.row = self.row.max(side);
        // Images lie on pixels, so nothing needs mixing, which a processor does for each pixel.
        let filter = if self.are_warped { TextureOptions::LINEAR } else { TextureOptions::NEAREST };
        let texture = self.texture.get_or_insert_with(|| {
            let empty = ColorImage::filled([SIDE, SIDE], Color32::TRANSPARENT);
            ctx.load_texture("boxes", empty, filter)
        });
        texture.set_partial(at, look.picture(corner, edge), filter);
        let place = Place { at, corner };
        self.places.insert(look, place);
        Some(place)
    }
}

/// The three pieces along one side of a box `length` pixels long: the ends of its first corner, of the part between,
/// and of its last corner, in pixels and in the image's pixels, which begin at `start`.
fn pieces(length: f32, corner: f32, start: f32) -> [[f32; 4]; 3] {
    // A box smaller than its two corners shows half of each.
    let (first, last) = (corner.min((0.5 * length).ceil()), corner.min((0.5 * length).floor()));
    let (middle, end) = (start + corner + 0.5, start + 2.0 * corner + 1.0);
    [
        [0.0, first, start, start + first],
        [first, length - last, middle, middle],
        [length - last, length, end - last, end],
    ]
}

/// The part of a first or last piece at most `deep` pixels from its outer end; other pieces stay whole.
fn outer_part([from, to, first, last]: [f32; 4], piece: usize, deep: f32) -> [f32; 4] {
    let length = (to - from).min(deep);
    match piece {
        0 => [from, from + length, first, first + length],
        2 => [to - length, to, last - length, last],
        _ => [from, to, first, last],
    }
}

#[cfg(test)]
mod tests {
    use egui::{Pos2, TextureId};

    use super::*;
    use crate::egui_painter::rounded::{Rounded, on_pixels};

    const FILL: Color32 = Color32::from_rgb(40, 90, 160);

    /// The ink of a box drawn as pieces, in square pixels of full opacity.
    fn ink(mesh: &Mesh, picture: &ColorImage, at: [usize; 2]) -> f32 {
        let dot = |uv: Pos2| {
            let at = [0, 1].map(|side| (uv[side] * SIDE as f32 - at[side] as f32) as usize);
            f32::from(picture[(at[0], at[1])].a()) / 255.0
        };
        let quads = mesh.vertices.chunks(4).map(|corners| {
            let (area, uv) = (
                Rect::from_min_max(corners[0].pos, corners[3].pos),
                Rect::from_min_max(corners[0].uv, corners[3].uv),
            );
            let (columns, rows) = (area.width().round() as u16, area.height().round() as u16);
            let share = |at: u16, of: u16| (f32::from(at) + 0.5) / f32::from(of);
            let pixels = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
            pixels
                .map(|(row, column)| dot(uv.lerp_inside(vec2(share(column, columns), share(row, rows)))))
                .sum::<f32>()
        });
        quads.sum()
    }

    fn patches() -> (Context, Patches) {
        let ctx = Context::default();
        frame(&ctx);
        (ctx, Patches::default())
    }

    /// Ends a frame; egui requires that the textures of each frame are taken.
    fn frame(ctx: &Context) {
        ctx.run_ui(egui::RawInput::default(), |_| {}).textures_delta.clear();
    }

    #[test]
    fn pieces_cover_what_the_box_covers() {
        for (radius, width, size) in [
            (0.0, 0.0, (60, 40)),
            (4.0, 0.0, (60, 41)),
            (11.3, 1.0, (68, 68)),
            (20.0, 2.2, (90, 40)),
            (9.5, 3.0, (19, 80)),
        ] {
            let (ctx, mut patches) = patches();
            let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(size.0 as f32, size.1 as f32));
            let rect = on_pixels(rect, width, 1.0);
            let stroke = Stroke::new(width, FILL);
            let look = BoxLook::filled(radius, FILL, stroke, 1.0);
            let mesh = patches.mesh(&ctx, rect, look).unwrap();
            assert!(mesh.indices.len() <= 54 && mesh.texture_id != TextureId::default());
            let (beyond, _) = look.reach();
            let edge = rect.left() - (rect.left() - beyond).floor();
            let picture = look.picture(patches.places[&look].corner, edge);
            let grown = rect.expand(0.5 * width);
            let round = (radius + 0.5 * width) * f32::from(u8::from(radius > 0.0));
            let wanted = grown.area() - (4.0 - std::f32::consts::PI) * round * round;
            let inked = ink(&mesh, &picture, patches.places[&look].at);
            assert!((inked - wanted).abs() < 0.01 * wanted, "{radius} {width}: {inked} of {wanted}");
            frame(&ctx);
        }
    }

    #[test]
    fn boxes_that_look_alike_share_a_picture_and_a_full_texture_begins_anew_with_a_frame() {
        let (ctx, mut patches) = patches();
        let rect = |side: f32| Rect::from_min_size(pos2(3.0, 4.0), vec2(side, side));
        for side in [30.0, 50.0, 400.0] {
            let look = BoxLook::filled(8.0, FILL, Stroke::NONE, 1.0);
            assert!(patches.mesh(&ctx, rect(side), look).is_some());
        }
        assert_eq!(patches.places.len(), 1);
        let other = |number: u8| BoxLook::halo(20.0, 12.0, Color32::from_gray(number), 1.0);
        let drawn =
            (0..=255).take_while(|number| patches.mesh(&ctx, rect(90.0), other(*number)).is_some()).count();
        assert!((30..200).contains(&drawn), "{drawn} fit");
        assert!(patches.mesh(&ctx, rect(90.0), other(255)).is_none(), "what this frame has drawn stays");
        frame(&ctx);
        assert!(patches.mesh(&ctx, rect(90.0), other(255)).is_some());
        assert!(
            patches.mesh(&ctx, rect(300.0), BoxLook::filled(90.0, FILL, Stroke::NONE, 1.0)).is_none(),
            "too large"
        );
        frame(&ctx);
    }

    #[test]
    fn a_halo_draws_little_more_than_its_ink() {
        let (ctx, mut patches) = patches();
        let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(200.0, 200.0));
        let mesh = patches.mesh(&ctx, rect, BoxLook::halo(12.0, 8.0, FILL, 1.0)).unwrap();
        let area: f32 =
            mesh.vertices.chunks(4).map(|it| (it[3].pos.x - it[0].pos.x) * (it[3].pos.y - it[0].pos.y)).sum();
        // Four corners of 20 pixels each way, and four sides of 176 by 8.
        assert_eq!(area, 4.0 * 400.0 + 4.0 * 176.0 * 8.0);
        frame(&ctx);
    }

    #[test]
    fn a_control_takes_a_fifth_of_the_triangles() {
        let (ctx, mut patches) = patches();
        let rect = Rect::from_min_size(pos2(10.0, 10.0), vec2(68.0, 68.0));
        let (stroke, mut plain) = (Stroke::new(1.0, FILL), Mesh::default());
        let shape = Rounded::new(rect, 11.0, 1.0);
        shape.halo(&mut plain, 8.0, FILL);
        shape.fill(&mut plain, FILL, true);
        shape.stroke(&mut plain, stroke);
        let looks = [BoxLook::halo(11.0, 8.0, FILL, 1.0), BoxLook::filled(11.0, FILL, stroke, 1.0)];
        let pieces: usize =
            looks.map(|look| patches.mesh(&ctx, rect, look).unwrap().indices.len()).iter().sum();
        assert!(4 * pieces < plain.indices.len(), "{pieces} of {}", plain.indices.len());
        frame(&ctx);
    }
}
