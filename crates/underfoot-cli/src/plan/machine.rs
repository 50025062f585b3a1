//! A computer's constants: measured on this one, or read from a file.

use std::path::Path;
use std::time::Duration;

use serde_json::Value;
use underfoot::schema;
use underfoot_lab::plan::{LOADS, Machine, measure};

use crate::failure::Failure;
use crate::progress::ProgressLine;

/// Maximum size of a file of constants in bytes, larger than any real one.
const MOST_BYTES: u64 = 1 << 20;

/// Reads constants as `underfoot plan --json` prints them: the whole file, or the part under `machine`.
pub(super) fn read(path: &Path) -> Result<Machine, Failure> {
    let wrong = |error: &dyn std::fmt::Display| Failure::Other(format!("{}: {error}", path.display()));
    let text =
        schema::read_bounded(path, MOST_BYTES).map_err(|error| Failure::File(path.to_path_buf(), error))?;
    let mut value: Value = serde_json::from_str(&text).map_err(|error| wrong(&error))?;
    if let Some(machine) = value.get_mut("machine") {
        value = machine.take();
    }
    let machine: Machine = serde_json::from_value(value).map_err(|error| wrong(&error))?;
    machine.check().map_err(|error| wrong(&error))?;
    Ok(machine)
}

/// Measures this computer, each load for `length`.
pub(super) fn measured(length: Duration) -> Result<Machine, Failure> {
    if cfg!(debug_assertions) {
        errln!("This is a debug build: a release build is many times faster.");
    }
    let progress = ProgressLine::of("load", LOADS);
    Ok(measure(length, || progress.advance())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONSTANTS: &str = r#"{"cores":2,"base_us":20,"packet_us":2,"forward_us":1,"wake_us":3,"assemble_tile_us":0.05,"sense_tile_us":0.05,
        "person_us":5,"channel_us":0.1,"active_channel_us":0.2,"channels":64,"link_mbit":1000}"#;

    fn of(text: &str) -> Result<Machine, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        read(file.path()).map_err(|error| error.to_string())
    }

    #[test]
    fn constants_are_read_alone_or_out_of_a_plan() {
        let alone = of(CONSTANTS).unwrap();
        assert_eq!((alone.cores, alone.packet_us), (2, 2.0));
        assert_eq!(of(&format!(r#"{{"columns":6,"machine":{CONSTANTS}}}"#)), Ok(alone));
    }

    #[test]
    fn what_is_wrong_with_constants_is_told() {
        let wrong = |text: &str| of(text).unwrap_err();
        assert!(wrong("{").contains("EOF"));
        assert!(wrong("{}").contains("cores"));
        assert!(wrong(&CONSTANTS.replace("packet_us", "paket_us")).contains("paket_us"));
        assert!(wrong(&CONSTANTS.replace(":5,", ":-5,")).contains("person_us"));
    }
}
