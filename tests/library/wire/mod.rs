//! Packets in and out: boards, clocks, other programs, hostile networks.

mod addresses;
mod assembler;
mod hostile;
mod mute;
mod osc_out;
mod rates;
mod server;
mod tuio;
mod tuio_client;
mod udp;
mod wrappers;
