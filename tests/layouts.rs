//! The shipped layouts and kinds, and everything that can be wrong with a file.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::fs;
use std::path::{Path, PathBuf};

use underfoot::floor::Geometry;
use underfoot::schema::{
    Diagnostics, Kinds, Loaded, builtin_layout, builtin_layouts, parse_floor, parse_layout,
};

fn parse(text: &str, name: &str) -> Result<Loaded, Diagnostics> {
    parse_layout(text, name, &Kinds::builtin(), &Geometry::default())
}

fn ron_files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "ron"));
    files.sort();
    files
}

#[test]
fn every_shipped_layout_reads_without_a_warning() {
    for name in builtin_layouts() {
        match parse(builtin_layout(name).unwrap(), name) {
            Ok(loaded) => assert!(loaded.warnings.is_empty(), "{}", loaded.warnings),
            Err(problems) => panic!("{problems}"),
        }
    }
}

/// What a designer reads for each broken file is the file beside it that ends in `.stderr`.
///
/// After a change of wording run this with `UPDATE_EXPECTED=1` and read the differences.
#[test]
fn every_broken_file_is_explained() {
    let update = std::env::var_os("UPDATE_EXPECTED").is_some();
    let files = ron_files("tests/broken_layouts");
    assert!(files.len() >= 50, "{} files", files.len());
    let mut differing = Vec::new();
    for path in files {
        let name = path.file_name().unwrap().to_str().unwrap();
        let text = fs::read_to_string(&path).unwrap();
        let problems = if name.starts_with("kind_") {
            Kinds::builtin().add(&text, name).unwrap_err()
        } else if name.starts_with("floor_") {
            parse_floor(&text, name).unwrap_err()
        } else {
            parse(&text, name).map_or_else(|errors| errors, |loaded| loaded.warnings)
        };
        let found = format!("{problems}\n");
        let expected = path.with_extension("stderr");
        if update {
            fs::write(&expected, &found).unwrap();
        } else if fs::read_to_string(&expected).unwrap_or_default() != found {
            differing.push(format!("--- {name}\n{found}"));
        }
    }
    assert!(differing.is_empty(), "not as expected:\n{}", differing.join("\n"));
}
