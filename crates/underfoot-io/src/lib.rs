//! Exchange of a floor with other programs and devices of its computer.

pub mod targets;
