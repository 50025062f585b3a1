//! `docs/faults.md`: the marks of tests (`marks`) determine the two last columns of its tables, and a row without a
//! test in the running program gives the reason.
//!
//! With `UPDATE_EXPECTED=1` the test rewrites the page.

mod compiled;
mod marks;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use marks::{LETTERS, is_row, marked};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Beginning of the third column of a row for a part that does not exist yet, so that its fault cannot happen.
const NOT_YET: &str = "not yet built";

/// Beginning of the fourth column if no test in the running program is possible; the reason follows.
const IMPOSSIBLE: &str = "Not possible: ";

/// Folders of tests that start programs of this workspace as processes.
const RUNNING: [&str; 2] = ["crates/underfoot-cli/tests/program/", "crates/underfoot-cluster/tests/cluster/"];

/// The tests of one row, as `file:function`.
#[derive(Default)]
struct Tests {
    running: Vec<String>,
    library: Vec<String>,
}

/// Every source file below `folder`.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in folder.read_dir().into_iter().flatten().map(Result::unwrap) {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// The tests of each row, of all crates of the workspace.
fn tests() -> BTreeMap<String, Tests> {
    let root = Path::new(ROOT);
    let mut rows: BTreeMap<String, Tests> = BTreeMap::new();
    for package in compiled::packages(root) {
        let (compiled, mut files) = (compiled::files(&package), Vec::new());
        ["src", "tests"].iter().for_each(|folder| sources(&package.join(folder), &mut files));
        files.sort();
        for file in files {
            let name = file.strip_prefix(root).unwrap().display().to_string();
            let marked = marked(&std::fs::read_to_string(&file).unwrap());
            assert!(marked.is_empty() || compiled.contains(&file), "{name} has marks and is not compiled");
            for test in marked {
                for row in test.rows {
                    let tests = rows.entry(row).or_default();
                    let is_running = RUNNING.iter().any(|folder| name.starts_with(folder));
                    let list = if is_running { &mut tests.running } else { &mut tests.library };
                    list.push(shown(&name, &test.function, test.is_ignored));
                }
            }
        }
    }
    rows
}

/// A test in the form of the page.
fn shown(file: &str, function: &str, is_ignored: bool) -> String {
    if is_ignored { format!("{BY_HAND}`{file}:{function}`") } else { format!("`{file}:{function}`") }
}

/// The page's mark of a test that runs only on request.
const BY_HAND: &str = "by hand ";

/// The tests that always run, then those that run on request.
fn cell(tests: &[String]) -> String {
    let (by_hand, always): (Vec<&String>, Vec<&String>) =
        tests.iter().partition(|test| test.starts_with(BY_HAND));
    always.into_iter().chain(by_hand).map(String::as_str).collect::<Vec<_>>().join(" ")
}

/// The fourth column of a row: its tests in the running program, or the reason why there are none.
fn running_cell(row: &str, outcome: &str, before: &str, tests: &Tests) -> String {
    let is_tested = |tests: &[String]| tests.iter().any(|test| !test.starts_with(BY_HAND));
    if outcome.starts_with(NOT_YET) {
        assert!(
            tests.running.is_empty() && tests.library.is_empty(),
            "row {row} has tests and says {outcome:?}"
        );
        return String::new();
    }
    if is_tested(&tests.running) {
        return cell(&tests.running);
    }
    assert!(is_tested(&tests.library), "row {row} has no test that always runs");
    let reason = before.strip_prefix(IMPOSSIBLE).unwrap_or_default();
    assert!(
        reason.len() > 20,
        "row {row} has no test in the running program: mark one, or write `{IMPOSSIBLE}...` with the reason"
    );
    before.to_owned()
}

/// The page with new last columns, and its rows.
fn made(page: &str, tests: &BTreeMap<String, Tests>) -> (String, Vec<String>) {
    let mut rows = Vec::new();
    let mut text = String::new();
    for line in page.lines() {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        match cells.as_slice() {
            ["", row, fault, outcome, running, _, ""] if is_row(row) => {
                let none = Tests::default();
                let tests = tests.get(*row).unwrap_or(&none);
                let (running, library) = (running_cell(row, outcome, running, tests), cell(&tests.library));
                rows.push((*row).to_owned());
                text.push_str(&format!("| {row} | {fault} | {outcome} | {running} | {library} |\n"));
            }
            [.., _] if cells.get(1).is_some_and(|row| is_row(row)) => {
                panic!("not a row of five columns: {line}")
            }
            _ => text.push_str(&format!("{line}\n")),
        }
    }
    (text, rows)
}

#[test]
fn every_row_names_its_tests_and_those_in_the_running_program() {
    let path = Path::new(ROOT).join("docs/faults.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let tests = tests();
    let (made, rows) = made(&page, &tests);
    let mut rest = rows.iter();
    for letter in LETTERS {
        let of_letter = rows.iter().filter(|row| row.starts_with(letter)).count();
        let expected: Vec<String> = (1..=of_letter).map(|number| format!("{letter}{number}")).collect();
        let found: Vec<String> = rest.by_ref().take(of_letter).cloned().collect();
        assert_eq!(found, expected, "rows are numbered without gaps, letter by letter");
    }
    for row in tests.keys() {
        assert!(rows.contains(row), "{row} is in no table, and marks tests");
    }
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    assert!(page == made, "docs/faults.md does not show its tests: write it anew with UPDATE_EXPECTED=1");
}

#[test]
fn a_row_needs_a_test_in_the_running_program_or_a_reason() {
    let tests = |running: &[&str], library: &[&str]| {
        let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        Tests { running: owned(running), library: owned(library) }
    };
    let refused = |outcome: &'static str, before: &'static str, tests: Tests| {
        std::panic::catch_unwind(move || running_cell("N1", outcome, before, &tests)).is_err()
    };
    let reason = "Not possible: nobody can reach this from outside of the process.";
    assert_eq!(
        running_cell("N1", "held", reason, &tests(&["`a:b`", "by hand `a:c`"], &[])),
        "`a:b` by hand `a:c`"
    );
    assert_eq!(running_cell("N1", "held", reason, &tests(&[], &["`c:d`"])), reason);
    assert!(refused("held", "", tests(&[], &["`c:d`"])), "no reason");
    assert!(
        refused("held", reason, tests(&["by hand `a:b`"], &["by hand `c:d`"])),
        "nothing that always runs"
    );
    assert!(refused("held", reason, tests(&[], &[])), "no test at all");
    assert!(refused("not yet built: later", "", tests(&["`a:b`"], &[])), "there is a test");
}
