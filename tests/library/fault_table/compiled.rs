//! The source files that the crates of the workspace compile, found through their `mod` lines.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The folders of the workspace's packages, the root first, as `Cargo.toml` lists them.
pub fn packages(root: &Path) -> Vec<PathBuf> {
    let manifest = std::fs::read_to_string(root.join("Cargo.toml")).unwrap();
    let members = manifest.split_once("\nmembers = [").unwrap().1.split_once(']').unwrap().0;
    let names = members.split('"').skip(1).step_by(2);
    std::iter::once(root.to_owned()).chain(names.map(|name| root.join(name))).collect()
}

/// Every file that the libraries, programs and tests of `package` compile.
pub fn files(package: &Path) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    for crate_root in crate_roots(package) {
        follow(&crate_root, true, &mut found);
    }
    found
}

fn crate_roots(package: &Path) -> Vec<PathBuf> {
    let mut roots: Vec<PathBuf> =
        ["src/lib.rs", "src/main.rs"].iter().map(|name| package.join(name)).collect();
    for entry in package.join("tests").read_dir().into_iter().flatten().map(Result::unwrap) {
        let path = entry.path();
        roots.push(if path.is_dir() { path.join("main.rs") } else { path });
    }
    roots.retain(|path| path.is_file() && path.extension().is_some_and(|extension| extension == "rs"));
    roots
}

/// Adds `file` and the modules that it names. The modules of a crate root or of a `mod.rs` lie beside it, those of
/// any other file in a folder of its name.
fn follow(file: &Path, is_root: bool, found: &mut BTreeSet<PathBuf>) {
    if !found.insert(file.to_owned()) {
        return;
    }
    let beside = file.parent().unwrap();
    let stem = file.file_stem().unwrap();
    let below = if is_root || stem == "mod" { beside.to_owned() } else { beside.join(stem) };
    for module in modules(&std::fs::read_to_string(file).unwrap()) {
        let places = match &module {
            Module::At(path) => vec![beside.join(path)],
            Module::Named(name) => vec![below.join(format!("{name}.rs")), below.join(name).join("mod.rs")],
        };
        let place = places.iter().find(|place| place.is_file());
        let place = place.unwrap_or_else(|| panic!("{}: no file of {module:?}", file.display()));
        follow(&place.canonicalize().unwrap(), false, found);
    }
}

#[derive(Debug, PartialEq, Eq)]
enum Module {
    Named(String),
    /// `#[path = "..."]`.
    At(String),
}

/// The modules with files of their own that a source text names.
fn modules(text: &str) -> Vec<Module> {
    let (mut found, mut path) = (Vec::new(), None);
    for line in text.lines().map(str::trim) {
        if let Some(rest) = line.strip_prefix("#[path = \"") {
            path = rest.strip_suffix("\"]").map(str::to_owned);
        } else if let Some((before, name)) = line.strip_suffix(';').and_then(|line| line.split_once("mod ")) {
            let is_item = before.is_empty() || (before.starts_with("pub") && before.ends_with(' '));
            let is_name = name.chars().all(|letter| letter.is_alphanumeric() || letter == '_');
            if is_item && is_name {
                found.push(path.take().map_or(Module::Named(name.to_owned()), Module::At));
            }
        } else if !line.starts_with("#[") {
            path = None;
        }
    }
    found
}

#[test]
fn modules_are_found_in_their_lines() {
    let text = "//! mod no;\nmod one;\npub(crate) mod two;\n#[cfg(test)]\n#[path = \"../three.rs\"]\nmod other;\n// mod no;\n\
                mod inline {\n    let modulus = 3;\n}\n";
    let named = |name: &str| Module::Named(name.into());
    assert_eq!(modules(text), [named("one"), named("two"), Module::At("../three.rs".into())]);
}
