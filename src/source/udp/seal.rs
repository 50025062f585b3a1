//! Authentication of datagrams between the computers of a floor.

use std::fmt;
use std::ops::Range;

/// Authenticates datagrams to and from other computers of the floor.
///
/// Sealed datagrams begin neither with a slash nor with a hash, as OSC does.
pub trait Seal: fmt::Debug + Send {
    /// `message` in sealed form, to be sent at once.
    fn seal(&mut self, message: &[u8]) -> &[u8];

    /// Opens a datagram that is not OSC and has just arrived.
    fn open(&mut self, datagram: &[u8]) -> Sealed;
}

/// The content of a sealed datagram.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sealed {
    /// A forwarded packet of a board: OSC at these bytes of the datagram.
    Forwarded(Range<usize>),
    /// A message to the owner of the seal, which has taken it.
    Taken,
    /// Rejected; the owner of the seal counts it by its reason.
    Refused,
}
