//! The claims of a JPEG 2000 codestream, checked before decoding (ISO/IEC 15444-1, annex A).

use crate::series::form::Form;
use crate::series::unfit::Unfit;

/// Greatest number of bits of a sample.
const MOST_BITS: u32 = 16;

/// Greatest number of tiles of a picture: their numbers have 16 bits.
const MOST_TILES: u64 = 65_535;

/// Greatest memory of the decoder for blocks and precincts, in bytes, as estimated here.
const MOST_MEMORY: u64 = 1 << 29;

/// Bytes for a block with its layers and for a precinct: measured with the smallest possible ones.
const BLOCK: u64 = 1024;
const PRECINCT: u64 = 256;

/// Markers of segments.
const SIZE: u8 = 0x51;
const CODING: u8 = 0x52;
const CODING_OF_PART: u8 = 0x53;
const TILE_PART: u8 = 0x90;
const DATA: u8 = 0x93;
const END: u8 = 0xd9;

/// The parameters in a codestream's headers.
#[derive(Debug, Default)]
pub struct Header {
    size: [u32; 2],
    parts: usize,
    tiles: u64,
    /// Whether a component has fewer pixels than others.
    is_subsampled: bool,
    pub bits: u32,
    pub is_signed: bool,
    /// Whether three components are coded as brightness and colour differences.
    pub is_transformed: bool,
    /// Number of blocks and of precincts per pixel, the greatest anywhere.
    blocks: f64,
    precincts: f64,
}

impl Header {
    /// Reads the headers of a codestream and of all of its tiles.
    ///
    /// # Errors
    /// They are damaged.
    pub fn read(stream: &[u8]) -> Result<Self, Unfit> {
        let mut header = Self::default();
        let mut at = 2;
        // The start and length of the present tile part.
        let mut part = None;
        while let Some(&[0xff, mark]) = stream.get(at..at + 2) {
            if mark == DATA {
                // Continues behind the part's data; its length is in its header, where 0 means to the end.
                let Some((start, length)) = part.take() else { break };
                if length == 0 {
                    break;
                }
                at = start + length as usize;
                continue;
            }
            if mark == END {
                break;
            }
            if (0x30..=0x3f).contains(&mark) {
                at += 2;
                continue;
            }
            let length = word(stream, at + 2)? as usize;
            let segment = stream.get(at + 4..at + 2 + length.max(2)).ok_or_else(cut)?;
            match mark {
                SIZE => header.read_size(segment)?,
                CODING => {
                    header.is_transformed |= byte(segment, 4)? != 0;
                    header.read_coding(byte(segment, 0)?, segment.get(5..).unwrap_or_default())?;
                }
                CODING_OF_PART => {
                    let skipped = if header.parts < 257 { 1 } else { 2 };
                    header.read_coding(
                        byte(segment, skipped)?,
                        segment.get(skipped + 1..).unwrap_or_default(),
                    )?;
                }
                TILE_PART => {
                    let length = long(segment, 2)?;
                    // With a length below that of its own header, the loop would never end.
                    if length != 0 && length < 14 {
                        return Err(cut());
                    }
                    part = Some((at, length));
                }
                _ => {}
            }
            at += 2 + length.max(2);
        }
        Ok(header)
    }

    /// Checks that it is the picture that the file describes, and that it fits into memory.
    ///
    /// # Errors
    /// A parameter differs, or the memory is too large.
    pub fn check(&self, form: &Form) -> Result<(), Unfit> {
        let is = self.size.map(|side| side as usize);
        if is != form.size || self.parts != form.samples {
            let ([width, height], [columns, rows]) = (is, form.size);
            let why = format!(
                "they are {width} x {height} of {} samples each, and the file says {columns} x {rows} of {}",
                self.parts, form.samples
            );
            return Err(Unfit::Pixels(why));
        }
        if self.is_subsampled {
            return Err(Unfit::Format("JPEG 2000 with fewer colours than pixels".into()));
        }
        if !(1..=MOST_BITS).contains(&self.bits) {
            return Err(Unfit::Format(format!("JPEG 2000 of {} bits", self.bits)));
        }
        let values = form.values() as f64;
        let memory = values * (self.blocks * BLOCK as f64 + self.precincts * PRECINCT as f64);
        if self.tiles > MOST_TILES || memory > MOST_MEMORY as f64 {
            return Err(Unfit::pixels("JPEG 2000 in too many small parts"));
        }
        Ok(())
    }

    fn read_size(&mut self, segment: &[u8]) -> Result<(), Unfit> {
        let side = |end: usize, start: usize| {
            Ok::<_, Unfit>(long(segment, end)?.saturating_sub(long(segment, start)?))
        };
        self.size = [side(2, 10)?, side(6, 14)?];
        let tile = [long(segment, 18)?, long(segment, 22)?];
        let whole = [side(2, 26)?, side(6, 30)?];
        if tile.contains(&0) {
            return Err(cut());
        }
        self.tiles = u64::from(whole[0].div_ceil(tile[0])) * u64::from(whole[1].div_ceil(tile[1]));
        self.parts = usize::from(word(segment, 34)?);
        let depth = byte(segment, 36)?;
        (self.bits, self.is_signed) = (u32::from(depth & 0x7f) + 1, depth & 0x80 != 0);
        for part in 0..self.parts {
            let [own, right, down] = [0, 1, 2].map(|index| byte(segment, 36 + 3 * part + index));
            self.is_subsampled |= (right?, down?) != (1, 1);
            if own? != depth {
                return Err(Unfit::Format("JPEG 2000 with samples of different depths".into()));
            }
        }
        Ok(())
    }

    /// Sizes of blocks and precincts, as powers of two.
    fn read_coding(&mut self, style: u8, segment: &[u8]) -> Result<(), Unfit> {
        let share = |exponents: u32| 0.5_f64.powi(exponents as i32);
        let [wide, high] = [byte(segment, 1)?, byte(segment, 2)?].map(|power| u32::from(power & 0xf) + 2);
        self.blocks = self.blocks.max(share(wide + high));
        if style & 1 != 0 {
            // From the smallest picture to the whole one, each with four times as many pixels.
            for (smaller, sizes) in segment.get(5..).unwrap_or_default().iter().rev().enumerate() {
                let precinct = u32::from(sizes & 0xf) + u32::from(sizes >> 4);
                let pixels = share(2 * smaller as u32);
                self.precincts = self.precincts.max(pixels * share(precinct));
                // A block is at most as large as its precinct, which is half as large in the bands of a level.
                self.blocks = self.blocks.max(pixels * share(precinct.saturating_sub(2)));
            }
        }
        Ok(())
    }
}

fn cut() -> Unfit {
    Unfit::pixels("the head of a JPEG 2000 picture is damaged")
}

fn byte(bytes: &[u8], at: usize) -> Result<u8, Unfit> {
    bytes.get(at).copied().ok_or_else(cut)
}

fn word(bytes: &[u8], at: usize) -> Result<u16, Unfit> {
    Ok(u16::from_be_bytes([byte(bytes, at)?, byte(bytes, at + 1)?]))
}

fn long(bytes: &[u8], at: usize) -> Result<u32, Unfit> {
    Ok(u32::from(word(bytes, at)?) << 16 | u32::from(word(bytes, at + 2)?))
}
