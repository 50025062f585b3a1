//! The window: a simulated or real floor, drawn on the screen and used with the mouse.
//!
//! [`run`] shows the content of its [`PreviewInput`]; sensing, sound and outputs run on other threads and never wait
//! for the window. Only this module and [`underfoot_scene::egui_painter`] depend on egui.

mod announced;
mod app;
pub(crate) mod appearance;
mod bars;
#[cfg(target_arch = "wasm32")]
mod browser;
mod channels;
mod closing;
mod damage;
mod design;
#[cfg(not(target_arch = "wasm32"))]
pub(crate) mod desktop;
#[cfg(test)]
mod drags;
mod feed;
mod feeds;
mod feet;
mod floor_check;
mod floor_view;
mod focus;
mod fold;
mod gallery;
mod handheld;
mod icons;
mod keyboard;
mod labels;
mod lookout;
mod messages;
mod mode;
mod native;
mod near_misses;
mod off_hint;
mod orders;
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
pub(crate) mod screen_report;
mod selection;
mod served;
mod share;
mod shown;
mod stage;
mod status;
pub(crate) mod style;
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

pub use announced::announced;
#[cfg(target_arch = "wasm32")]
pub use browser::run;
pub use channels::{NextFloor, Notice, ProgramChannels, WindowChannels, channels};
pub use design::{DesignInput, KindsOf, texts_beside, usual_state};
#[cfg(not(target_arch = "wasm32"))]
pub use desktop::run;
pub use feed::{
    EventNews, FootSink, LayoutCause, LayoutNews, PreviewCommand, PreviewFoot, PreviewInput, ScopeFeed,
    ServerFeed, ServerLink, ServerState, ShoeFeed, Warnings,
};
pub use feeds::{Mouse, SignalScopes, ToWindow, shoes};
pub use playback::{MarkWeight, Playback, PlaybackMark, PlaybackOrder, PlaybackState};
pub use projection::ProjectionOptions;
pub use served::ServedDesk;
pub use share::{LayoutToShare, ShareDesk};
pub use visit::{VisitDesk, VisitForm, VisitOrder, VisitSize, VisitState, VisitWork};

use std::path::PathBuf;

use thiserror::Error;

use underfoot_scene::scene::{Show, Theme};

/// Opens the set-up of a real floor, and returns the message for the user; called by the window's thread, so it must not
/// wait.
pub type OpenSetUp = fn() -> String;

/// The initial state of the window.
#[derive(Clone, Debug)]
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
    /// Whether the window begins with the gallery of layouts.
    pub begins_with_gallery: bool,
    /// The set-up of a real floor, in the menu *Help*; `None` where there is none, as in a browser.
    pub set_up: Option<OpenSetUp>,
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
            begins_with_gallery: false,
            set_up: None,
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

/// The contents of the window, with its fonts and colours.
fn app(
    input: PreviewInput,
    options: &PreviewOptions,
    context: &eframe::CreationContext<'_>,
) -> Box<dyn eframe::App> {
    let app = app::App::new(lookout::start(input, &context.egui_ctx), options);
    style::apply(&context.egui_ctx, &app.appearance.theme());
    context.egui_ctx.set_fonts(style::fonts());
    // The window has its own text size, which it stores.
    context.egui_ctx.options_mut(|options| options.zoom_with_keyboard = false);
    screen_report::report_screen(&context.egui_ctx);
    Box::new(app)
}
