//! Places of files that come in a folder or together, among the user's own.

use std::path::{Path, PathBuf};

use crate::link::{EFFECTS, KINDS};

/// The content of a file that has come; the text may have errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Incoming {
    /// A layout, or nothing that can be recognised.
    Layout,
    /// A kind of controls or an effect.
    Part,
}

/// The content of `text`, which came from `path`, and the path where it belongs: kinds and effects are found in
/// folders called `widgets` and `effects` beside a layout.
pub(crate) fn placed(path: &Path, text: &str) -> (Incoming, PathBuf) {
    let within = path.parent().unwrap_or(Path::new(""));
    let is_in = |folder: &str| within.file_name().is_some_and(|name| name == folder);
    let folder = match record_name(text) {
        "Kind" => KINDS,
        "Effect" => EFFECTS,
        "Layout" => return (Incoming::Layout, path.into()),
        // A damaged text may have lost its beginning.
        _ if is_in(KINDS) || is_in(EFFECTS) => return (Incoming::Part, path.into()),
        _ => return (Incoming::Layout, path.into()),
    };
    let file = path.file_name().unwrap_or_default();
    (Incoming::Part, if is_in(folder) { path.into() } else { within.join(folder).join(file) })
}

/// The name before the brackets of the record in `text`, behind comments; empty if there is none.
fn record_name(text: &str) -> &str {
    let mut rest = text.trim_start_matches('\u{feff}').trim_start();
    loop {
        let behind = if let Some(line) = rest.strip_prefix("//") {
            line.split_once('\n').map(|(_, behind)| behind)
        } else if let Some(block) = rest.strip_prefix("/*") {
            block.split_once("*/").map(|(_, behind)| behind)
        } else if let Some(extensions) = rest.strip_prefix("#![") {
            extensions.split_once(']').map(|(_, behind)| behind)
        } else {
            break;
        };
        rest = behind.unwrap_or("").trim_start();
    }
    let end =
        rest.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').unwrap_or(rest.len());
    rest.get(..end).unwrap_or("")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_and_effects_go_beside_the_layouts_and_all_else_is_a_layout() {
        let place = |path: &str, text: &str| {
            let (content, path) = placed(Path::new(path), text);
            (content, path.display().to_string())
        };
        let kind = "// A large one\nKind(name: \"large\", from: \"button\")";
        let effect = "Effect(name: \"x\", plays: Tone(hz: 80))";
        assert_eq!(place("my floor/widgets/a.ron", kind), (Incoming::Part, "my floor/widgets/a.ron".into()));
        assert_eq!(place("my floor/a.ron", kind), (Incoming::Part, "my floor/widgets/a.ron".into()));
        assert_eq!(place("x.ron", effect), (Incoming::Part, "effects/x.ron".into()));
        assert_eq!(place("my floor/x.ron", "Layout(version: 1)").0, Incoming::Layout);
        // Broken in the middle, and before the brackets.
        assert_eq!(place("broken.ron", "/* A */ Kind(name: "), (Incoming::Part, "widgets/broken.ron".into()));
        assert_eq!(place("effects/x.ron", "ect(name: "), (Incoming::Part, "effects/x.ron".into()));
        assert_eq!(place("x.ron", "// no end").0, Incoming::Layout);
        assert_eq!(place("widgets/x.ron", "Layout(").0, Incoming::Layout);
    }
}
