//! The OSC message with the readings of one board.

use core::fmt;
use core::iter::{once, repeat_n};

/// The usual OSC address of the board with this number: `/underfoot/board/0` is that of the first one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoardAddress(pub usize);

impl fmt::Display for BoardAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "/underfoot/board/{}", self.0)
    }
}

/// Appends a message with one OSC `i` for each count; a missing count is -1.
///
/// `number` counts the packets, or is the time of the sample in milliseconds; OSC has signed numbers only, so that
/// 2^31 and above are written as negative ones. `address` has no zero byte.
pub fn write_counts(
    address: &str,
    number: u32,
    counts: impl ExactSizeIterator<Item = Option<u16>>,
    out: &mut impl Extend<u8>,
) {
    write_head(address, number, repeat_n(b'i', counts.len()), out);
    for count in counts {
        out.extend(count.map_or(-1, i32::from).to_be_bytes());
    }
}

/// Appends a message with one OSC `f` for each force in newtons; see [`write_counts`].
pub fn write_newtons(
    address: &str,
    number: u32,
    forces: impl ExactSizeIterator<Item = f32>,
    out: &mut impl Extend<u8>,
) {
    write_head(address, number, repeat_n(b'f', forces.len()), out);
    for force in forces {
        out.extend(force.to_be_bytes());
    }
}

/// Appends a message with one OSC `b` of all counts, two bytes each; see [`write_counts`].
///
/// It has no code for a missing count. At most 2^31 counts have a length.
pub fn write_blob(
    address: &str,
    number: u32,
    counts: impl ExactSizeIterator<Item = u16>,
    out: &mut impl Extend<u8>,
) {
    write_head(address, number, once(b'b'), out);
    let length = 2 * counts.len();
    out.extend((length as u32).to_be_bytes());
    for count in counts {
        out.extend(count.to_be_bytes());
    }
    out.extend(repeat_n(0, length.next_multiple_of(4) - length));
}

/// Appends the address, the type tags, and the number.
fn write_head(
    address: &str,
    number: u32,
    tags: impl ExactSizeIterator<Item = u8>,
    out: &mut impl Extend<u8>,
) {
    out.extend(address.bytes());
    end_text(address.len(), out);
    let length = b",i".len() + tags.len();
    out.extend(*b",i");
    out.extend(tags);
    end_text(length, out);
    out.extend(number.to_be_bytes());
}

/// Appends the zeros behind a text of this length, at least one, up to a multiple of four bytes.
fn end_text(length: usize, out: &mut impl Extend<u8>) {
    out.extend(repeat_n(0, 4 - length % 4));
}
