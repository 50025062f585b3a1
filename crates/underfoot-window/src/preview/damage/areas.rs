//! The areas of a window in which two pictures differ, and the shapes in them.

use eframe::egui::epaint::{ClippedShape, Shape, TextureId};
use eframe::egui::{Rect, pos2};

/// Maximum number of areas that are drawn separately.
const MOST_AREAS: usize = 6;

/// Reach of soft edges beyond the bounds of a shape, in points.
const SOFT: f32 = 2.0;

/// Shapes of the old picture among which the counterpart of a new one is looked for.
const LOOK_AHEAD: usize = 256;

/// The areas in which two pictures may differ; those with a texture that has `changed` always do.
///
/// Shapes that both have in the same order are equal; so outside the areas of all others, the pictures are equal.
pub(super) fn areas(old: &[ClippedShape], new: &[ClippedShape], changed: &[TextureId]) -> Vec<Rect> {
    let mut areas = Vec::new();
    let mut rest = old;
    for shape in new {
        let is_same = |other: &ClippedShape| other == shape;
        match rest.iter().take(LOOK_AHEAD).position(is_same) {
            Some(at) => {
                areas.extend(rest[..at].iter().map(reach));
                rest = &rest[at + 1..];
                if is_of(&shape.shape, changed) {
                    areas.push(reach(shape));
                }
            }
            None => areas.push(reach(shape)),
        }
    }
    areas.extend(rest.iter().map(reach));
    areas.retain(Rect::is_positive);
    areas
}

/// The pixels that a shape may touch.
fn reach(shape: &ClippedShape) -> Rect {
    let bounds = shape.transform_after_tessellation.mul_rect(shape.shape.visual_bounding_rect());
    bounds.expand(SOFT).intersect(shape.clip_rect)
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

/// `area` with its sides moved outwards to the edges of pixels.
pub(super) fn on_pixels(area: Rect, pixels_per_point: f32) -> Rect {
    let down = |x: f32| (x * pixels_per_point).floor() / pixels_per_point;
    let up = |x: f32| (x * pixels_per_point).ceil() / pixels_per_point;
    Rect::from_min_max(pos2(down(area.min.x), down(area.min.y)), pos2(up(area.max.x), up(area.max.y)))
}

/// A few areas that cover all of these and do not overlap: soft edges that are drawn twice are too dark.
pub(super) fn joined(areas: impl Iterator<Item = Rect>) -> Vec<Rect> {
    let mut all: Vec<Rect> = Vec::new();
    for area in areas.filter(Rect::is_positive) {
        let mut area = area;
        // A joined area may meet others.
        while let Some(at) = all.iter().position(|other| other.intersects(area)) {
            area = area.union(all.swap_remove(at));
        }
        all.push(area);
        if all.len() > MOST_AREAS {
            let (one, other) = nearest(&all);
            let (other, one) = (all.swap_remove(other), all.swap_remove(one));
            let mut area = one.union(other);
            while let Some(at) = all.iter().position(|other| other.intersects(area)) {
                area = area.union(all.swap_remove(at));
            }
            all.push(area);
        }
    }
    all
}

/// The indices of the two areas that grow least when they are joined, the lower one first.
fn nearest(areas: &[Rect]) -> (usize, usize) {
    let pairs = (0..areas.len()).flat_map(|one| (one + 1..areas.len()).map(move |other| (one, other)));
    let growth = |(one, other): &(usize, usize)| {
        let (one, other) = (areas[*one], areas[*other]);
        one.union(other).area() - one.area() - other.area()
    };
    pairs.min_by(|one, other| growth(one).total_cmp(&growth(other))).unwrap_or_default()
}

/// The parts of `shapes` in `areas`.
pub(super) fn within(shapes: &[ClippedShape], areas: &[Rect]) -> Vec<ClippedShape> {
    let bounds: Vec<Rect> = shapes.iter().map(reach).collect();
    let parts = areas.iter().flat_map(|area| {
        shapes.iter().zip(&bounds).filter(|(_, bounds)| bounds.intersects(*area)).map(|(shape, _)| {
            let clip_rect = shape.clip_rect.intersect(*area);
            ClippedShape { clip_rect, ..shape.clone() }
        })
    });
    parts.filter(|part| part.clip_rect.is_positive()).collect()
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Color32, CornerRadius};
    use proptest::prelude::*;

    use super::*;

    /// A picture of whole pixels: the colour of the topmost box at each place.
    type Pixels = Vec<Color32>;

    const SIDE: usize = 24;

    fn boxed((x, y, width, height, colour): (u8, u8, u8, u8, u8)) -> ClippedShape {
        let min = pos2(f32::from(x), f32::from(y));
        let max = pos2(min.x + f32::from(width), min.y + f32::from(height));
        let area = Rect::from_min_max(min, max);
        let fill = Color32::from_gray(colour);
        ClippedShape::new(Rect::EVERYTHING, Shape::rect_filled(area, CornerRadius::ZERO, fill))
    }

    fn draw(pixels: &mut Pixels, shapes: &[ClippedShape]) {
        for ClippedShape { clip_rect, shape, .. } in shapes {
            let Shape::Rect(shape) = shape else { panic!("boxes only") };
            let area = shape.rect.intersect(*clip_rect);
            for (at, pixel) in pixels.iter_mut().enumerate() {
                let middle = pos2((at % SIDE) as f32 + 0.5, (at / SIDE) as f32 + 0.5);
                if area.contains(middle) {
                    *pixel = shape.fill;
                }
            }
        }
    }

    /// A background and these boxes over it.
    fn picture(boxes: &[(u8, u8, u8, u8, u8)]) -> Vec<ClippedShape> {
        let ground = (0, 0, SIDE as u8, SIDE as u8, 255);
        std::iter::once(ground).chain(boxes.iter().copied()).map(boxed).collect()
    }

    fn is_disjoint(areas: &[Rect]) -> bool {
        areas.iter().enumerate().all(|(at, area)| {
            !areas[..at].iter().any(|other| {
                let both = area.intersect(*other);
                both.is_positive()
            })
        })
    }

    #[test]
    fn a_foot_that_moves_draws_its_old_and_its_new_place_only() {
        let foot = |x| (x, 10, 2, 2, 9);
        let button = (1, 1, 4, 3, 100);
        let (old, new) = (picture(&[button, foot(3)]), picture(&[button, foot(18)]));
        let areas = joined(areas(&old, &new, &[]).into_iter());
        assert_eq!(areas.len(), 2);
        assert_eq!(areas.iter().map(Rect::area).sum::<f32>(), 2.0 * 36.0);
        assert!(joined(super::areas(&old, &old, &[]).into_iter()).is_empty());
    }

    #[test]
    fn an_image_with_new_content_is_drawn_again_and_new_letters_draw_nothing() {
        let texture = TextureId::User(7);
        let area = Rect::from_min_max(pos2(2.0, 2.0), pos2(8.0, 8.0));
        let image = Shape::image(texture, area, area, Color32::WHITE);
        let shapes = [boxed((0, 0, 24, 24, 255)), ClippedShape::new(Rect::EVERYTHING, image)];
        assert_eq!(areas(&shapes, &shapes, &[texture]), [area.expand(SOFT)]);
        assert!(areas(&shapes, &shapes, &[TextureId::default()]).is_empty());
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
            let (old, new) = (picture(&old), picture(&new));
            let (mut canvas, mut wanted) = (vec![Color32::RED; SIDE * SIDE], vec![Color32::RED; SIDE * SIDE]);
            draw(&mut canvas, &old);
            draw(&mut wanted, &new);
            let areas = joined(areas(&old, &new, &[]).into_iter().map(|area| on_pixels(area, 1.0)));
            prop_assert!(areas.len() <= MOST_AREAS && is_disjoint(&areas), "{areas:?}");
            draw(&mut canvas, &within(&new, &areas));
            prop_assert!(canvas == wanted);
        }
    }
}
