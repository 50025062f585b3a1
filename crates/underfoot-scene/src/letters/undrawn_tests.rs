//! Letters of layouts that no font has.

use underfoot::floor::Geometry;
use underfoot::schema::{Kinds, parse_layout};

use super::Fonts;

fn undrawn(text: &str) -> String {
    let loaded = parse_layout(text, "it.ron", &Kinds::builtin(), &Geometry::default()).unwrap();
    let fonts = Fonts::built_in();
    loaded.places.undrawn(|text| fonts.missing(text)).to_string()
}

fn layout(title: &str, stance: &str, label: &str) -> String {
    format!(
        "Layout(version: 1, title: \"{title}\", regions: [(id: \"r\", at: (0, 2), size: (6, 4))],\n\
         stances: [(at: (2, 0.5), size: (2, 1), label: \"{stance}\")], widgets: [\n\
         (id: \"a\", kind: \"button\", at: (0.4, 2.6), size: (0.8, 0.8), label: \"{label}\"),\n])"
    )
}

#[test]
fn letters_that_no_font_has_are_told_with_their_place() {
    let told = undrawn(&layout("Map", "Stand here", "首页 Home"));
    assert!(told.contains("warning[U304]: no font has 首 (U+9996) and 页 (U+9875)"), "{told}");
    assert!(told.contains("it.ron:3:"), "{told}");
    // All texts are drawn, not only labels of controls.
    let told = undrawn(&layout("地図", "ここ", "Home"));
    assert_eq!(told.matches("U304").count(), 2, "{told}");
    assert!(told.contains("it.ron:1:") && told.contains("it.ron:2:"), "{told}");
}

#[test]
fn a_letter_is_told_once_and_many_are_counted() {
    let told = undrawn(&layout("Map", "Stand", "いいろはにほへとち"));
    assert!(told.contains("い (U+3044), ろ (U+308D)"), "{told}");
    assert!(told.contains("へ (U+3078) and 2 more letters"), "{told}");
}

#[test]
fn what_the_programs_own_fonts_have_is_drawn_everywhere() {
    assert_eq!(undrawn(&layout("Žluť", "Дом Σ", "🏠 → 12 %")), "");
}
