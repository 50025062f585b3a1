//! Datagrams to sensor packets, events to OSC: pure, no sockets.
//!
//! A datagram is looked through by [`check`] before any decoder sees it, then
//! read whole or refused whole by [`Decoder`]. [`SensorEncoder`] is the way
//! back, for simulated boards.

mod counters;
mod decode;
mod encode;
mod guard;
mod packet;

pub use counters::LinkCounters;
pub use decode::{Batch, ControlMessage, Decoder, WireError};
pub use encode::{EncodeError, SensorEncoder, SensorFormat};
pub use guard::{Limits, Malformed, check};
pub use packet::{MAX_CHANNELS, Readings, SensorPacket};
