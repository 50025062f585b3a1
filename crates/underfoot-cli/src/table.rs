//! Tables of measurements in files: opened within limits, with reports of bad lines.

use std::io::BufReader;
use std::path::Path;

use underfoot::schema::{BoundedFile, open_bounded};
use underfoot::sense::{TableError, TableProblems};

use super::failure::Failure;

/// Opens the table at `path`; at most `most` bytes of it are read.
pub(crate) fn open(path: &Path, most: u64) -> Result<BufReader<BoundedFile>, Failure> {
    let file = open_bounded(path, most).map_err(|error| Failure::File(path.into(), error))?;
    Ok(BufReader::with_capacity(1 << 16, file))
}

/// The failure of a table that cannot be read; `kind` names such tables.
pub(crate) fn refused(path: &Path, kind: &str, error: &TableError) -> Failure {
    match error {
        TableError::Header { .. } => Failure::Other(format!("{} is no {kind}: {error}", path.display())),
        _ => Failure::Other(format!("{}: {error}", path.display())),
    }
}

/// Warns of columns that are not read.
pub(crate) fn warn_of_unread(path: &Path, columns: &[String]) {
    const MOST: usize = 8;
    if columns.is_empty() {
        return;
    }
    let more = columns.len().saturating_sub(MOST);
    let names: Vec<String> = columns.iter().take(MOST).map(|name| format!("{name:.40?}")).collect();
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    errln!("warning: {}: columns that are not read: {}{more}", path.display(), names.join(", "));
}

/// Message about the skipped lines, if any, with all their problems.
pub(crate) fn left_out(path: &Path, problems: &TableProblems) -> Option<String> {
    let lines = match problems.lines() {
        0 => return None,
        1 => "1 line was".to_owned(),
        lines => format!("{lines} lines were"),
    };
    Some(format!("{}: {lines} left out:\n{problems}", path.display()))
}

/// Fails if there is anything in `failures`.
pub(crate) fn conclude(failures: &[String]) -> Result<(), Failure> {
    if failures.is_empty() { Ok(()) } else { Err(Failure::Other(failures.join("\nerror: "))) }
}
