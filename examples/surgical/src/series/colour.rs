//! Converts samples to displayed pixels: grey values, or red, green and blue.

use dicom_core::Tag;
use dicom_dictionary_std::tags;

use super::attributes::Attributes;
use super::decode::Samples;
use super::form::Colours;
use super::unfit::Unfit;

/// The pixels of a picture, row by row.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// After the modality's own scale (such as Hounsfield units); NaN is shown black.
    Grey(Vec<f32>),
    /// Red, green and blue.
    Colour(Vec<[u8; 3]>),
}

/// The colours of a palette.
#[derive(Clone, Debug)]
pub struct Palette {
    /// The number of the first colour.
    first: i64,
    colours: Vec<[u8; 3]>,
}

/// Greatest number of colours of a palette: their numbers have 16 bits.
const MOST_COLOURS: usize = 1 << 16;

impl Palette {
    /// The palette of a file.
    ///
    /// # Errors
    /// It has none, or a damaged one.
    pub fn of(file: Attributes) -> Result<Self, Unfit> {
        let channels = [
            (
                tags::RED_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR,
                tags::RED_PALETTE_COLOR_LOOKUP_TABLE_DATA,
                tags::SEGMENTED_RED_PALETTE_COLOR_LOOKUP_TABLE_DATA,
            ),
            (
                tags::GREEN_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR,
                tags::GREEN_PALETTE_COLOR_LOOKUP_TABLE_DATA,
                tags::SEGMENTED_GREEN_PALETTE_COLOR_LOOKUP_TABLE_DATA,
            ),
            (
                tags::BLUE_PALETTE_COLOR_LOOKUP_TABLE_DESCRIPTOR,
                tags::BLUE_PALETTE_COLOR_LOOKUP_TABLE_DATA,
                tags::SEGMENTED_BLUE_PALETTE_COLOR_LOOKUP_TABLE_DATA,
            ),
        ];
        let mut first = 0;
        let mut channel = |(descriptor, data, segmented)| {
            let head = file.numbers(descriptor).ok_or(Unfit::Missing("its palette"))?;
            let &[count, start, bits] = head.as_slice() else { return Err(Unfit::Missing("its palette")) };
            first = start as i64;
            // Zero stands for 65,536 entries.
            let count = if count == 0.0 { MOST_COLOURS } else { count as usize };
            entries(file, data, segmented, count, bits as u32)
        };
        let [red, green, blue] = [channel(channels[0])?, channel(channels[1])?, channel(channels[2])?];
        let colours = red.iter().zip(&green).zip(&blue).map(|((red, green), blue)| [*red, *green, *blue]);
        Ok(Self { first, colours: colours.collect() })
    }

    /// The colour of a number; numbers beyond an end have the colour of that end.
    fn colour(&self, number: f32) -> [u8; 3] {
        let index = (number as i64 - self.first).clamp(0, self.colours.len() as i64 - 1);
        self.colours.get(index as usize).copied().unwrap_or_default()
    }
}

/// The strength of one colour in each entry of a palette.
fn entries(file: Attributes, data: Tag, segmented: Tag, count: usize, bits: u32) -> Result<Vec<u8>, Unfit> {
    let missing = || Unfit::Missing("its palette");
    let count = count.min(MOST_COLOURS);
    let words = match file.words(data) {
        // Entries of 8 bits may be packed two in a word, the lower half first.
        Some(words) if bits == 8 && words.len() < count => {
            words.iter().flat_map(|word| word.to_le_bytes()).map(u16::from).collect()
        }
        Some(words) => words,
        None => expanded(&file.words(segmented).ok_or_else(missing)?, count)?,
    };
    if words.len() < count || count == 0 {
        let there = words.len();
        return Err(Unfit::pixels(format!("their palette has {there} of {count} colours")));
    }
    let words = words.into_iter().take(count);
    // Some files declare 16 bits and use 8.
    let is_deep = bits > 8 && words.clone().any(|word| word > 0xff);
    Ok(words.map(|word| if is_deep { (word >> 8) as u8 } else { word as u8 }).collect())
}

/// Expands a palette in segments (PS3.3, C.7.9.2): constant, linear, and repeated ones.
fn expanded(words: &[u16], count: usize) -> Result<Vec<u16>, Unfit> {
    let cut = || Unfit::pixels("their palette in segments is damaged");
    let mut found: Vec<u16> = Vec::new();
    let mut at = 0;
    // The positions of segments to which a repetition may point.
    let mut repeated: Option<(usize, usize)> = None;
    while found.len() < count {
        if let Some((left, back)) = repeated
            && left == 0
        {
            (at, repeated) = (back, None);
            continue;
        }
        let Some(&kind) = words.get(at) else { break };
        let length = usize::from(*words.get(at + 1).ok_or_else(cut)?);
        match kind {
            0 => {
                found.extend(words.get(at + 2..at + 2 + length).ok_or_else(cut)?);
                at += 2 + length;
            }
            1 => {
                let to = f64::from(*words.get(at + 2).ok_or_else(cut)?);
                let from = f64::from(*found.last().ok_or_else(cut)?);
                let step = |index: usize| from + (to - from) * index as f64 / length as f64;
                found.extend((1..=length).map(|index| step(index).round() as u16));
                at += 3;
            }
            2 if repeated.is_none() && length > 0 => {
                let [low, high] =
                    [words.get(at + 2), words.get(at + 3)].map(|word| word.copied().unwrap_or(u16::MAX));
                let bytes = usize::from(low) | usize::from(high) << 16;
                repeated = Some((length, at + 4));
                at = bytes / 2;
                continue;
            }
            _ => return Err(cut()),
        }
        if let Some((left, _)) = &mut repeated {
            *left -= 1;
        }
    }
    Ok(found)
}

/// The displayed pixels of a frame; grey values go through `scale`.
///
/// # Errors
/// Its colours are in a palette, and the palette is missing.
pub fn shown(
    samples: Samples,
    palette: Option<&Palette>,
    scale: impl Fn(f32) -> f32,
) -> Result<Pixels, Unfit> {
    let bits = samples.bits;
    let colours = samples.values.as_chunks::<3>().0;
    Ok(match samples.colours {
        Colours::Grey { .. } => Pixels::Grey(samples.values.into_iter().map(scale).collect()),
        Colours::Palette => {
            let palette = palette.ok_or(Unfit::Missing("its palette"))?;
            Pixels::Colour(samples.values.iter().map(|number| palette.colour(*number)).collect())
        }
        Colours::Rgb => {
            Pixels::Colour(colours.iter().map(|colour| colour.map(|it| eighth(it, bits))).collect())
        }
        Colours::Ybr | Colours::Ybr422 => {
            Pixels::Colour(colours.iter().map(|colour| rgb(colour.map(|it| eighth(it, bits)))).collect())
        }
    })
}

/// A number of `bits` as one of 8.
fn eighth(number: f32, bits: u32) -> u8 {
    let most = f64::from(2.0_f32.powi(bits as i32)) - 1.0;
    let number = f64::from(number).max(0.0);
    if bits > 8 {
        (number / 2.0_f64.powi(bits as i32 - 8)) as u8
    } else {
        (number * 255.0 / most).round() as u8
    }
}

/// Red, green and blue from brightness and two colour differences (PS3.3, C.7.6.3.1.2; ITU-R BT.601).
fn rgb([y, blue, red]: [u8; 3]) -> [u8; 3] {
    let [y, blue, red] = [f64::from(y), f64::from(blue) - 128.0, f64::from(red) - 128.0];
    let colours = [y + 1.402 * red, y - 0.344_136 * blue - 0.714_136 * red, y + 1.772 * blue];
    colours.map(|colour| colour.round().clamp(0.0, 255.0) as u8)
}
