//! The bars at the window's edges, and the messages over the floor.

mod hand;
mod help;
mod messages;
mod pills;
mod tools;
mod top;

pub(super) use help::{HelpTopic, help_bar};
pub(super) use messages::{MessageStack, message_frame};
pub(super) use pills::TELL_S;
pub(super) use tools::handle_mute_key;
pub(super) use top::TopBar;
