//! Datagrams to sensor packets and requests, and how the link is doing: pure, no sockets.
//!
//! A datagram is looked through by [`check`] before any decoder sees it, then
//! read whole or refused whole by [`Decoder`]. [`SensorEncoder`] is the way
//! back, for simulated boards.

mod command;
pub mod corrupt;
mod counters;
mod decode;
mod encode;
mod guard;
mod link;
mod packet;
mod prefix;

pub use command::{ArgumentKind, COMMANDS, Command, ControlMessage, MAX_LABEL, Request};
pub use counters::LinkCounters;
pub use decode::{Batch, Decoder, WireError};
pub(crate) use encode::write;
pub use encode::{EncodeError, SensorEncoder, SensorFormat};
pub use guard::{Limits, Malformed, check};
pub use link::LinkState;
pub use packet::{MAX_CHANNELS, Readings, SensorPacket};
pub use prefix::{BadPrefix, Prefix};
