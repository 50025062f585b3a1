//! The floor file that fits a simulated floor, written for the program that serves it.

use std::borrow::Cow;
use std::collections::hash_map::DefaultHasher;
use std::hash::Hasher;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use tracing::warn;
use underfoot::floor::Floor;
use underfoot::schema;

use super::layout_args::DEFAULT_LAYOUT;

/// Writes `floor`, as a lab would measure it, into a file of its own in the folder for the state of programs. Returns
/// the path; `None` if the file can't be written: that is logged, since the simulation works without it.
///
/// The file's name has a hash of its content: the file of one simulation never replaces another's.
pub(super) fn keep(floor: &Floor, seed: u64) -> Option<PathBuf> {
    let mut hasher = DefaultHasher::new();
    hasher.write(schema::write_floor(floor).as_bytes());
    let (columns, rows) = (floor.geometry.columns(), floor.geometry.rows());
    let name = format!("simulated-{columns}x{rows}-seed-{seed}-{:08x}.ron", hasher.finish() as u32);
    let folder = schema::usual_state();
    let path = folder.join(name);
    let kept = std::fs::create_dir_all(&folder).map_err(|error| error.to_string());
    match kept.and_then(|()| schema::save_floor(floor, &path).map_err(|error| error.to_string())) {
        Ok(_) => Some(path),
        Err(error) => {
            warn!(
                "the floor file that fits this simulated floor can't be written: {error}; name another place with \
                 --write-floor"
            );
            None
        }
    }
}

/// The commands that serve a simulated floor whose floor file is at `path`: one, or one for each of its `areas`.
pub(super) fn commands(
    path: &Path,
    layout: Option<&Path>,
    listen: Option<SocketAddr>,
    areas: &[&str],
) -> Vec<String> {
    let layout = layout.unwrap_or(Path::new(DEFAULT_LAYOUT)).to_string_lossy();
    let base = format!("underfoot run {} --floor {}", word(&layout), word(&path.to_string_lossy()));
    if areas.is_empty() {
        let listen = listen.map(|listen| format!(" --listen {listen}")).unwrap_or_default();
        return vec![format!("{base}{listen}")];
    }
    // Each area's computer listens at its address in the floor file.
    areas.iter().map(|area| format!("{base} --area {}", word(area))).collect()
}

/// A word of a command, in quotes if a shell would split or change it.
fn word(text: &str) -> Cow<'_, str> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-:+,@%\\".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.into();
    }
    format!("'{}'", text.replace('\'', r"'\''")).into()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_command_names_layout_floor_file_and_an_unusual_address() {
        let listen = "127.0.0.1:9100".parse().unwrap();
        assert_eq!(
            commands(Path::new("/tmp/floor.ron"), None, None, &[]),
            ["underfoot run map --floor /tmp/floor.ron"]
        );
        assert_eq!(
            commands(Path::new("my floor.ron"), Some(Path::new("it's.ron")), Some(listen), &[]),
            [r"underfoot run 'it'\''s.ron' --floor 'my floor.ron' --listen 127.0.0.1:9100"]
        );
    }

    #[test]
    fn each_area_has_a_command_of_its_own() {
        let found =
            commands(Path::new("hall.ron"), Some(Path::new("hall_buttons.ron")), None, &["west", "east"]);
        assert_eq!(found[0], "underfoot run hall_buttons.ron --floor hall.ron --area west");
        assert_eq!(found.len(), 2);
    }
}
