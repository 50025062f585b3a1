//! The paper's figures and the accuracy of the sensing, measured on simulated floors.
//!
//! Each experiment puts known loads on a floor that was calibrated the way a
//! laboratory does it, and compares what comes out with what went in. All of it
//! is deterministic: the same seed gives the same figures.
//!
//! | experiment | asks | source |
//! |---|---|---|
//! | [`SpotTable`], [`SeamTable`] | how well one contact is found, over a tile and at its seams | |
//! | [`PeopleTable`] | how well both feet of walking, turning and standing people are found | |
//! | [`TapTable`] | whether a heavy foot beside a region disturbs the one that works in it | |
//!
//! ```
//! use underfoot::experiment::PeopleTable;
//!
//! let mut table = PeopleTable::default();
//! table.add_person(1)?;
//! println!("{table}");
//! # Ok::<(), underfoot::experiment::ExperimentError>(())
//! ```

mod errors;
mod follow;
mod people;
mod rig;
mod spot;
mod taps;

pub use errors::{Errors, Summary};
pub use follow::{DOWN_N, Followed};
pub use people::{Activity, PeopleLine, PeopleTable, Visit};
pub use rig::{ExperimentError, OFFSET_N, Rig};
pub use spot::{FORCES_N, SeamRow, SeamTable, SpotLine, SpotRow, SpotTable, Thing};
pub use taps::{Stance, TapLine, TapScore, TapTable};

use crate::sense::Method;

/// Both ways of making contacts, in the order of the tables, with the names they have there.
pub const METHODS: [(Method, &str); 2] = [(Method::Eq4, "Eq. 4"), (Method::Tracker, "tracker")];
