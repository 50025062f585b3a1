//! Options that choose a floor, and saving one.

use std::path::{Path, PathBuf};

use clap::Args;
use underfoot::floor::{Floor, Geometry};
use underfoot::schema::{self, Saved};

use super::failure::Failure;

/// Which floor it is about.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct FloorArgs {
    /// Floor file: geometry, boards, calibration, actuators. Without it, the paper's 6 x 6 floor.
    #[arg(long, value_name = "FILE", conflicts_with = "grid")]
    pub(crate) floor: Option<PathBuf>,
    /// The paper's tiles in another number, for example 8x4 (columns x rows).
    #[arg(long, value_name = "CxR", value_parser = grid)]
    pub(crate) grid: Option<Geometry>,
}

impl FloorArgs {
    /// The floor described.
    pub(crate) fn load(&self) -> Result<Floor, Failure> {
        match &self.floor {
            Some(path) => Ok(schema::load_floor(path)?),
            None => Ok(Floor::of(self.grid.unwrap_or_default())),
        }
    }
}

/// Reads `6x6`.
pub(crate) fn grid(text: &str) -> Result<Geometry, String> {
    let (columns, rows) = text.split_once(['x', 'X']).ok_or("write it like 6x6: columns x rows")?;
    let number = |digits: &str| digits.trim().parse::<u16>().map_err(|error| format!("{digits:?}: {error}"));
    Geometry::of_paper_tiles(number(columns)?, number(rows)?).map_err(|error| error.to_string())
}

/// Writes the floor file, keeps what it held before, and says both on standard error.
pub(crate) fn save_floor(floor: &Floor, path: &Path) -> Result<Saved, Failure> {
    let saved = schema::save_floor(floor, path)?;
    match &saved {
        Saved::New => errln!("Written to {}.", path.display()),
        Saved::Unchanged => errln!("{} holds all this already.", path.display()),
        Saved::Replaced { backup } => {
            errln!("Written to {}; what it held before is in {}.", path.display(), backup.display());
        }
    }
    Ok(saved)
}

/// A floor file that will be written at the end of some work, and what it holds at its beginning.
#[derive(Debug)]
pub(crate) struct FloorOut<'p> {
    path: &'p Path,
    /// `None` if there is no such file, or it can't be read.
    held: Option<String>,
}

impl<'p> FloorOut<'p> {
    /// Looks at what `path` holds; to be called before the work begins.
    pub(crate) fn new(path: &'p Path) -> Self {
        Self { path, held: held(path) }
    }

    /// Which file it is.
    pub(crate) const fn path(&self) -> &'p Path {
        self.path
    }

    /// As [`save_floor`], if nobody else has changed the file meanwhile.
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

/// More than any floor file has.
const MOST_BYTES: u64 = 64 << 20;

fn held(path: &Path) -> Option<String> {
    schema::read_bounded(path, MOST_BYTES).ok()
}

/// Where a floor was kept, for programs.
pub(crate) fn saved_json(path: &Path, saved: &Saved) -> serde_json::Value {
    let backup = match saved {
        Saved::Replaced { backup } => Some(backup),
        Saved::New | Saved::Unchanged => None,
    };
    serde_json::json!({ "floor": path, "backup": backup })
}
