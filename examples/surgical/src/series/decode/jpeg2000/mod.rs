//! JPEG 2000.

mod header;

use hayro_jpeg2000::{DecodeSettings, DecoderContext, Image};

use super::Samples;
use super::native::signed;
use crate::series::form::{Colours, Form};
use crate::series::unfit::Unfit;
use header::Header;

/// First bytes of a codestream.
const START: [u8; 4] = [0xff, 0x4f, 0xff, 0x51];

/// Greatest offset of a codestream in a frame: boxes before it violate the standard but occur.
const LATEST_START: usize = 4096;

/// The numbers of a frame.
///
/// # Errors
/// It is damaged, its size differs from the file's, or its kind is not supported.
pub fn decode(bytes: &[u8], form: &Form) -> Result<Samples, Unfit> {
    let start = bytes.windows(START.len()).take(LATEST_START).position(|window| window == START);
    let stream = start
        .and_then(|start| bytes.get(start..))
        .ok_or_else(|| Unfit::pixels("no JPEG 2000 begins in them"))?;
    let header = Header::read(stream)?;
    header.check(form)?;
    let settings = DecodeSettings { resolve_palette_indices: false, strict: false, target_resolution: None };
    let failed = |error: &dyn std::fmt::Display| Unfit::pixels(format!("JPEG 2000: {error}"));
    let image = Image::new(stream, &settings).map_err(|error| failed(&error))?;
    let mut context = DecoderContext::default();
    let decoded = image.decode(&mut context).map_err(|error| failed(&error))?;
    let parts = decoded.components();
    if parts.len() != form.samples || parts.iter().any(|part| part.samples().len() != form.pixels()) {
        return Err(Unfit::pixels("there are not as many numbers as pixels"));
    }
    let (bits, half) = (header.bits, f32::from(1_u16 << (header.bits - 1)));
    let number = |value: f32| {
        let value = value.round();
        if header.is_signed {
            // The decoder shifts all numbers to start at zero.
            value - half
        } else {
            signed(value as u64, bits, form.is_signed) as f32
        }
    };
    let at = |pixel: usize, part: usize| parts.get(part).and_then(|part| part.samples().get(pixel)).copied();
    let values = (0..form.values())
        .map(|index| number(at(index / form.samples, index % form.samples).unwrap_or_default()));
    let colours = match form.colours {
        // The decoder has already undone the colour transform.
        Colours::Ybr | Colours::Ybr422 if header.is_transformed => Colours::Rgb,
        Colours::Ybr422 => Colours::Ybr,
        told => told,
    };
    Ok(Samples { values: values.collect(), colours, bits })
}
