//! Shapes in groups of one texture each.

use egui::{Painter, Rect, Shape, TextureId};

/// Number of cells along each side of the area.
const CELLS: usize = 192;

/// Reach of soft edges beyond the bounds of a shape, in points.
const SOFT: f32 = 1.0;

/// Shapes in drawing order, in as few groups of one texture as the order allows.
///
/// Each change of the texture is a draw call with buffers of its own. So a shape joins an earlier group of its
/// texture, unless a group after that one draws at the same place. The picture stays the same.
pub(super) struct Batches {
    area: Rect,
    /// For each cell of the area, row by row, the last group that draws there; 0 for none.
    last: Vec<u32>,
    groups: Vec<OneTexture>,
}

struct OneTexture {
    texture: TextureId,
    shapes: Vec<Shape>,
}

impl Default for Batches {
    fn default() -> Self {
        Self { area: Rect::NOTHING, last: Vec::new(), groups: Vec::new() }
    }
}

impl Batches {
    /// Starts a drawing, most of which is within `area`.
    pub(super) fn begin(&mut self, area: Rect) {
        self.area = area;
        self.groups.clear();
        self.last.clear();
        self.last.resize(CELLS * CELLS, 0);
    }

    /// Adds a shape that draws at most `beyond` points outside its bounds, over all earlier ones.
    pub(super) fn add(&mut self, shape: impl Into<Shape>, beyond: f32) {
        let shape = shape.into();
        let texture = shape.texture_id();
        let area = self.cells(shape.visual_bounding_rect().expand(beyond + SOFT));
        let first = area.rows(&mut self.last).flatten().map(|last| *last).max().unwrap_or(0);
        let mut later = self.groups.iter().enumerate().skip(first as usize);
        let joined = later.find(|(_, group)| group.texture == texture).map(|(at, _)| at);
        let at = joined.unwrap_or_else(|| {
            self.groups.push(OneTexture { texture, shapes: Vec::new() });
            self.groups.len() - 1
        });
        area.rows(&mut self.last).for_each(|row| row.fill(at as u32));
        if let Some(group) = self.groups.get_mut(at) {
            group.shapes.push(shape);
        }
    }

    /// Draws the shapes.
    pub(super) fn draw(&mut self, painter: &Painter) {
        for group in self.groups.drain(..) {
            painter.extend(group.shapes);
        }
    }

    /// The cells that `bounds` touches; those of the rim stand for all places outside the area.
    fn cells(&self, bounds: Rect) -> CellBlock {
        let cell = |share: f32| ((share * CELLS as f32).max(0.0) as usize).min(CELLS - 1);
        let column = |x: f32| cell((x - self.area.left()) / self.area.width().max(1.0));
        let row = |y: f32| cell((y - self.area.top()) / self.area.height().max(1.0));
        CellBlock {
            columns: (column(bounds.left()), column(bounds.right())),
            rows: (row(bounds.top()), row(bounds.bottom())),
        }
    }
}

/// A rectangle of cells: the first and the last column and row.
#[derive(Clone, Copy)]
struct CellBlock {
    columns: (usize, usize),
    rows: (usize, usize),
}

impl CellBlock {
    /// These cells in `all`, row by row; none if they end before they begin.
    fn rows(self, all: &mut [u32]) -> impl Iterator<Item = &mut [u32]> {
        let (columns, (first, last)) = (self.columns, self.rows);
        let rows = all.chunks_exact_mut(CELLS).take(last + 1).skip(first);
        rows.filter_map(move |row| row.get_mut(columns.0..=columns.1))
    }
}

#[cfg(test)]
mod tests {
    use egui::epaint::Mesh;
    use egui::{Color32, Pos2, Vec2, pos2, vec2};
    use proptest::prelude::*;

    use super::*;

    const AREA: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(600.0, 600.0) };

    /// A rectangle with one of the textures; its colour is its number.
    fn shape(number: u8, texture: u64, rect: Rect) -> Shape {
        let mut mesh = Mesh::with_texture(TextureId::User(texture));
        mesh.add_rect_with_uv(rect, Rect::ZERO, Color32::from_gray(number));
        Shape::mesh(mesh)
    }

    /// The numbers of `shapes` in the order in which they are drawn, and the number of groups.
    fn drawn(shapes: impl Iterator<Item = Shape>) -> (Vec<u8>, usize) {
        let mut batches = Batches::default();
        batches.begin(AREA);
        shapes.for_each(|shape| batches.add(shape, 0.0));
        let all = batches.groups.iter().flat_map(|group| &group.shapes);
        let number = |shape: &Shape| match shape {
            Shape::Mesh(mesh) => mesh.vertices[0].color.r(),
            _ => panic!("no mesh"),
        };
        (all.map(number).collect(), batches.groups.len())
    }

    #[test]
    fn controls_beside_each_other_take_the_draw_calls_of_one() {
        let controls = (0..50_u8).flat_map(|control| {
            let corner = pos2(60.0 * f32::from(control % 10), 60.0 * f32::from(control / 10));
            let face = Rect::from_min_size(corner, Vec2::splat(50.0));
            [(1, face), (2, face.shrink(10.0)), (1, face.shrink(15.0)), (3, face.shrink(20.0))]
        });
        let (order, groups) = drawn(controls.map(|(texture, rect)| shape(0, texture, rect)));
        assert_eq!((order.len(), groups), (200, 4));
    }

    #[test]
    fn an_area_of_no_size_and_shapes_of_no_place_are_drawn_in_order() {
        let mut batches = Batches::default();
        batches.begin(Rect::NOTHING);
        for rect in [Rect::NAN, Rect::NOTHING, Rect::EVERYTHING, Rect::ZERO] {
            batches.add(shape(0, 1, rect), 0.0);
        }
        assert_eq!(batches.groups.iter().map(|group| group.shapes.len()).sum::<usize>(), 4);
    }

    proptest! {
        #[test]
        fn what_covers_another_stays_over_it(
            boxes in prop::collection::vec((0..3_u64, -50..650_i16, -50..650_i16, 1..200_i16, 1..200_i16), 1..100)
        ) {
            let rect = |at: usize| {
                let (_, x, y, width, height) = boxes[at];
                let corner: Pos2 = pos2(f32::from(x), f32::from(y));
                Rect::from_min_size(corner, vec2(f32::from(width), f32::from(height)))
            };
            let all = (0..boxes.len()).map(|at| shape(at as u8, boxes[at].0, rect(at)));
            let (order, _) = drawn(all);
            prop_assert_eq!(order.len(), boxes.len());
            for (place, above) in order.iter().enumerate() {
                for below in order.iter().take(place) {
                    let covers = rect(usize::from(*above)).intersects(rect(usize::from(*below)));
                    prop_assert!(below < above || !covers, "{below} under {above}");
                }
            }
        }
    }
}
