//! Transfer syntaxes: the encodings of a file's elements and of its pixels.

use dicom_transfer_syntax_registry::entries::{
    EXPLICIT_VR_BIG_ENDIAN, EXPLICIT_VR_LITTLE_ENDIAN, IMPLICIT_VR_LITTLE_ENDIAN,
};
use dicom_transfer_syntax_registry::{TransferSyntax, TransferSyntaxIndex, TransferSyntaxRegistry};

use crate::series::unfit::Unfit;

/// The encoding of elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Implicit,
    Explicit,
    BigEndian,
}

impl Encoding {
    pub fn is_explicit(self) -> bool {
        self != Self::Implicit
    }

    pub fn is_big_endian(self) -> bool {
        self == Self::BigEndian
    }

    /// The same for the library that reads elements.
    pub fn transfer_syntax(self) -> TransferSyntax {
        match self {
            Self::Implicit => IMPLICIT_VR_LITTLE_ENDIAN.erased(),
            Self::Explicit => EXPLICIT_VR_LITTLE_ENDIAN.erased(),
            Self::BigEndian => EXPLICIT_VR_BIG_ENDIAN.erased(),
        }
    }

    pub fn u16(self, bytes: [u8; 2]) -> u16 {
        if self.is_big_endian() { u16::from_be_bytes(bytes) } else { u16::from_le_bytes(bytes) }
    }

    pub fn u32(self, bytes: [u8; 4]) -> u32 {
        if self.is_big_endian() { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
    }
}

/// The encoding of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    Native,
    Rle,
    Jpeg,
    JpegLs,
    Jpeg2000,
}

/// A transfer syntax.
#[derive(Clone, Copy, Debug)]
pub struct Syntax {
    pub encoding: Encoding,
    pub coding: Coding,
    /// Whether all elements after the file's meta elements are compressed together.
    pub is_deflated: bool,
}

impl Syntax {
    pub fn native(encoding: Encoding) -> Self {
        Self { encoding, coding: Coding::Native, is_deflated: false }
    }

    /// The syntax with this identifier.
    ///
    /// # Errors
    /// It is not supported; the message names it in words if the standard does.
    pub fn of(uid: &str) -> Result<Self, Unfit> {
        let explicit = |coding| Self { coding, ..Self::native(Encoding::Explicit) };
        // PS3.6, annex A.
        let Some(number) = uid.strip_prefix("1.2.840.10008.1.2") else { return Err(unknown(uid)) };
        Ok(match number {
            "" => Self::native(Encoding::Implicit),
            ".1" => Self::native(Encoding::Explicit),
            ".1.99" => Self { is_deflated: true, ..Self::native(Encoding::Explicit) },
            ".2" => Self::native(Encoding::BigEndian),
            ".5" => explicit(Coding::Rle),
            ".4.50" | ".4.51" | ".4.53" | ".4.55" | ".4.57" | ".4.70" => explicit(Coding::Jpeg),
            ".4.80" | ".4.81" => explicit(Coding::JpegLs),
            ".4.90" | ".4.91" => explicit(Coding::Jpeg2000),
            _ => return Err(unknown(uid)),
        })
    }
}

fn unknown(uid: &str) -> Unfit {
    match TransferSyntaxRegistry.get(uid) {
        Some(syntax) => Unfit::Format(syntax.name().to_owned()),
        None => Unfit::Format(format!("an unknown one with the identifier {}", clean(uid))),
    }
}

/// The printable part of a text.
fn clean(text: &str) -> String {
    text.chars().filter(|sign| sign.is_ascii_graphic()).take(64).collect()
}
