//! The bars at the window's edges: state, buttons, help and problems.

mod help;
mod notices;
mod top;

pub(super) use help::{HelpTopic, help_bar};
pub(super) use notices::{notices, problems, warnings};
pub(super) use top::{TELL_S, TopBar, handle_mute_key};

/// Width of the window below which the top bar takes two lines, in points.
const TWO_LINES: f32 = 1010.0;
