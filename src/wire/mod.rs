//! Datagrams to sensor packets, events to OSC: pure, no sockets.

mod counters;
mod packet;

pub use counters::LinkCounters;
pub use packet::{MAX_CHANNELS, Readings, SensorPacket};
