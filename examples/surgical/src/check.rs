//! The viewer's results for files, for programs: a line of JSON for each.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::series::{self, Part, Pixels, Unfit};

/// The result for one file.
#[derive(Debug, Serialize)]
struct Outcome {
    file: PathBuf,
    shown: bool,
    /// The reason why it is not shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<String>,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    picture: Option<Picture>,
}

/// The properties of a shown picture.
#[derive(Debug, Serialize)]
struct Picture {
    title: String,
    about: String,
    size: [usize; 2],
    frames: usize,
    is_colour: bool,
    /// Of the first frame.
    spacing_mm: Option<[f64; 2]>,
    towards: Option<[String; 2]>,
    level: f64,
    width: f64,
}

impl Outcome {
    fn of(file: &Path, read: Result<&Part, &Unfit>) -> Self {
        let file = file.to_owned();
        match read {
            Ok(part) => Self { file, shown: true, why: None, picture: Some(Picture::of(part)) },
            Err(unfit) => Self { file, shown: false, why: Some(unfit.to_string()), picture: None },
        }
    }
}

impl Picture {
    fn of(part: &Part) -> Self {
        let series = &part.series;
        let first = series.frames.first();
        let plane = first.map(|frame| frame.plane.clone()).unwrap_or_default();
        Self {
            title: series.title.clone(),
            about: series.about.clone(),
            size: series.size,
            frames: series.frames.len(),
            is_colour: first.is_some_and(|frame| matches!(frame.pixels, Pixels::Colour(_))),
            spacing_mm: plane.spacing_mm,
            towards: plane.towards,
            level: series.window.level,
            width: series.window.width,
        }
    }
}

/// Prints the result for each file; writes the pixels of each first picture into `values`, if given, as
/// `<number>.f32` (little-endian) or `<number>.rgb` by the file's place in the list, from 0. Returns whether all are
/// shown.
///
/// # Errors
/// The pixels can't be written.
pub fn check(files: &[PathBuf], values: Option<&Path>) -> io::Result<bool> {
    let mut are_all_shown = true;
    for (number, file) in files.iter().enumerate() {
        let read = series::read_file(file);
        are_all_shown &= read.is_ok();
        if let (Some(folder), Ok(part)) = (values, &read) {
            write(folder, number, part)?;
        }
        println!("{}", serde_json::to_string(&Outcome::of(file, read.as_ref()))?);
    }
    Ok(are_all_shown)
}

fn write(folder: &Path, number: usize, part: &Part) -> io::Result<()> {
    match part.series.frames.first().map(|frame| &frame.pixels) {
        Some(Pixels::Grey(values)) => {
            let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            fs::write(folder.join(format!("{number}.f32")), bytes)
        }
        Some(Pixels::Colour(colours)) => {
            fs::write(folder.join(format!("{number}.rgb")), colours.as_flattened())
        }
        None => Ok(()),
    }
}
