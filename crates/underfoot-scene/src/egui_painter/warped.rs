//! Draws scenes through a warp, for projectors.

use egui::epaint::{ClippedShape, Primitive, Vertex};
use egui::{LayerId, Order, Painter, Rect, Shape};

use super::{Palette, ScreenFromFloor, paint};
use crate::scene::Scene;

/// Draws `scene`, placed by `map`, after `warp` has moved and coloured every vertex.
///
/// Shapes become triangles first, with the resolution of `map`; so `map` must be about as large as the picture.
/// Inside a triangle, the warp is linear: letters and outlines are exact, the shading of a large field of colours is
/// approximate.
pub fn paint_warped(
    painter: &Painter,
    palette: &mut Palette,
    scene: &Scene,
    map: ScreenFromFloor,
    warp: impl Fn(&mut Vertex),
) {
    let ctx = painter.ctx();
    palette.patches.are_warped = true;
    // A separate layer, emptied before it is displayed.
    let layer = LayerId::new(Order::Background, painter.layer_id().id.with("flat"));
    paint(&Painter::new(ctx.clone(), layer, Rect::EVERYTHING), palette, scene, map);
    let flat = ctx.graphics_mut(|graphics| std::mem::take(graphics.entry(layer)));
    let shapes: Vec<ClippedShape> = flat.all_entries().cloned().collect();
    for cut in ctx.tessellate(shapes, ctx.pixels_per_point()) {
        if let Primitive::Mesh(mut mesh) = cut.primitive {
            mesh.vertices.iter_mut().for_each(&warp);
            painter.add(Shape::mesh(mesh));
        }
    }
}
