//! The version of the file formats.

use super::diagnostic::Diagnostics;
use super::problem::Problem;
use super::reader::Reader;
use underfoot_format::{Num, num};

/// The newest version of the formats that this program reads and writes: version 2 added targets and messages.
pub const FORMAT_VERSION: u32 = 2;

/// The version that is written to files without anything that a later version added, so that older programs read them.
pub(super) const FIRST_VERSION: u32 = 1;

/// The first version with targets and messages.
pub(super) const WITH_MESSAGES: u32 = 2;

/// The version field of a file.
pub(super) const VERSION: Num = num(1.0..=FORMAT_VERSION as f64).explicit();

/// Returns the only problem of a file with a newer version than this program supports.
pub(super) fn newer(reader: &Reader<'_>, kind: &'static str) -> Option<Diagnostics> {
    let field = reader.root("")?.peek(kind, "version")?;
    let version = field.peek_number().filter(|version| *version > f64::from(FORMAT_VERSION))?;
    let message = format!("this {} is of version {version}", kind.to_lowercase());
    let problem = Problem::error(field.span(), message)
        .expected(format!("this program reads up to version {FORMAT_VERSION}"))
        .help("it was made for a newer underfoot: a newer program will read it");
    Some(reader.only(problem))
}
