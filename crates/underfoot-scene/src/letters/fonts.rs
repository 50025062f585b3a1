//! Finds the font for a letter.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use epaint::text::{FallbackRequest, FontData, FontDefinitions, FontFamily, FontProvider};
use skrifa::{FontRef, GlyphId, MetadataProvider};

/// The fonts for lines: those within the program, then those of the system if enabled.
///
/// The lookup of a letter runs once; its result is cached.
pub struct Fonts {
    /// The fonts of the system, if enabled.
    others: Option<Box<dyn FontProvider>>,
    found: Mutex<Found>,
}

#[derive(Default)]
struct Found {
    faces: Vec<Arc<FontFace>>,
    /// The font of each letter so far; `None` for a letter that no font has.
    of: HashMap<char, Option<Arc<FontFace>>>,
}

/// One font.
pub(super) struct FontFace {
    pub(super) data: FontData,
}

impl FontFace {
    pub(super) fn font(&self) -> Option<FontRef<'_>> {
        FontRef::from_index(self.data.bytes(), self.data.index).ok()
    }

    fn has(&self, letter: char) -> bool {
        let glyph = self.font().and_then(|font| font.charmap().map(letter));
        glyph.is_some_and(|glyph| glyph != GlyphId::NOTDEF)
    }
}

impl std::fmt::Debug for Fonts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Fonts").field("asks_the_system", &self.others.is_some()).finish_non_exhaustive()
    }
}

/// The fonts of windows and pictures: the default fonts of egui, and one with more signs, such as arrows. In a browser,
/// their common letters.
#[must_use]
pub fn definitions() -> FontDefinitions {
    #[cfg(not(target_arch = "wasm32"))]
    let mut all = FontDefinitions::default();
    #[cfg(target_arch = "wasm32")]
    let mut all = super::page::definitions();
    if let Some(family) = all.families.get_mut(&FontFamily::Proportional) {
        family.push("Hack".into());
    }
    all
}

impl Fonts {
    /// The fonts within the program: Latin, Greek, Cyrillic, arrows and emoji, the same on every computer.
    #[must_use]
    pub fn built_in() -> Self {
        Self::of(None)
    }

    /// The fonts within the program, then the fonts of this computer, which are listed at the first missing letter.
    #[cfg(feature = "system_fonts")]
    #[must_use]
    pub fn of_this_computer() -> Self {
        Self::of(Some(Box::new(super::system::Installed::new())))
    }

    fn of(others: Option<Box<dyn FontProvider>>) -> Self {
        let own = definitions().fonts_for_family(&FontFamily::Proportional);
        let faces = own.into_iter().map(|font| Arc::new(FontFace { data: font.data })).collect();
        Self { others, found: Mutex::new(Found { faces, of: HashMap::new() }) }
    }

    /// The fonts within the program, then a few letters of Hebrew, Arabic and Devanagari.
    #[cfg(test)]
    pub(crate) fn for_tests() -> Self {
        let fonts = Self::built_in();
        let files: [&'static [u8]; 3] = [
            include_bytes!("../../../../tests/fonts/NotoSansHebrew-few.ttf"),
            include_bytes!("../../../../tests/fonts/NotoSansArabic-few.ttf"),
            include_bytes!("../../../../tests/fonts/NotoSansDevanagari-few.ttf"),
        ];
        let more = files.map(|file| Arc::new(FontFace { data: FontData::from_static(file) }));
        fonts.found.lock().unwrap_or_else(PoisonError::into_inner).faces.extend(more);
        fonts
    }

    /// The letters of `text` that no font has, each once, in their order; each of them is drawn as a box. Skips
    /// invisible signs, such as joiners.
    #[must_use]
    pub fn missing(&self, text: &str) -> Vec<char> {
        missing_by(text, |letter| self.face_of(letter.encode_utf8(&mut [0; 4])).is_some())
    }

    /// The font for a letter with its marks; `None` if no font has the letter.
    pub(super) fn face_of(&self, cluster: &str) -> Option<Arc<FontFace>> {
        let letter = cluster.chars().next()?;
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(face) = found.of.get(&letter) {
            return face.clone();
        }
        let known = found.faces.iter().find(|face| face.has(letter)).cloned();
        let face = known.or_else(|| {
            let others = self.others.as_ref().filter(|_| !is_unseen(letter))?;
            let request = FallbackRequest { cluster, family: &FontFamily::Proportional };
            let face = Arc::new(FontFace { data: others.font_for(&request)?.data });
            found.faces.push(Arc::clone(&face));
            Some(face)
        });
        found.of.insert(letter, face.clone());
        face
    }

    /// The font that draws the boxes for missing letters.
    pub(super) fn first(&self) -> Option<Arc<FontFace>> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).faces.first().cloned()
    }
}

/// The letters of `text` for which `has` returns false, each once, as in [`Fonts::missing`].
pub fn missing_by(text: &str, mut has: impl FnMut(char) -> bool) -> Vec<char> {
    let mut missing = Vec::new();
    for letter in text.chars().filter(|letter| !is_unseen(*letter)) {
        if !missing.contains(&letter) && !has(letter) {
            missing.push(letter);
        }
    }
    missing
}

/// Whether it is invisible: control and direction characters, joiners, white space.
pub(super) fn is_unseen(letter: char) -> bool {
    use unicode_width::UnicodeWidthChar;
    letter.is_control() || letter.is_whitespace() || letter.width() == Some(0)
}
