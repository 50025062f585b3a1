//! The window: a simulated or real floor, drawn on the screen and used with the mouse.
//!
//! [`run`] shows the content of its [`PreviewInput`]; sensing, sound and outputs run on other threads and never wait
//! for the window. Only this module and [`underfoot_scene::egui_painter`] depend on egui.

mod app;
mod appearance;
mod bars;
mod channels;
mod closing;
mod design;
#[cfg(test)]
mod drags;
mod feed;
mod feet;
mod floor_check;
mod floor_view;
mod focus;
mod icons;
mod keyboard;
mod labels;
mod lookout;
mod messages;
mod mode;
mod native;
mod near_misses;
mod off_hint;
mod pace;
mod panel;
mod playback;
mod plots;
mod pointer;
mod presses;
mod projection;
mod rate;
mod rehearsal;
#[cfg(test)]
#[allow(dead_code, reason = "other crates use the rest")]
#[path = "../../../../tests/support/sample.rs"]
mod sample;
mod scopes;
mod screen_report;
mod selection;
mod shown;
mod stage;
mod status;
mod style;
#[cfg(test)]
mod tests;
mod time_line;
mod touches;
mod trace;
mod trails;
mod turns;
mod visit;
mod walks;
mod watch;
mod zoom;

pub use channels::{Notice, ProgramChannels, WindowChannels, channels};
pub use design::{DesignInput, KindsOf, usual_state};
pub use feed::{
    EventNews, FootSink, LayoutCause, LayoutNews, PreviewCommand, PreviewFoot, PreviewInput, ScopeFeed,
    ServerFeed, ServerLink, ServerState, ShoeFeed, Warnings,
};
pub use playback::{MarkWeight, Playback, PlaybackMark, PlaybackOrder, PlaybackState};
pub use projection::ProjectionOptions;
pub use visit::{VisitDesk, VisitForm, VisitOrder, VisitSize, VisitState, VisitWork};

use std::path::PathBuf;

use eframe::egui;
use thiserror::Error;

use underfoot_scene::scene::{Show, Theme};

/// The initial state of the window.
#[derive(Clone, Debug, PartialEq)]
pub struct PreviewOptions {
    /// The text of the window's title bar.
    pub title: String,
    /// Width and height of the inside, in points.
    pub size: (f32, f32),
    /// The colours, unless the settings hold others.
    pub theme: Theme,
    /// File that stores the user's colours and text size; `None` to store nothing.
    pub settings: Option<PathBuf>,
    /// The layers over the floor.
    pub layers: Show,
    /// The window for a projector.
    pub projection: ProjectionOptions,
}

impl Default for PreviewOptions {
    fn default() -> Self {
        Self {
            title: "underfoot".into(),
            size: (1280.0, 800.0),
            theme: Theme::LIGHT,
            settings: None,
            layers: Show::WINDOW,
            projection: ProjectionOptions::default(),
        }
    }
}

/// The reason why the window could not open.
#[derive(Debug, Error)]
pub enum PreviewError {
    /// The window could not be opened: no display, or one without OpenGL. Commands without a window still work.
    #[error(
        "no window can be opened ({0}): start it on a desktop with OpenGL, or use the commands that need no window"
    )]
    NoWindow(String),
}

/// Shows the window until the user closes it; must be called on the main thread.
///
/// # Errors
/// [`PreviewError::NoWindow`] if there is no display or no OpenGL on it.
pub fn run(input: PreviewInput, options: &PreviewOptions) -> Result<(), PreviewError> {
    let viewport = egui::ViewportBuilder::default()
        .with_title(&options.title)
        .with_app_id("underfoot")
        .with_inner_size([options.size.0, options.size.1])
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
    let (title, options) = (options.title.clone(), options.clone());
    let start = Box::new(move |context: &eframe::CreationContext<'_>| {
        let app = app::App::new(lookout::start(input, &context.egui_ctx), &options);
        style::apply(&context.egui_ctx, &app.appearance.theme());
        context.egui_ctx.set_fonts(style::fonts());
        // Missing letters come from the fonts of this computer, as in pictures.
        context.egui_ctx.add_font_provider(std::sync::Arc::new(underfoot_scene::letters::Installed::new()));
        // The window has its own text size, which it stores.
        context.egui_ctx.options_mut(|options| options.zoom_with_keyboard = false);
        screen_report::report_screen(&context.egui_ctx);
        Ok(Box::new(app) as Box<dyn eframe::App>)
    });
    eframe::run_native(&title, native, start)
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
fn reason(message: &str) -> &str {
    let after_line = message.rsplit_once(".rs:").and_then(|(_, line)| line.split_once(": "));
    after_line.map_or(message, |(_, reason)| reason).trim_end_matches('.')
}
