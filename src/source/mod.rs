//! Inputs of floors: packets from a socket, a simulated floor or a recording, and the requests beside them.

mod fault;
mod input;
mod journal;
#[cfg(any(feature = "mirror", feature = "replay"))]
pub(crate) mod log;
mod port;
#[cfg(any(feature = "mirror", feature = "net", feature = "replay"))]
mod shared;
mod tapped;
#[cfg(feature = "net")]
mod udp;

pub use fault::{BadFault, Bursts, FaultInjector, LinkFaults, Outage, Stall};
pub use input::FloorInput;
pub use journal::{Incoming, Journal, Replay};
pub use port::Port;
#[cfg(any(feature = "mirror", feature = "net", feature = "replay"))]
pub(crate) use shared::Shared;
pub use tapped::{PacketTap, TappedPackets};
#[cfg(feature = "net")]
pub use udp::{ForwardCounters, Seal, Sealed, UdpSource};

use std::time::Duration;

use thiserror::Error;

use crate::units::Instant;
use crate::wire::{LinkCounters, SensorPacket};

/// A floor's stream of sensor packets, with the clock that stamps them.
///
/// ```
/// use std::time::Duration;
/// use underfoot::source::{SensorSource, SourceError};
/// use underfoot::units::Instant;
/// use underfoot::wire::{LinkCounters, SensorPacket};
///
/// /// Boards on a bus of their own.
/// struct Bus {
///     begun: std::time::Instant,
/// }
///
/// impl SensorSource for Bus {
///     fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
///         std::thread::sleep(patience);
///         Ok(None)
///     }
///
///     fn now(&self) -> Instant {
///         Instant::START + self.begun.elapsed()
///     }
///
///     fn counters(&self) -> LinkCounters {
///         LinkCounters::default()
///     }
/// }
/// ```
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

    /// Numbers of datagrams that the source itself received and refused; zero for a source that refuses nothing.
    fn counters(&self) -> LinkCounters;
}

impl<S: SensorSource + ?Sized> SensorSource for Box<S> {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        (**self).next(patience)
    }

    fn now(&self) -> Instant {
        (**self).now()
    }

    fn counters(&self) -> LinkCounters {
        (**self).counters()
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
