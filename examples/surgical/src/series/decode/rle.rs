//! Run-length encoding (PS3.5, annex G): a segment for each byte of each sample, the highest byte first.

use openreadout_codecs::packbits_decode;

use super::Samples;
use super::native::sample;
use crate::series::form::Form;
use crate::series::unfit::Unfit;

/// Bytes of the table of segments: their number and their offsets.
const TABLE: usize = 64;

/// The numbers of a frame.
///
/// # Errors
/// The number of segments differs from that of the layout, or they hold fewer bytes than there are pixels.
pub fn decode(bytes: &[u8], form: &Form) -> Result<Samples, Unfit> {
    let deep = form.allocated as usize / 8;
    let needed = deep * form.samples;
    let words =
        bytes.get(..TABLE).ok_or_else(|| Unfit::pixels("the table of runs is cut"))?.as_chunks::<4>().0;
    let mut starts = words.iter().map(|word| u32::from_le_bytes(*word) as usize);
    let count = starts.next().unwrap_or_default();
    if count != needed || needed == 0 || needed >= words.len() {
        return Err(Unfit::pixels(format!("there are {count} segments of runs, where {needed} belong")));
    }
    let starts: Vec<usize> = starts.take(count).collect();
    let pixels = form.pixels();
    let mut segments = Vec::new();
    for (index, start) in starts.iter().enumerate() {
        let end = starts.get(index + 1).copied().unwrap_or(bytes.len());
        let segment = bytes.get(*start..end).ok_or_else(|| Unfit::pixels("a segment of runs is cut"))?;
        // Two bytes hold a run of at most 128.
        if segment.len().saturating_mul(64) < pixels {
            return Err(Unfit::pixels("a segment of runs is too short for as many pixels"));
        }
        let decoded = packbits_decode(segment, pixels).map_err(|error| Unfit::pixels(error.to_string()))?;
        if decoded.len() < pixels {
            return Err(Unfit::pixels(format!("a segment of runs ends after {} pixels", decoded.len())));
        }
        segments.push(decoded);
    }
    let byte = |segment: usize, pixel: usize| {
        let byte = segments.get(segment).and_then(|segment| segment.get(pixel));
        u64::from(byte.copied().unwrap_or_default())
    };
    let values = (0..form.values()).map(|at| {
        let (pixel, part) = (at / form.samples, at % form.samples);
        let raw = (0..deep).fold(0, |raw, place| raw << 8 | byte(part * deep + place, pixel));
        sample(form, raw)
    });
    Ok(Samples { values: values.collect(), colours: form.colours, bits: form.stored })
}
