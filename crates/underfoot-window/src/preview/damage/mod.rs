//! Draws only the parts of the main window that have changed, where the last picture is kept.
//!
//! Without a graphics card, drawing takes most of each frame; while a foot moves, a tenth of the window changes.
//!
//! ```text
//! shapes of a frame -compared with those on the canvas-> areas that differ -all shapes within them-> shapes to draw
//! ```

mod areas;
#[cfg(not(target_arch = "wasm32"))]
mod framebuffer;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use eframe::egui::epaint::{ClippedShape, PaintCallback, Shape, TextureId};
use eframe::egui::{Context, FullOutput, PaintCallbackInfo, Plugin, RawInput, Rect, ViewportId};
use eframe::egui_glow::{CallbackFn, Painter};

use areas::{areas, joined, on_pixels, within};
#[cfg(not(target_arch = "wasm32"))]
pub(super) use framebuffer::{Framebuffer, has_graphics_card};

/// A canvas that keeps its picture from one frame to the next.
pub(super) trait Canvas: Send + Sync + 'static {
    /// Makes the canvas, of `size_px` pixels, the target of what is drawn next. Returns whether it still has its picture.
    fn begin(&self, painter: &Painter, size_px: [u32; 2]) -> bool;

    /// Shows the picture in the window.
    fn end(&self, painter: &Painter, size_px: [u32; 2]);
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

/// The shapes of one frame.
struct Picture {
    shapes: Vec<ClippedShape>,
    screen: Rect,
    pixels_per_point: f32,
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
        let shapes = std::mem::take(&mut output.shapes);
        let picture = Picture { shapes, screen, pixels_per_point };
        self.note_drawn();
        let changed: Vec<TextureId> = output.textures_delta.set.keys().copied().collect();
        let known =
            self.shown.as_ref().filter(|it| it.screen == screen && it.pixels_per_point == pixels_per_point);
        let needs_picture = known.is_some();
        let areas = match known {
            Some(shown) => areas(&shown.shapes, &picture.shapes, &changed),
            None => vec![Rect::EVERYTHING],
        };
        let areas = joined(areas.into_iter().map(|area| on_pixels(area.intersect(screen), pixels_per_point)));
        self.number += 1;
        output.shapes.push(self.begin(ctx, screen, needs_picture));
        output.shapes.extend(within(&picture.shapes, &areas));
        output.shapes.push(self.end(screen));
        self.latest = Some(picture);
    }

    /// A shape that goes over to the canvas. Changes alone, drawn on a canvas that has lost its picture, make an unknown
    /// one, and another frame draws all of it.
    fn begin(&self, ctx: &Context, screen: Rect, needs_picture: bool) -> ClippedShape {
        let (canvas, drawn, number) = (Arc::clone(&self.canvas), Arc::clone(&self.drawn), self.number);
        let ctx = ctx.clone();
        called(screen, move |info, painter| {
            let is_known = canvas.begin(painter, info.screen_size_px) || !needs_picture;
            drawn.store(if is_known { number } else { 0 }, Ordering::Relaxed);
            if !is_known {
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
