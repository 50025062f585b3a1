//! Drawn glyphs and their order.

use glam::Vec2;

use super::{Fonts, OutlineStep, TextLine};
use crate::scene::TextDirection;

fn line(fonts: &Fonts, text: &str) -> TextLine {
    fonts.line(text, TextDirection::OfItsLetters)
}

/// All points of a line's outlines, in thousandths of an em.
fn points(line: &TextLine, from: f32) -> Vec<[i32; 2]> {
    let mut all = Vec::new();
    let mut note = |point: Vec2| {
        all.push([point.x - from, point.y].map(|part| (1000.0 * part).round() as i32));
    };
    line.outline(|step| match step {
        OutlineStep::Move(to) | OutlineStep::Line(to) => note(to),
        OutlineStep::Quadratic(by, to) => [by, to].into_iter().for_each(&mut note),
        OutlineStep::Cubic(by, then, to) => [by, then, to].into_iter().for_each(&mut note),
        OutlineStep::Close => {}
    });
    all
}

/// Whether `text` is drawn as `parts` side by side, the leftmost first.
fn is_drawn_as(fonts: &Fonts, text: &str, parts: &[&str]) -> bool {
    let mut wanted = Vec::new();
    let mut along = 0.0;
    for part in parts {
        let part = line(fonts, part);
        wanted.extend(points(&part, -along));
        along += part.width();
    }
    let drawn = line(fonts, text);
    let apart = |(one, other): (&[i32; 2], &[i32; 2])| (0..2).any(|side| (one[side] - other[side]).abs() > 1);
    let seen = points(&drawn, 0.0);
    (drawn.width() - along).abs() < 1e-3
        && seen.len() == wanted.len()
        && !seen.is_empty()
        && !seen.iter().zip(&wanted).any(apart)
}

#[test]
fn hebrew_is_drawn_from_the_right_with_numbers_and_brackets_as_they_are_read() {
    let fonts = Fonts::for_tests();
    assert!(fonts.missing("בית חדר").is_empty());
    assert!(is_drawn_as(&fonts, "בית", &["ת", "י", "ב"]));
    assert!(!is_drawn_as(&fonts, "בית", &["ב", "י", "ת"]));
    assert!(is_drawn_as(&fonts, "חדר 12", &["1", "2", " ", "ר", "ד", "ח"]));
    assert!(is_drawn_as(&fonts, "(חדר)", &["(", "ר", "ד", "ח", ")"]));
    assert!(is_drawn_as(&fonts, "Go חדר בית now", &["Go ", "ת", "י", "ב", " ", "ר", "ד", "ח", " now"]));
}

#[test]
fn arabic_letters_join_and_its_words_are_drawn_from_the_right() {
    let fonts = Fonts::for_tests();
    let alone: f32 = ["ب", "ي", "ت"].map(|letter| line(&fonts, letter).width()).iter().sum();
    let joined = line(&fonts, "بيت").width();
    assert!(joined < 0.9 * alone, "{joined} em joined, {alone} em apart");
    assert!(is_drawn_as(&fonts, "كبر بيت 2x", &["2x", " ", "بيت", " ", "كبر"]));
}

#[test]
fn a_vowel_sign_of_devanagari_is_drawn_before_the_letter_that_it_follows() {
    let fonts = Fonts::for_tests();
    // "मि" is stored as m, i, and the i is drawn to the left of the m.
    let (mi, m) = (line(&fonts, "मि"), line(&fonts, "म"));
    let shift = mi.width() - m.width();
    assert!(shift > 0.2, "{shift}");
    let (mi, m) = (points(&mi, 0.0), points(&m, -shift));
    assert!(
        m.iter().all(|point| mi.iter().any(|other| (point[0] - other[0]).abs() <= 1 && point[1] == other[1]))
    );
    // The same after a Latin word, which has another script.
    assert!(is_drawn_as(&fonts, "Go मि", &["Go ", "मि"]));
}

#[test]
fn the_programs_own_fonts_have_latin_greek_cyrillic_arrows_and_emoji() {
    let fonts = Fonts::built_in();
    assert_eq!(fonts.missing("Žluť, Дом, Σ, 12 %, →, ●, 🏠👣"), Vec::<char>::new());
    assert!(line(&fonts, "🏠").signs().is_empty(), "an outline, in the ink of the label");
    assert_eq!(fonts.missing("首页 首"), ['首', '页'], "each once");
    // Invisible characters do not count as missing.
    assert_eq!(fonts.missing("a\u{200d}\u{200f}b\tc\u{301}"), Vec::<char>::new());
}

#[test]
fn a_letter_that_no_font_has_is_a_box() {
    let fonts = Fonts::built_in();
    let (one, two) = (line(&fonts, "首"), line(&fonts, "首页"));
    assert!(!points(&one, 0.0).is_empty() && (two.width() - 2.0 * one.width()).abs() < 1e-3);
    assert_eq!(points(&line(&fonts, "\u{200f}"), 0.0), Vec::<[i32; 2]>::new());
}

#[test]
fn nothing_is_drawn_of_nothing() {
    let fonts = Fonts::built_in();
    assert_eq!((line(&fonts, "").width(), points(&line(&fonts, "  "), 0.0).len()), (0.0, 0));
}
