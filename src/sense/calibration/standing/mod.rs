//! Calibration by standing: the laws of all sensors from a person of known weight who stands at marked places.
//!
//! ```text
//! StandingMark (where to stand) -person-> StandData: empty floor, Stands, Crossings
//!   -start-> one law for all sensors, of each kind
//!   -equations-> weighted errors: sums equal the weight, centroids lie at the marks
//!   -solve-> damped Gauss-Newton, normal equations
//!   -fit-> StandFit: a law for each sensor, its uncertainty, residuals
//! ```

mod curve;
mod data;
mod equations;
mod fit;
mod marks;
mod rivals;
mod search;
mod solve;
#[cfg(test)]
mod tests;

pub use data::{Crossing, MeasuredStand, SensorMoments, SensorVolts, StandData};
pub use fit::{SensorFit, StandError, StandFit, StandLaws};
pub use marks::StandingMark;
