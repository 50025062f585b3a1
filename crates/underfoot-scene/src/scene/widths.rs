//! Widths of texts, for fitting them without access to a font.

use unicode_script::{Script, UnicodeScript};
use unicode_width::UnicodeWidthChar;

/// Height of a capital letter, in em; half of it above the base line is the visual middle of a line.
///
/// # Source
/// Ubuntu Light, the font of both painters.
pub const CAP_HEIGHT: f32 = 0.693;

/// Distance between base lines, in em.
pub(super) const LINE_HEIGHT: f32 = 1.15;

/// Width of a letter of an unmeasured script, in thousandths of an em: a full square.
const UNKNOWN: u16 = 1000;

/// Width of most Cyrillic and Greek letters in Ubuntu Light; few are wider.
const FOREIGN: u16 = 760;

/// Width of a Noto Emoji sign, at the size of the window's painter.
const EMOJI: u16 = 1050;

/// Widths of `' '` to `'~'` in Ubuntu Light, in thousandths of an em.
const ASCII: [u16; 95] = [
    228, 274, 392, 653, 564, 831, 648, 240, 310, 310, 472, 564, 246, 282, 246, 359, 564, 564, 564, 564, 564,
    564, 564, 564, 564, 564, 246, 246, 564, 564, 564, 380, 940, 641, 630, 609, 702, 555, 520, 658, 692, 248,
    487, 599, 502, 865, 709, 774, 592, 774, 618, 517, 548, 680, 624, 921, 608, 569, 560, 310, 359, 310, 564,
    490, 376, 509, 583, 460, 583, 548, 376, 573, 569, 237, 237, 495, 255, 863, 569, 582, 583, 583, 374, 428,
    387, 569, 480, 775, 499, 474, 455, 319, 262, 319, 564,
];

/// Widths of U+00A0 to U+00FF in Ubuntu Light, in thousandths of an em.
const LATIN_1: [u16; 96] = [
    228, 274, 564, 564, 564, 564, 262, 482, 376, 826, 386, 452, 564, 282, 826, 376, 318, 564, 359, 359, 376,
    575, 616, 246, 376, 359, 437, 452, 874, 874, 874, 380, 641, 641, 641, 641, 641, 641, 915, 609, 555, 555,
    555, 555, 248, 248, 248, 248, 716, 709, 774, 774, 774, 774, 774, 564, 774, 680, 680, 680, 680, 569, 593,
    596, 509, 509, 509, 509, 509, 509, 854, 460, 548, 548, 548, 548, 237, 237, 237, 237, 578, 569, 582, 582,
    582, 582, 582, 564, 582, 569, 569, 569, 569, 474, 583, 474,
];

/// Width of `text` on one line, in em; rather too wide than too narrow for letters beyond Latin.
pub(super) fn width(text: &str) -> f32 {
    text.chars().map(letter).sum()
}

fn letter(letter: char) -> f32 {
    let code = letter as usize;
    let thousandths = match code {
        0x20..=0x7e => ASCII[code - 0x20],
        0xa0..=0xff => LATIN_1[code - 0xa0],
        0x100..=0x24f => 700,
        // Marks are above or below their letter.
        0x300.. if letter.width() == Some(0) => 0,
        0x370..=0x52f => FOREIGN,
        0x2010..=0x2015 | 0x2018..=0x201f | 0x2022 | 0x2212 => 570,
        0x2600..=0x27bf | 0x1f000..=0x1faff => EMOJI,
        _ => of_script(letter),
    };
    f32::from(thousandths) * 1e-3
}

/// Mean width of a letter of a script, in thousandths of an em.
///
/// # Source
/// Advances of all letters in Noto Sans of the script, plus a tenth: words have narrow letters more often than wide
/// ones, and vowel signs beside letters are narrower than these. For Arabic, widths of words, because joined letters
/// are narrower.
fn of_script(letter: char) -> u16 {
    match letter.script() {
        Script::Hebrew | Script::Thai | Script::Lao => 620,
        Script::Arabic | Script::Syriac | Script::Thaana => 640,
        Script::Armenian | Script::Georgian => 720,
        Script::Devanagari | Script::Bengali | Script::Gujarati | Script::Gurmukhi => 720,
        Script::Ethiopic | Script::Khmer => 780,
        Script::Telugu | Script::Kannada | Script::Sinhala | Script::Myanmar => 960,
        Script::Tamil | Script::Malayalam => 1100,
        // Half-width forms.
        _ if (0xff61..=0xffdc).contains(&u32::from(letter)) => 500,
        _ => UNKNOWN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_follow_the_letters() {
        assert!((width("Zoom") - (0.560 + 0.582 + 0.582 + 0.863)).abs() < 1e-6);
        assert!(width("W") > 3.0 * width("i"));
        assert!("0123456789".chars().all(|digit| letter(digit) == letter('0')), "digits are of one width");
        assert_eq!(width("é"), width("e"));
        assert_eq!(width("靴"), 1.0);
    }

    /// Advances of whole words in Noto Sans of each script, in em, as shaped by HarfBuzz.
    #[test]
    fn words_of_other_scripts_are_measured_a_little_too_wide() {
        let words = [
            ("בית", 1.53),
            ("הגדלה", 2.69),
            ("שלום", 2.23),
            ("بيت", 1.74),
            ("تكبير", 1.92),
            ("الصفحة الرئيسية", 6.54),
            ("घर", 1.00),
            ("मानचित्र", 2.86),
            ("ফিরে", 2.05),
            ("வீடு", 2.06),
            ("บ้าน", 1.62),
            ("แผนที่", 2.44),
            ("ቤት", 1.38),
            ("სახლი", 3.42),
            ("ホーム", 2.97),
        ];
        for (word, shaped) in words {
            let measured = width(word);
            assert!((shaped..1.8 * shaped).contains(&measured), "{word}: {measured} for {shaped}");
        }
    }
}
