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
#[cfg(any(feature = "internals", test))]
mod calibration;
mod calibration_fault;
mod cluster;
mod contact;
mod corners;
mod cursor;
mod eq4;
#[cfg(any(feature = "internals", test))]
mod force_table;
mod frame;
mod health;
mod hold_doubt;
#[cfg(any(feature = "internals", test))]
mod law_choice;
#[cfg(any(feature = "internals", test))]
mod load_table;
mod loaded;
mod pool;
#[cfg(any(feature = "internals", test))]
mod position_map;
#[cfg(any(feature = "internals", test))]
mod press_table;
mod quality;
mod sensing;
#[cfg(any(feature = "internals", test))]
mod table;
mod tile;
mod track;
mod uncertainty;

#[cfg(any(feature = "internals", test))]
pub use calibration::{Fit, FitError, LoadPoint};
pub use calibration_fault::CalibrationFault;
pub use contact::{Contact, ContactId, Covariance, TileLoad};
pub use cursor::Cursor;
#[cfg(any(feature = "internals", test))]
pub use force_table::ForceTable;
pub use frame::ForceFrame;
pub use health::{SensorHealth, Trouble};
pub use hold_doubt::HoldDoubt;
#[cfg(any(feature = "internals", test))]
pub use law_choice::{Candidate, Comparison};
#[cfg(any(feature = "internals", test))]
pub use load_table::{Judgement, LoadTable, SensorLoads, Verdict};
#[cfg(any(feature = "internals", test))]
pub use position_map::{Errors, MapError, MapFit, Press, Sighting};
#[cfg(any(feature = "internals", test))]
pub use press_table::{PressTable, TilePoints};
pub use quality::Quality;
pub use sensing::Method;
#[cfg(any(feature = "internals", test))]
pub use table::{TableError, TableNotes, TableProblem, TableProblems};

internal! {
    use assembler::{Assembler, BoardStatus, Tare, TareOutcome, TareRules};
    use corners::{known_corners};
    use cursor::{CursorPicker, Stickiness};
    use loaded::{LoadThreshold};
    use sensing::{Sensing, SensingConfig};
    use tile::{LoadedTile, TileReading, Wrench};
    use uncertainty::{SensorUncertainty};
}
