//! Places of files that come in a folder or together, among the user's own.

use std::path::{Path, PathBuf};

use underfoot_format::outline::Outline;

/// The content of a file that has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Incoming {
    /// A layout, or a text with an error, which the window reports when it opens it.
    Layout,
    /// A kind of controls or an effect.
    Part,
}

/// The content of `text`, which came from `path`, and the path where it belongs: kinds and effects are found in
/// folders called `widgets` and `effects` beside a layout.
pub(crate) fn placed(path: &Path, text: &str) -> (Incoming, PathBuf) {
    let name = Outline::parse(text).and_then(|outline| outline.name);
    let folder = match name.as_deref() {
        Some("Kind") => "widgets",
        Some("Effect") => "effects",
        _ => return (Incoming::Layout, path.into()),
    };
    let within = path.parent().unwrap_or(Path::new(""));
    let file = path.file_name().unwrap_or_default();
    let is_there = within.file_name().is_some_and(|name| name == folder);
    (Incoming::Part, if is_there { path.into() } else { within.join(folder).join(file) })
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
        assert_eq!(
            place("widgets/broken.ron", "Kind(name: ").0,
            Incoming::Layout,
            "the window shows the error"
        );
    }
}
