//! What a floor exchanges with other programs and devices of its computer.

pub mod targets;
