//! Channels between the window and the program that provides its floor.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use super::feed::{EventNews, LayoutNews, PreviewCommand, PreviewInput};

/// Capacity for events; the window takes them 60 times a second.
const EVENTS_WAITING: usize = 4096;

/// Capacity for layouts and for notices: more arrive only while the window is covered and does not draw.
const NEWS_WAITING: usize = 64;

/// Capacity for commands: seconds of a dragging mouse.
const COMMANDS_WAITING: usize = 256;

/// A message for the user of the window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Notice {
    /// Appears at once.
    Text(String),
    /// Describes the output of sound, or the reason why there is none; appears once there is something to hear.
    Sound(String),
}

impl From<String> for Notice {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&str> for Notice {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

/// The window's ends.
pub struct WindowChannels {
    /// Every event, in order.
    pub events: Receiver<EventNews>,
    /// The results of changes to the layout file.
    pub layouts: Receiver<LayoutNews>,
    /// Messages for the user of the window, such as the reason why there is no sound.
    pub notices: Receiver<Notice>,
    /// The commands of the user; at most 256 wait.
    pub commands: SyncSender<PreviewCommand>,
    /// The floor that takes the place of this one, once there is one; `None` where none does.
    pub next_floor: Option<NextFloor>,
}

/// The floor that a window shows next; the window on display takes it in its next frame.
pub type NextFloor = Rc<RefCell<Option<Box<PreviewInput>>>>;

/// The program's ends. Sending to a closed window is not a fault.
#[derive(Debug)]
pub struct ProgramChannels {
    /// Sends events; at most 4096 wait.
    pub events: SyncSender<EventNews>,
    /// Sends results of changes to the layout file; at most 64 wait.
    pub layouts: SyncSender<LayoutNews>,
    /// Sends messages for the user of the window; at most 64 wait.
    pub notices: SyncSender<Notice>,
    /// The commands of the user; the channel closes with the window.
    pub commands: Receiver<PreviewCommand>,
}

/// Creates the channels between a window and its program.
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
    (WindowChannels { events, layouts, notices, commands, next_floor: None }, program)
}
