//! DICOM files of a folder as series of grey pictures. What can't be shown is left out and told, each with its name.

use std::collections::BTreeMap;
use std::fs;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};

use dicom_core::Tag;
use dicom_dictionary_std::tags;
use dicom_object::{DefaultDicomObject, open_file};
use dicom_pixeldata::{PhotometricInterpretation, PixelDecoder};
use thiserror::Error;

/// Largest file that is read, in bytes: beyond the largest series of a day's imaging in one file.
const LARGEST_FILE: u64 = 1 << 30;

/// Most pixels that are kept at once, of all series: a gibibyte of them.
const MOST_PIXELS: usize = 1 << 28;

/// Most files that are looked at, and how many folders deep.
const MOST_FILES: usize = 20_000;
const DEEPEST: usize = 8;

/// Which values are between black and white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    pub level: f64,
    pub width: f64,
}

/// Pictures of one size, one behind the other.
#[derive(Clone, Debug)]
pub struct Series {
    pub title: String,
    /// Pixels from left to right and from top to bottom.
    pub size: [usize; 2],
    /// Distance between pixels likewise, in millimetres; `None` where the files don't say it.
    pub spacing_mm: Option<[f64; 2]>,
    /// What the files ask for, or what shows all values.
    pub window: Window,
    /// Whether the least value is white (MONOCHROME1).
    pub is_inverted: bool,
    /// Values row by row, after the modality's own scale (such as Hounsfield units); all finite.
    pub frames: Vec<Vec<f32>>,
}

/// What a folder gave.
#[derive(Debug, Default)]
pub struct Found {
    pub series: Vec<Series>,
    /// One sentence for each file that is not shown, which begins with its name.
    pub left_out: Vec<String>,
}

/// Why a file is not shown.
#[derive(Debug, Error)]
enum Unfit {
    #[error("can't be read: {0}")]
    Io(#[from] std::io::Error),
    #[error("is larger than {} MiB", LARGEST_FILE >> 20)]
    Huge,
    #[error("is not a DICOM file, or a damaged one ({0})")]
    NotDicom(String),
    #[error("has no picture: {0} is missing")]
    Missing(&'static str),
    #[error("has colours in a palette, which are not shown")]
    Palette,
    #[error("has pixels that can't be read ({0})")]
    Pixels(String),
    #[error("does not fit into memory any more: {} million pixels are shown at most", MOST_PIXELS >> 20)]
    Full,
    #[error("is {} x {} pixels, and its series {} x {}", .is[0], .is[1], .series[0], .series[1])]
    OtherSize { is: [usize; 2], series: [usize; 2] },
}

/// One file's part of a series.
struct Part {
    path: PathBuf,
    uid: String,
    /// Where it belongs: place across the slices in millimetres, number, and whether the file says them.
    place: Option<f64>,
    number: Option<f64>,
    series: Series,
}

/// The series in the DICOM file at `path`, or in all files of the folder there and below it.
///
/// A file that is not DICOM, damaged, without a picture, too large or of another size than its series is left out and
/// told; the others are shown. Slices are ordered by their place, where all of a series have one, or their number, or
/// their file's name.
///
/// # Errors
/// The file or folder can't be read at all.
pub fn read(path: &Path) -> std::io::Result<Found> {
    let mut found = Found::default();
    let mut files = Vec::new();
    if fs::metadata(path)?.is_dir() {
        collect(path, 0, &mut files, &mut found.left_out)?;
    } else {
        files.push(path.to_owned());
    }
    files.sort();
    let mut room = MOST_PIXELS;
    let mut parts: BTreeMap<String, Vec<Part>> = BTreeMap::new();
    for file in files {
        match part(&file, &mut room) {
            Ok(part) => parts.entry(part.uid.clone()).or_default().push(part),
            Err(unfit) => found.left_out.push(told(&file, &unfit)),
        }
    }
    found.series = parts.into_values().filter_map(|parts| join(parts, &mut found.left_out)).collect();
    found.series.sort_by(|one, other| one.title.cmp(&other.title));
    Ok(found)
}

fn told(path: &Path, unfit: &Unfit) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    format!("{name} {unfit}")
}

/// The files of a folder and of those in it; a folder inside that can't be read is told.
fn collect(
    folder: &Path,
    depth: usize,
    files: &mut Vec<PathBuf>,
    left_out: &mut Vec<String>,
) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if files.len() >= MOST_FILES {
            left_out
                .push(format!("{} and what follows: {MOST_FILES} files are read at most", path.display()));
            return Ok(());
        }
        match fs::metadata(&path) {
            Ok(what) if !what.is_dir() => files.push(path),
            Ok(_) if depth >= DEEPEST => {
                left_out.push(format!("{} lies too deep: {DEEPEST} folders at most", path.display()));
            }
            Ok(_) => {
                if let Err(error) = collect(&path, depth + 1, files, left_out) {
                    left_out.push(told(&path, &error.into()));
                }
            }
            Err(error) => left_out.push(told(&path, &error.into())),
        }
    }
    Ok(())
}

/// The parts of one series in their order; those of another size than the first are left out.
fn join(mut parts: Vec<Part>, left_out: &mut Vec<String>) -> Option<Series> {
    let by = |key: fn(&Part) -> Option<f64>| {
        move |one: &Part, other: &Part| key(one).unwrap_or(0.0).total_cmp(&key(other).unwrap_or(0.0))
    };
    // Stable: files come by name, and numbers and places that are the same keep that order.
    if parts.iter().all(|part| part.place.is_some()) {
        parts.sort_by(by(|part| part.place));
    } else if parts.iter().all(|part| part.number.is_some()) {
        parts.sort_by(by(|part| part.number));
    }
    let mut parts = parts.into_iter();
    let mut series = parts.next()?.series;
    for part in parts {
        if part.series.size == series.size {
            series.frames.extend(part.series.frames);
        } else {
            let unfit = Unfit::OtherSize { is: part.series.size, series: series.size };
            left_out.push(told(&part.path, &unfit));
        }
    }
    Some(series)
}

/// What one file holds; takes its pixels from `room`.
fn part(path: &Path, room: &mut usize) -> Result<Part, Unfit> {
    if fs::metadata(path)?.len() > LARGEST_FILE {
        return Err(Unfit::Huge);
    }
    // A damaged file may trip the libraries that read it.
    let mut left = *room;
    let caught = catch_unwind(move || {
        let file = open_file(path).map_err(|error| Unfit::NotDicom(chain(&error)))?;
        let part = decode(path, &file, &mut left)?;
        Ok((part, left))
    });
    let (part, left) = caught.unwrap_or_else(|_| Err(Unfit::Pixels("the decoder failed".into())))?;
    *room = left;
    Ok(part)
}

fn decode(path: &Path, file: &DefaultDicomObject, room: &mut usize) -> Result<Part, Unfit> {
    let needed = [(tags::ROWS, "Rows"), (tags::COLUMNS, "Columns"), (tags::PIXEL_DATA, "PixelData")];
    if let Some((_, name)) = needed.into_iter().find(|(tag, _)| file.element(*tag).is_err()) {
        return Err(Unfit::Missing(name));
    }
    let whole = |tag, otherwise| number(file, tag).unwrap_or(otherwise).max(0.0) as usize;
    let size = [whole(tags::COLUMNS, 0.0), whole(tags::ROWS, 0.0)];
    let pixels = size[0].saturating_mul(size[1]);
    if pixels == 0 {
        return Err(Unfit::Missing("a size of at least 1 x 1"));
    }
    let needed = pixels.saturating_mul(whole(tags::NUMBER_OF_FRAMES, 1.0).max(1));
    *room = room.checked_sub(needed).ok_or(Unfit::Full)?;

    let decoded = file.decode_pixel_data().map_err(|error| Unfit::Pixels(chain(&error)))?;
    let colours = decoded.photometric_interpretation();
    if *colours == PhotometricInterpretation::PaletteColor {
        return Err(Unfit::Palette);
    }
    let samples = usize::from(decoded.samples_per_pixel()).max(1);
    let is_rgb = *colours == PhotometricInterpretation::Rgb;
    let mut frames = Vec::new();
    for frame in 0..decoded.number_of_frames() {
        let values: Vec<f32> = decoded.to_vec_frame(frame).map_err(|error| Unfit::Pixels(chain(&error)))?;
        let grey: Vec<f32> = values.chunks_exact(samples).map(|pixel| grey(pixel, is_rgb)).collect();
        if grey.len() != pixels || grey.iter().any(|value| !value.is_finite()) {
            return Err(Unfit::Pixels("not as many numbers as pixels".into()));
        }
        frames.push(grey);
    }
    let asked = decoded.window().ok().flatten().and_then(|windows| windows.first().copied());
    let asked =
        asked.filter(|asked| asked.width >= 1.0 && asked.width.is_finite() && asked.center.is_finite());
    let window =
        asked.map_or_else(|| whole_range(&frames), |it| Window { level: it.center, width: it.width });
    let modality = text(file, tags::MODALITY).unwrap_or_default();
    let description = text(file, tags::SERIES_DESCRIPTION).unwrap_or_else(|| "Untitled".into());
    let spacing =
        [tags::PIXEL_SPACING, tags::IMAGER_PIXEL_SPACING].into_iter().find_map(|tag| numbers(file, tag));
    let series = Series {
        title: format!("{modality} {description}").trim().to_owned(),
        size,
        // Files say the distance between rows first, which is downwards.
        spacing_mm: spacing.and_then(|spacing| match spacing.as_slice() {
            [down, right, ..] if *down > 0.0 && *right > 0.0 => Some([*right, *down]),
            _ => None,
        }),
        window,
        is_inverted: *colours == PhotometricInterpretation::Monochrome1,
        frames,
    };
    let uid = text(file, tags::SERIES_INSTANCE_UID).unwrap_or_else(|| path.display().to_string());
    let (place, number) = (place(file), number(file, tags::INSTANCE_NUMBER));
    Ok(Part { path: path.to_owned(), uid, place, number, series })
}

/// Brightness of one pixel: of red, green and blue as weighed by ITU-R BT.601, else what comes first.
fn grey(pixel: &[f32], is_rgb: bool) -> f32 {
    match pixel {
        [red, green, blue] if is_rgb => 0.299 * red + 0.587 * green + 0.114 * blue,
        [first, ..] => *first,
        [] => 0.0,
    }
}

fn whole_range(frames: &[Vec<f32>]) -> Window {
    let values = || frames.iter().flatten().copied();
    let (least, most) = (values().fold(f32::INFINITY, f32::min), values().fold(f32::NEG_INFINITY, f32::max));
    let (least, most) = (f64::from(least), f64::from(most));
    Window { level: 0.5 * (least + most), width: (most - least).max(1.0) }
}

/// How far a slice lies along the line across its plane, in millimetres.
fn place(file: &DefaultDicomObject) -> Option<f64> {
    let at = numbers(file, tags::IMAGE_POSITION_PATIENT)?;
    let axes = numbers(file, tags::IMAGE_ORIENTATION_PATIENT)?;
    let ([x, y, z], [a, b, c, d, e, f]) = (at.as_slice(), axes.as_slice()) else { return None };
    Some(x * (b * f - c * e) + y * (c * d - a * f) + z * (a * e - b * d))
}

fn text(file: &DefaultDicomObject, tag: Tag) -> Option<String> {
    let text = file.element(tag).ok()?.to_str().ok()?.trim().to_owned();
    (!text.is_empty()).then_some(text)
}

fn numbers(file: &DefaultDicomObject, tag: Tag) -> Option<Vec<f64>> {
    let numbers = file.element(tag).ok()?.to_multi_float64().ok()?;
    numbers.iter().all(|number| number.is_finite()).then_some(numbers)
}

fn number(file: &DefaultDicomObject, tag: Tag) -> Option<f64> {
    numbers(file, tag)?.first().copied()
}

/// An error with its causes, each once.
fn chain(error: &dyn std::error::Error) -> String {
    let mut words = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let more = error.to_string();
        if !words.contains(&more) {
            words = format!("{words}: {more}");
        }
        cause = error.source();
    }
    words
}

#[cfg(test)]
mod tests;
