//! A floor and the other devices and programs of its computer.
//!
//! [`serial`] reads boards behind serial ports, beside a floor's other input. [`targets`] sends the messages of a
//! layout's controls to other programs, with a guardian of what they hold down. The library `underfoot` has the formats
//! and decisions and knows no device.

pub mod serial;
pub mod targets;
