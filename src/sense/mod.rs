//! From calibrated forces to feet: frames, contacts and the cursor.

mod calibration;
mod contact;
mod cursor;
mod frame;
mod quality;

pub use calibration::{Fit, FitError, LoadPoint};
pub use contact::{Contact, ContactId, TileLoad};
pub use cursor::Cursor;
pub use frame::ForceFrame;
pub use quality::Quality;
