//! Decodes frames of pixels to numbers.

mod jpeg;
mod jpeg2000;
mod native;
mod pieces;
mod rle;

use super::form::{Colours, Form};
use super::guard::{Coding, Numbers, Pixels, Stretch, Syntax};
use super::unfit::Unfit;
use pieces::Frames;

/// Greatest number of pixels of a compressed frame: decoding takes some 16 bytes for each.
const MOST_IN_A_FRAME: usize = 1 << 26;

/// Greatest number of pixels per compressed byte, and the number that any frame may have: a picture of one colour
/// takes some hundred bytes at any size, and such pictures are rarely large.
const MOST_IN_A_BYTE: usize = 1000;
const ALWAYS: usize = 1 << 22;

/// The numbers of one frame.
#[derive(Clone, Debug)]
pub struct Samples {
    /// All samples of the first pixel, of the second one, and so on, by rows; as stored.
    pub values: Vec<f32>,
    /// Their meaning; a decoder may have converted the colours.
    pub colours: Colours,
    /// Number of bits of the largest value.
    pub bits: u32,
}

/// The frames of a file.
pub struct Decoder<'a> {
    form: &'a Form,
    syntax: Syntax,
    numbers: Numbers,
    are_words: bool,
    frames: Frames<'a>,
}

impl<'a> Decoder<'a> {
    /// A decoder for the frames that `bytes` hold at `pixels`; `offsets` are those of frames among pieces, if the
    /// file has a table of its own for them.
    ///
    /// # Errors
    /// There are fewer bytes, or pieces, than the frames need.
    pub fn new(
        bytes: &'a [u8],
        pixels: &Pixels,
        syntax: Syntax,
        form: &'a Form,
        offsets: &[u64],
    ) -> Result<Self, Unfit> {
        let frames = match (&pixels.stretch, syntax.coding) {
            (Stretch::Whole(range), Coding::Native) => {
                let bytes = bytes.get(range.clone()).unwrap_or_default();
                Frames::equal(bytes, form.frames, native::bits_of_frame(form, pixels.numbers))?
            }
            (Stretch::Pieces { table, pieces }, coding) if coding != Coding::Native => {
                Frames::of_pieces(bytes, table, pieces, form.frames, offsets)?
            }
            (Stretch::Whole(_), _) => {
                return Err(Unfit::pixels("it says they are compressed, and they are not"));
            }
            (Stretch::Pieces { .. }, _) => {
                return Err(Unfit::pixels("it says they are not compressed, and they are in pieces"));
            }
        };
        Ok(Self { form, syntax, numbers: pixels.numbers, are_words: pixels.are_words, frames })
    }

    /// Decodes the frame of this number, from 0.
    ///
    /// # Errors
    /// It is damaged, or its format is not supported.
    pub fn frame(&self, number: usize) -> Result<Samples, Unfit> {
        let form = self.form;
        let compressed = || {
            let bytes = self.frames.bytes(number)?;
            let most = ALWAYS.max(bytes.len().saturating_mul(MOST_IN_A_BYTE)).min(MOST_IN_A_FRAME);
            if form.pixels() > most {
                let (there, length) = (form.pixels(), bytes.len());
                return Err(Unfit::pixels(format!("{there} of them can't be in {length} compressed bytes")));
            }
            Ok(bytes)
        };
        let samples = match self.syntax.coding {
            Coding::Native => native::decode(&self.frames.bits(number)?, form, self.numbers, self.order()),
            Coding::Rle => rle::decode(&compressed()?, form)?,
            Coding::Jpeg => jpeg::decode(&compressed()?, form)?,
            Coding::JpegLs => jpeg::decode_ls(&compressed()?, form)?,
            Coding::Jpeg2000 => jpeg2000::decode(&compressed()?, form)?,
        };
        if samples.values.len() != form.values() {
            return Err(Unfit::pixels("there are not as many numbers as pixels"));
        }
        Ok(samples)
    }

    fn order(&self) -> native::Order {
        let is_big_endian = self.syntax.encoding.is_big_endian();
        native::Order { is_big_endian, are_words: self.are_words }
    }
}
