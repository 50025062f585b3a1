//! A walk over the elements of a DICOM file that compares each length with the file's size before it uses it.

use std::ops::Range;

use dicom_core::dictionary::{DataDictionary, DataDictionaryEntry};
use dicom_core::{Tag, VR};
use dicom_dictionary_std::StandardDataDictionary;

use super::syntax::Encoding;
use crate::series::unfit::Unfit;

/// Greatest number of elements of a file, including those inside sequences: some hundred for each of some thousand
/// frames.
const MOST_ELEMENTS: usize = 1_000_000;

/// Greatest depth of nested sequences; files in use have some five levels.
const DEEPEST: usize = 32;

/// The value of an undefined length.
const UNTOLD: u32 = u32::MAX;

const ITEM: Tag = Tag(0xfffe, 0xe000);
const ITEM_END: Tag = Tag(0xfffe, 0xe00d);
const SEQUENCE_END: Tag = Tag(0xfffe, 0xe0dd);

/// One element, with a value inside the file.
#[derive(Clone, Debug)]
pub struct Element {
    pub tag: Tag,
    /// As the file writes it; `None` if it writes none.
    pub vr: Option<VR>,
    pub start: usize,
    /// Without header and without the delimiter at its end.
    pub value: Range<usize>,
    /// The start of the next element.
    pub next: usize,
    /// Whether its length is undefined and its end marked.
    pub is_open: bool,
}

/// A header with an unchecked length.
struct Header {
    tag: Tag,
    vr: Option<VR>,
    length: u32,
    value: usize,
}

pub struct Walk<'a> {
    bytes: &'a [u8],
    encoding: Encoding,
    left: usize,
}

impl<'a> Walk<'a> {
    pub fn new(bytes: &'a [u8], encoding: Encoding) -> Self {
        Self { bytes, encoding, left: MOST_ELEMENTS }
    }

    /// The element at `at`, which lies completely inside the file.
    ///
    /// # Errors
    /// It extends beyond the file, its content contradicts its length, or it has too much content.
    pub fn element(&mut self, at: usize) -> Result<Element, Unfit> {
        let end = self.bytes.len();
        self.element_within(at, end, self.encoding, 0)
    }

    /// The pieces of pixels that begin at `at`, as a sequence of items with unread content. Without an end mark, it
    /// ends with the file.
    ///
    /// # Errors
    /// A piece extends beyond the file.
    pub fn fragments(&mut self, at: usize) -> Result<(Vec<Range<usize>>, usize), Unfit> {
        let (mut found, mut at) = (Vec::new(), at);
        loop {
            if at >= self.bytes.len() {
                return Ok((found, at));
            }
            self.count()?;
            let (tag, length) = self.item(at, self.encoding)?;
            if tag == SEQUENCE_END {
                return Ok((found, at + 8));
            }
            if tag != ITEM || length == UNTOLD {
                return Err(Unfit::damaged("its compressed pixels are not in pieces of known length"));
            }
            let piece = self.stretch(tag, at + 8, length, self.bytes.len())?;
            at = piece.end;
            found.push(piece);
        }
    }

    fn element_within(
        &mut self,
        at: usize,
        end: usize,
        encoding: Encoding,
        depth: usize,
    ) -> Result<Element, Unfit> {
        self.count()?;
        let Header { tag, vr, length, value } = self.header(at, encoding)?;
        if tag.0 == 0xfffe {
            return Err(Unfit::damaged(format!("a mark {tag} stands where an element should")));
        }
        if length == UNTOLD {
            // A sequence of unknown kind is encoded without kinds (PS3.5, 6.2.2, note 2).
            let inside = if vr == Some(VR::UN) { Encoding::Implicit } else { encoding };
            let next = self.sequence(value, end, true, inside, depth + 1)?;
            return Ok(Element { tag, vr, start: at, value: value..next - 8, next, is_open: true });
        }
        let value = self.stretch(tag, value, length, end)?;
        if is_sequence(tag, vr) {
            self.sequence(value.start, value.end, false, encoding, depth + 1)?;
        }
        let next = value.end;
        Ok(Element { tag, vr, start: at, value, next, is_open: false })
    }

    /// Walks over the items from `at` to `end`, or to the end mark; returns the end.
    fn sequence(
        &mut self,
        mut at: usize,
        end: usize,
        is_open: bool,
        encoding: Encoding,
        depth: usize,
    ) -> Result<usize, Unfit> {
        if depth > DEEPEST {
            return Err(Unfit::damaged(format!("its sequences are nested more than {DEEPEST} deep")));
        }
        while is_open || at < end {
            self.count()?;
            let (tag, length) = self.item(at, encoding)?;
            at += 8;
            match tag {
                SEQUENCE_END if is_open && at <= end => return Ok(at),
                ITEM if length == UNTOLD => at = self.items(at, end, true, encoding, depth)?,
                ITEM => {
                    let inside = self.stretch(tag, at, length, end)?;
                    at = self.items(inside.start, inside.end, false, encoding, depth)?;
                }
                _ => return Err(Unfit::damaged(format!("{tag} stands where an item should"))),
            }
        }
        Ok(at)
    }

    /// Walks over the elements of one item.
    fn items(
        &mut self,
        mut at: usize,
        end: usize,
        is_open: bool,
        encoding: Encoding,
        depth: usize,
    ) -> Result<usize, Unfit> {
        while is_open || at < end {
            if is_open && self.tag(at, encoding)? == ITEM_END {
                let (_, _) = self.item(at, encoding)?;
                return Ok(at + 8);
            }
            at = self.element_within(at, end, encoding, depth)?.next;
        }
        Ok(at)
    }

    fn header(&self, at: usize, encoding: Encoding) -> Result<Header, Unfit> {
        let tag = self.tag(at, encoding)?;
        if !encoding.is_explicit() || tag.0 == 0xfffe {
            let length = encoding.u32(self.take(at + 4)?);
            return Ok(Header { tag, vr: None, length, value: at + 8 });
        }
        // An unknown kind is read as `UN`, like in the library behind this.
        let vr = VR::from_binary(self.take(at + 4)?).unwrap_or(VR::UN);
        if is_short(vr) {
            let length = u32::from(encoding.u16(self.take(at + 6)?));
            return Ok(Header { tag, vr: Some(vr), length, value: at + 8 });
        }
        let length = encoding.u32(self.take(at + 8)?);
        Ok(Header { tag, vr: Some(vr), length, value: at + 12 })
    }

    /// The item tag at `at` and its length.
    fn item(&self, at: usize, encoding: Encoding) -> Result<(Tag, u32), Unfit> {
        Ok((self.tag(at, encoding)?, encoding.u32(self.take(at + 4)?)))
    }

    fn tag(&self, at: usize, encoding: Encoding) -> Result<Tag, Unfit> {
        Ok(Tag(encoding.u16(self.take(at)?), encoding.u16(self.take(at + 2)?)))
    }

    fn take<const N: usize>(&self, at: usize) -> Result<[u8; N], Unfit> {
        let bytes = at.checked_add(N).and_then(|end| self.bytes.get(at..end));
        bytes
            .and_then(|bytes| bytes.try_into().ok())
            .ok_or_else(|| Unfit::damaged("it ends inside an element"))
    }

    /// The range of `length` bytes at `at`, if it lies before `end`.
    fn stretch(&self, tag: Tag, at: usize, length: u32, end: usize) -> Result<Range<usize>, Unfit> {
        let there = end.saturating_sub(at);
        if length as usize > there {
            let name = name(tag);
            return Err(Unfit::damaged(format!("{name} says {length} bytes, and {there} are left")));
        }
        Ok(at..at + length as usize)
    }

    fn count(&mut self) -> Result<(), Unfit> {
        self.left = self
            .left
            .checked_sub(1)
            .ok_or_else(|| Unfit::damaged(format!("it has more than {MOST_ELEMENTS} elements")))?;
        Ok(())
    }
}

/// Whether an element holds items.
fn is_sequence(tag: Tag, vr: Option<VR>) -> bool {
    match vr {
        Some(vr) => vr == VR::SQ,
        None => StandardDataDictionary.by_tag(tag).is_some_and(|entry| entry.vr().relaxed() == VR::SQ),
    }
}

/// Whether a kind of value has a length of two bytes (PS3.5, table 7.1-2).
fn is_short(vr: VR) -> bool {
    use VR::{AE, AS, AT, CS, DA, DS, DT, FD, FL, IS, LO, LT, PN, SH, SL, SS, ST, TM, UI, UL, US};
    matches!(
        vr,
        AE | AS
            | AT
            | CS
            | DA
            | DS
            | DT
            | FD
            | FL
            | IS
            | LO
            | LT
            | PN
            | SH
            | SL
            | SS
            | ST
            | TM
            | UI
            | UL
            | US
    )
}

/// The name of an element for messages.
fn name(tag: Tag) -> String {
    match tag {
        ITEM => "an item".into(),
        _ => StandardDataDictionary
            .by_tag(tag)
            .map_or_else(|| tag.to_string(), |entry| entry.alias().to_owned()),
    }
}
