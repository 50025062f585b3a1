//! The name of the file that a floor was read from.

use std::fmt;
use std::sync::Arc;

/// Maximum number of characters kept of a name: its end, which distinguishes the files of one folder.
const LONGEST: usize = 120;

/// The name of the file that a floor was read from, for messages about missing fields of that file.
///
/// All names are equal: two floors with the same hardware are the same floor, regardless of their files. A floor
/// without a name was made in code, as the built-in floor is.
#[derive(Clone, Debug, Default)]
pub struct FloorFile(Option<Arc<str>>);

impl FloorFile {
    /// A floor that was made in code.
    pub const NONE: Self = Self(None);

    /// The file `name`, as the user wrote it. If a name is longer than 120 characters, its end is kept; characters
    /// that control a terminal become `\u{fffd}`.
    #[must_use]
    pub fn new(name: &str) -> Self {
        let length = name.chars().count();
        let shown = name.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c });
        if length <= LONGEST {
            return Self(Some(shown.collect::<String>().into()));
        }
        let end: String = shown.skip(length - LONGEST + 1).collect();
        Self(Some(format!("…{end}").into()))
    }

    /// Returns the name; `None` for a floor that was made in code.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        self.0.as_deref()
    }
}

impl PartialEq for FloorFile {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for FloorFile {}

impl fmt::Display for FloorFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name().unwrap_or("the built-in floor"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_shown_as_it_was_written() {
        assert_eq!(FloorFile::new("lab/floor.ron").to_string(), "lab/floor.ron");
        assert_eq!(FloorFile::NONE.to_string(), "the built-in floor");
    }

    #[test]
    fn a_name_can_neither_control_a_terminal_nor_fill_it() {
        assert_eq!(FloorFile::new("a\u{1b}[2Jb\n").name(), Some("a\u{fffd}[2Jb\u{fffd}"));
        let long = FloorFile::new(&format!("{}/floor.ron", "ä".repeat(5000)));
        let name = long.name().unwrap();
        assert_eq!(name.chars().count(), LONGEST);
        assert!(name.starts_with('…') && name.ends_with("ä/floor.ron"), "{name}");
    }
}
