//! `docs/faults.md`: its last column is made from the marks of the tests, and no row is without one.
//!
//! A test is marked by its name (`n3_a_silent_floor...`), by a comment (`// N3`, `// N1, N2`) or in its doc comment
//! (`Row N3.`). With
//! `UPDATE_EXPECTED=1` the page is written anew.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// What a row says that waits for something that does not exist.
const NOT_YET: &str = "not yet built";

/// Every source file below `folder`.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in folder.read_dir().unwrap().map(Result::unwrap) {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// `N3` of `n3_a_silent_floor`.
fn row_of_name(name: &str) -> Option<String> {
    let (row, _) = name.split_once('_')?;
    is_row(&row.to_uppercase()).then(|| row.to_uppercase())
}

fn is_row(text: &str) -> bool {
    let mut letters = text.chars();
    letters.next().is_some_and(|letter| "NPSAFRC".contains(letter))
        && !letters.as_str().is_empty()
        && letters.as_str().parse::<u8>().is_ok_and(|number| (1..=15).contains(&number))
}

/// The rows that a comment names: it is nothing but them, or they follow `Row` or `Rows`.
fn rows_of_comment(comment: &str) -> Vec<String> {
    let rows = |list: &str| -> Vec<String> {
        let words = list.split_whitespace().map(|word| word.trim_end_matches([',', '.', ':']));
        words.take_while(|word| is_row(word)).map(str::to_owned).collect()
    };
    let bare = rows(comment);
    if bare.len() == comment.split_whitespace().count() {
        return bare;
    }
    comment.split("Rows ").nth(1).or_else(|| comment.split("Row ").nth(1)).map(rows).unwrap_or_default()
}

/// Each row's tests, as `file:function`.
fn marked() -> BTreeMap<String, Vec<String>> {
    let mut files = Vec::new();
    for folder in ["src", "tests", "crates"] {
        sources(&Path::new(ROOT).join(folder), &mut files);
    }
    files.sort();
    let mut rows: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let name = file.strip_prefix(ROOT).unwrap().display().to_string();
        let (mut named, mut is_test) = (Vec::new(), false);
        for line in text.lines().map(str::trim) {
            if let Some(comment) = line.strip_prefix("//") {
                named.extend(rows_of_comment(comment.trim_start_matches('/')));
            } else if line == "#[test]" {
                is_test = true;
            } else if let Some(rest) = line.strip_prefix("fn ") {
                if std::mem::take(&mut is_test) {
                    let function = rest.split(['(', '<']).next().unwrap();
                    named.extend(row_of_name(function));
                    for row in named.drain(..) {
                        rows.entry(row).or_default().push(format!("{name}:{function}"));
                    }
                }
                named.clear();
            } else if !line.starts_with('#') {
                (named, is_test) = (Vec::new(), false);
            }
        }
    }
    rows
}

/// The page with its last column made anew, and the rows that it has.
fn made(page: &str, tests: &BTreeMap<String, Vec<String>>) -> (String, Vec<String>) {
    let mut rows = Vec::new();
    let mut text = String::new();
    for line in page.lines() {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        match cells.as_slice() {
            ["", row, fault, outcome, _, ""] if is_row(row) => {
                let named = tests.get(*row).map_or(String::new(), |tests| {
                    tests.iter().map(|test| format!("`{test}`")).collect::<Vec<_>>().join(" ")
                });
                assert_eq!(
                    named.is_empty(),
                    outcome.starts_with(NOT_YET),
                    "row {row} has the tests {named:?} and says {outcome:?}"
                );
                rows.push((*row).to_owned());
                text.push_str(&format!("| {row} | {fault} | {outcome} | {named} |\n"));
            }
            _ => text.push_str(&format!("{line}\n")),
        }
    }
    (text, rows)
}

#[test]
fn every_row_has_a_test_and_the_page_names_it() {
    let path = Path::new(ROOT).join("docs/faults.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let tests = marked();
    let (made, rows) = made(&page, &tests);
    let counts = [("N", 15), ("P", 13), ("S", 12), ("A", 10), ("F", 11), ("R", 10), ("C", 10)];
    for (letter, count) in counts {
        assert_eq!(rows.iter().filter(|row| row.starts_with(letter)).count(), count, "rows {letter}");
    }
    for row in tests.keys() {
        assert!(rows.contains(row), "{row} is in no table, but marks {:?}", tests[row]);
    }
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    assert!(page == made, "docs/faults.md is not what its tests are: write it anew with UPDATE_EXPECTED=1");
}

#[test]
fn marks_are_read_as_they_are_meant() {
    assert_eq!(row_of_name("n11_boards_that_change"), Some("N11".into()));
    assert_eq!(row_of_name("rule_7_only_one"), None);
    assert_eq!(row_of_name("p95_is"), None);
    assert_eq!(rows_of_comment(" Ten minutes. Rows N1, N2, P10. And more."), ["N1", "N2", "P10"]);
    assert_eq!(rows_of_comment(" Row F4."), ["F4"]);
    assert_eq!(rows_of_comment(" P1, P2"), ["P1", "P2"]);
    assert_eq!(rows_of_comment(" Row R7 of the fault table."), ["R7"]);
    assert_eq!(rows_of_comment(" A8: every way"), Vec::<String>::new());
    assert_eq!(rows_of_comment(" Row by row, as A1."), Vec::<String>::new());
}
