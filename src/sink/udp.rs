//! A socket that only sends.

use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::SinkError;

/// A socket that only sends, and counts failures.
#[derive(Debug)]
pub(super) struct UdpOut {
    socket: UdpSocket,
    target: SocketAddr,
    undelivered: Arc<AtomicU64>,
}

impl UdpOut {
    /// A socket for datagrams to `target`; a broadcast address reaches all machines of a network.
    pub(super) fn new(target: SocketAddr, what: &str) -> Result<Self, SinkError> {
        let failed = |source| SinkError::Output {
            message: format!("cannot send {what} to {target}: {source}"),
            source,
        };
        let any: SocketAddr = match target {
            SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
            SocketAddr::V6(_) => (Ipv6Addr::UNSPECIFIED, 0).into(),
        };
        // Not connected: a closed port at the other end must not cause an error here.
        let socket = UdpSocket::bind(any).map_err(failed)?;
        if target.is_ipv4() {
            socket.set_broadcast(true).map_err(failed)?;
        }
        Ok(Self { socket, target, undelivered: Arc::new(AtomicU64::new(0)) })
    }

    /// Returns the counter of datagrams that could not be sent.
    pub(super) fn undelivered(&self) -> Arc<AtomicU64> {
        Arc::clone(&self.undelivered)
    }

    pub(super) fn send(&self, datagram: &[u8]) {
        if self.socket.send_to(datagram, self.target).is_err() {
            self.count(1);
        }
    }

    /// Counts `lost` messages that failed for another reason.
    pub(super) fn count(&self, lost: usize) {
        self.undelivered.fetch_add(lost as u64, Ordering::Relaxed);
    }

    /// Returns the address under which the target sees this machine, if the system knows it; otherwise `localhost`.
    pub(super) fn own_name(&self) -> String {
        let probe = || -> std::io::Result<String> {
            let any: SocketAddr = match self.target {
                SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
                SocketAddr::V6(_) => (Ipv6Addr::UNSPECIFIED, 0).into(),
            };
            // Connecting sends nothing; it only selects the route.
            let socket = UdpSocket::bind(any)?;
            socket.connect(self.target)?;
            Ok(socket.local_addr()?.ip().to_string())
        };
        probe().unwrap_or_else(|_| "localhost".into())
    }
}
