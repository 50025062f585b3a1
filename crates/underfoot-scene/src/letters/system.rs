//! The fonts of this computer, for letters that the program's own fonts lack.

use std::fs;
use std::sync::{Arc, OnceLock};

use epaint::text::{
    FallbackRequest, FontData, FontFamily, FontInsert, FontPriority, FontProvider, InsertFontFamily,
};
use fontdb::{Database, FaceInfo, ID, Source, Stretch, Style};
use skrifa::instance::Size;
use skrifa::{FontRef, MetadataProvider};
use unicode_script::{Script, UnicodeScript};

/// The fonts of this computer, listed on first use: that takes a tenth of a second or more.
pub struct Installed {
    fonts: OnceLock<Ranked>,
    /// Returns the language of the system, such as `ja-JP`.
    language: fn() -> Option<String>,
}

/// The fonts, sorted by their suitability for labels.
struct Ranked {
    all: Database,
    order: Vec<ID>,
    /// The suffix in the names of fonts with the Chinese letters of this language, such as `JP`.
    han: &'static str,
}

/// Prefixes of the names of families for screens, on the common systems.
const FOR_SCREENS: [&str; 20] = [
    "Noto Sans",
    "Segoe UI",
    "Nirmala UI",
    "Leelawadee UI",
    "Microsoft YaHei",
    "Microsoft JhengHei",
    "Yu Gothic",
    "Meiryo",
    "Malgun Gothic",
    "Ebrima",
    "PingFang",
    "Hiragino Sans",
    "Apple SD Gothic Neo",
    "Geeza Pro",
    "Arial Hebrew",
    "Kohinoor",
    "Thonburi",
    "Noto Color Emoji",
    "Apple Color Emoji",
    "Twemoji",
];

/// Parts of the names of families that do not suit labels.
const FOR_OTHERS: [&str; 9] =
    ["Serif", "Mono", "Nastaliq", "Kufi", "Rashi", "Looped", "Display", "Condensed", "Unjoined"];

impl Default for Installed {
    fn default() -> Self {
        Self::new()
    }
}

impl Installed {
    /// The fonts of this computer in the order that suits its language.
    #[must_use]
    pub fn new() -> Self {
        Self { fonts: OnceLock::new(), language: sys_locale::get_locale }
    }

    fn fonts(&self) -> &Ranked {
        self.fonts.get_or_init(|| {
            let mut all = Database::new();
            all.load_system_fonts();
            Ranked::new(all, (self.language)().as_deref().unwrap_or_default())
        })
    }
}

impl FontProvider for Installed {
    fn font_for(&self, request: &FallbackRequest<'_>) -> Option<FontInsert> {
        let (name, data) = self.fonts().font_for(request.cluster.chars().next()?)?;
        let families = vec![InsertFontFamily {
            family: FontFamily::clone(request.family),
            priority: FontPriority::Lowest,
        }];
        Some(FontInsert { name, data, families })
    }
}

impl Ranked {
    /// Sorts `all` for a computer with the language `language`.
    fn new(all: Database, language: &str) -> Self {
        let mut ranked: Vec<_> = all.faces().filter_map(|face| Some((rank(face)?, face.id))).collect();
        ranked.sort();
        let order = ranked.into_iter().map(|(_, id)| id).collect();
        Self { all, order, han: han(language) }
    }

    /// The best font with the letter, and a name for the font.
    fn font_for(&self, letter: char) -> Option<(String, FontData)> {
        let wanted = match letter.script() {
            Script::Han => self.han,
            Script::Hiragana | Script::Katakana => "JP",
            Script::Hangul => "KR",
            _ => "",
        };
        let is_wanted = |id: &ID| self.all.face(*id).is_some_and(|face| family(face).ends_with(wanted));
        let (first, others) =
            self.order.iter().partition::<Vec<ID>, _>(|id| !wanted.is_empty() && is_wanted(id));
        let has = |id: &ID| {
            self.all.with_face_data(*id, |file, index| can_draw(file, index, letter)).unwrap_or(false)
        };
        let id = first.into_iter().chain(others).find(has)?;
        let face = self.all.face(id)?;
        let file: Arc<dyn AsRef<[u8]> + Send + Sync> = match &face.source {
            Source::Binary(file) | Source::SharedFile(_, file) => Arc::clone(file),
            // A file that was deleted since the listing has no letters.
            Source::File(path) => Arc::new(fs::read(path).ok()?),
        };
        let name = format!("{} {}", face.post_script_name, face.index);
        Some((name, FontData::from_blob(file, face.index)))
    }
}

/// Sort key, the lowest first; `None` for a font without useful glyphs.
fn rank(face: &FaceInfo) -> Option<(u8, bool, u16, bool, String, u32)> {
    let family = family(face);
    // An example is the font of macOS that has a box for every letter.
    if family.starts_with('.') || family.contains("LastResort") || family.contains("Blank") {
        return None;
    }
    let made_for = match () {
        () if FOR_OTHERS.iter().any(|part| family.contains(part)) => 3,
        () if FOR_SCREENS.iter().any(|begin| family.starts_with(begin)) => 0,
        () if family.contains("Sans") => 1,
        () => 2,
    };
    // The regular weight: the program's own font is light, but few other fonts have a light variant.
    let weight = face.weight.0.abs_diff(400);
    let is_odd = face.style != Style::Normal || face.stretch != Stretch::Normal;
    Some((made_for, is_odd, weight, face.monospaced, family.to_owned(), face.index))
}

fn family(face: &FaceInfo) -> &str {
    face.families.first().map_or("", |(name, _)| name)
}

/// The suffix in the names of fonts with the Chinese letters of `language`; that of simplified letters for all other
/// languages.
fn han(language: &str) -> &'static str {
    let parts: Vec<&str> = language.split(['-', '_', '.']).collect();
    let has = |part: &str| parts.iter().any(|own| own.eq_ignore_ascii_case(part));
    match parts.first().copied().unwrap_or_default() {
        "ja" => "JP",
        "ko" => "KR",
        "zh" if has("HK") || has("MO") => "HK",
        "zh" if has("TW") || has("Hant") => "TC",
        _ => "SC",
    }
}

/// Whether the font has an outline or a bitmap of the letter.
fn can_draw(file: &[u8], index: u32, letter: char) -> bool {
    let Ok(font) = FontRef::from_index(file, index) else { return false };
    let Some(glyph) = font.charmap().map(letter).filter(|glyph| glyph.to_u32() != 0) else { return false };
    font.outline_glyphs().get(glyph).is_some()
        || font.color_glyphs().get(glyph).is_some()
        || font.bitmap_strikes().glyph_for_size(Size::unscaled(), glyph).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILES: [&[u8]; 3] = [
        include_bytes!("../../../../tests/fonts/NotoSansHebrew-few.ttf"),
        include_bytes!("../../../../tests/fonts/NotoSansArabic-few.ttf"),
        include_bytes!("../../../../tests/fonts/NotoSansDevanagari-few.ttf"),
    ];

    fn ranked(language: &str) -> Ranked {
        let mut all = Database::new();
        FILES.iter().for_each(|file| all.load_font_data(file.to_vec()));
        Ranked::new(all, language)
    }

    #[test]
    fn a_font_is_found_for_each_letter_that_some_font_has() {
        let fonts = ranked("de-DE");
        for (letter, name) in [('ב', "Hebrew"), ('ب', "Arabic"), ('घ', "Devanagari")] {
            let (found, data) = fonts.font_for(letter).unwrap();
            assert!(found.contains(name), "{letter}: {found}");
            assert!(can_draw(data.bytes(), data.index, letter));
        }
        assert!(fonts.font_for('首').is_none());
    }

    #[test]
    fn a_computer_without_fonts_finds_none() {
        assert!(Ranked::new(Database::new(), "").font_for('ב').is_none());
    }

    #[test]
    fn fonts_for_screens_come_before_others_and_heavy_ones_last() {
        let mut all = Database::new();
        all.load_font_data(FILES[0].to_vec());
        let face = all.faces().next().unwrap().clone();
        let of = |family: &str, weight: u16| {
            let families = vec![(family.to_owned(), fontdb::Language::English_UnitedStates)];
            rank(&FaceInfo { families, weight: fontdb::Weight(weight), ..face.clone() })
        };
        let order = [
            of("Noto Sans Hebrew", 400),
            of("Noto Sans Hebrew", 700),
            of("DejaVu Sans", 400),
            of("Miriam", 400),
            of("Noto Serif Hebrew", 400),
        ];
        assert!(order.is_sorted(), "{order:?}");
        assert_eq!(of(".LastResort", 400), None);
    }

    #[test]
    fn chinese_letters_are_drawn_as_the_computers_language_writes_them() {
        let ends = ["ja_JP.UTF-8", "ko", "zh-Hant-TW", "zh_HK", "zh-CN", "de-DE", ""].map(han);
        assert_eq!(ends, ["JP", "KR", "TC", "HK", "SC", "SC", "SC"]);
    }
}
