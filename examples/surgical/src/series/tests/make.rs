//! Small DICOM files, written byte by byte: their lengths may be wrong.

use dicom_core::{Tag, VR};
use dicom_dictionary_std::{tags, uids};

use crate::series::guard::Encoding;

/// The syntax of big-endian files, which the standard has retired.
pub const BIG_ENDIAN: &str = "1.2.840.10008.1.2.2";

/// An undefined length.
pub const OPEN: u32 = u32::MAX;

const ITEM: Tag = Tag(0xfffe, 0xe000);
const SEQUENCE_END: Tag = Tag(0xfffe, 0xe0dd);

/// A file, element by element.
#[derive(Clone)]
pub struct Maker {
    pub encoding: Encoding,
    uid: &'static str,
    elements: Vec<u8>,
}

impl Maker {
    /// A file of this transfer syntax without any element.
    pub fn new(uid: &'static str) -> Self {
        let encoding = match uid {
            uids::IMPLICIT_VR_LITTLE_ENDIAN => Encoding::Implicit,
            BIG_ENDIAN => Encoding::BigEndian,
            _ => Encoding::Explicit,
        };
        Self { encoding, uid, elements: Vec::new() }
    }

    /// A picture of this size with grey values of `bits` bits, without pixels yet.
    pub fn picture(uid: &'static str, [columns, rows]: [u16; 2], bits: u16) -> Self {
        let allocated = if bits == 1 { 1 } else { bits.next_multiple_of(8).next_power_of_two() };
        Self::new(uid)
            .number(tags::SAMPLES_PER_PIXEL, 1)
            .text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "MONOCHROME2")
            .number(tags::ROWS, rows)
            .number(tags::COLUMNS, columns)
            .number(tags::BITS_ALLOCATED, allocated)
            .number(tags::BITS_STORED, bits)
            .number(tags::HIGH_BIT, bits - 1)
            .number(tags::PIXEL_REPRESENTATION, 0)
    }

    /// A picture of this size in colours of 8 bits, without pixels yet.
    pub fn colours(uid: &'static str, size: [u16; 2], name: &str) -> Self {
        Self::picture(uid, size, 8)
            .number(tags::SAMPLES_PER_PIXEL, 3)
            .number(tags::PLANAR_CONFIGURATION, 0)
            .text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, name)
    }

    fn short(&self, number: u16) -> [u8; 2] {
        if self.encoding.is_big_endian() { number.to_be_bytes() } else { number.to_le_bytes() }
    }

    fn long(&self, number: u32) -> [u8; 4] {
        if self.encoding.is_big_endian() { number.to_be_bytes() } else { number.to_le_bytes() }
    }

    /// The header of an element with a length that may be wrong.
    pub fn head(mut self, tag: Tag, vr: VR, length: u32) -> Self {
        let (group, element) = (self.short(tag.0), self.short(tag.1));
        self.elements.extend([group, element].concat());
        if !self.encoding.is_explicit() || tag.0 == 0xfffe {
            self.elements.extend(self.long(length));
            return self;
        }
        self.elements.extend(vr.to_bytes());
        if matches!(vr, VR::OB | VR::OW | VR::OF | VR::OD | VR::OV | VR::SQ | VR::UN | VR::UT) {
            self.elements.extend([0, 0]);
            self.elements.extend(self.long(length));
        } else {
            self.elements.extend(self.short(length as u16));
        }
        self
    }

    pub fn raw(mut self, bytes: &[u8]) -> Self {
        self.elements.extend(bytes);
        self
    }

    pub fn bytes(self, tag: Tag, vr: VR, bytes: &[u8]) -> Self {
        let spare = bytes.len() % 2;
        let length = (bytes.len() + spare) as u32;
        self.head(tag, vr, length).raw(bytes).raw(&[0][..spare])
    }

    pub fn text(self, tag: Tag, vr: VR, text: &str) -> Self {
        let spare = text.len() % 2;
        self.bytes(tag, vr, format!("{text}{:spare$}", "").as_bytes())
    }

    pub fn number(self, tag: Tag, number: u16) -> Self {
        self.numbers(tag, VR::US, &[number])
    }

    pub fn numbers(self, tag: Tag, vr: VR, numbers: &[u16]) -> Self {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| self.short(*number)).collect();
        self.bytes(tag, vr, &bytes)
    }

    /// A sequence of items, each with the elements of a file.
    pub fn sequence(self, tag: Tag, items: &[Self]) -> Self {
        let mut inside = Self { elements: Vec::new(), ..self.clone() };
        for item in items {
            inside = inside.head(ITEM, VR::UN, item.elements.len() as u32).raw(&item.elements);
        }
        self.bytes(tag, VR::SQ, &inside.elements)
    }

    pub fn pixels(self, vr: VR, bytes: &[u8]) -> Self {
        self.bytes(tags::PIXEL_DATA, vr, bytes)
    }

    /// Pixels in pieces, after a table of frame offsets.
    pub fn pieces(self, table: &[u32], pieces: &[&[u8]]) -> Self {
        let table: Vec<u8> = table.iter().flat_map(|offset| self.long(*offset)).collect();
        let mut file = self.head(tags::PIXEL_DATA, VR::OB, OPEN).bytes(ITEM, VR::UN, &table);
        for piece in pieces {
            file = file.bytes(ITEM, VR::UN, piece);
        }
        file.head(SEQUENCE_END, VR::UN, 0)
    }

    /// The elements alone.
    pub fn elements(&self) -> &[u8] {
        &self.elements
    }

    /// The file's meta elements, then `data`.
    pub fn with_data(&self, data: &[u8]) -> Vec<u8> {
        let meta =
            Self::new(uids::EXPLICIT_VR_LITTLE_ENDIAN).text(tags::TRANSFER_SYNTAX_UID, VR::UI, self.uid);
        [&[0; 128], b"DICM".as_slice(), &meta.elements, data].concat()
    }

    /// The whole file.
    pub fn file(&self) -> Vec<u8> {
        self.with_data(&self.elements)
    }
}
