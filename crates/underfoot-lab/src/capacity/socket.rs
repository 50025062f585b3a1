//! Speed of receiving packets from a socket and decoding them, over this machine's own network.

use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::time::Duration;

use super::receiving::square;
use underfoot::floor::Floor;
use underfoot::source::{SourceError, UdpSource};
use underfoot::units::Instant;
use underfoot::wire::{Readings, SensorEncoder, SensorFormat, SensorPacket};

/// Maximum time from sending a packet to receiving it.
const PATIENCE: Duration = Duration::from_millis(100);

/// Simulated boards, and the socket that receives their packets.
#[derive(Debug)]
pub struct SocketLoad {
    source: UdpSource,
    sender: UdpSocket,
    to: SocketAddr,
    encoder: SensorEncoder,
    floor: Floor,
    sent: usize,
}

impl SocketLoad {
    /// Number of packets per burst: the smallest usual receive buffer holds twice as many.
    pub const BATCH: usize = 96;

    /// Packets per second of the boards of 96 x 96 tiles: 1152 boards, 1000 times.
    pub const PACKETS_PER_S: f64 = 1_152_000.0;

    /// Prepares the boards of 96 x 96 tiles, with 32 channels each, and binds a free port of this machine.
    ///
    /// # Errors
    /// [`SourceError::Socket`] if no port is free.
    pub fn new() -> Result<Self, SourceError> {
        let floor = square(96);
        let here = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
        let source = UdpSource::bind(here, &floor)?;
        let failed = |source: std::io::Error| SourceError::Socket {
            message: format!("packets can't be sent to this machine itself: {source}"),
            source,
        };
        let sender = UdpSocket::bind(here).map_err(failed)?;
        let to = source.local_addr().map_err(failed)?;
        let encoder = SensorEncoder::new(&floor, SensorFormat::Counts);
        Ok(Self { to, source, sender, encoder, floor, sent: 0 })
    }

    /// Sends a packet from each of the next 96 boards.
    pub fn send(&mut self) {
        for _ in 0..Self::BATCH {
            let boards = self.floor.boards.len();
            let (number, sequence) = (self.sent % boards, (self.sent / boards) as u32);
            let channels = self.floor.boards.get(number).map_or(0, |board| board.channels.len());
            let readings =
                Readings::Counts((0..channels).map(|channel| Some(20_000 + channel as u16)).collect());
            let packet = SensorPacket { board: number as u16, sequence, received: Instant::START, readings };
            if let Ok(datagram) = self.encoder.encode(&packet) {
                // A lost packet counts as missing at the receiver.
                let _ = self.sender.send_to(datagram, self.to);
            }
            self.sent += 1;
        }
    }

    /// Receives the packets that were sent; returns their number, 96 unless some were lost.
    ///
    /// # Errors
    /// [`SourceError`] if the socket fails.
    pub fn take(&mut self) -> Result<usize, SourceError> {
        for taken in 0..Self::BATCH {
            if std::hint::black_box(self.source.next(PATIENCE)?).is_none() {
                return Ok(taken);
            }
        }
        Ok(Self::BATCH)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_sent_is_taken() {
        let mut load = SocketLoad::new().unwrap();
        assert!((SocketLoad::PACKETS_PER_S - 1000.0 * load.floor.boards.len() as f64).abs() < 1e-9);
        for _ in 0..3 {
            load.send();
            assert_eq!(load.take().unwrap(), SocketLoad::BATCH);
        }
    }
}
