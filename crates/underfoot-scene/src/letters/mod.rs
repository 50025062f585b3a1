//! Lines of text as outlines, and the characters that no font has.
//!
//! The fonts within the program come first, so that Latin, Greek, Cyrillic and emoji look the same everywhere. With
//! the feature `system_fonts`, missing letters come from the fonts of this computer; the window uses the same fonts
//! in the same order.

mod fonts;
mod line;
#[cfg(any(target_arch = "wasm32", test))]
#[cfg_attr(not(target_arch = "wasm32"), allow(dead_code, reason = "its tests run on the desktop"))]
mod page;
#[cfg(feature = "system_fonts")]
mod system;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod undrawn_tests;

pub use fonts::{Fonts, definitions, missing_by};
pub use line::{OutlineStep, Sign, TextLine};
#[cfg(feature = "system_fonts")]
pub use system::Installed;
