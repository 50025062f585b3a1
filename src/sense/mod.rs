//! From calibrated forces to feet: frames, contacts and the cursor.
//!
//! ```text
//! counts -assembler, health-> ForceFrame
//! ForceFrame -loaded, position maps-> loaded tiles (F, M per tile; Eq. 2-3)
//!   -track-> feet, followed through time, several on one group of tiles
//!   or -cluster-> groups of touching tiles -eq4-> one contact each (Eq. 4)
//!   -cursor-> the contact that operates a region
//! ```
//!
//! `Sensing` is the whole chain up to the contacts; `CursorPicker` chooses
//! among them, one picker per region.
//!
//! Calibration comes before all that: `LoadTable` and `Comparison` give each sensor
//! its law from a load cell, `StandFit` from a person who stands there; `PressTable` and `MapFit` give each
//! tile its position map.
//!
//! | folder | content |
//! |---|---|
//! | `assembler` | packets of boards to frames of the whole floor |
//! | `health` | faulty sensors, drift and creep |
//! | `frame` | the forces and qualities of all sensors in one millisecond |
//! | `centroid` | force and centroid of a tile (Eq. 2 and 3), their uncertainty, contacts by Eq. 4 |
//! | `loaded` | which tiles carry a load |
//! | `track` | feet, followed through time |
//! | `contact` | contacts, and the cursor among them |
//! | `calibration` | laws of sensors and position maps of tiles, from measurements |
//! | `table` | tables of measurements and of forces as files |

mod assembler;
mod calibration;
mod centroid;
mod contact;
mod frame;
mod health;
mod loaded;
mod scatter;
mod sensing;
mod table;
mod track;

pub use assembler::{
    Assembler, BoardCounts, BoardStatus, BoardTiming, Tare, TareOutcome, TareRules, TimeBase,
};
pub use calibration::{
    Candidate, Comparison, Crossing, Errors, Fit, FitError, Judgement, LoadPoint, LoadTable, MapError,
    MapFit, MeasuredStand, PressTable, PressedPoint, SensorFit, SensorLoads, SensorMoments, SensorVolts,
    Sighting, StandData, StandError, StandFit, StandLaws, StandingMark, TilePoints, Verdict,
};
pub use centroid::{LoadedTile, SensorUncertainty, TileReading, Wrench, known_corners};
pub use contact::{Contact, ContactId, Covariance, Cursor, CursorPicker, Stickiness, TileLoad};
pub use frame::{CalibrationFault, ForceFrame, HoldDoubt, Quality, TileSample};
pub use health::{SensorHealth, Trouble};
pub use loaded::LoadThreshold;
pub use scatter::Scatter;
pub use sensing::{Method, Sensing, SensingConfig};
pub use table::{ForceTable, TableError, TableNotes, TableProblem, TableProblems};
