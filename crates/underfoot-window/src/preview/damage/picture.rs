//! The shapes of one frame, and the areas in which two frames differ.

use std::collections::HashMap;
use std::sync::Arc;

use eframe::egui::Rect;
use eframe::egui::epaint::{ClippedShape, Shape, TextShape, TextureId};

use super::grid::Grid;

/// Reach of soft edges beyond the bounds of a shape, in points.
const SOFT: f32 = 2.0;

/// The shapes of one frame.
///
/// Each has a name, which only shapes that are equal to it have. Each cell of the window folds the names of the shapes
/// that touch it, in their order; so two pictures are equal in a cell if their folds are, wherever else shapes came, went
/// or changed places.
pub(super) struct Picture {
    shapes: Vec<NamedShape>,
    /// The shapes by the bits of their reach, to find equal ones.
    places: HashMap<[u32; 4], Vec<usize>>,
    grid: Grid,
    /// The first name that no shape has.
    free_name: u64,
}

struct NamedShape {
    shape: ClippedShape,
    /// The points that it may touch.
    reach: Rect,
    name: u64,
}

impl Picture {
    /// The picture of these shapes, beside the one `before` it. A shape with one of the `changed` textures has a new name.
    pub(super) fn new(
        shapes: Vec<ClippedShape>,
        (screen, pixels_per_point): (Rect, f32),
        before: Option<&Self>,
        changed: &[TextureId],
    ) -> Self {
        let mut picture = Self {
            shapes: Vec::with_capacity(shapes.len()),
            places: HashMap::new(),
            grid: Grid::new(screen, pixels_per_point),
            free_name: before.map_or(0, |before| before.free_name),
        };
        for shape in shapes {
            let reach = reach(&shape);
            if reach.is_positive() {
                picture.add(shape, reach, before, changed);
            }
        }
        picture
    }

    fn add(&mut self, shape: ClippedShape, reach: Rect, before: Option<&Self>, changed: &[TextureId]) {
        let key = bits(reach);
        let is_kept = !is_of(&shape.shape, changed);
        let name =
            before.filter(|_| is_kept).and_then(|before| before.name_of(&shape, key)).unwrap_or_else(|| {
                self.free_name += 1;
                self.free_name
            });
        self.grid.fold(reach, name);
        self.places.entry(key).or_default().push(self.shapes.len());
        self.shapes.push(NamedShape { shape, reach, name });
    }

    /// The name of a shape, if this picture has it.
    fn name_of(&self, shape: &ClippedShape, key: [u32; 4]) -> Option<u64> {
        let there = self.places.get(&key)?.iter().filter_map(|at| self.shapes.get(*at));
        there.into_iter().find(|it| is_same(&it.shape, shape)).map(|it| it.name)
    }

    /// Areas that do not overlap and cover all differences from another picture: the whole window for one of another size.
    pub(super) fn differences(&self, other: Option<&Self>) -> Vec<Rect> {
        self.grid.differences(other.map(|other| &other.grid))
    }

    /// Whether both pictures have the same size.
    pub(super) fn fits(&self, other: &Self) -> bool {
        self.grid.fits(&other.grid)
    }

    /// The parts of the shapes in `areas`.
    pub(super) fn within(&self, areas: &[Rect]) -> Vec<ClippedShape> {
        let parts = areas.iter().flat_map(|area| {
            self.shapes.iter().filter(|it| it.reach.intersects(*area)).map(|it| {
                let clip_rect = it.shape.clip_rect.intersect(*area);
                ClippedShape { clip_rect, ..it.shape.clone() }
            })
        });
        parts.filter(|part| part.clip_rect.is_positive()).collect()
    }
}

/// The points that a shape may touch: none for text without letters, since its bounds are unknown.
fn reach(shape: &ClippedShape) -> Rect {
    let bounds = shape.shape.visual_bounding_rect();
    if matches!(&shape.shape, Shape::Text(text) if text.galley.mesh_bounds.is_negative()) {
        return Rect::NOTHING;
    }
    shape.transform_after_tessellation.mul_rect(bounds).expand(SOFT).intersect(shape.clip_rect)
}

fn bits(Rect { min, max }: Rect) -> [u32; 4] {
    [min.x, min.y, max.x, max.y].map(f32::to_bits)
}

/// Whether both shapes draw the same. Text that is laid out once and kept is not compared letter by letter.
fn is_same(one: &ClippedShape, other: &ClippedShape) -> bool {
    if one.clip_rect != other.clip_rect
        || one.transform_after_tessellation != other.transform_after_tessellation
    {
        return false;
    }
    match (&one.shape, &other.shape) {
        (Shape::Text(one), Shape::Text(other)) if Arc::ptr_eq(&one.galley, &other.galley) => {
            is_same_way(one, other)
        }
        (Shape::Mesh(one), Shape::Mesh(other)) => Arc::ptr_eq(one, other) || one == other,
        (one, other) => one == other,
    }
}

/// Whether both texts are in the same place and style.
fn is_same_way(one: &TextShape, other: &TextShape) -> bool {
    let way = |text: &TextShape| {
        let TextShape {
            pos,
            galley: _,
            underline,
            fallback_color,
            override_text_color,
            opacity_factor,
            angle,
        } = text;
        (*pos, *underline, *fallback_color, *override_text_color, *opacity_factor, *angle)
    };
    way(one) == way(other)
}

/// Whether the shape shows one of these textures. New letters in the texture of the fonts leave the others as they are.
fn is_of(shape: &Shape, textures: &[TextureId]) -> bool {
    match shape {
        Shape::Vec(shapes) => shapes.iter().any(|shape| is_of(shape, textures)),
        shape => {
            let texture = shape.texture_id();
            texture != TextureId::default() && textures.contains(&texture)
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Color32, CornerRadius, pos2};
    use proptest::prelude::*;

    use super::*;

    /// A picture of whole points: the colour of the topmost box at each place.
    type Points = Vec<Color32>;

    const SIDE: usize = 24;

    /// The tests' window, with cells of four points.
    const WINDOW: (Rect, f32) = (Rect::from_min_max(pos2(0.0, 0.0), pos2(SIDE as f32, SIDE as f32)), 8.0);

    type SmallBox = (u8, u8, u8, u8, u8);

    fn boxed((x, y, width, height, colour): SmallBox) -> ClippedShape {
        let min = pos2(f32::from(x), f32::from(y));
        let max = pos2(min.x + f32::from(width), min.y + f32::from(height));
        let fill = Color32::from_gray(colour);
        ClippedShape::new(
            Rect::EVERYTHING,
            Shape::rect_filled(Rect::from_min_max(min, max), CornerRadius::ZERO, fill),
        )
    }

    fn draw(points: &mut Points, shapes: &[ClippedShape]) {
        for ClippedShape { clip_rect, shape, .. } in shapes {
            let Shape::Rect(shape) = shape else { panic!("boxes only") };
            let area = shape.rect.intersect(*clip_rect);
            for (at, point) in points.iter_mut().enumerate() {
                let middle = pos2((at % SIDE) as f32 + 0.5, (at / SIDE) as f32 + 0.5);
                if area.contains(middle) {
                    *point = shape.fill;
                }
            }
        }
    }

    /// A background and these boxes over it.
    fn shapes(boxes: &[SmallBox]) -> Vec<ClippedShape> {
        let ground = (0, 0, SIDE as u8, SIDE as u8, 255);
        std::iter::once(ground).chain(boxes.iter().copied()).map(boxed).collect()
    }

    fn picture(boxes: &[SmallBox], before: Option<&Picture>) -> Picture {
        Picture::new(shapes(boxes), WINDOW, before, &[])
    }

    fn area(areas: &[Rect]) -> f32 {
        areas.iter().map(Rect::area).sum()
    }

    #[test]
    fn a_foot_that_moves_draws_its_old_and_its_new_place_only() {
        let (foot, button) = (|x| (x, 9, 2, 2, 9), (1, 1, 4, 3, 100));
        let old = picture(&[button, foot(2)], None);
        let new = picture(&[button, foot(17)], Some(&old));
        // With their soft edges, both places reach from 7 to 13 in one direction, and from 0 to 6 and 15 to 21 in the other.
        assert_eq!(area(&new.differences(Some(&old))), (3.0 * 2.0 + 3.0 * 3.0) * 16.0);
        assert!(picture(&[button, foot(2)], Some(&old)).differences(Some(&old)).is_empty());
    }

    #[test]
    fn what_changes_places_in_the_order_of_drawing_is_drawn_where_it_overlaps_only() {
        let [one, over, apart] = [(1, 1, 2, 2, 9), (2, 2, 2, 2, 50), (17, 17, 2, 2, 100)];
        let old = picture(&[one, over, apart], None);
        assert!(picture(&[apart, one, over], Some(&old)).differences(Some(&old)).is_empty());
        let swapped = picture(&[apart, over, one], Some(&old)).differences(Some(&old));
        assert!(swapped.iter().any(|area| area.contains(pos2(2.5, 2.5))), "{swapped:?}");
        assert!(!swapped.iter().any(|area| area.contains(pos2(18.0, 18.0))), "{swapped:?}");
    }

    #[test]
    fn an_image_with_new_content_is_drawn_again_and_new_letters_draw_nothing() {
        let texture = TextureId::User(7);
        let place = Rect::from_min_max(pos2(2.0, 2.0), pos2(6.0, 6.0));
        let image = ClippedShape::new(Rect::EVERYTHING, Shape::image(texture, place, place, Color32::WHITE));
        let all = || vec![boxed((0, 0, 24, 24, 255)), image.clone()];
        let old = Picture::new(all(), WINDOW, None, &[]);
        let new = |changed| Picture::new(all(), WINDOW, Some(&old), &[changed]).differences(Some(&old));
        assert_eq!(area(&new(texture)), 144.0);
        assert!(new(TextureId::default()).is_empty());
    }

    proptest! {
        #[test]
        fn the_canvas_shows_the_new_picture_whatever_changes(
            old in prop::collection::vec((0..20_u8, 0..20_u8, 1..9_u8, 1..9_u8, 0..4_u8), 0..14),
            edits in prop::collection::vec((0..14_usize, prop::option::of((0..20_u8, 0..20_u8, 1..9_u8, 1..9_u8, 0..4_u8))), 0..6),
            swap in prop::option::of((0..14_usize, 0..14_usize)),
        ) {
            let mut new = old.clone();
            for (at, shape) in edits {
                match shape {
                    Some(shape) => new.insert(at.min(new.len()), shape),
                    None if at < new.len() => _ = new.remove(at),
                    None => {}
                }
            }
            if let Some((one, other)) = swap.filter(|(one, other)| *one.max(other) < new.len()) {
                new.swap(one, other);
            }
            let (mut canvas, mut wanted) = (vec![Color32::RED; SIDE * SIDE], vec![Color32::RED; SIDE * SIDE]);
            draw(&mut canvas, &shapes(&old));
            draw(&mut wanted, &shapes(&new));
            let old = picture(&old, None);
            let new = picture(&new, Some(&old));
            draw(&mut canvas, &new.within(&new.differences(Some(&old))));
            prop_assert!(canvas == wanted);
        }
    }
}
