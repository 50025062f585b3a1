//! Lines of text as outlines, and which characters no font has.
//!
//! The fonts within the program come first, so that Latin, Greek, Cyrillic and emoji look the same everywhere. What
//! they lack is looked for among the fonts of this computer, with the feature `system_fonts`; the window asks the same
//! fonts in the same order.

mod fonts;
mod line;
#[cfg(feature = "system_fonts")]
mod system;
#[cfg(test)]
mod tests;

pub use fonts::Fonts;
#[cfg(feature = "preview")]
pub(crate) use fonts::{definitions, missing_by};
pub use line::{Line, Sign, Step};
#[cfg(feature = "preview")]
pub(crate) use system::Installed;
