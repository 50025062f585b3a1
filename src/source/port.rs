//! The network port of a floor.

use std::net::SocketAddr;

use crate::wire::{LinkCause, Request};

/// The network port of a floor: apps send their requests to it and get answers from it.
pub trait Port: Send {
    /// The next request of an app, oldest first; `None` once all are taken.
    fn take_request(&mut self) -> Option<Request>;

    /// Sends `datagram` to the sender of a request; an answer that does not arrive is not an error.
    fn answer(&mut self, to: SocketAddr, datagram: &[u8]);

    /// The address to which boards send their packets; `None` if the system does not report it.
    fn local_addr(&self) -> Option<SocketAddr>;

    /// The cause of the last refusal of something from boards, or [`LinkCause::Unknown`] with the reason if it was
    /// something else; `None` before the first refusal.
    fn last_refused(&self) -> Option<LinkCause>;
}
