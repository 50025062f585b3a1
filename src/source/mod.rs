//! Sources of sensor packets: a socket; simulated floors and recordings implement the same trait.

mod fault;
#[cfg(feature = "net")]
mod udp;

pub use fault::{BadFault, Bursts, FaultInjector, Faults, Outage, Stall};
#[cfg(feature = "net")]
pub use udp::{ForwardCounters, Seal, Sealed, UdpSource};

use std::net::SocketAddr;
use std::time::Duration;

use thiserror::Error;

use crate::layout::Layout;
use crate::units::Instant;
use crate::wire::{LinkCause, LinkCounters, Request, SensorPacket};

/// A floor's stream of sensor packets, with the clock that stamps them.
pub trait SensorSource: Send {
    /// The next packet; waits for it at most `patience` and returns `None` if none arrived.
    ///
    /// A free-running source (a simulation, a recording) advances its own
    /// clock instead of waiting.
    ///
    /// # Errors
    /// [`SourceError`] tells whether another call can help.
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError>;

    /// The present on the clock that stamps [`SensorPacket::received`].
    fn now(&self) -> Instant;

    /// The next request of an app over the same wire, oldest first; `None` once all are taken.
    fn take_request(&mut self) -> Option<Request> {
        None
    }

    /// A layout that the floor gets at this moment, for a recording that contains one; in the order of the requests.
    fn take_layout(&mut self) -> Option<Layout> {
        None
    }

    /// Notes a request of the program's own app, so that a recording contains it.
    fn note_request(&mut self, _request: &Request) {}

    /// Notes a layout that the floor is about to get; a recording replaces it by the form that it stores.
    fn note_layout(&mut self, _layout: &mut Layout) {}

    /// The address that receives packets; `None` for a source without a network.
    fn local_addr(&self) -> Option<SocketAddr> {
        None
    }

    /// Sends `datagram` to the sender of a request; does nothing for a source without a wire.
    fn answer(&mut self, _to: SocketAddr, _datagram: &[u8]) {}

    /// Numbers of datagrams that the source itself received and refused; zero for a source that refuses nothing.
    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
    }

    /// The cause of the last refusal of something from boards, or [`LinkCause::Unknown`] with the reason if it was
    /// something else; `None` before the first refusal.
    fn last_refused(&self) -> Option<LinkCause> {
        None
    }
}

/// Reasons why a source gives no packets.
#[derive(Debug, Error)]
pub enum SourceError {
    /// The stream has ended: the scenario or the recording is over. Not a failure.
    #[error("the source has ended")]
    Ended,
    /// The socket does not open or failed; `message` gives the remedy.
    #[error("{message}")]
    Socket {
        /// One sentence for the user of the program.
        message: String,
        /// The error of the operating system.
        #[source]
        source: std::io::Error,
    },
}
