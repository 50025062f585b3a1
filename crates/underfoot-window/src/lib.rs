//! The window of underfoot, and the editor of layouts in it.
//!
//! | module | content |
//! |---|---|
//! | [`edit`] | layouts changed in place: edits of their text, undo, files, snapping; without a window |
//! | [`link`] | a layout in a link |
//! | `preview` | the window: a simulated or real floor, drawn, played with the mouse, and designed (feature `window`) |
//! | [`setup`] | the guided set-up of a floor: its steps, and with the feature `window` a window that shows them |

pub mod edit;
pub mod link;
mod platform;
#[cfg(feature = "window")]
pub mod preview;
pub mod setup;
