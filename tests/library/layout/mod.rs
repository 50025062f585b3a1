//! Layout files: the shipped ones, the language, and its errors.

mod by_ron;
mod ergonomics;
mod language;
mod messages;
mod random_files;
mod reference;
mod shipped;

use std::fs;
use std::path::{Path, PathBuf};

/// The files of `folder` in the repository that end in `.ron`, sorted.
pub fn ron_files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "ron"));
    files.sort();
    files
}
