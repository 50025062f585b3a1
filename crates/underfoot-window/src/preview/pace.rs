//! The times at which the window draws without news from the floor and without input.

use std::time::Duration;

use eframe::egui::Context;
use web_time::Instant;

/// Time between frames: 60 a second.
const PICTURE: Duration = Duration::from_nanos(16_666_667);

/// Time between frames while only the lines of plots move.
const PLOT: Duration = Duration::from_millis(50);

/// Time between frames while a message waits to disappear.
const MESSAGE: Duration = Duration::from_millis(500);

/// The parts of the window that change without news.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct WindowMotion {
    /// Whether a message is on display that disappears after a while.
    pub(super) tells: bool,
    /// Whether lines move through the plots.
    pub(super) plots: bool,
    /// Whether anything else moves.
    pub(super) floor: bool,
}

/// The time of the next frame.
pub(super) struct FramePace {
    due: Instant,
}

impl Default for FramePace {
    fn default() -> Self {
        Self { due: Instant::now() }
    }
}

impl FramePace {
    /// Requests 60 frames a second while something moves without messages about it, also where the display does not
    /// pace frames; otherwise the next frame comes with news from the floor ([`super::lookout`]) or with input.
    pub(super) fn request(&mut self, ctx: &Context, motion: WindowMotion) {
        let now = Instant::now();
        self.due = (self.due + PICTURE).max(now);
        if motion.tells {
            ctx.request_repaint_after(MESSAGE);
        }
        if motion.plots {
            ctx.request_repaint_after(PLOT);
        }
        if motion.floor {
            // A delay of zero would request two frames.
            ctx.request_repaint_after((self.due - now).max(Duration::from_micros(100)));
        }
    }
}
