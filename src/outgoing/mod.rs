//! Encoding of events, contacts and states for other programs, as OSC, TUIO and JSON: pure, no sockets.

mod area;
mod held;
pub mod json;
mod osc;
mod tuio;
mod tuio1;
mod tuio2;

pub use area::{AreaNews, AreaState};
pub use held::HeldReport;
pub use tuio1::TuioProfiles;

pub use area::write_area;
pub use held::{write_alive, write_held};
pub use osc::{
    write_contacts, write_control, write_crack, write_device, write_error, write_event, write_health,
    write_ignored, write_mute, write_page,
};
pub use tuio::{TUIO_CONTACTS, TUIO_DATAGRAM, tuio_first_frame};
pub use tuio1::Tuio1;
pub use tuio2::Tuio2;
