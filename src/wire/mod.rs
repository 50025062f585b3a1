//! Datagrams to sensor packets, events to OSC: pure, no sockets.
//!
//! A datagram is looked through by [`check`] before any decoder sees it, then
//! read whole or refused whole by [`Decoder`]. [`SensorEncoder`] is the way
//! back, for simulated boards; [`write_event`] and its kin speak to other
//! programs.

mod counters;
mod decode;
mod encode;
mod event;
pub mod garble;
mod guard;
mod packet;

pub use counters::LinkCounters;
pub use decode::{Batch, ControlMessage, Decoder, WireError};
pub use encode::{EncodeError, SensorEncoder, SensorFormat};
pub(crate) use event::link_name;
pub use event::{write_contacts, write_event, write_health};
pub use guard::{Limits, Malformed, check};
pub use packet::{MAX_CHANNELS, Readings, SensorPacket};
