//! Drawings as files, without a display: SVG with all text as outlines, PNG, and animated GIF.

mod film;
mod svg;
#[cfg(test)]
mod tests;
mod text;

pub use film::Film;
pub use svg::svg;

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use thiserror::Error;

use crate::letters::Fonts;
use crate::scene::Scene;

/// Permitted widths of a picture, in pixels.
pub const WIDTHS: RangeInclusive<u32> = 16..=16_384;

/// The reason why a drawing could not become a picture.
#[derive(Debug, Error)]
pub enum PictureError {
    /// The picture would be too small, or too large for memory; another width solves this.
    #[error("a picture is {} to {} pixels wide and at most as high, not {width} x {height}", WIDTHS.start(), WIDTHS.end())]
    Size {
        /// The requested width.
        width: u32,
        /// The height that follows from it.
        height: u32,
    },
    /// The drawing has no extent, or a NaN extent.
    #[error("the drawing cannot be painted: {0}")]
    Drawing(String),
    /// The animated picture cannot be written.
    #[error("cannot write the animated picture: {0}")]
    Film(#[from] gif::EncodingError),
    /// The file cannot be written.
    #[error("cannot write {path}: {source}")]
    File {
        /// The path.
        path: PathBuf,
        /// The error of the system.
        #[source]
        source: std::io::Error,
    },
}

/// The bytes of a PNG file of the drawing, `width_px` pixels wide, with the height by the drawing's aspect ratio.
///
/// The same drawing gives the same bytes on every computer, except with letters that only the fonts of one computer
/// have.
///
/// # Errors
/// [`PictureError::Size`] for a width outside [`WIDTHS`] or a height above them,
/// [`PictureError::Drawing`] for a scene that was never drawn.
pub fn png(scene: &Scene, fonts: &Fonts, width_px: u32) -> Result<Vec<u8>, PictureError> {
    let pixels = painted(scene, fonts, width_px)?;
    pixels.encode_png().map_err(|error| PictureError::Drawing(error.to_string()))
}

/// The pixels of the drawing, `width_px` wide.
fn painted(scene: &Scene, fonts: &Fonts, width_px: u32) -> Result<Pixmap, PictureError> {
    let size = scene.bounds().size();
    let height = (width_px as f32 * size.y / size.x).round();
    let fits = WIDTHS.contains(&width_px) && (1.0..=*WIDTHS.end() as f32).contains(&height);
    if !height.is_finite() {
        return Err(PictureError::Drawing("it has no extent".into()));
    }
    let height_px = height as u32;
    let too_large = PictureError::Size { width: width_px, height: height_px };
    if !fits {
        return Err(too_large);
    }
    let tree = Tree::from_str(&svg(scene, fonts), &Options::default())
        .map_err(|error| PictureError::Drawing(error.to_string()))?;
    let mut pixels = Pixmap::new(width_px, height_px).ok_or(too_large)?;
    let scale =
        Transform::from_scale(width_px as f32 / tree.size().width(), height_px as f32 / tree.size().height());
    resvg::render(&tree, scale, &mut pixels.as_mut());
    Ok(pixels)
}

/// Writes the drawing to `path`: as SVG if its name ends in `.svg`, otherwise as a PNG `width_px` wide.
///
/// # Errors
/// As [`png`], and [`PictureError::File`] if the file cannot be written.
pub fn write(scene: &Scene, fonts: &Fonts, path: &Path, width_px: u32) -> Result<(), PictureError> {
    let is_svg = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg"));
    let bytes = if is_svg { svg(scene, fonts).into_bytes() } else { png(scene, fonts, width_px)? };
    std::fs::write(path, bytes).map_err(|source| PictureError::File { path: path.to_path_buf(), source })
}
