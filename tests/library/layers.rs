//! No module of the library imports from a layer above its own: ARCHITECTURE.md draws the order.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The modules of each layer, lowest first: the words before the first two spaces of each line of the block `
/// ```layers ` in ARCHITECTURE.md.
fn layers(architecture: &str) -> BTreeMap<&str, usize> {
    let lines = architecture.lines().skip_while(|line| *line != "```layers").skip(1);
    lines
        .take_while(|line| *line != "```")
        .enumerate()
        .flat_map(|(layer, line)| {
            let names = line.split("  ").next().unwrap_or_default();
            names.split(", ").map(move |name| (name.trim(), layer))
        })
        .collect()
}

/// The Rust files below `folder`, with the top-level module of each.
fn sources(folder: &Path) -> Vec<(String, PathBuf)> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let first = path.strip_prefix(folder).unwrap().iter().next().unwrap();
                found.push((first.to_str().unwrap().trim_end_matches(".rs").to_owned(), path));
            }
        }
    }
    found.sort();
    found
}

/// The lines of `text` with their numbers, without comments and items under `#[cfg(test)]`; and the modules that have
/// files of their own and are only compiled for tests.
fn code(text: &str) -> (Vec<(usize, &str)>, Vec<&str>) {
    let (mut lines, mut test_modules) = (Vec::new(), Vec::new());
    let mut rest = (1..).zip(text.lines().map(|line| line.split("//").next().unwrap_or_default()));
    while let Some((number, line)) = rest.next() {
        if !line.trim_start().starts_with("#[cfg(test)]") && !line.trim_start().starts_with("#[cfg(all(test")
        {
            lines.push((number, line));
            continue;
        }
        let indent = line.len() - line.trim_start().len();
        let mut is_open = false;
        for (_, item) in rest.by_ref() {
            let item = item.trim_end();
            if is_open && item.len() > indent && item[indent..].starts_with('}') {
                break;
            }
            if !is_open && item.ends_with(';') {
                let name = item.trim_end_matches(';').split(' ').next_back();
                test_modules.extend(name.filter(|_| item.contains("mod ")));
                break;
            }
            is_open |= item.ends_with('{');
        }
    }
    (lines, test_modules)
}

/// The modules that `line` names behind `crate::`, including those of a group in braces.
fn imports(line: &str) -> Vec<&str> {
    let is_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let first = |path: &str| path.find(|letter| !is_name(letter)).unwrap_or(path.len());
    let mut found = Vec::new();
    for (at, start) in line.match_indices("crate::") {
        if line[..at].ends_with(is_name) {
            continue;
        }
        let path = &line[at + start.len()..];
        match path.strip_prefix('{') {
            Some(group) => {
                found.extend(group.split([',', '}']).map(str::trim).map(|path| &path[..first(path)]));
            }
            None => found.push(&path[..first(path)]),
        }
    }
    found.retain(|name| !name.is_empty());
    found
}

#[test]
fn no_import_runs_upward() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let architecture = fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap();
    let layers = layers(&architecture);
    assert!(layers.len() > 10, "ARCHITECTURE.md draws the layers in a block that begins with ```layers");
    let is_library = |module: &str| module != "lib";
    let files: Vec<_> =
        sources(&root.join("src")).into_iter().filter(|(module, _)| is_library(module)).collect();
    let texts: Vec<_> = files.iter().map(|(_, path)| fs::read_to_string(path).unwrap()).collect();
    let codes: Vec<_> = texts.iter().map(|text| code(text)).collect();
    let mut tests_only = Vec::new();
    for ((_, path), (_, modules)) in files.iter().zip(&codes) {
        let is_root = path.file_name().is_some_and(|name| name == "mod.rs");
        let folder = if is_root { path.with_file_name("") } else { path.with_extension("") };
        tests_only.extend(modules.iter().map(|module| folder.join(module)));
    }

    let mut wrong = Vec::new();
    for ((module, path), (lines, _)) in files.iter().zip(&codes) {
        let name = path.strip_prefix(root).unwrap().display();
        let Some(own) = layers.get(module.as_str()) else {
            wrong.push(format!("{name}: ARCHITECTURE.md does not say which layer `{module}` is in"));
            continue;
        };
        if tests_only.iter().any(|tests| path.starts_with(tests) || path.with_extension("") == *tests) {
            continue;
        }
        for (number, line) in lines {
            for import in imports(line).into_iter().filter(|import| import != module) {
                match layers.get(import) {
                    Some(layer) if layer < own => {}
                    Some(_) => wrong.push(format!(
                        "{name}:{number}: `{module}` is not above `{import}`: {}",
                        line.trim()
                    )),
                    None => wrong.push(format!("{name}:{number}: ARCHITECTURE.md has no layer `{import}`")),
                }
            }
        }
    }
    let missing = layers.keys().filter(|layer| !files.iter().any(|(module, _)| module == *layer));
    wrong.extend(missing.map(|layer| format!("ARCHITECTURE.md: there is no module `{layer}`")));
    assert!(wrong.is_empty(), "{} imports run upward or aside:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn imports_are_found_and_comments_and_tests_are_not() {
    let text = "use crate::{floor, units::Newtons};\n// use crate::comment;\n#[cfg(test)]\nmod only;\nlet x = \
                crate::wire::check;\nuse supercrate::no;\n#[cfg(test)]\nmod tests {\n    use crate::hidden;\n    fn f() {\n        crate::hidden::f();\n    }\n}\nuse \
                crate::last;\n";
    let (lines, test_modules) = code(text);
    let found: Vec<_> =
        lines.iter().flat_map(|(number, line)| imports(line).into_iter().map(|it| (*number, it))).collect();
    assert_eq!(found, [(1, "floor"), (1, "units"), (5, "wire"), (14, "last")]);
    assert_eq!(test_modules, ["only"]);
}
