//! Opens sockets, and advises on failures.

use std::io::ErrorKind;
use std::net::{SocketAddr, UdpSocket};

use socket2::{Domain, Protocol, Socket, Type};

use super::proc_net;
use crate::source::SourceError;

/// Requested receive buffer: it covers half a second of a stalled reader on a large floor.
pub(super) const BUFFER_BYTES: usize = 8 << 20;

/// Opens a socket on `address`; also returns its receive buffer in bytes.
pub(super) fn open(address: SocketAddr) -> Result<(UdpSocket, usize), SourceError> {
    let opened = || {
        let socket = Socket::new(Domain::for_address(address), Type::DGRAM, Some(Protocol::UDP))?;
        // A smaller buffer than requested works too; the granted size is reported.
        let _ = socket.set_recv_buffer_size(BUFFER_BYTES);
        socket.bind(&address.into())?;
        let granted = socket.recv_buffer_size().unwrap_or(0);
        Ok((UdpSocket::from(socket), granted))
    };
    opened().map_err(|source| SourceError::Socket { message: advice(address, &source), source })
}

/// One sentence of advice for a user whose floor program does not start.
fn advice(address: SocketAddr, error: &std::io::Error) -> String {
    let port = address.port();
    match error.kind() {
        ErrorKind::AddrInUse => {
            let owner = proc_net::owner(address).unwrap_or_else(|| "another program".into());
            let other = SocketAddr::new(address.ip(), if port == u16::MAX { port - 1 } else { port + 1 });
            format!("UDP port {port} is in use by {owner}: stop it, or listen on {other} and send there")
        }
        ErrorKind::AddrNotAvailable => format!(
            "{ip} is no address of this machine: 0.0.0.0:{port} takes packets on all of them",
            ip = address.ip()
        ),
        ErrorKind::PermissionDenied => {
            format!("UDP port {port} needs special rights: choose one above 1023")
        }
        _ => format!("cannot listen on {address}: {error}"),
    }
}
