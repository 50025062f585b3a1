//! The layout of pixels: size, bits, samples, colours.

use dicom_dictionary_std::tags;

use super::attributes::Attributes;
use super::guard::Numbers;
use super::unfit::Unfit;

/// The meaning of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// Grey values; the least one is black, or white.
    Grey {
        is_inverted: bool,
    },
    /// Numbers of colours in a palette.
    Palette,
    Rgb,
    /// Brightness and two differences of colour, over the whole range.
    Ybr,
    /// The same, with half as many differences of colour as brightnesses along a row.
    Ybr422,
}

/// The layout of pixels in all frames of a file.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    /// Pixels from left to right and from top to bottom.
    pub size: [usize; 2],
    pub frames: usize,
    /// Samples of a pixel: 1, or 3.
    pub samples: usize,
    pub colours: Colours,
    /// Whether each colour has a plane of its own.
    pub is_planar: bool,
    /// Number of bits of a sample, number of its significant bits, and position of the highest of these.
    pub allocated: u32,
    pub stored: u32,
    pub high: u32,
    pub is_signed: bool,
}

impl Form {
    /// The layout described by a file with these numbers.
    ///
    /// # Errors
    /// The layout is missing or not supported.
    pub fn of(file: Attributes, numbers: Numbers) -> Result<Self, Unfit> {
        let rows = file.count(tags::ROWS).ok_or(Unfit::Missing("its number of rows"))?;
        let columns = file.count(tags::COLUMNS).ok_or(Unfit::Missing("its number of columns"))?;
        if rows == 0 || columns == 0 {
            return Err(Unfit::Missing("a size of at least 1 x 1 pixels"));
        }
        let frames = match file.has(tags::NUMBER_OF_FRAMES) {
            true => file.count(tags::NUMBER_OF_FRAMES).unwrap_or(1).max(1),
            false => 1,
        };
        let samples = file.count(tags::SAMPLES_PER_PIXEL).unwrap_or(1);
        let colours = colours(file.text(tags::PHOTOMETRIC_INTERPRETATION).as_deref(), samples)?;
        let expected = if matches!(colours, Colours::Grey { .. } | Colours::Palette) { 1 } else { 3 };
        if samples != expected {
            return Err(Unfit::Format(format!("{samples} samples for each pixel, where {expected} belong")));
        }
        let allocated = match numbers {
            Numbers::Whole => {
                file.count(tags::BITS_ALLOCATED).ok_or(Unfit::Missing("the number of bits of a pixel"))?
            }
            Numbers::Float => 32,
            Numbers::Double => 64,
        };
        if numbers == Numbers::Whole && !matches!(allocated, 1 | 8 | 16 | 32) {
            return Err(Unfit::Format(format!("samples of {allocated} bits")));
        }
        let allocated = allocated as u32;
        let stored = file.count(tags::BITS_STORED).map_or(allocated, |bits| bits as u32);
        let stored = if (1..=allocated).contains(&stored) { stored } else { allocated };
        let high = file.count(tags::HIGH_BIT).map_or(stored - 1, |bit| bit as u32);
        let high = if (stored - 1..allocated).contains(&high) { high } else { stored - 1 };
        Ok(Self {
            size: [columns, rows],
            frames,
            samples,
            colours,
            is_planar: samples > 1 && file.count(tags::PLANAR_CONFIGURATION) == Some(1),
            allocated,
            stored,
            high,
            is_signed: file.count(tags::PIXEL_REPRESENTATION) == Some(1),
        })
    }

    pub fn pixels(&self) -> usize {
        self.size[0].saturating_mul(self.size[1])
    }

    /// Samples of one frame.
    pub fn values(&self) -> usize {
        self.pixels().saturating_mul(self.samples)
    }
}

fn colours(name: Option<&str>, samples: usize) -> Result<Colours, Unfit> {
    Ok(match name {
        Some("MONOCHROME1") => Colours::Grey { is_inverted: true },
        Some("MONOCHROME2") => Colours::Grey { is_inverted: false },
        Some("PALETTE COLOR") => Colours::Palette,
        // The last two are JPEG 2000's own transforms of red, green and blue.
        Some("RGB" | "YBR_RCT" | "YBR_ICT") => Colours::Rgb,
        Some("YBR_FULL") => Colours::Ybr,
        Some("YBR_FULL_422") => Colours::Ybr422,
        Some(other) => {
            let name: String = other.chars().filter(|sign| !sign.is_control()).take(16).collect();
            return Err(Unfit::Format(format!("colours as “{name}”")));
        }
        None if samples == 3 => Colours::Rgb,
        None => Colours::Grey { is_inverted: false },
    })
}
