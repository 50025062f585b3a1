//! From calibrated forces to feet: frames, contacts and the cursor.

mod assembler;
mod contact;
mod cursor;
mod frame;
mod quality;

pub use assembler::{Assembler, BoardStatus, Tare, TareOutcome, TareRules};
pub use contact::{Contact, ContactId, TileLoad};
pub use cursor::Cursor;
pub use frame::ForceFrame;
pub use quality::Quality;
