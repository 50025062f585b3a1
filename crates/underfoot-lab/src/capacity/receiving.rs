//! Speed of decoding and assembling packets: empty floors with noisy sensors.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use underfoot::floor::{Calibration, Corner, Exponential, Floor, Geometry, SensorId};
use underfoot::sense::Assembler;
use underfoot::units::Instant;
use underfoot::wire::{Batch, Decoder, Readings, SensorEncoder, SensorFormat, SensorPacket};

/// Number of recorded milliseconds, which repeat; with 8 no sensor sends the same reading twice in a row.
pub(super) const MILLIS: usize = 8;

/// Mean reading of an empty floor's sensors, and its maximum deviation (counts).
pub(super) const RESTING: u16 = 20_000;
const STRAYS: u16 = 30;

/// Packets of a square floor's boards, and their decoder.
#[derive(Clone, Debug)]
pub struct PacketLoad {
    decoder: Decoder,
    batch: Batch,
    datagrams: Vec<Vec<u8>>,
}

impl PacketLoad {
    /// Prepares a floor of `side` x `side` tiles, with `side` clamped to the range of a floor.
    #[must_use]
    pub fn new(side: u16) -> Self {
        let floor = square(side);
        let mut encoder = SensorEncoder::new(&floor, SensorFormat::Counts);
        // The encoder accepts every board of its own floor.
        let encoded = |packet: &SensorPacket| encoder.encode(packet).map(<[u8]>::to_vec).ok();
        let datagrams = millisecond(&floor, 0).iter().filter_map(encoded).collect();
        Self { decoder: Decoder::new(&floor), batch: Batch::default(), datagrams }
    }

    /// Decodes the datagrams of one second; returns the number of packets in the last datagram.
    pub fn second(&mut self) -> usize {
        let mut packets = 0;
        for ms in 0..1000 {
            for datagram in &self.datagrams {
                let read = self.decoder.decode(datagram, Instant::from_millis(ms), &mut self.batch);
                packets = if read.is_ok() { self.batch.packets.len() } else { 0 };
                std::hint::black_box(&self.batch);
            }
        }
        packets
    }
}

/// Assembles a square floor's packets into frames.
#[derive(Clone, Debug)]
pub struct AssemblyLoad {
    assembler: Assembler,
    millis: Vec<Vec<SensorPacket>>,
    sequence: u32,
}

impl AssemblyLoad {
    /// Prepares a floor of `side` x `side` tiles, with `side` clamped to the range of a floor.
    #[must_use]
    pub fn new(side: u16) -> Self {
        let floor = tared(square(side));
        let millis = (0..MILLIS).map(|seed| millisecond(&floor, seed as u64)).collect();
        Self { assembler: Assembler::new(&floor), millis, sequence: 0 }
    }

    /// Assembles the frames of one second and returns their number.
    pub fn second(&mut self) -> usize {
        let mut frames = 0;
        for _ in 0..1000 {
            self.sequence = self.sequence.wrapping_add(1);
            let received = Instant::from_millis(self.sequence.into());
            let now = self.sequence as usize % MILLIS;
            for packet in self.millis.get_mut(now).into_iter().flatten() {
                (packet.sequence, packet.received) = (self.sequence, received);
                self.assembler.take(packet);
            }
            while std::hint::black_box(self.assembler.ready()).is_some() {
                frames += 1;
            }
        }
        frames
    }
}

pub(crate) fn square(side: u16) -> Floor {
    let side = side.clamp(1, Geometry::MAX_SIDE);
    Floor::of(Geometry::of_paper_tiles(side, side).unwrap_or_default())
}

/// Returns the floor with calibrated sensors, and with the readings of its empty state as tare.
pub(super) fn tared(mut floor: Floor) -> Floor {
    // Curves slightly off the nominal part's: a server warns about a floor with exactly the nominal curves, as
    // uncalibrated.
    let law = Exponential { a_n: 1.001 * Exponential::NOMINAL.a_n, ..Exponential::NOMINAL };
    let sensors =
        floor.geometry.tiles().flat_map(|tile| Corner::ALL.map(move |corner| SensorId { tile, corner }));
    for sensor in sensors {
        floor.recalibrate(sensor, Calibration::Exponential(law), None);
    }
    let tare = |sensor| floor.law(sensor).force(RESTING);
    let tiles = floor.geometry.tiles();
    floor.tare = tiles.map(|tile| Corner::ALL.map(|corner| tare(SensorId { tile, corner }))).collect();
    floor
}

/// Packets of all boards in one millisecond.
pub(super) fn millisecond(floor: &Floor, seed: u64) -> Vec<SensorPacket> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let packet = |(board, channels): (u16, usize)| SensorPacket {
        board,
        sequence: 0,
        received: Instant::START,
        readings: Readings::Counts(
            (0..channels).map(|_| Some(RESTING + random.random_range(0..=2 * STRAYS) - STRAYS)).collect(),
        ),
    };
    (0..).zip(floor.boards.iter().map(|board| board.channels.len())).map(packet).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_packet_is_read_and_every_millisecond_becomes_a_frame() {
        assert_eq!(PacketLoad::new(6).second(), 1);
        let mut load = AssemblyLoad::new(6);
        assert_eq!(load.second() + load.second(), 2000);
        let counters = load.assembler.counters();
        assert_eq!((counters.lost, counters.late, counters.bad_readings, counters.frozen), (0, 0, 0, 0));
        assert!(!load.assembler.is_foreign());
    }
}
