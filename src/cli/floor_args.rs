use std::path::PathBuf;

use clap::Args;
use underfoot::floor::{Floor, Geometry};
use underfoot::schema;

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
