//! Converts stored numbers to those of the modality, and maps these to grey levels.

use dicom_dictionary_std::tags;

use super::attributes::Attributes;
use super::colour::Pixels;

/// The range of values between black and white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    pub level: f64,
    pub width: f64,
}

/// The meaning of a frame's numbers (PS3.3, C.11.1).
#[derive(Clone, Debug)]
pub enum Scale {
    /// `slope * number + intercept`.
    Line { slope: f64, intercept: f64 },
    /// A table, and the number of its first entry.
    Table { first: i64, entries: Vec<u16> },
}

impl Scale {
    /// The scale of a frame, from 0.
    pub fn of_frame(file: Attributes, frame: usize) -> Self {
        if let Some(table) = file.item(tags::MODALITY_LUT_SEQUENCE, 0).and_then(Self::table) {
            return table;
        }
        let mut places = file.of_frame(frame, tags::PIXEL_VALUE_TRANSFORMATION_SEQUENCE);
        let line = places.find_map(|place| {
            let slope = place.number(tags::RESCALE_SLOPE)?;
            Some(Self::Line { slope, intercept: place.number(tags::RESCALE_INTERCEPT)? })
        });
        line.unwrap_or(Self::Line { slope: 1.0, intercept: 0.0 })
    }

    fn table(item: Attributes) -> Option<Self> {
        let first = *item.numbers(tags::LUT_DESCRIPTOR)?.get(1)? as i64;
        let entries = item.words(tags::LUT_DATA).filter(|entries| !entries.is_empty())?;
        Some(Self::Table { first, entries })
    }

    pub fn value(&self, stored: f32) -> f32 {
        match self {
            Self::Line { slope, intercept } => (f64::from(stored) * slope + intercept) as f32,
            Self::Table { first, entries } => {
                let index = (stored as i64 - first).clamp(0, entries.len() as i64 - 1);
                entries.get(index as usize).copied().map_or(0.0, f32::from)
            }
        }
    }
}

impl Window {
    /// Shows colours unchanged.
    pub const COLOURS: Self = Self { level: 127.5, width: 255.0 };

    /// The window in the file.
    pub fn asked(file: Attributes) -> Option<Self> {
        file.of_frame(0, tags::FRAME_VOILUT_SEQUENCE).find_map(|place| {
            let (level, width) = (place.number(tags::WINDOW_CENTER)?, place.number(tags::WINDOW_WIDTH)?);
            (width >= 1.0).then_some(Self { level, width })
        })
    }

    /// From the least value to the greatest one.
    pub fn of_all<'a>(frames: impl Iterator<Item = &'a Pixels>) -> Self {
        let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
        for frame in frames {
            let Pixels::Grey(values) = frame else { return Self::COLOURS };
            for value in values.iter().filter(|value| value.is_finite()) {
                (least, most) = (least.min(*value), most.max(*value));
            }
        }
        if least > most {
            return Self::COLOURS;
        }
        let (least, most) = (f64::from(least), f64::from(most));
        let width = most - least;
        // If all values are equal, they are in the middle.
        Self { level: 0.5 * (least + most), width: if width > 0.0 { width } else { 1.0 } }
    }
}
