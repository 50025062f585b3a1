//! The window on a desktop.

use std::sync::Arc;

use eframe::egui;

use super::damage::{Damage, Framebuffer, TopFirst, has_graphics_card};
use super::{PreviewError, PreviewInput, PreviewOptions};
use underfoot_scene::letters::Installed;

/// Shows the window until the user closes it; must be called on the main thread.
///
/// # Errors
/// [`PreviewError::NoWindow`] if there is no display or no OpenGL on it.
pub fn run(input: PreviewInput, options: &PreviewOptions) -> Result<(), PreviewError> {
    let copied = options.clone();
    open(&options.title, options.size, move |context| super::app(input, &copied, context))
}

/// Opens a window with the contents that `app` makes, and shows it until the user closes it.
///
/// # Errors
/// [`PreviewError::NoWindow`] if there is no display or no OpenGL on it.
pub(crate) fn open(
    title: &str,
    size: (f32, f32),
    app: impl FnOnce(&eframe::CreationContext<'_>) -> Box<dyn eframe::App> + 'static,
) -> Result<(), PreviewError> {
    let viewport = egui::ViewportBuilder::default()
        .with_title(title)
        .with_app_id("underfoot")
        .with_inner_size([size.0, size.1])
        .with_min_inner_size([640.0, 420.0]);
    // There are no gradients that need dithering, and without a graphics card it takes a tenth of each frame.
    let native = eframe::NativeOptions {
        viewport,
        renderer: eframe::Renderer::Glow,
        dithering: false,
        // Our fallback uses the same fonts as pictures do, and works without installed fonts.
        system_font_fallback: false,
        ..Default::default()
    };
    keep_memory();
    let start = Box::new(move |context: &eframe::CreationContext<'_>| {
        let app = app(context);
        // Missing letters come from the fonts of this computer, as in pictures.
        context.egui_ctx.add_font_provider(Arc::new(Installed::new()));
        if let Some(gl) = context.gl.as_ref().filter(|gl| !has_graphics_card(gl)) {
            let address = context.get_proc_address.as_ref();
            let top_first = address.and_then(|address| TopFirst::find(gl, &**address));
            context.egui_ctx.add_plugin(Damage::new(Framebuffer::new(top_first)));
        }
        Ok(app)
    });
    eframe::run_native(title, native, start)
        .map_err(|error| PreviewError::NoWindow(reason(&error.to_string()).to_owned()))
}

/// Keeps freed memory in the process, for the next frame.
///
/// A graphics driver without a graphics card allocates and frees some megabytes for each frame. The C library of
/// Linux would return them to the system each time, and the page faults take a sixth of the frame. Once a large block
/// has been freed, the library raises its threshold and keeps up to twice as much (mallopt(3), "dynamic mmap
/// threshold", at most 32 MiB). On other systems this has no effect.
fn keep_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(31 << 20)));
}

/// The useful part of winit's message: the text after the source line in it.
pub(super) fn reason(message: &str) -> &str {
    let after_line = message.rsplit_once(".rs:").and_then(|(_, line)| line.split_once(": "));
    after_line.map_or(message, |(_, reason)| reason).trim_end_matches('.')
}
