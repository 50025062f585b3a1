//! Marks of tests with rows of the table of faults.
//!
//! A mark is a test's name (`n3_a_silent_floor...`), a comment above it (`// N3`, `// N1, N2`) or a part of its doc
//! comment (`Row N3.`).

/// A test and the rows of its marks.
#[derive(Debug, PartialEq, Eq)]
pub struct Marked {
    pub function: String,
    pub rows: Vec<String>,
    /// Whether it runs only on request.
    pub is_ignored: bool,
}

/// First letters of the rows, in the order of the page's tables.
pub const LETTERS: [&str; 9] = ["N", "P", "S", "A", "F", "R", "W", "J", "C"];

pub fn is_row(text: &str) -> bool {
    let number = LETTERS.iter().find_map(|letter| text.strip_prefix(letter));
    number.is_some_and(|number| {
        !number.starts_with(['0', '+']) && number.parse::<u8>().is_ok_and(|number| (1..=40).contains(&number))
    })
}

/// The marked tests of a source text.
pub fn marked(text: &str) -> Vec<Marked> {
    let mut all = Vec::new();
    let (mut rows, mut is_test, mut is_ignored) = (Vec::new(), false, false);
    for line in text.lines().map(str::trim) {
        if let Some(comment) = line.strip_prefix("//") {
            rows.extend(rows_of_comment(comment.trim_start_matches('/')));
        } else if line == "#[test]" {
            is_test = true;
        } else if line.starts_with("#[ignore") {
            is_ignored = true;
        } else if let Some(rest) = line.strip_prefix("fn ").filter(|_| is_test) {
            let function = rest.split(['(', '<']).next().unwrap().to_owned();
            rows.extend(row_of_name(&function));
            rows.sort();
            rows.dedup();
            if !rows.is_empty() {
                all.push(Marked { function, rows: std::mem::take(&mut rows), is_ignored });
            }
            (is_test, is_ignored) = (false, false);
        } else if !line.starts_with('#') {
            (rows, is_test, is_ignored) = (Vec::new(), false, false);
        }
    }
    all
}

/// `N3` of `n3_a_silent_floor`.
fn row_of_name(name: &str) -> Option<String> {
    let (row, _) = name.split_once('_')?;
    is_row(&row.to_uppercase()).then(|| row.to_uppercase())
}

/// The rows in a comment: it holds only rows, or they follow `Row` or `Rows`.
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

#[test]
fn names_and_comments_mark_rows() {
    assert_eq!(row_of_name("n11_boards_that_change"), Some("N11".into()));
    assert_eq!(row_of_name("rule_7_only_one"), None);
    assert_eq!(row_of_name("p95_is"), None);
    assert_eq!(rows_of_comment(" Ten minutes. Rows N1, N2, P10. And more."), ["N1", "N2", "P10"]);
    assert_eq!(rows_of_comment(" Row F4."), ["F4"]);
    assert_eq!(rows_of_comment(" P1, W2"), ["P1", "W2"]);
    assert_eq!(rows_of_comment(" Row R7 of the fault table."), ["R7"]);
    assert_eq!(rows_of_comment(" A8: every way"), Vec::<String>::new());
    assert_eq!(rows_of_comment(" Row by row, as A1."), Vec::<String>::new());
}

#[test]
fn only_tests_count_and_ignored_ones_are_known() {
    let text = "/// Row N1.\nfn helper() {}\n\n/// Row N2.\n#[test]\n#[cfg(unix)]\nfn one() {\n}\n\n\
                // N3, N4\n#[test]\n#[ignore = \"takes hours\"]\nfn two() {}\n\n#[test]\nfn s5_three(x in 0..1) {}\n";
    let marked = marked(text);
    let told: Vec<_> =
        marked.iter().map(|test| (test.function.as_str(), test.rows.join(" "), test.is_ignored)).collect();
    assert_eq!(
        told,
        [("one", "N2".into(), false), ("two", "N3 N4".into(), true), ("s5_three", "S5".into(), false)]
    );
}
