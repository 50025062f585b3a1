//! The paper's figures and the accuracy of the sensing, measured on simulated floors.
//!
//! Each experiment puts known loads on a floor that was calibrated the way a
//! laboratory does it, and compares what comes out with what went in. All of it
//! is deterministic: the same seed gives the same figures.
//!
//! | experiment | asks | source |
//! |---|---|---|
//! | [`Orientation`] | what two tiles' centroids say about a contact's direction | paper, figure 7 |
//! | [`TileScan`] | where a point load is found on one tile | paper, figure 8 |
//! | [`SeamObject`] | what one tile makes of an object over its edge | paper, figure 9 |
//! | [`TwoFeet`] | what two feet on four tiles look like, before and after they are told apart | paper, figure 11 |
//! | [`SpotTable`], [`SeamTable`] | how well one contact is found, over a tile and at its seams | |
//! | [`PlaceTable`] | how well one foot is found, by its force and its distance from a seam | |
//! | [`PeopleTable`] | how well both feet of walking, turning and standing people are found | |
//! | [`SceneTable`] | the same of everything that presses in fourteen scenes, on floors of several qualities | |
//! | [`TapTable`] | whether a heavy foot beside a region disturbs the one that works in it | |
//! | [`EffectSheet`] | what an effect feels like: waveform, spectrum, figures | |
//! | [`IntentTable`], [`IntentSweep`] | how often controls act that nobody meant, and miss presses that somebody did | |
//! | [`PondLaws`] | whether the frozen pond's onsets, energies, fronts and turns follow its model | paper, section 4.1 |
//! | [`PondWalk`] | how many cracks each manner of walking opens | |
//!
//! ```
//! use underfoot::experiment::PeopleTable;
//!
//! let mut table = PeopleTable::default();
//! table.add_person(1)?;
//! println!("{table}");
//! # Ok::<(), underfoot::experiment::ExperimentError>(())
//! ```

mod chart;
mod effect;
mod errors;
mod figure;
mod follow;
mod goodness;
mod intent;
mod intent_act;
mod intent_sweep;
mod orientation;
mod people;
mod place;
mod pond;
mod pond_walk;
mod rig;
mod scan;
mod scenes;
mod seam_object;
mod spot;
mod taps;
mod two_feet;
mod wilson;

pub use effect::EffectSheet;
pub use errors::{Errors, Summary};
pub use figure::Figure;
pub use follow::{DOWN_N, Followed};
pub use goodness::Goodness;
pub use intent::{Guarded, IntentEffort, IntentLine, IntentScore, IntentTable};
pub use intent_sweep::{IntentSweep, SweepCell};
pub use orientation::{Orientation, OrientationRow};
pub use people::{Activity, PeopleLine, PeopleTable, Visit};
pub use place::{PlaceLine, PlaceTable};
pub use pond::{PondLaw, PondLaws};
pub use pond_walk::{Manner, MannerLine, PondWalk};
pub use rig::{ExperimentError, FaultHook, OFFSET_N, Rig};
pub use scan::{Scan, ScanPoint, TileScan};
pub use scenes::{SceneLine, SceneTable};
pub use seam_object::{SeamObject, SeamObjectRow};
pub use spot::{FORCES_N, SeamRow, SeamTable, SpotLine, SpotRow, SpotTable, Thing, Way};
pub use taps::{Stance, TapLine, TapScene, TapScore, TapTable};
pub use two_feet::TwoFeet;
pub use wilson::Counted;

use crate::sense::Method;

/// Both ways of making contacts, in the order of the tables, with the names they have there.
pub const METHODS: [(Method, &str); 2] = [(Method::Eq4, "Eq. 4"), (Method::Tracker, "tracker")];
