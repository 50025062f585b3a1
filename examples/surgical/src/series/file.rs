//! One file's pictures.

use std::fs::{self, File};
use std::io::Read;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use dicom_core::dictionary::UidDictionary;
use dicom_dictionary_std::StandardSopClassDictionary;
use dicom_dictionary_std::tags;

use super::attributes::{self, Attributes};
use super::colour::{Palette, shown};
use super::decode::Decoder;
use super::form::{Colours, Form};
use super::geometry::Plane;
use super::guard::{Guarded, guard};
use super::scale::{Scale, Window};
use super::unfit::{LARGEST_FILE, Unfit};
use super::{Frame, Series, about};

/// One file's part of a series.
#[derive(Debug)]
pub struct Part {
    pub uid: String,
    /// Its order: place across the slices in millimetres, and number, if the file has them.
    pub place_mm: Option<f64>,
    pub number: Option<f64>,
    pub series: Series,
}

/// The content of one file; its pixels count against `room`.
///
/// # Errors
/// The file is not shown.
pub fn read(path: &Path, room: &mut usize) -> Result<Part, Unfit> {
    let mut left = *room;
    // A damaged file may make the decoding libraries panic.
    let caught = catch_unwind(AssertUnwindSafe(|| {
        let part = part(path, &bytes(path)?, &mut left)?;
        Ok(part)
    }));
    let part = caught.unwrap_or_else(|_| Err(Unfit::pixels("the decoder failed")))?;
    *room = left;
    Ok(part)
}

fn bytes(path: &Path) -> Result<Vec<u8>, Unfit> {
    let about = fs::metadata(path)?;
    // Reading a pipe or a device may never end, or may block.
    if !about.is_file() {
        return Err(Unfit::NotDicom("it is a pipe, a device or a folder"));
    }
    if about.len() > LARGEST_FILE {
        return Err(Unfit::Huge);
    }
    let mut bytes = Vec::new();
    // The file may have grown since.
    File::open(path)?.take(LARGEST_FILE + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST_FILE { Err(Unfit::Huge) } else { Ok(bytes) }
}

pub(super) fn part(path: &Path, bytes: &[u8], room: &mut usize) -> Result<Part, Unfit> {
    let guarded = guard(bytes)?;
    let object = attributes::parse(&guarded.known, guarded.syntax.encoding)?;
    let file = Attributes::of(&object);
    let (form, frames) = frames(&guarded, file, room)?;
    let asked = if form.colours == (Colours::Grey { is_inverted: false }) || is_inverted(&form) {
        Window::asked(file)
    } else {
        Some(Window::COLOURS)
    };
    let window = asked.unwrap_or_else(|| Window::of_all(frames.iter().map(|frame| &frame.pixels)));
    Ok(Part {
        uid: file.text(tags::SERIES_INSTANCE_UID).unwrap_or_else(|| path.display().to_string()),
        place_mm: frames.first().and_then(|frame| frame.plane.place_mm),
        number: file.number(tags::INSTANCE_NUMBER),
        series: Series {
            title: about::title(file),
            about: about::line(file),
            size: form.size,
            window,
            is_inverted: is_inverted(&form),
            frames,
        },
    })
}

fn is_inverted(form: &Form) -> bool {
    form.colours == (Colours::Grey { is_inverted: true })
}

/// All frames of a file; their pixels count against `room`.
fn frames(guarded: &Guarded, file: Attributes, room: &mut usize) -> Result<(Form, Vec<Frame>), Unfit> {
    let pixels = guarded.pixels.as_ref().ok_or_else(|| without_pixels(file, &guarded.class))?;
    let form = Form::of(file, pixels.numbers)?;
    let needed = form.pixels().saturating_mul(form.frames);
    let left = room.checked_sub(needed).ok_or(Unfit::Full)?;
    let decoder = Decoder::new(&guarded.bytes, pixels, guarded.syntax, &form, &file.offsets())?;
    let palette = match form.colours {
        Colours::Palette => Some(Palette::of(file)?),
        _ => None,
    };
    let mut frames = Vec::new();
    for number in 0..form.frames {
        let scale = Scale::of_frame(file, number);
        let pixels = shown(decoder.frame(number)?, palette.as_ref(), |stored| scale.value(stored))?;
        frames.push(Frame { pixels, plane: Plane::of_frame(file, number) });
    }
    *room = left;
    Ok((form, frames))
}

/// The reason for a file without pixels: its kind, if the file names it.
fn without_pixels(file: Attributes, class: &str) -> Unfit {
    let uid = file.text(tags::SOP_CLASS_UID).unwrap_or_else(|| class.to_owned());
    let kind = StandardSopClassDictionary.by_uid(&uid).map(|class| class.name.to_owned());
    kind.map_or(Unfit::Missing("the element with its pixels"), Unfit::OtherKind)
}
