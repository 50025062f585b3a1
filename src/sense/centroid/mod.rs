//! The force and the centroid of each tile (Eq. 2 and 3), and contacts from them by the paper's method (Eq. 4).
//!
//! [`corners`] relates the readings of one tile's four sensors, [`tile`] computes force and centroid from them, and
//! [`uncertainty`] bounds the centroid's error. [`cluster`] groups loaded tiles that touch, and [`eq4`] makes each
//! group one contact.

pub(super) mod cluster;
pub(super) mod corners;
pub(super) mod eq4;
pub(super) mod tile;
pub(super) mod uncertainty;

pub use corners::known_corners;
pub use tile::{LoadedTile, TileReading, Wrench};
pub use uncertainty::SensorUncertainty;
