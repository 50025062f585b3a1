//! The window in a page of a browser.

use eframe::egui_glow::Painter;
use js_sys::{Object, Reflect};
use wasm_bindgen::JsValue;
use wasm_bindgen::closure::Closure;
use web_sys::HtmlCanvasElement;

use super::damage::{Canvas, CanvasState, Damage};
use super::{PreviewError, PreviewInput, PreviewOptions};

/// The canvas of the page, which keeps its picture by itself ([`keep_picture`]).
struct PageCanvas;

impl Canvas for PageCanvas {
    fn begin(&self, _: &Painter, _: [u32; 2]) -> CanvasState {
        CanvasState::Kept
    }

    fn end(&self, _: &Painter, _: [u32; 2]) {}
}

/// Shows the window in `canvas` from now on, until the page is left. Letters that the program's own fonts lack are
/// drawn by the browser.
///
/// # Errors
/// [`PreviewError::NoWindow`] if the browser has no WebGL.
pub async fn run(
    input: PreviewInput,
    options: PreviewOptions,
    canvas: HtmlCanvasElement,
) -> Result<(), PreviewError> {
    // There are no gradients that need dithering.
    let web = eframe::WebOptions { dithering: false, ..Default::default() };
    // Without WebGL 2, each frame draws the whole window.
    let keeps_picture = keep_picture(&canvas).is_ok_and(|keeps| keeps);
    let start: eframe::AppCreator<'static> = Box::new(move |context| {
        let app = super::app(input, &options, context);
        if keeps_picture {
            context.egui_ctx.add_plugin(Damage::new(PageCanvas));
        }
        Ok(app)
    });
    let started = eframe::WebRunner::new().start(canvas, web, start).await;
    started.map_err(|error| {
        let message = error.as_string().unwrap_or_else(|| format!("{error:?}"));
        PreviewError::NoWindow(message)
    })
}

/// Lets the picture stay on the canvas between frames; returns whether the browser can do so.
///
/// A canvas has one context: eframe gets this one when it asks for its own.
fn keep_picture(canvas: &HtmlCanvasElement) -> Result<bool, JsValue> {
    let options = Object::new();
    // The window smooths its own edges.
    let parts = [
        ("alpha", false),
        ("antialias", false),
        ("depth", false),
        ("stencil", false),
        ("preserveDrawingBuffer", true),
    ];
    for (name, is_on) in parts {
        Reflect::set(&options, &name.into(), &is_on.into())?;
    }
    let Some(context) = canvas.get_context_with_context_options("webgl2", &options)? else {
        return Ok(false);
    };
    // eframe clears the canvas before each frame.
    let stays = Closure::<dyn Fn(u32)>::new(|_| {}).into_js_value();
    Reflect::set(&context, &"clear".into(), &stays)
}
