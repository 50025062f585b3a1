//! Options that choose a floor, and functions that save one.

use std::path::{Path, PathBuf};

use clap::Args;
use underfoot::floor::{Floor, Geometry, PortName};
use underfoot::schema::{self, Saved};

use super::failure::Failure;

/// Options that choose the floor.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct FloorArgs {
    /// Floor file: geometry, boards, calibration, actuators; or a shipped one: `balance_board`, `dance_pad`,
    /// `load_cells`, `paper`. Without it, the paper's 6 x 6 floor.
    #[arg(long, value_name = "FILE", conflicts_with = "grid")]
    pub(crate) floor: Option<PathBuf>,
    /// A floor of this many of the paper's tiles, for example 8x4 (columns x rows).
    #[arg(long, value_name = "CxR", value_parser = grid)]
    pub(crate) grid: Option<Geometry>,
}

impl FloorArgs {
    /// Loads the chosen floor.
    pub(crate) fn load(&self) -> Result<Floor, Failure> {
        match &self.floor {
            Some(path) => load_floor(path, &|_| None),
            None => Ok(Floor::of(self.grid.unwrap_or_default())),
        }
    }
}

/// Loads the floor file at `path`, or the shipped floor of that name where there is no such file; `absent` as in
/// [`schema::load_floor_with_ports`].
pub(crate) fn load_floor(
    path: &Path,
    absent: &dyn Fn(&PortName) -> Option<String>,
) -> Result<Floor, Failure> {
    let shipped = path.to_str().filter(|_| !path.exists());
    match shipped.and_then(|name| Some((name, schema::builtin_floor(name)?))) {
        Some((name, text)) => {
            Ok(schema::parse_floor_with_ports(text, &format!("{name} (built in)"), absent)?)
        }
        None => Ok(schema::load_floor_with_ports(path, absent)?),
    }
}

/// Parses `6x6`.
pub(crate) fn grid(text: &str) -> Result<Geometry, String> {
    let (columns, rows) = text.split_once(['x', 'X']).ok_or("write it like 6x6: columns x rows")?;
    let number = |digits: &str| digits.trim().parse::<u16>().map_err(|error| format!("{digits:?}: {error}"));
    Geometry::of_paper_tiles(number(columns)?, number(rows)?).map_err(|error| error.to_string())
}

/// Writes the floor file, keeps its previous content as a backup, and reports both on standard error.
pub(crate) fn save_floor(floor: &Floor, path: &Path) -> Result<Saved, Failure> {
    let saved = schema::save_floor(floor, path)?;
    errln!("{}", saved_words(&saved, path));
    Ok(saved)
}

/// Says where a floor is, and what the file held before.
pub(crate) fn saved_words(saved: &Saved, path: &Path) -> String {
    let path = path.display();
    match saved {
        Saved::New => format!("Written to {path}."),
        Saved::Unchanged => format!("{path} holds all this already."),
        Saved::Replaced { backup } => {
            format!("Written to {path}; what it held before is in {}.", backup.display())
        }
    }
}

/// A floor file for the result of some work, and its content at the start.
#[derive(Debug)]
pub(crate) struct FloorOut<'p> {
    path: &'p Path,
    /// `None` if the file is missing or unreadable.
    held: Option<String>,
}

impl<'p> FloorOut<'p> {
    /// Reads the content of `path`; call it before the work begins.
    pub(crate) fn new(path: &'p Path) -> Self {
        Self { path, held: held(path) }
    }

    /// Path of the file.
    pub(crate) const fn path(&self) -> &'p Path {
        self.path
    }

    /// As [`save_floor`], if no other program has changed the file meanwhile.
    pub(crate) fn save(&self, floor: &Floor) -> Result<Saved, Failure> {
        if held(self.path) != self.held {
            return Err(Failure::Other(format!(
                "{} was changed by another program meanwhile, so it is left as it is now: look at it, and do this again",
                self.path.display()
            )));
        }
        save_floor(floor, self.path)
    }
}

/// Maximum size of a floor file in bytes, larger than any real one.
const MOST_BYTES: u64 = 64 << 20;

fn held(path: &Path) -> Option<String> {
    schema::read_bounded(path, MOST_BYTES).ok()
}

/// The paths of a saved floor and its backup, for programs.
pub(crate) fn saved_json(path: &Path, saved: &Saved) -> serde_json::Value {
    let backup = match saved {
        Saved::Replaced { backup } => Some(backup),
        Saved::New | Saved::Unchanged => None,
    };
    serde_json::json!({ "floor": path, "backup": backup })
}
