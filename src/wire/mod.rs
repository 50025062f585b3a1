//! Decoding of datagrams into sensor packets and requests, and the state of the link: pure, no sockets.
//!
//! `check` examines a datagram before any decoder reads it; then `Decoder` accepts or rejects all of it.
//! `SensorEncoder` is the inverse, for simulated boards.

mod argument;
mod cause;
mod command;
#[cfg(any(feature = "internals", test))]
pub mod corrupt;
mod counters;
mod decode;
mod encode;
mod guard;
mod json_request;
mod link;
mod message;
mod packet;
mod pattern;
mod prefix;
mod sensor_message;
pub(crate) mod sent;
mod split;

pub(crate) use cause::guess_format;
pub use cause::{BOARD_RATES_HZ, LinkCause};
pub use counters::LinkCounters;
pub(crate) use encode::write;
pub use link::LinkState;
pub use message::{ControlMessage, Request};
pub use packet::{Readings, SensorPacket};
pub use prefix::{BadPrefix, Prefix};
pub(crate) use split::each_message;

internal! {
    use argument::{ArgumentKind, MAX_LABEL};
    use command::{COMMANDS, Command};
    use decode::{Batch, Decoder, WireError};
    use encode::{EncodeError, SensorEncoder, SensorFormat};
    use guard::{Limits, Malformed, check};
    use json_request::{read_json, write_json};
    use packet::{MAX_CHANNELS};
    use pattern::{is_pattern, matches};
}
