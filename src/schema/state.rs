//! The folder for data that persist between runs.

use std::path::PathBuf;

/// Returns the folder for data that persist between runs, such as drafts of layouts without a file: `underfoot` in
/// the system's folder for the state of programs, or in the one for temporary files.
#[must_use]
pub fn usual_state() -> PathBuf {
    let of = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = if cfg!(target_os = "windows") {
        of("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        of("HOME").map(|home| home.join("Library/Application Support"))
    } else {
        of("XDG_STATE_HOME").or_else(|| Some(of("HOME")?.join(".local/state")))
    };
    folder.unwrap_or_else(std::env::temp_dir).join("underfoot")
}
