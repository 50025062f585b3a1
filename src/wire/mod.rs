//! Decoding of datagrams into sensor packets and requests, and the state of the link: pure, no sockets.
//!
//! `check` examines a datagram before any decoder reads it; then `Decoder` accepts or rejects all of it.
//! `SensorEncoder` is the inverse, for simulated boards.

mod argument;
mod cause;
mod command;
mod counters;
mod decode;
mod encode;
mod guard;
mod json_request;
mod lines;
mod link;
mod message;
mod packet;
mod pattern;
mod prefix;
mod sensor_message;
pub(crate) mod sent;
mod slip;
mod split;

pub use cause::guess_format;
pub use cause::{BOARD_RATES_HZ, LinkCause};
pub use counters::LinkCounters;
pub(crate) use encode::write;
pub use lines::{LineDecoder, LineFault};
pub use link::LinkState;
pub use message::{ControlMessage, Request};
pub use packet::{Readings, SensorPacket};
pub use prefix::{BadPrefix, Prefix};
pub use slip::{SlipDecoder, SlipFault};
pub use split::each_message;

pub use argument::{ArgumentKind, MAX_LABEL};
pub use command::{COMMANDS, Command};
pub use decode::{Batch, Decoder, WireError};
pub use encode::{EncodeError, SensorEncoder, SensorFormat};
pub use guard::{DatagramLimits, Malformed, check};
pub use json_request::{read_json, write_json};
pub use packet::MAX_CHANNELS;
pub use pattern::{is_pattern, matches};
pub use underfoot_packet::write_slip;
