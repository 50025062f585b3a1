//! The claims of a DICOM file, bounded by its size before any library reads it.
//!
//! A file of some bytes can claim gigabytes: by a length, by nesting, by deflated zeros. Here each length is compared
//! with the present bytes, and only the elements that the viewer knows are passed on; pixels stay in place.

mod syntax;
mod walk;

use std::borrow::Cow;
use std::io::Read;
use std::ops::Range;

use dicom_core::{Tag, VR};
use dicom_dictionary_std::tags;
use flate2::read::DeflateDecoder;

pub use syntax::{Coding, Encoding, Syntax};
use walk::{Element, Walk};

use super::unfit::Unfit;

/// Greatest size of inflated elements, in bytes.
const MOST_INFLATED: u64 = 256 << 20;

/// Greatest size of all elements passed on, in bytes.
const MOST_KEPT: usize = 64 << 20;

/// The position of pixels in the file.
#[derive(Clone, Debug)]
pub enum Stretch {
    /// All frames one behind the other.
    Whole(Range<usize>),
    /// In pieces, after the table of frame offsets among them.
    Pieces { table: Range<usize>, pieces: Vec<Range<usize>> },
}

/// The type of pixel values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    Whole,
    Float,
    Double,
}

/// The pixels of a file.
#[derive(Clone, Debug)]
pub struct Pixels {
    pub numbers: Numbers,
    /// Whether they are written as words of 16 bits, which big-endian files swap.
    pub are_words: bool,
    pub stretch: Stretch,
}

/// A file with checked lengths.
#[derive(Debug)]
pub struct Guarded<'a> {
    /// The file, inflated if it was deflated.
    pub bytes: Cow<'a, [u8]>,
    pub syntax: Syntax,
    /// The declared kind of file: the identifier of a class of the standard, or nothing.
    pub class: String,
    /// The elements that the viewer knows, as the file writes them.
    pub known: Vec<u8>,
    pub pixels: Option<Pixels>,
}

/// Checks a file.
///
/// # Errors
/// It is not a DICOM file, or its claims are impossible.
pub fn guard(bytes: &[u8]) -> Result<Guarded<'_>, Unfit> {
    let Beginning { syntax, class, data } = begin(bytes)?;
    let (bytes, data) = match syntax.is_deflated {
        true => (Cow::Owned(inflated(bytes.get(data..))?), 0),
        false => (Cow::Borrowed(bytes), data),
    };
    let mut guarded = Guarded { bytes: Cow::default(), syntax, class, known: Vec::new(), pixels: None };
    let mut walk = Walk::new(&bytes, syntax.encoding);
    let mut at = data;
    while at < bytes.len() {
        if let Some(value) = pieces_at(&bytes, at, syntax.encoding) {
            let (mut pieces, next) = walk.fragments(value)?;
            let table = if pieces.is_empty() { value..value } else { pieces.remove(0) };
            let stretch = Stretch::Pieces { table, pieces };
            guarded.pixels = Some(Pixels { numbers: Numbers::Whole, are_words: false, stretch });
            at = next;
            continue;
        }
        match walk.element(at) {
            Ok(element) => at = guarded.keep(&bytes, element)?,
            // Elements behind the pixels are not needed.
            Err(_) if guarded.pixels.is_some() => break,
            Err(unfit) => return Err(unfit),
        }
    }
    guarded.bytes = bytes;
    Ok(guarded)
}

impl Guarded<'_> {
    /// Keeps an element that the viewer knows; returns the start of the next one.
    fn keep(&mut self, bytes: &[u8], element: Element) -> Result<usize, Unfit> {
        let next = element.next;
        let numbers = match element.tag {
            tags::PIXEL_DATA => Some(Numbers::Whole),
            tags::FLOAT_PIXEL_DATA => Some(Numbers::Float),
            tags::DOUBLE_FLOAT_PIXEL_DATA => Some(Numbers::Double),
            _ => None,
        };
        if let Some(numbers) = numbers {
            // Without an explicit kind, pixels are words (PS3.5, A.1).
            let are_words = element.vr.is_none_or(|vr| vr == VR::OW);
            let stretch = Stretch::Whole(element.value);
            self.pixels = Some(Pixels { numbers, are_words, stretch });
        } else if is_known(element.tag) && !(element.is_open && element.vr == Some(VR::UN)) {
            let bytes = bytes.get(element.start..next).unwrap_or_default();
            if self.known.len() + bytes.len() > MOST_KEPT {
                return Err(Unfit::damaged(format!(
                    "it describes itself in more than {} MiB",
                    MOST_KEPT >> 20
                )));
            }
            self.known.extend_from_slice(bytes);
        }
        Ok(next)
    }
}

/// The start of pixels in pieces, if the element at `at` holds such: pixels of undefined length.
fn pieces_at(bytes: &[u8], at: usize, encoding: Encoding) -> Option<usize> {
    let take = |at: usize| bytes.get(at..at.checked_add(4)?)?.try_into().ok();
    let [a, b, c, d]: [u8; 4] = take(at)?;
    // The length follows the tag, or the kind.
    let length = if encoding.is_explicit() { at + 8 } else { at + 4 };
    let is_pixels = Tag(encoding.u16([a, b]), encoding.u16([c, d])) == tags::PIXEL_DATA;
    (is_pixels && encoding.u32(take(length)?) == u32::MAX).then_some(length + 4)
}

/// The part of a file before the elements that describe its picture.
struct Beginning {
    syntax: Syntax,
    class: String,
    /// The start of those elements.
    data: usize,
}

fn begin(bytes: &[u8]) -> Result<Beginning, Unfit> {
    const MAGIC: &[u8] = b"DICM";
    let has = |at: usize| bytes.get(at..at + 4).is_some_and(|found| found == MAGIC);
    let is_meta = |at: usize| bytes.get(at..at + 2).is_some_and(|group| group == [2, 0]);
    // Files without the preamble, or without the mark behind it, are accepted as well.
    let places = [(has(128), 132), (has(0), 4), (is_meta(0), 0), (is_meta(128), 128)];
    let Some((_, start)) = places.into_iter().find(|(is_here, _)| *is_here) else {
        let encoding = guess(bytes, 0).ok_or(Unfit::NotDicom("it does not begin as one"))?;
        return Ok(Beginning { syntax: Syntax::native(encoding), class: String::new(), data: 0 });
    };
    let (mut at, mut uid, mut class) = (start, None, String::new());
    let mut walk = Walk::new(bytes, Encoding::Explicit);
    while is_meta(at) {
        let element = walk.element(at)?;
        at = element.next;
        let text = || {
            let text = bytes.get(element.value.clone()).unwrap_or_default();
            String::from_utf8_lossy(text).trim_matches(['\0', ' ']).to_owned()
        };
        match element.tag {
            tags::TRANSFER_SYNTAX_UID => uid = Some(text()),
            tags::MEDIA_STORAGE_SOP_CLASS_UID => class = text(),
            _ => {}
        }
    }
    let guessed = guess(bytes, at);
    let mut syntax = match (uid, guessed) {
        (Some(uid), _) => Syntax::of(&uid)?,
        (None, Some(encoding)) => Syntax::native(encoding),
        (None, None) => return Err(Unfit::damaged("it does not say how it is written")),
    };
    // The encoding of some files differs from the declared one.
    if let Some(guessed) = guessed
        && !syntax.is_deflated
        && guessed.is_explicit() != syntax.encoding.is_explicit()
    {
        syntax.encoding = guessed;
    }
    Ok(Beginning { syntax, class, data: at })
}

/// The apparent encoding of the first element, at `at`; `None` if it is not an element.
fn guess(bytes: &[u8], at: usize) -> Option<Encoding> {
    let &[a, b, c, d, kind, other, e, f] = bytes.get(at..at.checked_add(8)?)? else { return None };
    // A file begins with one of the lowest groups (PS3.6), which hold its identification.
    let is_first = |group: u16| (1..=0x0028).contains(&group) || group == 0x7fe0;
    let is_explicit = VR::from_binary([kind, other]).is_some();
    if is_first(u16::from_le_bytes([a, b])) {
        if is_explicit {
            return Some(Encoding::Explicit);
        }
        let length = u32::from_le_bytes([kind, other, e, f]);
        let fits = length == u32::MAX || length as usize <= bytes.len() - at;
        // Element numbers in use are far below this.
        let is_tag = u16::from_le_bytes([c, d]) <= 0x4000;
        return (fits && is_tag && a % 2 == 0).then_some(Encoding::Implicit);
    }
    (is_first(u16::from_be_bytes([a, b])) && is_explicit).then_some(Encoding::BigEndian)
}

fn inflated(bytes: Option<&[u8]>) -> Result<Vec<u8>, Unfit> {
    let mut inflated = Vec::new();
    let mut decoder = DeflateDecoder::new(bytes.unwrap_or_default()).take(MOST_INFLATED + 1);
    decoder
        .read_to_end(&mut inflated)
        .map_err(|error| Unfit::damaged(format!("it can't be inflated: {error}")))?;
    if inflated.len() as u64 > MOST_INFLATED {
        return Err(Unfit::damaged(format!("it becomes more than {} MiB inflated", MOST_INFLATED >> 20)));
    }
    Ok(inflated)
}

/// Whether the viewer uses an element.
fn is_known(tag: Tag) -> bool {
    KNOWN.contains(&tag)
}

const KNOWN: &[Tag] = &[
    tags::SPECIFIC_CHARACTER_SET,
    tags::SOP_CLASS_UID,
    tags::STUDY_DATE,
    tags::SERIES_DATE,
    tags::ACQUISITION_DATE,
    tags::CONTENT_DATE,
    tags::MODALITY,
    tags::STUDY_DESCRIPTION,
    tags::SERIES_DESCRIPTION,
    tags::PATIENT_NAME,
    tags::PATIENT_ID,
    tags::SERIES_INSTANCE_UID,
    tags::INSTANCE_NUMBER,
    tags::PATIENT_ORIENTATION,
    tags::IMAGE_POSITION_PATIENT,
    tags::IMAGE_ORIENTATION_PATIENT,
    tags::IMAGER_PIXEL_SPACING,
    tags::NOMINAL_SCANNED_PIXEL_SPACING,
    tags::PIXEL_SPACING,
    tags::SAMPLES_PER_PIXEL,
    tags::PHOTOMETRIC_INTERPRETATION,
    tags::PLANAR_CONFIGURATION,
    tags::NUMBER_OF_FRAMES,
    tags::ROWS,
    tags::COLUMNS,
    tags::BITS_ALLOCATED,
    tags::BITS_STORED,
    tags::HIGH_BIT,
    tags::PIXEL_REPRESENTATION,
    tags::WINDOW_CENTER,
    tags::WINDOW_WIDTH,
    tags::RESCALE_INTERCEPT,
    tags::RESCALE_SLOPE,
    tags::MODALITY_LUT_SEQUENCE,
    tags::RED_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR,
    tags::GREEN_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR,
    tags::BLUE_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR,
    tags::RED_PALETTE_COLOR_LOOKUP_TABLE_DATA,
    tags::GREEN_PALETTE_COLOR_LOOKUP_TABLE_DATA,
    tags::BLUE_PALETTE_COLOR_LOOKUP_TABLE_DATA,
    tags::SEGMENTED_RED_PALETTE_COLOR_LOOKUP_TABLE_DATA,
    tags::SEGMENTED_GREEN_PALETTE_COLOR_LOOKUP_TABLE_DATA,
    tags::SEGMENTED_BLUE_PALETTE_COLOR_LOOKUP_TABLE_DATA,
    tags::SHARED_FUNCTIONAL_GROUPS_SEQUENCE,
    tags::PER_FRAME_FUNCTIONAL_GROUPS_SEQUENCE,
    tags::EXTENDED_OFFSET_TABLE,
    tags::EXTENDED_OFFSET_TABLE_LENGTHS,
];
