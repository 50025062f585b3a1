//! README.md and the pages under docs/ are correct: their files are valid, and the things that they name exist; each
//! source file begins with a description.

use std::path::Path;

use underfoot::floor::Floor;
use underfoot::schema::{self, Kinds};
use underfoot_sim::Scenario;

use crate::pages::{Page, pages};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The error in a block of RON, if any; kinds may be made from those of earlier blocks.
fn problem(block: &str, page: &Page, kinds: &mut Kinds) -> Option<String> {
    let geometry = Floor::default().geometry;
    let name = page.name.as_str();
    let told = |problems: schema::Diagnostics| problems.to_string();
    match block.split('(').next().unwrap().lines().next_back() {
        Some("Kind") => kinds.add(block, name).err().map(told),
        Some("Effect") => schema::parse_effect(block, name, kinds.effects()).err().map(told),
        Some("Layout") => schema::parse_layout(block, name, kinds, &geometry).err().map(told),
        Some("Floor") => schema::parse_floor(block, name).err().map(told),
        Some("Scenario") => Scenario::parse(name, block).err().map(|problems| problems.to_string()),
        other => Some(format!("what is {other:?}?")),
    }
}

#[test]
fn every_ron_block_is_good() {
    let mut count = 0;
    for page in pages() {
        let mut kinds = Kinds::builtin();
        for block in page.blocks("ron") {
            count += 1;
            let problem = problem(&block, &page, &mut kinds);
            assert!(problem.is_none(), "{}:\n{block}\n{}", page.name, problem.unwrap());
        }
    }
    assert!(count >= 10, "{count}");
}

/// `./dev test` compiles and runs these files.
#[test]
fn what_pages_show_of_other_languages_is_a_file_that_is_tried() {
    for (page, language, file) in [
        ("docs/c-app.md", "c", "bindings/c/first.c"),
        ("docs/python-app.md", "python", "bindings/python/examples/follow.py"),
    ] {
        let pages = pages();
        let page = pages.iter().find(|other| other.name == page).unwrap();
        let text = std::fs::read_to_string(Path::new(ROOT).join(file)).unwrap();
        assert_eq!(page.blocks(language)[0].trim_end(), text.trim_end(), "{}", page.name);
    }
}

#[test]
fn every_link_leads_somewhere() {
    for page in pages() {
        let folder = Path::new(ROOT).join(&page.name).parent().unwrap().to_path_buf();
        for link in page.links().iter().filter(|link| !link.starts_with("http")) {
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.name.clone() } else { file.into() };
            let path = if file.is_empty() { Path::new(ROOT).join(target) } else { folder.join(target) };
            assert!(path.exists(), "{} links to {link}", page.name);
            if !heading.is_empty() {
                let text = std::fs::read_to_string(&path).unwrap();
                assert!(text.lines().any(|line| anchor(line) == heading), "{} links to {link}", page.name);
            }
        }
    }
}

/// The anchor of a heading, for links.
fn anchor(line: &str) -> String {
    let Some(title) = line.strip_prefix('#') else { return String::new() };
    let kept = title.trim_start_matches('#').trim().to_lowercase();
    kept.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).collect::<String>().replace(' ', "-")
}

/// The README's table lists every page.
#[test]
fn every_page_is_listed() {
    let pages = pages();
    let readme = pages.iter().find(|page| page.name == "README.md").unwrap();
    for page in pages.iter().filter(|page| page.name != readme.name) {
        assert!(readme.links().contains(&page.name), "README.md does not lead to {}", page.name);
    }
    assert!(readme.text.lines().count() <= 160, "README.md is a first page, not the manual");
}

/// `src/file.rs` is a file, `src/file.rs:name` a function in it.
#[test]
fn every_place_in_the_source_is_there() {
    let mut functions = 0;
    for page in pages() {
        for span in page.code() {
            let is_path =
                ["src/", "crates/", "tests/", "benches/", "examples/"].iter().any(|at| span.starts_with(at));
            if !is_path || span.contains([' ', '*', '<']) {
                continue;
            }
            let (file, function) = span.split_once(':').unwrap_or((&span, ""));
            let path = Path::new(ROOT).join(file);
            assert!(path.exists(), "{} names {file}", page.name);
            if function.is_empty() {
                continue;
            }
            functions += 1;
            let text = std::fs::read_to_string(&path).unwrap();
            let begins = format!("fn {function}");
            let defines = |at: usize| text[at + begins.len()..].starts_with(['(', '<']);
            let found = text.match_indices(&begins).any(|(at, _)| defines(at));
            assert!(found, "{} names {span}", page.name);
        }
    }
    assert!(functions >= 30, "{functions}");
}

#[test]
fn every_source_file_says_what_it_is() {
    let mut folders: Vec<_> =
        ["src", "crates", "tests", "benches", "examples"].map(|at| Path::new(ROOT).join(at)).into();
    let mut count = 0;
    while let Some(folder) = folders.pop() {
        for entry in folder.read_dir().unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                count += 1;
                let text = std::fs::read_to_string(&path).unwrap();
                assert!(text.starts_with("//! "), "{} begins without //!", path.display());
            }
        }
    }
    assert!(count >= 400, "{count}");
}
