//! Calibration: each sensor's law from load-cell measurements or from a person who stands on the floor, and each
//! tile's position map from known points pressed.
//!
//! [`law_fit`] fits one law and [`law_choice`] selects among the laws, for the sensors in a [`load_table`];
//! [`position_map`] fits the map of one tile, for the tiles in a [`press_table`]; [`standing`] fits the laws of all
//! sensors at once.

mod law_choice;
mod law_fit;
mod load_table;
mod position_map;
mod press_table;
mod standing;

pub use law_choice::{Candidate, Comparison};
pub use law_fit::{Fit, FitError, LoadPoint};
pub use load_table::{Judgement, LoadTable, SensorLoads, Verdict};
pub use position_map::{Errors, MapError, MapFit, PressedPoint, Sighting};
pub use press_table::{PressTable, TilePoints};
pub use standing::{
    Crossing, MeasuredStand, SensorFit, SensorMoments, SensorVolts, StandData, StandError, StandFit,
    StandLaws, StandingMark,
};
