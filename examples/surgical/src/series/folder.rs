//! The files of a folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::told;

/// Greatest number of files that are read, and greatest depth of folders.
const MOST_FILES: usize = 20_000;
const DEEPEST: usize = 8;

/// The file at `path`, or those of the folder there and below it, by their names; adds skipped ones to `left_out`.
///
/// # Errors
/// The file or folder cannot be read at all.
pub fn files(path: &Path, left_out: &mut Vec<String>) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    if fs::metadata(path)?.is_dir() {
        collect(path, 0, &mut files, left_out)?;
    } else {
        files.push(path.to_owned());
    }
    files.sort();
    Ok(files)
}

/// The files of a folder and of those in it; adds unreadable inner folders to `left_out`.
fn collect(
    folder: &Path,
    depth: usize,
    files: &mut Vec<PathBuf>,
    left_out: &mut Vec<String>,
) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if files.len() >= MOST_FILES {
            left_out
                .push(format!("{} and what follows: {MOST_FILES} files are read at most", path.display()));
            return Ok(());
        }
        match fs::metadata(&path) {
            Ok(entry) if entry.is_file() => files.push(path),
            Ok(entry) if !entry.is_dir() => {
                left_out.push(format!("{} is neither a file nor a folder", path.display()));
            }
            Ok(_) if depth >= DEEPEST => {
                left_out.push(format!("{} lies too deep: {DEEPEST} folders at most", path.display()));
            }
            Ok(_) => {
                if let Err(error) = collect(&path, depth + 1, files, left_out) {
                    left_out.push(told(&path, &error.into()));
                }
            }
            Err(error) => left_out.push(told(&path, &error.into())),
        }
    }
    Ok(())
}
