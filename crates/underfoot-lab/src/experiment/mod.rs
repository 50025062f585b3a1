//! The paper's figures and the accuracy of sensing, measured on simulated floors.
//!
//! Each experiment puts known loads on a floor calibrated as in a laboratory, and compares the result with the true
//! loads. All experiments are deterministic: the same seed gives the same figures.
//!
//! | experiment | subject | source |
//! |---|---|---|
//! | [`Orientation`] | direction of a contact from the centroids of two tiles | paper, figure 7 |
//! | [`TileScan`] | position of a point load on one tile | paper, figure 8 |
//! | [`SeamObject`] | an object over a tile's edge, as measured by one tile | paper, figure 9 |
//! | [`TwoFeet`] | two feet on four tiles, before and after their separation | paper, figure 11 |
//! | [`SpotTable`], [`SeamTable`] | accuracy of one contact, over a tile and at its seams | |
//! | [`PlaceTable`] | accuracy of one foot, by its force and its distance from a seam | |
//! | [`PeopleTable`] | accuracy of both feet of walking, turning and standing people | |
//! | [`SceneTable`] | accuracy of all contacts in fifteen scenes, on floors of several qualities | |
//! | [`BrokenTable`] | walks over one broken sensor: places of feet, time until it is found, sound ones accused | |
//! | [`TapTable`] | influence of a heavy foot beside a region on the foot that works in it | |
//! | [`SeatedTable`] | sliders under seated people: first answer, and changes of a value at rest | |
//! | [`BesideTable`] | buttons tapped beside a standing foot, by the region's cursor rule | |
//! | [`StandTable`] | accuracy of a calibration by standing, beside that by a load cell | |
//! | [`EffectSheet`] | waveform, spectrum and figures of an effect | |
//! | [`IntentTable`], [`IntentSweep`] | rates of false activations and of missed presses | |
//! | [`PondLaws`] | onsets, energies, fronts and turns of the frozen pond, against its model | paper, section 4.1 |
//! | [`PondWalk`] | number of cracks that each manner of walking opens | |
//!
//! ```
//! use underfoot_lab::experiment::PeopleTable;
//!
//! let mut table = PeopleTable::default();
//! table.add_person(1)?;
//! println!("{table}");
//! # Ok::<(), underfoot_lab::experiment::ExperimentError>(())
//! ```

mod beside;
mod broken;
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
mod seated;
mod spot;
mod standing;
mod taps;
mod two_feet;
mod wilson;

pub use beside::{BesideLine, BesideTable};
pub use broken::{BrokenLine, BrokenTable, DRIFT_MOST_N, DRIFT_N_S, NOISE_N, SensorBreak};
pub use effect::EffectSheet;
pub use errors::{PositionErrors, Summary};
pub use figure::Figure;
pub use follow::{DOWN_N, Followed};
pub use goodness::Goodness;
pub use intent::{Guarded, IntentEffort, IntentLine, IntentScore, IntentTable};
pub use intent_sweep::{IntentSweep, SweepCell};
pub use orientation::{Orientation, OrientationRow};
pub use people::{Activity, DrawnVisit, PeopleLine, PeopleTable};
pub use place::{PlaceLine, PlaceTable};
pub use pond::{PondLaw, PondLaws};
pub use pond_walk::{MannerLine, PondWalk, WalkManner};
pub use rig::{ExperimentError, FaultHook, OFFSET_N, Rig};
pub use scan::{ScanPoint, TileScan, TileSweep};
pub use scenes::{SceneLine, SceneRows, SceneTable};
pub use seam_object::{SeamObject, SeamObjectRow};
pub use seated::{SeatedLine, SeatedTable};
pub use spot::{FORCES_N, SeamRow, SeamTable, SpotLine, SpotRow, SpotTable, Thing, Way};
pub use standing::{StandLine, StandTable};
pub use taps::{HeavyFoot, TapLine, TapScene, TapScore, TapTable};
pub use two_feet::TwoFeet;
pub use wilson::Counted;

use underfoot::sense::Method;

/// Both contact methods, in the order of the tables, with their names in the tables.
pub const METHODS: [(Method, &str); 2] = [(Method::Eq4, "Eq. 4"), (Method::Tracker, "tracker")];
