//! The start of the window.

use std::path::PathBuf;
use std::sync::mpsc::SyncSender;

use crate::setup::{SetupOrder, SetupView};

/// The window's ends of the channels to the steps at work.
pub struct SetupChannels {
    /// The state of the steps; the latest one counts.
    pub views: triple_buffer::Output<SetupView>,
    /// Orders; without room for one, the window says so.
    pub orders: SyncSender<SetupOrder>,
}

/// The initial state of the window.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupOptions {
    /// Name of the floor file, as shown.
    pub file: String,
    /// The address of the boards' packets, as shown.
    pub listen: String,
    /// Whether only this machine's packets arrive there.
    pub is_local: bool,
    /// File with the user's colours and text size; `None` for the usual ones.
    pub settings: Option<PathBuf>,
}

/// Shows the window until the user closes it; must be called on the main thread.
///
/// # Errors
/// [`PreviewError::NoWindow`](crate::preview::PreviewError) if there is no display or no OpenGL on it.
pub fn run(channels: SetupChannels, options: &SetupOptions) -> Result<(), crate::preview::PreviewError> {
    use super::app::SetupApp;
    use crate::preview::{desktop, screen_report, style};

    let title = format!("underfoot set-up: {}", options.file);
    let options = options.clone();
    desktop::open(&title, (1280.0, 800.0), move |context| {
        let app = SetupApp::new(channels, options);
        style::apply(&context.egui_ctx, &app.theme());
        context.egui_ctx.set_fonts(style::fonts());
        screen_report::report_screen(&context.egui_ctx);
        Box::new(app)
    })
}
