//! Packets of sensor boards: OSC messages with the readings of one instant, and SLIP frames around them on serial lines.
//!
//! Firmware and simulated boards share this crate, so that both send the same bytes. It needs no heap: the functions
//! append to anything that takes bytes, such as a `Vec` or the buffer of a microcontroller.
//!
//! ```
//! use underfoot_packet::{BoardAddress, write_counts, write_slip};
//!
//! let mut message = Vec::new();
//! let counts = [Some(0), Some(65_535), None];
//! write_counts(&BoardAddress(0).to_string(), 7, counts.into_iter(), &mut message);
//! assert!(message.starts_with(b"/underfoot/board/0\0\0,iiii\0\0\0\0\0\0\x07"));
//! let mut frame = Vec::new();
//! write_slip(&message, &mut frame);
//! ```

#![no_std]

mod message;
mod slip;

pub use message::{BoardAddress, write_blob, write_counts, write_newtons};
pub use slip::{END, ESC, ESC_END, ESC_ESC, write_slip};
