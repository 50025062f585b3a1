//! Assigns bytes to frames.

use std::borrow::Cow;
use std::ops::Range;

use crate::series::unfit::Unfit;

/// The bytes of each frame.
pub enum Frames<'a> {
    /// Frames of the same number of bits each.
    Equal { bytes: &'a [u8], bits: usize },
    /// Frames in pieces of a file.
    Pieces { file: &'a [u8], frames: Vec<Vec<Range<usize>>> },
}

/// The bits of a frame, which may begin inside a byte.
pub struct Bits<'a> {
    /// The bytes of all frames.
    pub bytes: &'a [u8],
    pub first: usize,
}

impl<'a> Frames<'a> {
    /// Frames of `bits` each, one behind the other.
    ///
    /// # Errors
    /// There are not enough bytes for `count` of them.
    pub fn equal(bytes: &'a [u8], count: usize, bits: usize) -> Result<Self, Unfit> {
        let needed = bits.checked_mul(count).map_or(usize::MAX, |bits| bits.div_ceil(8));
        if bytes.len() < needed {
            let there = bytes.len();
            return Err(Unfit::pixels(format!("they need {needed} bytes, and {there} are there")));
        }
        Ok(Self::Equal { bytes, bits })
    }

    /// Frames in pieces: one piece for each, or those between two offsets, or, without offsets, those from one piece
    /// that begins a picture to the next.
    ///
    /// # Errors
    /// There are fewer pieces than frames, or their grouping is unknown.
    pub fn of_pieces(
        file: &'a [u8],
        table: &Range<usize>,
        pieces: &[Range<usize>],
        count: usize,
        offsets: &[u64],
    ) -> Result<Self, Unfit> {
        if pieces.len() < count {
            let there = pieces.len();
            return Err(Unfit::pixels(format!("there are {count} frames in {there} pieces")));
        }
        let frames = if pieces.len() == count {
            pieces.iter().map(|piece| vec![piece.clone()]).collect()
        } else if count == 1 {
            vec![pieces.to_vec()]
        } else {
            let written = file.get(table.clone()).unwrap_or_default();
            let words = written.as_chunks::<4>().0.iter().map(|word| u64::from(u32::from_le_bytes(*word)));
            let offsets = if offsets.is_empty() { words.collect() } else { offsets.to_vec() };
            grouped(file, pieces, count, &offsets)?
        };
        Ok(Self::Pieces { file, frames })
    }

    /// The bytes of a compressed frame.
    ///
    /// # Errors
    /// There is no such frame.
    pub fn bytes(&self, number: usize) -> Result<Cow<'a, [u8]>, Unfit> {
        let Self::Pieces { file, frames } = self else { return Err(missing(number)) };
        let pieces = frames.get(number).ok_or_else(|| missing(number))?;
        let piece = |range: &Range<usize>| file.get(range.clone()).unwrap_or_default();
        Ok(match pieces.as_slice() {
            [one] => Cow::Borrowed(piece(one)),
            some => Cow::Owned(some.iter().flat_map(piece).copied().collect()),
        })
    }

    /// The bits of an uncompressed frame.
    ///
    /// # Errors
    /// There is no such frame.
    pub fn bits(&self, number: usize) -> Result<Bits<'a>, Unfit> {
        let Self::Equal { bytes, bits } = self else { return Err(missing(number)) };
        let start = bits.checked_mul(number).ok_or_else(|| missing(number))?;
        Ok(Bits { bytes, first: start })
    }
}

fn missing(number: usize) -> Unfit {
    Unfit::pixels(format!("frame {} is missing", number + 1))
}

/// The pieces of each frame, grouped by the starts of frames.
fn grouped(
    file: &[u8],
    pieces: &[Range<usize>],
    count: usize,
    offsets: &[u64],
) -> Result<Vec<Vec<Range<usize>>>, Unfit> {
    let first = pieces.first().map_or(0, |piece| piece.start);
    let begins = |piece: &Range<usize>| match offsets {
        // JPEG and JPEG 2000 begin with markers of their own.
        [] => {
            let head = file.get(piece.start..piece.end.min(piece.start + 3)).unwrap_or_default();
            matches!(head, [0xff, 0xd8, 0xff] | [0xff, 0x4f, 0xff])
        }
        _ => offsets.contains(&((piece.start - first) as u64)),
    };
    let mut frames: Vec<Vec<Range<usize>>> = Vec::new();
    for piece in pieces {
        match frames.last_mut() {
            Some(frame) if !begins(piece) => frame.push(piece.clone()),
            _ => frames.push(vec![piece.clone()]),
        }
    }
    if frames.len() != count {
        let (there, pieces) = (frames.len(), pieces.len());
        return Err(Unfit::pixels(format!("{there} frames begin in {pieces} pieces, and it says {count}")));
    }
    Ok(frames)
}
