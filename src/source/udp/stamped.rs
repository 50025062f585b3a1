//! Datagrams with their waiting time in the kernel, on systems whose kernel stamps them (Linux).

use std::io;
use std::net::{SocketAddr, UdpSocket};
use std::time::Duration;

/// A received datagram.
#[derive(Clone, Copy, Debug)]
pub(super) struct Received {
    pub(super) length: usize,
    pub(super) sender: SocketAddr,
    /// Time between arrival and reading; zero if the kernel does not report it.
    pub(super) waited: Duration,
}

/// Receives datagrams from a socket.
#[cfg(target_os = "linux")]
#[derive(Debug)]
pub(super) struct Stamped {
    /// Buffer for the kernel's stamp; empty if it gives none.
    space: Vec<u8>,
}

#[cfg(target_os = "linux")]
impl Stamped {
    /// Requests stamps on `socket`.
    pub(super) fn on(socket: &UdpSocket) -> Self {
        use nix::sys::socket::{setsockopt, sockopt::ReceiveTimestampns};
        let stamped = setsockopt(socket, ReceiveTimestampns, &true).is_ok();
        let space = if stamped { nix::cmsg_space!(nix::sys::time::TimeSpec) } else { Vec::new() };
        Self { space }
    }

    /// Receives one datagram; waits for the time-out of the socket.
    pub(super) fn receive(&mut self, socket: &UdpSocket, buffer: &mut [u8]) -> io::Result<Received> {
        use std::os::fd::AsRawFd;

        use nix::sys::socket::{ControlMessageOwned, MsgFlags, SockaddrStorage, recvmsg};
        if self.space.is_empty() {
            return plainly(socket, buffer);
        }
        let mut parts = [io::IoSliceMut::new(buffer)];
        let space = Some(self.space.as_mut_slice());
        let message = recvmsg::<SockaddrStorage>(socket.as_raw_fd(), &mut parts, space, MsgFlags::empty())?;
        let stamps = message.cmsgs().into_iter().flatten();
        let stamp = stamps.into_iter().find_map(|message| match message {
            ControlMessageOwned::ScmTimestampns(stamp) => Some(Duration::from(stamp)),
            _ => None,
        });
        let address = message.address.as_ref();
        let v4 = address.and_then(|address| address.as_sockaddr_in()).map(|v4| SocketAddr::V4((*v4).into()));
        let v6 =
            || address.and_then(|address| address.as_sockaddr_in6()).map(|v6| SocketAddr::V6((*v6).into()));
        let sender = v4.or_else(v6).ok_or(io::ErrorKind::AddrNotAvailable)?;
        Ok(Received { length: message.bytes, sender, waited: stamp.map_or(Duration::ZERO, waited_since) })
    }
}

/// Maximum plausible waiting time: the kernel stamps by the wall clock, which may be set in between.
#[cfg(target_os = "linux")]
const LONGEST: Duration = Duration::from_secs(1);

/// Time since `stamp` on the wall clock; zero if it exceeds the maximum.
#[cfg(target_os = "linux")]
fn waited_since(stamp: Duration) -> Duration {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
    let waited = now.saturating_sub(stamp);
    if waited > LONGEST { Duration::ZERO } else { waited }
}

/// Receives datagrams from a socket.
#[cfg(not(target_os = "linux"))]
#[derive(Debug)]
pub(super) struct Stamped;

#[cfg(not(target_os = "linux"))]
impl Stamped {
    /// Other systems have no stamps.
    pub(super) fn on(_: &UdpSocket) -> Self {
        Self
    }

    /// Receives one datagram; waits for the time-out of the socket.
    pub(super) fn receive(&mut self, socket: &UdpSocket, buffer: &mut [u8]) -> io::Result<Received> {
        plainly(socket, buffer)
    }
}

fn plainly(socket: &UdpSocket, buffer: &mut [u8]) -> io::Result<Received> {
    let (length, sender) = socket.recv_from(buffer)?;
    Ok(Received { length, sender, waited: Duration::ZERO })
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn the_time_a_datagram_lay_in_the_kernel_is_known() {
        for local in ["127.0.0.1:0", "[::1]:0"] {
            let Ok(socket) = UdpSocket::bind(local) else { continue };
            let sender = UdpSocket::bind(local).unwrap();
            let mut stamped = Stamped::on(&socket);
            let mut buffer = [0; 16];
            // The kernel begins to stamp a moment after the request: until then it reports a waiting time of zero.
            let seen = (0..50).any(|_| {
                sender.send_to(b"step", socket.local_addr().unwrap()).unwrap();
                std::thread::sleep(Duration::from_millis(10));
                let received = stamped.receive(&socket, &mut buffer).unwrap();
                assert_eq!((received.length, received.sender), (4, sender.local_addr().unwrap()));
                assert_eq!(&buffer[..4], b"step");
                received.waited >= Duration::from_millis(9)
            });
            assert!(seen, "{local}: the kernel's stamps are not used");
        }
    }

    // N9
    #[test]
    fn a_wall_clock_that_was_set_is_not_believed() {
        assert_eq!(waited_since(Duration::ZERO), Duration::ZERO);
        assert_eq!(waited_since(Duration::from_secs(1 << 40)), Duration::ZERO);
    }
}
