//! The version of the file formats.

use std::ops::Range;

use super::diagnostic::Diagnostics;
use super::problem::Problem;
use super::reader::Reader;
use crate::messages::TargetSort;
use underfoot_format::{Num, num};

/// The newest version of the formats that this program reads and writes: version 2 added targets, messages and
/// serial ports, version 3 rates and ranges of boards, plates other than squares with sensors at their corners, and
/// sensors that are switched off, version 4 targets of DMX and MQTT and programs.
pub const FORMAT_VERSION: u32 = 4;

/// The version that is written to files without anything that a later version added, so that older programs read them.
pub(super) const FIRST_VERSION: u32 = 1;

/// The first version with targets and messages.
pub(super) const WITH_MESSAGES: u32 = 2;

/// The first version with DMX, MQTT and programs as targets.
const WITH_DEVICES: u32 = 4;

/// Returns the first version of layouts with targets of this `sort`.
#[must_use]
pub const fn version_with(sort: TargetSort) -> u32 {
    match sort {
        TargetSort::Keyboard | TargetSort::Osc | TargetSort::Midi => WITH_MESSAGES,
        TargetSort::Dmx | TargetSort::Mqtt | TargetSort::Program => WITH_DEVICES,
    }
}

/// The first version with serial ports.
pub(super) const WITH_SERIAL_PORTS: u32 = 2;

/// The first version with rates and ranges of boards.
pub(super) const WITH_BOARD_RATES: u32 = 3;

/// The first version with rectangular tiles, sensors at given places, missing tiles and plates that differ.
pub(super) const WITH_PLATES: u32 = 3;

/// The first version with sensors that are switched off.
pub(super) const WITH_SENSORS_OFF: u32 = 3;

/// The version field of a file.
pub(super) const VERSION: Num = num(1.0..=FORMAT_VERSION as f64).explicit();

/// Reports that `things`, which stand at `at` in a file of the version `written`, need version `first`.
pub(super) fn require(
    reader: &Reader<'_>,
    at: Range<usize>,
    (things, first): (&str, u32),
    (file, written): (&str, u32),
) {
    if written < first {
        let problem = Problem::error(at, format!("{things} need version {first} of the format"));
        let expected = format!("this {file} says version {written}");
        reader.report(problem.expected(expected).help(format!("write version: {first}")));
    }
}

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
