//! Drawings over time as an animated GIF file.

use std::io::Write;
use std::time::Duration;

use gif::{Encoder, Frame, Repeat};
use resvg::tiny_skia::Pixmap;

use super::{PictureError, painted};
use crate::letters::Fonts;
use crate::scene::Scene;

/// Bytes of a pixel: red, green, blue, opacity.
const PIXEL: usize = 4;

/// Effort of the palette for frames of more than 256 colours, from 1 (best) to 30 (fastest): the value that the
/// crate recommends.
const PALETTE_SPEED: i32 = 10;

/// An animated picture that repeats for ever: drawings, each with the time of its appearance.
///
/// Of each drawing, the file holds only the smallest rectangle around the pixels that differ from the drawing before.
pub struct Film<W: Write> {
    out: Option<W>,
    width_px: u32,
    encoder: Option<Encoder<W>>,
    /// The pixels of the last drawing.
    shown: Option<Pixmap>,
    /// The part of them that is not written yet, and the time of its appearance in hundredths of a second.
    waiting: Option<(Frame<'static>, u64)>,
}

impl<W: Write> Film<W> {
    /// Begins a picture that is `width_px` wide, with the height by the aspect ratio of the first drawing.
    pub const fn new(out: W, width_px: u32) -> Self {
        Self { out: Some(out), width_px, encoder: None, shown: None, waiting: None }
    }

    /// Adds a drawing that appears at `at`, counted from any moment; a drawing that looks like the one before only
    /// prolongs that. Times before that of the last drawing count as that.
    ///
    /// # Errors
    /// As [`super::png`], [`PictureError::Drawing`] for a drawing of another aspect ratio than the first, and
    /// [`PictureError::Film`] if `out` cannot be written.
    pub fn add(&mut self, scene: &Scene, fonts: &Fonts, at: Duration) -> Result<(), PictureError> {
        let pixels = painted(scene, fonts, self.width_px)?;
        let frame = match &self.shown {
            None => whole(&pixels)?,
            Some(shown) if (shown.width(), shown.height()) != (pixels.width(), pixels.height()) => {
                return Err(PictureError::Drawing("its size changes within the animated picture".into()));
            }
            Some(shown) => match changed(shown, &pixels)? {
                Some(frame) => frame,
                None => return Ok(()),
            },
        };
        self.write_until(at)?;
        self.waiting = Some((frame, hundredths(at)));
        self.shown = Some(pixels);
        Ok(())
    }

    /// Ends the picture; the last drawing is shown until `until`.
    ///
    /// # Errors
    /// [`PictureError::Drawing`] without any drawing, [`PictureError::Film`] if the rest cannot be written.
    pub fn finish(mut self, until: Duration) -> Result<W, PictureError> {
        self.write_until(until)?;
        let encoder = self.encoder.ok_or_else(|| PictureError::Drawing("it has no drawings".into()))?;
        encoder.into_inner().map_err(PictureError::Film)
    }

    /// Writes the waiting part, which is shown until `until`.
    fn write_until(&mut self, until: Duration) -> Result<(), PictureError> {
        let Some((mut frame, at)) = self.waiting.take() else { return Ok(()) };
        let mut rest = hundredths(until).saturating_sub(at);
        if self.encoder.is_none()
            && let Some(out) = self.out.take()
        {
            let mut encoder = Encoder::new(out, frame.width, frame.height, &[])?;
            encoder.set_repeat(Repeat::Infinite)?;
            self.encoder = Some(encoder);
        }
        let Some(encoder) = &mut self.encoder else { return Ok(()) };
        // A frame lasts up to 655 s: longer ones are written several times.
        loop {
            frame.delay = u16::try_from(rest).unwrap_or(u16::MAX);
            rest -= u64::from(frame.delay);
            encoder.write_frame(&frame)?;
            if rest == 0 {
                return Ok(());
            }
        }
    }
}

impl<W: Write> std::fmt::Debug for Film<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Film").field("width_px", &self.width_px).finish_non_exhaustive()
    }
}

fn hundredths(at: Duration) -> u64 {
    // The cast from float saturates at the range of the integer.
    (100.0 * at.as_secs_f64()).round() as u64
}

/// A frame of all pixels.
fn whole(pixels: &Pixmap) -> Result<Frame<'static>, PictureError> {
    frame(pixels, [0, 0, pixels.width() as usize, pixels.height() as usize])
}

/// A frame of the pixels that differ; `None` if all are the same.
fn changed(before: &Pixmap, after: &Pixmap) -> Result<Option<Frame<'static>>, PictureError> {
    let row = after.width() as usize * PIXEL;
    let rows = || before.data().chunks_exact(row).zip(after.data().chunks_exact(row));
    let Some(top) = rows().position(|(before, after)| before != after) else { return Ok(None) };
    let bottom = rows().rposition(|(before, after)| before != after).unwrap_or(top) + 1;
    let (mut left, mut right) = (after.width() as usize, 0);
    for (before, after) in rows().take(bottom).skip(top) {
        let pixels = || before.chunks_exact(PIXEL).zip(after.chunks_exact(PIXEL));
        left = left.min(pixels().position(|(before, after)| before != after).unwrap_or(left));
        right = right.max(pixels().rposition(|(before, after)| before != after).map_or(0, |last| last + 1));
    }
    frame(after, [left, top, right, bottom]).map(Some)
}

/// A frame of the pixels within left, top, right and bottom.
fn frame(pixels: &Pixmap, [left, top, right, bottom]: [usize; 4]) -> Result<Frame<'static>, PictureError> {
    let rows = pixels.data().chunks_exact(pixels.width() as usize * PIXEL).take(bottom).skip(top);
    let part = rows.filter_map(|row| row.get(left * PIXEL..right * PIXEL));
    let mut colours: Vec<u8> = part.flatten().copied().collect();
    let size = [left, top, right - left, bottom - top].map(u16::try_from);
    let [Ok(left), Ok(top), Ok(width), Ok(height)] = size else {
        return Err(PictureError::Drawing("it is too large for an animated picture".into()));
    };
    let made = Frame::from_rgba_speed(width, height, &mut colours, PALETTE_SPEED);
    Ok(Frame { left, top, ..made })
}
