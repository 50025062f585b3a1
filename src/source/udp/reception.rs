//! Receives datagrams from the sensors' socket, with their time of arrival.

use std::io;
use std::net::UdpSocket;
use std::time::Duration;

use super::stamped::{Received, Stamped};
use crate::units::Instant;
use crate::wire::DatagramLimits;

/// The receiving side of the sensors' socket, and the last datagram.
#[derive(Debug)]
pub(super) struct Reception {
    stamped: Stamped,
    /// Size of the system's receive buffer, as [`super::UdpSource::granted_buffer`] returns it.
    granted: usize,
    /// Time-out of the socket; `None` before it is set.
    patience: Option<Duration>,
    /// The last datagram of any socket, and space.
    pub(super) buffer: Vec<u8>,
    /// Arrival time of the last datagram on this socket.
    received: Instant,
}

impl Reception {
    /// Receives from `socket`, for which the system granted a buffer of so many bytes.
    pub(super) fn on(socket: &UdpSocket, granted: usize) -> Self {
        Self {
            stamped: Stamped::on(socket),
            granted,
            patience: None,
            // One byte more than the maximum distinguishes a truncated datagram from one that just fits.
            buffer: vec![0; DatagramLimits::SENSORS.bytes + 1],
            received: Instant::START,
        }
    }

    /// The size of the system's receive buffer.
    pub(super) const fn granted(&self) -> usize {
        self.granted
    }

    /// Arrival time of the last datagram.
    pub(super) const fn received(&self) -> Instant {
        self.received
    }

    /// Sets the time-out of `socket`; zero means non-blocking. Makes a system call only if it changes.
    pub(super) fn set_patience(&mut self, socket: &UdpSocket, patience: Duration) -> io::Result<()> {
        if self.patience == Some(patience) {
            return Ok(());
        }
        socket.set_nonblocking(patience.is_zero())?;
        if !patience.is_zero() {
            socket.set_read_timeout(Some(patience))?;
        }
        self.patience = Some(patience);
        Ok(())
    }

    /// Receives one datagram into the buffer; waits for the time-out of `socket`.
    pub(super) fn receive(&mut self, socket: &UdpSocket) -> io::Result<Received> {
        self.stamped.receive(socket, &mut self.buffer)
    }

    /// Notes that the last datagram, read at `now`, had waited in the kernel for so long.
    pub(super) fn note_arrival(&mut self, now: Instant, waited: Duration) {
        // The kernel stamps by the wall clock, which may be slewed; this keeps time monotonic.
        self.received = self.received.max(now.before(waited));
    }
}
