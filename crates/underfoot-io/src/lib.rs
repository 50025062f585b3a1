//! Boards of a floor on other wires than the network.
//!
//! [`serial`] reads boards behind serial ports, beside a floor's other input. The library `underfoot` has the formats
//! (SLIP frames, lines of text) and knows no device.

pub mod serial;
