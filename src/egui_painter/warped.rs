//! Scenes drawn through a warp, as a projector needs them.

use egui::epaint::{ClippedShape, Primitive};
use egui::{LayerId, Order, Painter, Pos2, Rect, Shape};

use super::{Palette, ScreenFromFloor, paint};
use crate::scene::Scene;

/// Draws `scene` where `map` says and then moves every corner of every shape by `warp`.
///
/// Shapes are cut into triangles first, finely for `map`; so `map` should be about as large as the picture. The inside
/// of a triangle is drawn evenly: letters and outlines are exact, the shading of a large field of colours only nearly.
pub fn paint_warped(
    painter: &Painter,
    palette: &mut Palette,
    scene: &Scene,
    map: ScreenFromFloor,
    warp: impl Fn(Pos2) -> Pos2,
) {
    let ctx = painter.ctx();
    // A layer of its own, emptied before anybody sees it.
    let layer = LayerId::new(Order::Background, painter.layer_id().id.with("flat"));
    paint(&Painter::new(ctx.clone(), layer, Rect::EVERYTHING), palette, scene, map);
    let flat = ctx.graphics_mut(|graphics| std::mem::take(graphics.entry(layer)));
    let shapes: Vec<ClippedShape> = flat.all_entries().cloned().collect();
    for cut in ctx.tessellate(shapes, ctx.pixels_per_point()) {
        if let Primitive::Mesh(mut mesh) = cut.primitive {
            for vertex in &mut mesh.vertices {
                vertex.pos = warp(vertex.pos);
            }
            painter.add(Shape::mesh(mesh));
        }
    }
}
