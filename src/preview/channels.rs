//! What goes between the window and the program that serves its floor.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use super::feed::{EventNews, LayoutNews, PreviewCommand};

/// Events that may wait for the window; it takes them 60 times a second.
const EVENTS_WAITING: usize = 4096;

/// Layouts and sentences that may wait for the window: more come only while it is covered, and draws nothing.
const NEWS_WAITING: usize = 64;

/// Commands that may wait for the program: seconds of a mouse that drags.
const COMMANDS_WAITING: usize = 256;

/// The window's ends.
#[derive(Debug)]
pub struct WindowChannels {
    /// Every event, in order.
    pub events: Receiver<EventNews>,
    /// What became of changes to the layout file.
    pub layouts: Receiver<LayoutNews>,
    /// Sentences for the person at the window, such as why there is no sound.
    pub notices: Receiver<String>,
    /// What the person at the window wants; 256 may wait.
    pub commands: SyncSender<PreviewCommand>,
}

/// The program's ends. What is sent to a window that is closed is not a fault.
#[derive(Debug)]
pub struct ProgramChannels {
    /// Takes events; 4096 may wait.
    pub events: SyncSender<EventNews>,
    /// Takes what became of changes to the layout file; 64 may wait.
    pub layouts: SyncSender<LayoutNews>,
    /// Takes sentences for the person at the window; 64 may wait.
    pub notices: SyncSender<String>,
    /// What the person at the window wants; hangs up with the window.
    pub commands: Receiver<PreviewCommand>,
}

/// Channels between a window and its program.
#[must_use]
pub fn channels() -> (WindowChannels, ProgramChannels) {
    let (event_sender, events) = sync_channel(EVENTS_WAITING);
    let (layout_sender, layouts) = sync_channel(NEWS_WAITING);
    let (notice_sender, notices) = sync_channel(NEWS_WAITING);
    let (commands, asked) = sync_channel(COMMANDS_WAITING);
    let program = ProgramChannels {
        events: event_sender,
        layouts: layout_sender,
        notices: notice_sender,
        commands: asked,
    };
    (WindowChannels { events, layouts, notices, commands }, program)
}
