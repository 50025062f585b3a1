//! Where sensor packets come from: a socket, a simulated floor, a recording.

#[cfg(any(feature = "internals", test))]
mod fault;
#[cfg(feature = "sim")]
mod floor_clock;
#[cfg(feature = "sim")]
mod simulated;
mod udp;

#[cfg(any(feature = "internals", test))]
pub use fault::{BadFault, Bursts, FaultInjector, Faults, Outage, Stall};
#[cfg(feature = "sim")]
pub use fault::{FaultSwitch, RehearsalSource};
#[cfg(all(test, feature = "preview"))]
pub(crate) use floor_clock::tests::ByHand;
#[cfg(feature = "sim")]
pub use simulated::{Pace, SimulatedSource};
pub use udp::{ForwardCounters, Seal, Sealed, UdpSource};

use std::net::SocketAddr;
use std::time::Duration;

use thiserror::Error;

use crate::layout::Layout;
use crate::units::Instant;
use crate::wire::{LinkCause, LinkCounters, Request, SensorPacket};

/// A floor's stream of sensor packets, with the clock they are stamped by.
pub trait SensorSource: Send {
    /// The next packet, waiting for it at most `patience`; `None` if none came.
    ///
    /// A free-running source (a simulation, a recording) advances its own
    /// clock instead of waiting.
    ///
    /// # Errors
    /// [`SourceError`] says whether trying again can help.
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError>;

    /// The present moment on the clock that stamps [`SensorPacket::received`].
    fn now(&self) -> Instant;

    /// What an app asked over the same wire, oldest first; `None` once all is taken.
    fn take_request(&mut self) -> Option<Request> {
        None
    }

    /// A layout that the floor got at this moment, where a recording has one; it comes in the order of the requests.
    fn take_layout(&mut self) -> Option<Layout> {
        None
    }

    /// Hears what the program's own app asks, so that a recording has that as well.
    fn note_request(&mut self, _request: &Request) {}

    /// Hears of a layout that the floor is about to get; a recording puts in its place what it keeps of it.
    fn note_layout(&mut self, _layout: &mut Layout) {}

    /// The address that packets come to; `None` where they do not come over a network.
    fn local_addr(&self) -> Option<SocketAddr> {
        None
    }

    /// Sends `datagram` to somebody who asked; where there is no wire, nobody hears it.
    fn answer(&mut self, _to: SocketAddr, _datagram: &[u8]) {}

    /// What the source itself received and refused so far; zero where it can refuse nothing.
    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
    }

    /// The cause for which something from boards was refused last, or [`LinkCause::Unknown`] with the reason where it
    /// was something else; `None` where nothing was refused so far.
    fn last_refused(&self) -> Option<LinkCause> {
        None
    }
}

/// Why a source gives no packets.
#[derive(Debug, Error)]
pub enum SourceError {
    /// The stream has ended: the scenario is over, the recording is played. Not a failure.
    #[error("the source has ended")]
    Ended,
    /// The socket cannot be had or failed; `message` says what to do.
    #[error("{message}")]
    Socket {
        /// One sentence for the person who started the program.
        message: String,
        /// What the system said.
        #[source]
        source: std::io::Error,
    },
}
