//! Drawings of a floor of underfoot, and reviews of how well feet and eyes can use it.
//!
//! | module | content |
//! |---|---|
//! | [`scene`] | a floor and its layout as a drawing |
//! | `egui_painter` | scenes drawn by egui (feature `egui`) |
//! | `letters` | lines of text as outlines, and the characters that no font has (feature `letters`) |
//! | `picture` | scenes as PNG and SVG files (feature `picture`) |
//! | [`ergonomics`] | the controls of a layout that are hard to reach, see or press |

#[cfg(feature = "egui")]
pub mod egui_painter;
pub mod ergonomics;
#[cfg(feature = "letters")]
pub mod letters;
#[cfg(feature = "picture")]
pub mod picture;
pub mod scene;
