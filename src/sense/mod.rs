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
//! its law, `PressTable` and `MapFit` each tile its position map.

mod assembler;
mod calibration;
mod calibration_fault;
mod cluster;
mod contact;
mod corners;
mod cursor;
mod eq4;
mod force_table;
mod frame;
mod health;
mod hold_doubt;
mod law_choice;
mod load_table;
mod loaded;
mod pool;
mod position_map;
mod press_table;
mod quality;
mod sensing;
mod table;
mod tile;
mod track;
mod uncertainty;

pub use calibration::{Fit, FitError, LoadPoint};
pub use calibration_fault::CalibrationFault;
pub use contact::{Contact, ContactId, Covariance, TileLoad};
pub use cursor::Cursor;
pub use force_table::ForceTable;
pub use frame::ForceFrame;
pub use health::{SensorHealth, Trouble};
pub use hold_doubt::HoldDoubt;
pub use law_choice::{Candidate, Comparison};
pub use load_table::{Judgement, LoadTable, SensorLoads, Verdict};
pub use position_map::{Errors, MapError, MapFit, Press, Sighting};
pub use press_table::{PressTable, TilePoints};
pub use quality::Quality;
pub use sensing::Method;
pub use table::{TableError, TableNotes, TableProblem, TableProblems};

pub use assembler::{Assembler, BoardStatus, Tare, TareOutcome, TareRules};
pub use corners::known_corners;
pub use cursor::{CursorPicker, Stickiness};
pub use loaded::LoadThreshold;
pub use sensing::{Sensing, SensingConfig};
pub use tile::{LoadedTile, TileReading, Wrench};
pub use uncertainty::SensorUncertainty;
