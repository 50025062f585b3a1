//! The text of a file: size, encoding, lines.

use std::io;
use std::ops::Range;
use std::path::Path;

use super::diagnostic::{Diagnostic, Diagnostics, Severity};
use super::excerpt::Excerpt;
use super::file::read_bytes;

/// Maximum size of a file that is read, in bytes.
pub const MAX_BYTES: usize = 4 << 20;

/// The text of one file and where its lines begin.
pub struct Source<'t> {
    name: &'t str,
    text: &'t str,
    /// Bytes of the file before `text`: a byte-order mark, or nothing.
    skipped: usize,
    line_starts: Vec<usize>,
}

impl<'t> Source<'t> {
    /// The text of a file called `name`, without its byte-order mark.
    ///
    /// # Errors
    /// If it is larger than [`MAX_BYTES`].
    pub fn new(name: &'t str, text: &'t str) -> Result<Self, Diagnostics> {
        if text.len() > MAX_BYTES {
            return Err(too_large(name).into());
        }
        let bare = text.strip_prefix('\u{feff}').unwrap_or(text);
        let line_starts = std::iter::once(0).chain(bare.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Ok(Self { name, text: bare, skipped: text.len() - bare.len(), line_starts })
    }

    /// Returns the name of the file in diagnostics.
    pub fn name(&self) -> &'t str {
        self.name
    }

    /// The text, without a byte-order mark; all places count from its start.
    pub fn text(&self) -> &'t str {
        self.text
    }

    /// The line, from 1, that holds the byte at `offset`.
    pub fn line(&self, offset: usize) -> usize {
        self.line_starts.partition_point(|&start| start <= offset).max(1)
    }

    /// A diagnostic whose carets stand under the first line of `span`.
    pub fn diagnostic(&self, severity: Severity, span: &Range<usize>, message: String) -> Diagnostic {
        let start = self.text.floor_char_boundary(span.start);
        let end = self.text.floor_char_boundary(span.end).max(start);
        let line = self.line(start);
        let from = self.line_starts.get(line - 1).copied().unwrap_or(0);
        let to = self.line_starts.get(line).map_or(self.text.len(), |next| next - 1);
        let written = self.text[from..to].trim_end_matches('\r');
        let excerpt = Excerpt::of(written, start - from..end - from);
        Diagnostic {
            severity,
            code: None,
            path: self.name.into(),
            line,
            column: self.text[from..start].chars().count() + 1,
            span: start + self.skipped..end + self.skipped,
            field: String::new(),
            message,
            expected: String::new(),
            help: None,
            source_line: excerpt.text.clone(),
            excerpt,
        }
    }
}

/// The text of the file at `path`.
///
/// # Errors
/// If it cannot be opened or read, is not an ordinary file, is larger than [`MAX_BYTES`] or is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, Diagnostics> {
    let name = path.display().to_string();
    let bytes = match read_bytes(path, MAX_BYTES as u64) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == io::ErrorKind::FileTooLarge => return Err(too_large(&name).into()),
        Err(error) => return Err(unreadable(&name, &error).into()),
    };
    String::from_utf8(bytes)
        .map_err(|error| not_utf8(&name, error.as_bytes(), error.utf8_error().valid_up_to()).into())
}

fn unreadable(name: &str, error: &io::Error) -> Diagnostic {
    let (message, help) = match error.kind() {
        io::ErrorKind::NotFound => ("there is no such file".into(), Some("check the spelling of its path")),
        io::ErrorKind::IsADirectory => ("this is a folder, not a file".into(), Some("name a file in it")),
        io::ErrorKind::PermissionDenied => {
            ("the file may not be read".into(), Some("check its permissions and those of its folders"))
        }
        _ => (format!("the file cannot be read: {error}"), None),
    };
    Diagnostic::of_file(name, message, help.map(Into::into))
}

fn too_large(name: &str) -> Diagnostic {
    let message = format!("the file is larger than {} MB", MAX_BYTES >> 20);
    Diagnostic::of_file(
        name,
        message,
        Some("a layout of 4096 controls is below 1 MB: is this the right file?".into()),
    )
}

fn not_utf8(name: &str, bytes: &[u8], valid: usize) -> Diagnostic {
    let byte = bytes.get(valid).copied().unwrap_or_default();
    let message = format!("the file is not UTF-8 text: byte 0x{byte:02x} at offset {valid}");
    let help = match bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "this looks like UTF-16: save it as UTF-8",
        _ => "save it as UTF-8 in the editor",
    };
    // The text up to the invalid byte, which becomes one replacement character under the caret.
    let before = String::from_utf8_lossy(bytes.get(..valid).unwrap_or_default());
    let shown = format!("{before}\u{fffd}");
    let place = before.len()..shown.len();
    match Source::new(name, &shown) {
        Ok(source) if !shown.starts_with('\u{feff}') => {
            let found = source.diagnostic(Severity::Error, &place, message);
            Diagnostic { span: valid..valid + 1, help: Some(help.into()), ..found }
        }
        _ => Diagnostic::of_file(name, message, Some(help.into())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn only(result: Result<String, Diagnostics>) -> Diagnostic {
        result.unwrap_err().into_iter().next().unwrap()
    }

    #[test]
    fn columns_count_characters_and_spans_count_bytes_of_the_file() {
        let text = "\u{feff}a\r\nlabel: \"Über\" x\r\n";
        let source = Source::new("map.ron", text).unwrap();
        let at = source.text().find('x').unwrap();
        let found = source.diagnostic(Severity::Error, &(at..at + 1), "m".into());
        assert_eq!((found.line, found.column), (2, 15));
        assert_eq!(&text[found.span], "x");
        assert_eq!(found.source_line, "label: \"Über\" x");
    }

    #[test]
    fn a_place_at_the_very_end_or_beyond_is_the_end() {
        let source = Source::new("map.ron", "ab\n").unwrap();
        let found = source.diagnostic(Severity::Error, &(3..99), "m".into());
        assert_eq!((found.line, found.column, found.span), (2, 1, 3..3));
    }

    #[test]
    fn files_that_are_not_text_are_named_with_the_byte() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("latin1.ron");
        std::fs::write(&path, b"Layout(\n  title: \"K\xfcche\",\n)").unwrap();
        let found = only(read_text(&path));
        assert_eq!((found.line, found.column), (2, 12));
        assert!(found.message.contains("byte 0xfc at offset 19"), "{}", found.message);

        std::fs::write(&path, b"\xff\xfeL\0a\0").unwrap();
        assert!(only(read_text(&path)).help.unwrap().contains("UTF-16"));
    }

    #[test]
    fn absent_folders_and_oversized_files_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let message = |path: &Path| only(read_text(path)).message;
        assert_eq!(message(&folder.path().join("none.ron")), "there is no such file");
        assert_eq!(message(folder.path()), "this is a folder, not a file");
        let large = folder.path().join("large.ron");
        std::fs::write(&large, vec![b' '; MAX_BYTES + 1]).unwrap();
        assert_eq!(message(&large), "the file is larger than 4 MB");
    }
}
