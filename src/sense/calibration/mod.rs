//! Calibration: each sensor's law from load-cell measurements, and each tile's position map from known points pressed.
//!
//! [`law_fit`] fits one law and [`law_choice`] selects among the laws, for the sensors in a [`load_table`];
//! [`position_map`] fits the map of one tile, for the tiles in a [`press_table`].

mod law_choice;
mod law_fit;
mod load_table;
mod position_map;
mod press_table;

pub use law_choice::{Candidate, Comparison};
pub use law_fit::{Fit, FitError, LoadPoint};
pub use load_table::{Judgement, LoadTable, SensorLoads, Verdict};
pub use position_map::{Errors, MapError, MapFit, PressedPoint, Sighting};
pub use press_table::{PressTable, TilePoints};
