//! One line of text, shaped: the position of each glyph.

use std::sync::Arc;

use glam::Vec2;
use harfrust::{BufferFlags, ShapeOptions, ShaperData, UnicodeBuffer};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{GlyphId, MetadataProvider};
use unicode_segmentation::UnicodeSegmentation;

use super::Fonts;
use super::fonts::FontFace;
use crate::scene::{TextDirection, TextPiece, pieces};

/// One step of an outline, in em from the start of the base line: x to the right, y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutlineStep {
    /// Starts another outline here.
    Move(Vec2),
    /// A straight line to this point.
    Line(Vec2),
    /// A quadratic curve: control point, end point.
    Quadratic(Vec2, Vec2),
    /// A cubic curve: two control points, end point.
    Cubic(Vec2, Vec2, Vec2),
    /// Closes the outline.
    Close,
}

/// A line of text, shaped and in visual order. Positions are in em.
#[derive(Default)]
pub struct TextLine {
    glyphs: Vec<Glyph>,
    signs: Vec<Sign>,
    width: f32,
}

/// A glyph that has an outline.
struct Glyph {
    face: Arc<FontFace>,
    id: GlyphId,
    at: Vec2,
}

/// A sign with its own colours, which an outline cannot show: an emoji of this computer's fonts.
#[derive(Clone)]
pub struct Sign {
    /// The sign, as text.
    pub text: String,
    /// Its start on the base line, in em.
    pub at: Vec2,
    face: Arc<FontFace>,
}

impl Sign {
    /// The font's file, and the index of the font in it.
    #[must_use]
    pub fn font(&self) -> (Arc<dyn AsRef<[u8]> + Send + Sync>, u32) {
        (Arc::clone(&self.face.data.font), self.face.data.index)
    }
}

impl std::fmt::Debug for Sign {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Sign").field("text", &self.text).field("at", &self.at).finish_non_exhaustive()
    }
}

impl Fonts {
    /// Shapes the line; a letter that no font has becomes a box.
    #[must_use]
    pub fn line(&self, text: &str, direction: TextDirection) -> TextLine {
        let mut line = TextLine::default();
        for piece in pieces(text, direction) {
            let mut parts = self.parts(&piece);
            if piece.right_to_left {
                parts.reverse();
            }
            for (part, face) in parts {
                match face {
                    Some(face) => line.set(part, &face, piece.right_to_left),
                    None => line.set_box(part, self.first()),
                }
            }
        }
        line
    }

    /// Splits a piece into parts with one font each, in reading order; each letter without a font is a part of its
    /// own.
    fn parts<'t>(&self, piece: &'t TextPiece<'_>) -> Vec<(&'t str, Option<Arc<FontFace>>)> {
        let mut parts: Vec<(std::ops::Range<usize>, Option<Arc<FontFace>>)> = Vec::new();
        for (at, cluster) in piece.text.grapheme_indices(true) {
            let face = self.face_of(cluster);
            let end = at + cluster.len();
            match (parts.last_mut(), &face) {
                (Some((part, Some(before))), Some(face)) if Arc::ptr_eq(before, face) => part.end = end,
                _ => parts.push((at..end, face)),
            }
        }
        let text = |part| piece.text.get(part).unwrap_or_default();
        parts.into_iter().map(|(part, face)| (text(part), face)).collect()
    }
}

impl TextLine {
    /// Its width, in em.
    #[must_use]
    pub fn width(&self) -> f32 {
        self.width
    }

    /// The signs with their own colours.
    #[must_use]
    pub fn signs(&self) -> &[Sign] {
        &self.signs
    }

    /// Passes the outlines of all glyphs to `draw`, in em; they are filled by the non-zero winding rule.
    pub fn outline(&self, draw: impl FnMut(OutlineStep)) {
        let mut pen = Pen { draw, at: Vec2::ZERO, scale: 1.0 };
        for glyph in &self.glyphs {
            let Some(font) = glyph.face.font() else { continue };
            let Some(outline) = font.outline_glyphs().get(glyph.id) else { continue };
            (pen.at, pen.scale) = (glyph.at, glyph.face.scale());
            // A glyph with a damaged outline is left out.
            let _ = outline.draw(DrawSettings::unhinted(Size::unscaled(), LocationRef::default()), &mut pen);
        }
    }

    /// Shapes `text` with one font and appends it.
    fn set(&mut self, text: &str, face: &Arc<FontFace>, right_to_left: bool) {
        let Some(font) = face.font() else { return };
        let data = ShaperData::new(&font);
        let mut buffer = UnicodeBuffer::new();
        buffer.push_str(text);
        buffer.set_direction(match right_to_left {
            true => harfrust::Direction::RightToLeft,
            false => harfrust::Direction::LeftToRight,
        });
        buffer.guess_segment_properties();
        buffer.set_flags(BufferFlags::BEGINNING_OF_TEXT | BufferFlags::END_OF_TEXT);
        let shaped = data.shaper(&font).build().shape(buffer, ShapeOptions::new());
        let (outlines, scale) = (font.outline_glyphs(), face.scale());
        for (info, position) in shaped.glyph_infos().iter().zip(shaped.glyph_positions()) {
            let id = GlyphId::new(info.glyph_id);
            let offset = Vec2::new(position.x_offset as f32, position.y_offset as f32) * scale;
            let at = Vec2::new(self.width, 0.0) + offset;
            if has_colours(&font, id) {
                let rest = text.get(info.cluster as usize..).unwrap_or_default();
                let text = rest.graphemes(true).next().unwrap_or_default().to_owned();
                self.signs.push(Sign { text, at, face: Arc::clone(face) });
            } else if outlines.get(id).is_some() {
                self.glyphs.push(Glyph { face: Arc::clone(face), id, at });
            }
            self.width += position.x_advance as f32 * scale;
        }
    }

    /// Appends a box for a missing letter, unless the letter is invisible.
    fn set_box(&mut self, cluster: &str, face: Option<Arc<FontFace>>) {
        let is_seen = cluster.chars().next().is_some_and(|letter| !super::fonts::is_unseen(letter));
        let Some(face) = face.filter(|_| is_seen) else { return };
        let Some(font) = face.font() else { return };
        let metrics = font.glyph_metrics(Size::unscaled(), LocationRef::default());
        let advance = metrics.advance_width(GlyphId::NOTDEF).unwrap_or_default() * face.scale();
        let at = Vec2::new(self.width, 0.0);
        self.glyphs.push(Glyph { face, id: GlyphId::NOTDEF, at });
        self.width += advance;
    }
}

impl FontFace {
    /// The factor from the font's units to em, including the font's scale tweak.
    fn scale(&self) -> f32 {
        let units = self
            .font()
            .map_or(1000, |font| font.metrics(Size::unscaled(), LocationRef::default()).units_per_em.max(1));
        self.data.tweak.scale / f32::from(units)
    }
}

/// Whether the glyph is a bitmap, or has coloured layers.
fn has_colours(font: &skrifa::FontRef<'_>, id: GlyphId) -> bool {
    font.color_glyphs().get(id).is_some()
        || font.bitmap_strikes().glyph_for_size(Size::unscaled(), id).is_some()
}

struct Pen<D> {
    draw: D,
    at: Vec2,
    scale: f32,
}

impl<D> Pen<D> {
    fn place(&self, x: f32, y: f32) -> Vec2 {
        self.at + Vec2::new(x, y) * self.scale
    }
}

impl<D: FnMut(OutlineStep)> OutlinePen for Pen<D> {
    fn move_to(&mut self, x: f32, y: f32) {
        let to = self.place(x, y);
        (self.draw)(OutlineStep::Move(to));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = self.place(x, y);
        (self.draw)(OutlineStep::Line(to));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        let (by, to) = (self.place(cx, cy), self.place(x, y));
        (self.draw)(OutlineStep::Quadratic(by, to));
    }

    fn curve_to(&mut self, cx: f32, cy: f32, dx: f32, dy: f32, x: f32, y: f32) {
        let (by, then, to) = (self.place(cx, cy), self.place(dx, dy), self.place(x, y));
        (self.draw)(OutlineStep::Cubic(by, then, to));
    }

    fn close(&mut self) {
        (self.draw)(OutlineStep::Close);
    }
}
