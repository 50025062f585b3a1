//! Draws only the parts of the main window that have changed, where the last picture is kept.
//!
//! Without a graphics card, drawing takes most of each frame; while a foot moves, a tenth of the window changes.
//!
//! ```text
//! shapes of a frame -compared with those on the canvas, cell by cell-> areas that differ -all shapes within them-> shapes to draw
//! ```

#[cfg(not(target_arch = "wasm32"))]
mod framebuffer;
mod grid;
mod picture;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use eframe::egui::epaint::{ClippedShape, PaintCallback, Shape, TextureId};
use eframe::egui::{Context, FullOutput, PaintCallbackInfo, Plugin, RawInput, Rect, ViewportId};
use eframe::egui_glow::{CallbackFn, Painter};

#[cfg(not(target_arch = "wasm32"))]
pub(super) use framebuffer::{Framebuffer, TopFirst, has_graphics_card};
use picture::Picture;

/// A canvas that keeps its picture from one frame to the next.
pub(super) trait Canvas: Send + Sync + 'static {
    /// Makes the canvas, of `size_px` pixels, the target of what is drawn next.
    fn begin(&self, painter: &Painter, size_px: [u32; 2]) -> CanvasState;

    /// Shows the picture in the window.
    fn end(&self, painter: &Painter, size_px: [u32; 2]);
}

/// The picture on a canvas when a frame begins.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(target_arch = "wasm32", allow(dead_code, reason = "the canvas of a page keeps its picture"))]
pub(super) enum CanvasState {
    /// It is that of the frame before.
    Kept,
    /// It is unknown: the canvas is new.
    New,
    /// It is unknown, and that of this frame will be lost: there is no memory for it.
    Lost,
}

/// Draws only the differences from the picture on the canvas.
///
/// The owner keeps the canvas from being cleared between frames, and the window draws its own background.
pub(super) struct Damage {
    canvas: Arc<dyn Canvas>,
    /// The windows whose frames have begun and not yet ended, the innermost last.
    begun: Vec<ViewportId>,
    /// The picture on the canvas; `None` for an unknown one.
    shown: Option<Picture>,
    /// The latest picture, which is on the canvas once it is drawn.
    latest: Option<Picture>,
    number: u64,
    /// The number of the picture on the canvas; 0 for an unknown one.
    drawn: Arc<AtomicU64>,
}

impl Damage {
    /// Draws on this canvas.
    pub(super) fn new(canvas: impl Canvas) -> Self {
        Self {
            canvas: Arc::new(canvas),
            begun: Vec::new(),
            shown: None,
            latest: None,
            number: 0,
            drawn: Arc::default(),
        }
    }

    /// The picture on the canvas, as far as it is known: a frame that was computed and not drawn leaves the older one.
    fn note_drawn(&mut self) {
        match self.drawn.load(Ordering::Relaxed) {
            0 => self.shown = None,
            drawn if drawn == self.number => self.shown = self.latest.take(),
            _ => {}
        }
    }

    /// Replaces the shapes of a frame of the main window by those to draw.
    fn draw_changes(&mut self, ctx: &Context, output: &mut FullOutput) {
        let (screen, pixels_per_point) = (ctx.viewport_rect(), output.pixels_per_point);
        self.note_drawn();
        let shapes = std::mem::take(&mut output.shapes);
        let changed: Vec<TextureId> = output.textures_delta.set.keys().copied().collect();
        let shown = self.shown.as_ref();
        let picture = Picture::new(shapes, (screen, pixels_per_point), shown, &changed);
        let needs_picture = shown.is_some_and(|shown| picture.fits(shown));
        let areas = picture.differences(shown);
        self.number += 1;
        output.shapes.push(self.begin(ctx, screen, needs_picture));
        output.shapes.extend(picture.within(&areas));
        output.shapes.push(self.end(screen));
        self.latest = Some(picture);
    }

    /// A shape that goes over to the canvas. Changes alone, drawn on a canvas that has lost its picture, make an unknown
    /// one, and another frame draws all of it.
    fn begin(&self, ctx: &Context, screen: Rect, needs_picture: bool) -> ClippedShape {
        let (canvas, drawn, number) = (Arc::clone(&self.canvas), Arc::clone(&self.drawn), self.number);
        let ctx = ctx.clone();
        called(screen, move |info, painter| {
            let state = canvas.begin(painter, info.screen_size_px);
            let is_known = state == CanvasState::Kept || state == CanvasState::New && !needs_picture;
            drawn.store(if is_known { number } else { 0 }, Ordering::Relaxed);
            if needs_picture && !is_known {
                ctx.request_repaint();
            }
        })
    }

    /// A shape that shows the canvas.
    fn end(&self, screen: Rect) -> ClippedShape {
        let canvas = Arc::clone(&self.canvas);
        called(screen, move |info, painter| canvas.end(painter, info.screen_size_px))
    }
}

/// A shape that calls `call` when it is drawn.
fn called(screen: Rect, call: impl Fn(&PaintCallbackInfo, &Painter) + Send + Sync + 'static) -> ClippedShape {
    let callback = CallbackFn::new(move |info, painter| call(&info, painter));
    let shape = Shape::Callback(PaintCallback { rect: screen, callback: Arc::new(callback) });
    ClippedShape::new(screen, shape)
}

impl Plugin for Damage {
    fn debug_name(&self) -> &'static str {
        "damage"
    }

    fn input_hook(&mut self, _: &Context, input: &mut RawInput) {
        self.begun.push(input.viewport_id);
    }

    fn output_hook(&mut self, ctx: &Context, output: &mut FullOutput) {
        if self.begun.pop() == Some(ViewportId::ROOT) {
            self.draw_changes(ctx, output);
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::epaint::{CornerRadius, RectShape};
    use eframe::egui::{Color32, LayerId, StrokeKind, pos2, vec2};

    use super::*;

    /// A canvas that draws nothing; the tests say what was drawn.
    struct NoCanvas;

    impl Canvas for NoCanvas {
        fn begin(&self, _: &Painter, _: [u32; 2]) -> CanvasState {
            CanvasState::Kept
        }

        fn end(&self, _: &Painter, _: [u32; 2]) {}
    }

    /// The places of the boxes that a frame draws: of a ground, and of a foot at `x`.
    fn drawn(ctx: &Context, x: f32) -> Vec<f32> {
        let screen = Rect::from_min_size(pos2(0.0, 0.0), vec2(400.0, 300.0));
        let input = RawInput { screen_rect: Some(screen), ..Default::default() };
        let mut output = ctx.run_ui(input, |ui| {
            let painter = ui.ctx().layer_painter(LayerId::background());
            painter.rect_filled(screen, 0, Color32::WHITE);
            let foot = Rect::from_min_size(pos2(x, 40.0), vec2(10.0, 10.0));
            painter.rect(foot, CornerRadius::ZERO, Color32::RED, (0.0, Color32::RED), StrokeKind::Inside);
            let button = foot.translate(vec2(0.0, 200.0));
            painter.rect_filled(button.translate(vec2(300.0 - x, 0.0)), 0, Color32::BLUE);
        });
        output.textures_delta.clear();
        let calls = output.shapes.iter().filter(|it| matches!(it.shape, Shape::Callback(_))).count();
        assert_eq!(calls, 2, "the canvas begins and ends");
        let boxes = output.shapes.iter().filter_map(|it| match &it.shape {
            Shape::Rect(RectShape { rect, fill, .. }) if *fill != Color32::WHITE => Some(rect.min.x),
            _ => None,
        });
        boxes.collect()
    }

    #[test]
    fn only_a_foot_that_moves_is_drawn_and_all_of_a_picture_that_is_lost() {
        let (ctx, damage) = (Context::default(), Damage::new(NoCanvas));
        let on_canvas = Arc::clone(&damage.drawn);
        ctx.add_plugin(damage);
        assert_eq!(drawn(&ctx, 20.0), [20.0, 300.0], "the first frame has all");
        on_canvas.store(1, Ordering::Relaxed);
        assert_eq!(drawn(&ctx, 60.0), [60.0], "the button stays as it is");
        // This frame is never drawn: the next one replaces both feet.
        assert_eq!(drawn(&ctx, 90.0), [90.0]);
        on_canvas.store(3, Ordering::Relaxed);
        assert_eq!(drawn(&ctx, 90.0), [0.0; 0]);
        on_canvas.store(0, Ordering::Relaxed);
        assert_eq!(drawn(&ctx, 90.0), [90.0, 300.0], "the window was resized while it was drawn");
    }
}
