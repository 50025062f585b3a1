//! The fonts of a page in a browser: the common letters of the fonts of egui. The browser draws all others itself.

use std::sync::Arc;

use epaint::text::{FontData, FontDefinitions, FontFamily};

/// The letters of Ubuntu-Light and of Hack that `tools/page_fonts.py` chooses, without rules for single sizes: a third
/// of their bytes.
const TEXT: &[u8] = include_bytes!("../../fonts/Ubuntu-Light-part.ttf");
const CODE: &[u8] = include_bytes!("../../fonts/Hack-Regular-part.ttf");

/// The same families as on the desktop, in the same order.
pub(super) fn definitions() -> FontDefinitions {
    let mut all = FontDefinitions::empty();
    for (name, file) in [("Ubuntu-Light", TEXT), ("Hack", CODE)] {
        all.font_data.insert(name.into(), Arc::new(FontData::from_static(file)));
    }
    all.families.insert(FontFamily::Proportional, vec!["Ubuntu-Light".into()]);
    all.families.insert(FontFamily::Monospace, vec!["Hack".into(), "Ubuntu-Light".into()]);
    all
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Path, PathBuf};

    use skrifa::{FontRef, MetadataProvider};

    use super::*;

    fn has(font: &[u8], letter: char) -> bool {
        FontRef::new(font).unwrap().charmap().map(letter).is_some()
    }

    fn files_below(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let path = entry.path();
            let is_test = path.components().any(|part| part.as_os_str().to_string_lossy().contains("tests"));
            if path.is_dir() {
                files_below(&path, ending, found);
            } else if !is_test && path.extension().is_some_and(|has| has == ending) {
                found.push(path);
            }
        }
    }

    /// The text of a source without its comments and its tests.
    fn code_of(path: &Path) -> String {
        let text = fs::read_to_string(path).unwrap();
        let shown = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        let lines = shown.lines().filter(|line| !line.trim_start().starts_with("//"));
        lines.collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn a_page_has_the_letters_that_its_window_and_the_shipped_files_use() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut files = Vec::new();
        for folder in
            ["crates/underfoot-window/src", "crates/underfoot-scene/src/scene", "crates/underfoot-web/src"]
        {
            files_below(&root.join(folder), "rs", &mut files);
        }
        assert!(files.len() > 150, "{}", files.len());
        for folder in ["layouts", "widgets", "effects", "floors"] {
            files_below(&root.join(folder), "ron", &mut files);
        }
        for path in &files {
            for letter in code_of(path).chars().filter(|letter| !letter.is_whitespace()) {
                assert!(has(TEXT, letter) || has(CODE, letter), "{letter:?} of {}", path.display());
            }
        }
    }

    #[test]
    fn a_page_has_the_letters_of_european_languages() {
        for text in ["Fußtaster öffnen", "Łódź příliš őű", "ίχνος ποδιού", "педаль їґў", "€ → ≤ „“ – 5 µm"]
        {
            for letter in text.chars().filter(|letter| *letter != ' ') {
                assert!(has(TEXT, letter) || has(CODE, letter), "{letter}");
            }
        }
        // The browser draws these.
        assert!(['足', '👣', '✓'].into_iter().all(|letter| !has(TEXT, letter) && !has(CODE, letter)));
    }
}
