//! Datagrams to sensor packets, events to OSC: pure, no sockets.
//!
//! A datagram is looked through by [`check`] before any decoder sees it, then
//! read whole or refused whole by [`Decoder`]. [`SensorEncoder`] is the way
//! back, for simulated boards; [`write_event`] and its kin speak to other
//! programs.

mod command;
pub mod corrupt;
mod counters;
mod decode;
mod encode;
mod event;
mod guard;
mod packet;
mod prefix;
mod tuio;
mod tuio1;
mod tuio2;

pub use command::{ArgumentKind, COMMANDS, Command, ControlMessage, MAX_LABEL, Request};
pub use counters::LinkCounters;
pub use decode::{Batch, Decoder, WireError};
pub use encode::{EncodeError, SensorEncoder, SensorFormat};
pub(crate) use event::link_name;
pub use event::{
    Readback, write_contacts, write_crack, write_device, write_error, write_event, write_health, write_mute,
    write_page, write_readback,
};
pub use guard::{Limits, Malformed, check};
pub use packet::{MAX_CHANNELS, Readings, SensorPacket};
pub use prefix::{BadPrefix, Prefix};
pub use tuio::{TUIO_CONTACTS, TUIO_DATAGRAM};
pub use tuio1::Tuio1;
pub use tuio2::{TUIO_FULL_FORCE_N, Tuio2};
