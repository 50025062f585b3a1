//! The window: a simulated or real floor, drawn and played with the mouse.
//!
//! [`run`] shows whatever its [`PreviewInput`] brings in; sensing, sound and
//! outputs run on other threads and never wait for it. Only this module and [`crate::egui_painter`] know
//! egui.

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
mod keyboard;
mod lookout;
mod messages;
mod off_hint;
mod panel;
mod playback;
mod plots;
mod pointer;
mod presses;
mod projection;
mod rate;
mod rehearsal;
mod scopes;
mod selection;
mod status;
mod style;
#[cfg(test)]
mod tests;
mod time_line;
mod touches;
mod trace;
mod trails;
mod turns;
mod walks;
mod watch;
mod zoom;

pub use channels::{ProgramChannels, WindowChannels, channels};
pub use design::{DesignInput, KindsOf, usual_state};
pub use feed::{
    EventNews, FootSink, LayoutCause, LayoutNews, PreviewCommand, PreviewFoot, PreviewInput, ScopeFeed,
    ServerFeed, ServerLink, ServerState, ShoeFeed, Warnings,
};
pub use playback::{MarkWeight, Playback, PlaybackMark, PlaybackOrder, PlaybackState};
pub use projection::ProjectionOptions;

use std::path::PathBuf;

use eframe::egui;
use thiserror::Error;

use crate::scene::Theme;

/// How the window looks at first.
#[derive(Clone, Debug, PartialEq)]
pub struct PreviewOptions {
    /// What the window's title bar says.
    pub title: String,
    /// Width and height of the inside, in points.
    pub size: (f32, f32),
    /// The colours, unless somebody has chosen others.
    pub theme: Theme,
    /// File that remembers which colours and which size of the text people choose; `None` to forget it.
    pub settings: Option<PathBuf>,
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
            projection: ProjectionOptions::default(),
        }
    }
}

/// Why there is no window.
#[derive(Debug, Error)]
pub enum PreviewError {
    /// The window could not be opened: no display, or one without OpenGL. What needs no window still works.
    #[error(
        "no window can be opened ({0}): start it on a desktop with OpenGL, or use the commands that need no window"
    )]
    NoWindow(String),
}

/// Shows the window until it is closed; to be called on the main thread.
///
/// # Errors
/// [`PreviewError::NoWindow`] if there is no display or no OpenGL on it.
pub fn run(input: PreviewInput, options: &PreviewOptions) -> Result<(), PreviewError> {
    let viewport = egui::ViewportBuilder::default()
        .with_title(&options.title)
        .with_app_id("underfoot")
        .with_inner_size([options.size.0, options.size.1])
        .with_min_inner_size([640.0, 420.0]);
    // No gradients here that dithering would help, and without a graphics card it costs a tenth of each frame.
    let native = eframe::NativeOptions {
        viewport,
        renderer: eframe::Renderer::Glow,
        dithering: false,
        // Ours chooses the same fonts for pictures, and does without any.
        system_font_fallback: false,
        ..Default::default()
    };
    keep_memory();
    let (title, options) = (options.title.clone(), options.clone());
    let start = Box::new(move |context: &eframe::CreationContext<'_>| {
        let app = app::App::new(lookout::start(input, &context.egui_ctx), &options);
        style::apply(&context.egui_ctx, &app.theme);
        context.egui_ctx.set_fonts(crate::letters::definitions());
        // What they lack comes from the fonts of this computer, as pictures have it.
        context.egui_ctx.add_font_provider(std::sync::Arc::new(crate::letters::Installed::new()));
        // The size of the text is the window's own: it is remembered.
        context.egui_ctx.options_mut(|options| options.zoom_with_keyboard = false);
        Ok(Box::new(app) as Box<dyn eframe::App>)
    });
    eframe::run_native(&title, native, start)
        .map_err(|error| PreviewError::NoWindow(reason(&error.to_string()).to_owned()))
}

/// Lets freed memory stay with the program, for the next frame.
///
/// A graphics driver without a graphics card takes and frees some megabytes for each frame. The C library of
/// Linux would give them back to the system each time, and the page faults cost a sixth of the frame; once a
/// large block was freed it takes this for the custom, and keeps up to twice as much (mallopt(3), "dynamic mmap
/// threshold", at most 32 MiB). Elsewhere this does nothing.
fn keep_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(31 << 20)));
}

/// What a person can use of winit's message: the part after the source line that it names.
fn reason(message: &str) -> &str {
    let after_line = message.rsplit_once(".rs:").and_then(|(_, line)| line.split_once(": "));
    after_line.map_or(message, |(_, reason)| reason).trim_end_matches('.')
}
