//! JPEG of 8 and 12 bits, lossless JPEG, and JPEG-LS.

use std::borrow::Cow;

use openreadout_codecs::{
    CodecError, JpegColor, JpegMarkers, Raster, jpeg_decode_tiff_limited, jpeg_markers, jpegls_decode_limited,
};

use super::Samples;
use super::native::signed;
use crate::series::form::{Colours, Form};
use crate::series::unfit::Unfit;

/// Greatest number of scans over a picture: a progressive one has some ten.
const MOST_SCANS: usize = 100;

/// The numbers of a JPEG frame.
///
/// # Errors
/// It is damaged, its size differs from the file's, or its kind is not supported.
pub fn decode(bytes: &[u8], form: &Form) -> Result<Samples, Unfit> {
    let markers = jpeg_markers(bytes, None).map_err(|error| unfit(&error, "JPEG"))?;
    let scans = bytes.windows(2).filter(|mark| **mark == [0xff, 0xda]).count();
    if scans > MOST_SCANS {
        return Err(Unfit::pixels(format!("its JPEG goes over the picture {scans} times")));
    }
    let colours = colours(&markers, form.colours);
    let raster = jpeg_decode_tiff_limited(bytes, None, JpegColor::AsCoded, most_bytes(form));
    samples(&raster.map_err(|error| unfit(&error, "JPEG"))?, form, colours)
}

/// The numbers of a JPEG-LS frame.
///
/// # Errors
/// As for [`decode`]. Pictures in colour are not supported.
pub fn decode_ls(bytes: &[u8], form: &Form) -> Result<Samples, Unfit> {
    if form.samples > 1 {
        return Err(Unfit::Format("JPEG-LS in colours".into()));
    }
    let raster = jpegls_decode_limited(&without_fill(bytes), most_bytes(form));
    samples(&raster.map_err(|error| unfit(&error, "JPEG-LS"))?, form, form.colours)
}

/// The codestream without the fill bytes before its end marker, which make its length even and which the decoder
/// rejects.
fn without_fill(bytes: &[u8]) -> Cow<'_, [u8]> {
    let end = bytes.windows(2).rposition(|mark| mark == [0xff, 0xd9]);
    let data = end.and_then(|end| bytes.get(..end)).unwrap_or(bytes);
    let filled = data.iter().rev().take_while(|byte| **byte == 0xff).count();
    if filled == 0 {
        return Cow::Borrowed(bytes);
    }
    let data = data.get(..data.len() - filled).unwrap_or_default();
    Cow::Owned([data, &[0xff, 0xd9]].concat())
}

fn most_bytes(form: &Form) -> usize {
    form.values().saturating_mul(2)
}

/// The numbers of a decoded picture, if it has the file's size.
fn samples(raster: &Raster, form: &Form, colours: Colours) -> Result<Samples, Unfit> {
    let is = [raster.width as usize, raster.height as usize];
    if is != form.size || raster.channels as usize != form.samples {
        let ([width, height], [columns, rows]) = (is, form.size);
        let why = format!(
            "they are {width} x {height} of {} samples each, and the file says {columns} x {rows} of {}",
            raster.channels, form.samples
        );
        return Err(Unfit::Pixels(why));
    }
    let bits = if raster.bits_per_sample > 8 { form.stored.clamp(9, 16) } else { 8 };
    let number = |raw: u16| signed(u64::from(raw), bits, form.is_signed) as f32;
    let values = if raster.bits_per_sample > 8 {
        raster.data.as_chunks::<2>().0.iter().map(|word| number(u16::from_le_bytes(*word))).collect()
    } else {
        raster.data.iter().map(|byte| number(u16::from(*byte))).collect()
    };
    Ok(Samples { values, colours, bits })
}

/// The meaning of a picture's components: by its own markers, else by the file.
fn colours(markers: &JpegMarkers, told: Colours) -> Colours {
    let ids = markers.component_ids.as_slice();
    match told {
        Colours::Grey { .. } | Colours::Palette => told,
        _ if ids == b"RGB" || ids == b"rgb" => Colours::Rgb,
        _ if markers.jfif || markers.adobe_transform == Some(1) => Colours::Ybr,
        // The decoder has doubled the colour differences along rows.
        Colours::Ybr422 => Colours::Ybr,
        told => told,
    }
}

fn unfit(error: &CodecError, name: &str) -> Unfit {
    match error {
        CodecError::Unsupported { detail, .. } => Unfit::Format(format!("{name} with {detail}")),
        error => Unfit::pixels(error.to_string()),
    }
}
