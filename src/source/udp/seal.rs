//! Authentication of datagrams between the computers of a floor.

use std::fmt;
use std::ops::Range;

/// Authenticates datagrams to and from other computers of the floor.
///
/// A sealed datagram begins neither with a slash nor with a hash: those mark OSC.
pub trait Seal: fmt::Debug + Send {
    /// `message` in sealed form, ready to send.
    fn seal(&mut self, message: &[u8]) -> &[u8];

    /// Opens a datagram that is not OSC and has just arrived.
    fn open(&mut self, datagram: &[u8]) -> Sealed;
}

/// The content of a sealed datagram.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sealed {
    /// A forwarded packet of a board: OSC in these bytes of the datagram.
    Forwarded(Range<usize>),
    /// A message to the owner of the seal, which has processed it.
    Taken,
    /// Rejected; the owner of the seal counts it by its reason.
    Refused,
}
