//! Limits on a datagram, checked before it is decoded.

use arrayvec::ArrayVec;
use rosc::OscTime;
use thiserror::Error;

/// Limits beyond which a datagram is rejected before decoding.
///
/// Every limit is far above the needs of a board or an app, and far below the depth that exhausts the stack of a
/// recursive decoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DatagramLimits {
    /// Maximum number of bytes.
    pub bytes: usize,
    /// Maximum nesting of bundles; at most [`DatagramLimits::MAX_DEPTH`], 0 allows messages only.
    pub depth: usize,
    /// Maximum number of bundle elements, counted over all bundles.
    pub elements: usize,
    /// Maximum number of type tags of one message.
    pub tags: usize,
    /// Maximum number of bytes of one address.
    pub address: usize,
}

impl DatagramLimits {
    /// Upper limit on the nesting of bundles, regardless of [`DatagramLimits::depth`].
    pub const MAX_DEPTH: usize = 8;

    /// Maximum nesting of arrays within a message.
    const MAX_ARRAY_DEPTH: usize = 4;

    /// Limits for sensor boards and apps: 8 KiB, bundles four deep, 256 messages of 256 arguments.
    pub const SENSORS: Self = Self { bytes: 8192, depth: 4, elements: 256, tags: 256, address: 128 };
}

impl Default for DatagramLimits {
    fn default() -> Self {
        Self::SENSORS
    }
}

/// Reason for which a datagram is not well-formed OSC, or exceeds the limits; `at` is a byte offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Malformed {
    /// The datagram is empty.
    #[error("the datagram is empty")]
    Empty,
    /// It is longer than [`DatagramLimits::bytes`].
    #[error("{bytes} bytes are more than the {limit} a datagram may have")]
    TooLarge {
        /// Bytes received; a socket may have cut the rest off.
        bytes: usize,
        /// Bytes allowed.
        limit: usize,
    },
    /// Its length, or that of a bundle element, is not a multiple of four.
    #[error("a length of {length} bytes is not a multiple of 4 (at byte {at})")]
    Length {
        /// The length.
        length: usize,
        /// Its place.
        at: usize,
    },
    /// An element, string, blob or argument extends past the end of its container.
    #[error("cut short: what starts at byte {at} reaches past the end")]
    CutShort {
        /// The start of that part.
        at: usize,
    },
    /// Bundles or arrays nest deeper than allowed, or an array is not closed.
    #[error("bundles or arrays nest too deep (at byte {at})")]
    TooDeep {
        /// The place of the excess.
        at: usize,
    },
    /// More bundle elements, type tags or address bytes than allowed.
    #[error("more elements, arguments or address bytes than allowed (at byte {at})")]
    TooMany {
        /// The place of the excess.
        at: usize,
    },
    /// An element is neither a bundle nor a message with an address starting in `/`.
    #[error("neither a message nor a bundle at byte {at}")]
    Neither {
        /// The start of the element.
        at: usize,
    },
    /// A text holds bytes that OSC text may not have, or a type tag is unknown.
    #[error("bytes that are not OSC text, or an unknown type tag (at byte {at})")]
    Text {
        /// Its place.
        at: usize,
    },
    /// Bytes remain after the last argument.
    #[error("bytes are left over at byte {at}")]
    LeftOver {
        /// The first of these bytes.
        at: usize,
    },
}

/// Checks whether an OSC decoder can safely read `datagram`.
///
/// Reads the datagram once, front to back, without recursion or allocation: `limits` bound time and memory for any
/// bytes. A datagram that passes is well-formed throughout: every element, string, blob and argument lies within its
/// container, no byte is left over, texts are UTF-8 (addresses ASCII), arrays are closed.
///
/// # Errors
/// [`Malformed`] gives the first fault and its place. No part of such a datagram should be used.
///
/// # Source
/// Open Sound Control 1.0 with the type tags of 1.1, as far as rosc supports them.
pub fn check(datagram: &[u8], limits: &DatagramLimits) -> Result<(), Malformed> {
    walk(datagram, limits, |scan, _| match scan.form(limits)? {
        Form::Whole => Ok(()),
        Form::Bare { at } => Err(Malformed::CutShort { at }),
        Form::Untagged { at } | Form::Unknown { at } => Err(Malformed::Text { at }),
    })
}

/// Checks whether `datagram` splits into its parts: as [`check`], but a message may have no type tags or unknown
/// ones, and a message in a bundle may exceed `limits`. [`form`] tells which messages are readable.
pub(super) fn check_parts(datagram: &[u8], limits: &DatagramLimits) -> Result<(), Malformed> {
    walk(datagram, limits, |scan, is_alone| match scan.form(limits) {
        Err(Malformed::TooMany { .. }) if !is_alone => Ok(()),
        form => form.map(drop),
    })
}

/// The readable part of a message; `at` is a byte offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// To its last byte.
    Whole,
    /// It ends after its address, as older senders write a message without arguments.
    Bare {
        /// Place where its type tags would begin.
        at: usize,
    },
    /// Bytes follow its address without type tags for them.
    Untagged {
        /// Place where its type tags would begin.
        at: usize,
    },
    /// Some of its type tags are unknown, so that its arguments are unreadable.
    Unknown {
        /// Place of its type tags.
        at: usize,
    },
}

/// Returns the readable part of the message `bytes`.
///
/// # Errors
/// [`Malformed`] if it exceeds `limits`, or is not well-formed.
pub(super) fn form(bytes: &[u8], limits: &DatagramLimits) -> Result<Form, Malformed> {
    Scan { bytes, offset: 0, at: 0 }.form(limits)
}

/// Calls `message` for all messages of `datagram`; the flag says whether the message stands alone.
fn walk(
    datagram: &[u8],
    limits: &DatagramLimits,
    mut message: impl FnMut(Scan<'_>, bool) -> Result<(), Malformed>,
) -> Result<(), Malformed> {
    if datagram.is_empty() {
        return Err(Malformed::Empty);
    }
    if datagram.len() > limits.bytes {
        return Err(Malformed::TooLarge { bytes: datagram.len(), limit: limits.bytes });
    }
    if !datagram.len().is_multiple_of(4) {
        return Err(Malformed::Length { length: datagram.len(), at: 0 });
    }

    // End of each open bundle, outermost first; the outermost element is the datagram itself.
    let mut ends: ArrayVec<usize, { DatagramLimits::MAX_DEPTH }> = ArrayVec::new();
    let mut elements = 0;
    let mut element = 0..datagram.len();
    loop {
        let bytes = datagram.get(element.clone()).ok_or(Malformed::CutShort { at: element.start })?;
        let mut next = element.end;
        if bytes.starts_with(BUNDLE_TAG) {
            if bytes.len() < BUNDLE_HEADER {
                return Err(Malformed::CutShort { at: element.start });
            }
            if ends.len() >= limits.depth || ends.try_push(element.end).is_err() {
                return Err(Malformed::TooDeep { at: element.start });
            }
            next = element.start + BUNDLE_HEADER;
        } else {
            message(Scan { bytes, offset: element.start, at: 0 }, ends.is_empty())?;
        }

        while ends.last() == Some(&next) {
            ends.pop();
        }
        let Some(&end) = ends.last() else { return Ok(()) };

        elements += 1;
        if elements > limits.elements {
            return Err(Malformed::TooMany { at: next });
        }
        let length = datagram.get(next..end).and_then(be_u32).ok_or(Malformed::CutShort { at: next })?;
        let start = next + 4;
        if length % 4 != 0 {
            return Err(Malformed::Length { length, at: next });
        }
        if length == 0 {
            return Err(Malformed::Neither { at: start });
        }
        if length > end - start {
            return Err(Malformed::CutShort { at: next });
        }
        element = start..start + length;
    }
}

const BUNDLE_TAG: &[u8] = b"#bundle\0";

/// Bytes of the bundle tag and the time tag.
const BUNDLE_HEADER: usize = 16;

/// A bundle that [`check`] has accepted.
pub(super) struct Bundle<'a> {
    /// Time at which it is due.
    pub(super) time_tag: OscTime,
    elements: &'a [u8],
}

impl<'a> Bundle<'a> {
    /// Reads `bytes` as a bundle; `None` if they are a message.
    pub(super) fn of(bytes: &'a [u8]) -> Option<Self> {
        let (seconds, rest) = bytes.strip_prefix(BUNDLE_TAG)?.split_first_chunk()?;
        let (fractional, elements) = rest.split_first_chunk()?;
        let [seconds, fractional] = [seconds, fractional].map(|word| u32::from_be_bytes(*word));
        Some(Self { time_tag: OscTime { seconds, fractional }, elements })
    }

    /// Returns its messages and bundles, in order.
    pub(super) fn elements(&self) -> impl Iterator<Item = &'a [u8]> {
        let mut rest = self.elements;
        std::iter::from_fn(move || {
            let (element, behind) = rest.get(4..)?.split_at_checked(be_u32(rest)?)?;
            rest = behind;
            Some(element)
        })
    }
}

fn be_u32(bytes: &[u8]) -> Option<usize> {
    let word: [u8; 4] = bytes.get(..4)?.try_into().ok()?;
    usize::try_from(u32::from_be_bytes(word)).ok()
}

/// A scan of one message; the length of `bytes` is a multiple of four.
struct Scan<'a> {
    bytes: &'a [u8],
    /// Offset of `bytes` in the datagram, for error messages.
    offset: usize,
    at: usize,
}

impl<'a> Scan<'a> {
    fn form(mut self, limits: &DatagramLimits) -> Result<Form, Malformed> {
        if self.bytes.first() != Some(&b'/') {
            return Err(Malformed::Neither { at: self.offset });
        }
        let address = self.text()?;
        if !address.bytes().all(|byte| byte.is_ascii_graphic() || byte == b' ') {
            return Err(Malformed::Text { at: self.offset });
        }
        let at = self.offset + self.at;
        let form = match self.rest().first() {
            None => Form::Bare { at },
            Some(b',') => self.tagged(limits, at)?,
            Some(_) => Form::Untagged { at },
        };
        if address.len() > limits.address {
            return Err(Malformed::TooMany { at: self.offset });
        }
        Ok(form)
    }

    /// Returns the form of a message with its type tags at `at`.
    fn tagged(&mut self, limits: &DatagramLimits, at: usize) -> Result<Form, Malformed> {
        let tags = self.text()?.strip_prefix(',').unwrap_or_default();
        if !self.arguments(tags, at)? {
            return Ok(Form::Unknown { at });
        }
        if self.at < self.bytes.len() {
            return Err(Malformed::LeftOver { at: self.offset + self.at });
        }
        if tags.len() > limits.tags {
            return Err(Malformed::TooMany { at });
        }
        Ok(Form::Whole)
    }

    /// Skips the arguments; false at the first tag that rosc does not support.
    fn arguments(&mut self, tags: &str, tags_at: usize) -> Result<bool, Malformed> {
        let mut depth = 0;
        for tag in tags.bytes() {
            match tag {
                b'i' | b'f' | b'r' | b'm' => self.skip(4)?,
                b'h' | b'd' | b't' => self.skip(8)?,
                b'T' | b'F' | b'N' | b'I' => {}
                b's' => {
                    self.text()?;
                }
                b'c' => self.character()?,
                b'b' => self.blob()?,
                b'[' if depth < DatagramLimits::MAX_ARRAY_DEPTH => depth += 1,
                b'[' => return Err(Malformed::TooDeep { at: tags_at }),
                b']' if depth > 0 => depth -= 1,
                b']' => return Err(Malformed::Text { at: tags_at }),
                _ => return Ok(false),
            }
        }
        if depth == 0 { Ok(true) } else { Err(Malformed::TooDeep { at: tags_at }) }
    }

    fn cut_short(&self) -> Malformed {
        Malformed::CutShort { at: self.offset + self.at }
    }

    fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    fn skip(&mut self, length: usize) -> Result<(), Malformed> {
        if length > self.rest().len() {
            return Err(self.cut_short());
        }
        self.at += length;
        Ok(())
    }

    /// Reads a string with its terminator, padded to four bytes.
    fn text(&mut self) -> Result<&'a str, Malformed> {
        let rest = self.rest();
        let length = rest.iter().position(|&byte| byte == 0).ok_or_else(|| self.cut_short())?;
        let bytes = rest.get(..length).unwrap_or_default();
        let text = std::str::from_utf8(bytes).map_err(|_| Malformed::Text { at: self.offset + self.at })?;
        self.skip((length + 1).next_multiple_of(4))?;
        Ok(text)
    }

    fn character(&mut self) -> Result<(), Malformed> {
        let code = be_u32(self.rest()).ok_or_else(|| self.cut_short())?;
        if u32::try_from(code).ok().and_then(char::from_u32).is_none() {
            return Err(Malformed::Text { at: self.offset + self.at });
        }
        self.skip(4)
    }

    fn blob(&mut self) -> Result<(), Malformed> {
        let length = be_u32(self.rest()).ok_or_else(|| self.cut_short())?;
        // Checked before rounding up, which could overflow on a 32-bit machine.
        if length > self.rest().len() {
            return Err(self.cut_short());
        }
        self.skip(4 + length.next_multiple_of(4))
    }
}

#[cfg(test)]
mod tests;
