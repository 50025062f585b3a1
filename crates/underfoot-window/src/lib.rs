//! The window of underfoot, and the editor of layouts in it.
//!
//! | module | content |
//! |---|---|
//! | [`edit`] | layouts changed in place: edits of their text, undo, files, snapping; without a window |
//! | `preview` | the window: a simulated or real floor, drawn, played with the mouse, and designed (feature `window`) |

pub mod edit;
#[cfg(feature = "window")]
pub mod preview;
