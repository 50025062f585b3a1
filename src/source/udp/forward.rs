//! Packets of boards near the border of an area, forwarded to the computers of other areas that sense them.
//!
//! The program forwards each message at once and unchanged, sealed if there is a seal: the neighbour treats it as a
//! packet of the board itself that is a little late. A packet that has waited here for too long is dropped, because
//! the neighbour could mistake an old state of the floor for a new one; gaps in the boards' sequence numbers show the
//! loss.

use std::collections::HashMap;
use std::io;
use std::net::{SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use super::seal::Seal;
use crate::floor::Forwarding;
use crate::wire::each_message;

/// Maximum waiting time of a packet that is still forwarded: a neighbour's frame waits at most six milliseconds for
/// it, including the time on the network.
const WITHIN: Duration = Duration::from_millis(5);

/// Counts of forwarded and dropped packets since the start.
#[derive(Debug, Default)]
pub struct ForwardCounters {
    sent: AtomicU64,
    late: AtomicU64,
    unsent: AtomicU64,
}

impl ForwardCounters {
    /// Packets forwarded, counted once per destination.
    #[must_use]
    pub fn sent(&self) -> u64 {
        self.sent.load(Ordering::Relaxed)
    }

    /// Packets not forwarded because they had waited here for more than 5 ms.
    #[must_use]
    pub fn late(&self) -> u64 {
        self.late.load(Ordering::Relaxed)
    }

    /// Packets that the system rejected: its buffer was full, or there is no route.
    #[must_use]
    pub fn unsent(&self) -> u64 {
        self.unsent.load(Ordering::Relaxed)
    }
}

/// Forwards packets.
#[derive(Debug)]
pub(super) struct Forwarder {
    socket: UdpSocket,
    /// Destinations by the boards' addresses.
    to: HashMap<Box<[u8]>, Vec<SocketAddr>>,
    counters: Arc<ForwardCounters>,
}

impl Forwarder {
    /// Forwards from a port of its own beside `local`.
    pub(super) fn new(local: SocketAddr, forwardings: &[Forwarding]) -> io::Result<Self> {
        let socket = UdpSocket::bind(SocketAddr::new(local.ip(), 0))?;
        socket.set_nonblocking(true)?;
        let entry = |one: &Forwarding| (one.address.as_bytes().into(), one.to.clone());
        Ok(Self { socket, to: forwardings.iter().map(entry).collect(), counters: Arc::default() })
    }

    pub(super) fn counters(&self) -> Arc<ForwardCounters> {
        Arc::clone(&self.counters)
    }

    /// Forwards those messages of `datagram` that others need; it has been decoded and has `waited` here.
    pub(super) fn forward(
        &self,
        datagram: &[u8],
        waited: Duration,
        mut seal: Option<&mut (dyn Seal + 'static)>,
    ) {
        each_message(datagram, &mut |address, message| {
            let Some(to) = self.to.get(address) else { return };
            if waited > WITHIN {
                self.counters.late.fetch_add(to.len() as u64, Ordering::Relaxed);
                return;
            }
            let message = seal.as_mut().map_or(message, |seal| seal.seal(message));
            for to in to {
                let is_sent = self.reaches(message, *to);
                let count = if is_sent { &self.counters.sent } else { &self.counters.unsent };
                count.fetch_add(1, Ordering::Relaxed);
            }
        });
    }

    fn reaches(&self, message: &[u8], to: SocketAddr) -> bool {
        match self.socket.send_to(message, to) {
            Ok(_) => true,
            // The error belongs to an earlier packet to an absent neighbour; this packet has not been sent yet.
            Err(error) if error.kind() == io::ErrorKind::ConnectionRefused => {
                self.socket.send_to(message, to).is_ok()
            }
            Err(_) => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use rosc::{OscBundle, OscMessage, OscPacket, OscTime, OscType, encoder};

    use super::*;

    fn message(board: u16) -> OscPacket {
        OscPacket::Message(OscMessage {
            addr: format!("/underfoot/board/{board}"),
            args: vec![OscType::Int(7), OscType::Int(1000)],
        })
    }

    fn received(socket: &UdpSocket) -> Option<Vec<u8>> {
        let mut buffer = [0; 512];
        let length = socket.recv(&mut buffer).ok()?;
        Some(buffer[..length].to_vec())
    }

    #[test]
    fn each_board_of_a_datagram_goes_to_those_who_need_it_and_what_is_old_to_nobody() {
        let here: SocketAddr = ([127, 0, 0, 1], 0).into();
        let [west, east] = [(); 2].map(|()| {
            let socket = UdpSocket::bind(here).unwrap();
            socket.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
            socket
        });
        let to = |sockets: &[&UdpSocket]| sockets.iter().map(|one| one.local_addr().unwrap()).collect();
        let forwardings = [
            Forwarding { address: "/underfoot/board/1".into(), to: to(&[&west]) },
            Forwarding { address: "/underfoot/board/2".into(), to: to(&[&west, &east]) },
        ];
        let forwarder = Forwarder::new(here, &forwardings).unwrap();
        let timetag = OscTime { seconds: 0, fractional: 1 };
        let content = (0..3).map(message).collect();
        let bundle = encoder::encode(&OscPacket::Bundle(OscBundle { timetag, content })).unwrap();
        forwarder.forward(&bundle, Duration::ZERO, None);
        let sent = |board| Some(encoder::encode(&message(board)).unwrap());
        assert_eq!((received(&west), received(&west), received(&east)), (sent(1), sent(2), sent(2)));
        forwarder.forward(&bundle, WITHIN + Duration::from_millis(1), None);
        assert_eq!((received(&west), received(&east)), (None, None));
        let counters = forwarder.counters();
        assert_eq!((counters.sent(), counters.late(), counters.unsent()), (3, 3, 0));
    }

    /// Prefixes each message with a letter and its number.
    #[derive(Debug, Default)]
    struct Numbered(Vec<u8>, u8);

    impl Seal for Numbered {
        fn seal(&mut self, message: &[u8]) -> &[u8] {
            self.1 += 1;
            self.0 = [b"s", &[self.1][..], message].concat();
            &self.0
        }

        fn open(&mut self, _: &[u8]) -> super::super::Sealed {
            super::super::Sealed::Refused
        }
    }

    #[test]
    fn a_forwarded_packet_is_sealed_once_for_all_receivers() {
        let here: SocketAddr = ([127, 0, 0, 1], 0).into();
        let sockets = [(); 2].map(|()| UdpSocket::bind(here).unwrap());
        let to = sockets.iter().map(|socket| socket.local_addr().unwrap()).collect();
        let forwardings = [Forwarding { address: "/underfoot/board/1".into(), to }];
        let forwarder = Forwarder::new(here, &forwardings).unwrap();
        let plain = encoder::encode(&message(1)).unwrap();
        forwarder.forward(&plain, Duration::ZERO, Some(&mut Numbered::default()));
        for socket in &sockets {
            assert_eq!(received(socket), Some([b"s", &[1][..], &plain].concat()));
        }
    }
}
