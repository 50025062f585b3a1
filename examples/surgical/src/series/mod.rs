//! DICOM files of a folder as series of pictures. Unreadable files are skipped and named, with the reason.

mod about;
mod attributes;
mod colour;
mod decode;
mod file;
mod folder;
mod form;
mod geometry;
mod guard;
mod scale;
mod unfit;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub use colour::Pixels;
pub use file::Part;
pub use geometry::{Plane, opposite};
pub use scale::Window;
use unfit::MOST_PIXELS;
pub use unfit::Unfit;

/// One picture.
#[derive(Clone, Debug)]
pub struct Frame {
    pub pixels: Pixels,
    pub plane: Plane,
}

/// Pictures of one size, one behind the other.
#[derive(Clone, Debug)]
pub struct Series {
    pub title: String,
    /// Patient, number and day, if the files have them.
    pub about: String,
    /// Pixels from left to right and from top to bottom.
    pub size: [usize; 2],
    /// The window in the files, or else one that shows all values.
    pub window: Window,
    /// Whether the least value is white (MONOCHROME1).
    pub is_inverted: bool,
    pub frames: Vec<Frame>,
}

/// The content of a folder.
#[derive(Debug, Default)]
pub struct Found {
    pub series: Vec<Series>,
    /// One sentence for each skipped file, which begins with its name.
    pub left_out: Vec<String>,
}

/// The series in the DICOM file at `path`, or in all files of the folder there and below it.
///
/// A file that is not DICOM, damaged, without a picture, too large or of another size than its series is skipped and
/// named; the others are shown. Slices are ordered by their place, if all of a series have one, or their number, or
/// their file's name.
///
/// # Errors
/// The file or folder cannot be read at all.
pub fn read(path: &Path) -> std::io::Result<Found> {
    let mut found = Found::default();
    let files = folder::files(path, &mut found.left_out)?;
    let mut room = MOST_PIXELS;
    let mut parts: BTreeMap<String, Vec<(PathBuf, Part)>> = BTreeMap::new();
    for path in files {
        match file::read(&path, &mut room) {
            Ok(part) => parts.entry(part.uid.clone()).or_default().push((path, part)),
            Err(unfit) => found.left_out.push(told(&path, &unfit)),
        }
    }
    found.series = parts.into_values().filter_map(|parts| join(parts, &mut found.left_out)).collect();
    found.series.sort_by(|one, other| one.title.cmp(&other.title));
    Ok(found)
}

/// The content of the one file at `path`.
///
/// # Errors
/// It cannot be shown.
pub fn read_file(path: &Path) -> Result<Part, Unfit> {
    file::read(path, &mut MOST_PIXELS.clone())
}

fn told(path: &Path, unfit: &Unfit) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    format!("{name} {unfit}")
}

/// The parts of one series in order; parts of another size than the first are skipped.
fn join(mut parts: Vec<(PathBuf, Part)>, left_out: &mut Vec<String>) -> Option<Series> {
    let by = |key: fn(&Part) -> Option<f64>| {
        move |one: &(PathBuf, Part), other: &(PathBuf, Part)| {
            key(&one.1).unwrap_or(0.0).total_cmp(&key(&other.1).unwrap_or(0.0))
        }
    };
    // Stable: files come by name, and equal numbers or places keep that order.
    if parts.iter().all(|(_, part)| part.place_mm.is_some()) {
        parts.sort_by(by(|part| part.place_mm));
    } else if parts.iter().all(|(_, part)| part.number.is_some()) {
        parts.sort_by(by(|part| part.number));
    }
    let mut parts = parts.into_iter();
    let mut series = parts.next()?.1.series;
    for (path, part) in parts {
        if part.series.size == series.size {
            series.frames.extend(part.series.frames);
        } else {
            let unfit = Unfit::OtherSize { is: part.series.size, series: series.size };
            left_out.push(told(&path, &unfit));
        }
    }
    Some(series)
}

#[cfg(test)]
mod tests;
