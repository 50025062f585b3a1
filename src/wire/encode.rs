//! Encoding of packets as boards write them.

use rosc::{OscPacket, encoder};
use thiserror::Error;
use underfoot_packet::{write_blob, write_counts, write_newtons};

use super::{Readings, SensorPacket};
use crate::floor::{Calibration, Floor};

/// Format in which a board writes the readings of its channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SensorFormat {
    /// One OSC `i` of raw counts per channel.
    #[default]
    Counts,
    /// One OSC `f` of newtons per channel.
    Newtons,
    /// One OSC `b` of big-endian u16 counts.
    Blob,
}

/// Reason for which a packet cannot be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum EncodeError {
    /// The floor has no board of the packet's number.
    #[error("the floor has no board {0}")]
    NoBoard(u16),
    /// The number of readings in the packet differs from the number of channels of the board.
    #[error("board {board} has {channels} channels, the packet {readings}")]
    Channels {
        /// The board.
        board: u16,
        /// The number of its channels.
        channels: usize,
        /// Readings in the packet.
        readings: usize,
    },
    /// The packet holds newtons or fractions and the format takes counts, or a count is missing and the format has no code for
    /// that.
    #[error("the packet has no raw counts to write")]
    NoCounts,
}

/// Writes the sensor packets of one floor in the format of its boards.
#[derive(Clone, Debug)]
pub struct SensorEncoder {
    boards: Vec<BoardText>,
    format: SensorFormat,
    bytes: Vec<u8>,
}

#[derive(Clone, Debug)]
struct BoardText {
    address: String,
    /// Calibration of each channel, for writing newtons; nominal for a channel without a sensor.
    calibration: Vec<Calibration>,
}

impl SensorEncoder {
    /// An encoder for the boards of `floor` that writes all packets in `format`.
    #[must_use]
    pub fn new(floor: &Floor, format: SensorFormat) -> Self {
        let calibration = |sensor: &Option<crate::floor::SensorId>| {
            sensor
                .and_then(|sensor| {
                    let tile = floor.calibration.get(floor.geometry.index(sensor.tile)?)?;
                    Some(tile[sensor.corner.index()])
                })
                .unwrap_or(Calibration::NOMINAL)
        };
        let boards = floor
            .boards
            .iter()
            .map(|board| BoardText {
                address: board.address.clone(),
                calibration: board.channels.iter().map(calibration).collect(),
            })
            .collect();
        Self { boards, format, bytes: Vec::new() }
    }

    /// Returns the datagram with `packet`; valid until the next call.
    ///
    /// If the format is newtons, counts are converted by the floor's calibration (without subtracting the tare). A
    /// missing count is written as -1 by [`SensorFormat::Counts`] and as NaN by [`SensorFormat::Newtons`].
    ///
    /// # Errors
    /// [`EncodeError`] if the packet does not belong to this floor, or the format cannot represent its contents.
    pub fn encode(&mut self, packet: &SensorPacket) -> Result<&[u8], EncodeError> {
        let board = self.boards.get(usize::from(packet.board)).ok_or(EncodeError::NoBoard(packet.board))?;
        let (channels, readings) = (board.calibration.len(), packet.readings.len());
        if channels != readings {
            return Err(EncodeError::Channels { board: packet.board, channels, readings });
        }
        let (address, number, bytes) = (board.address.as_str(), packet.sequence, &mut self.bytes);
        bytes.clear();
        let parts = board.calibration.iter();
        match (self.format, &packet.readings) {
            (SensorFormat::Counts, Readings::Counts(counts)) => {
                write_counts(address, number, counts.iter().copied(), bytes);
            }
            (SensorFormat::Blob, Readings::Counts(counts)) => {
                if counts.contains(&None) {
                    return Err(EncodeError::NoCounts);
                }
                write_blob(address, number, counts.iter().map(|count| count.unwrap_or_default()), bytes);
            }
            (SensorFormat::Newtons, Readings::Counts(counts)) => {
                let force = |(count, part): (&Option<u16>, &Calibration)| {
                    count.map_or(f32::NAN, |count| part.force(count).0)
                };
                write_newtons(address, number, counts.iter().zip(parts).map(force), bytes);
            }
            (SensorFormat::Newtons, Readings::Newtons(forces)) => {
                write_newtons(address, number, forces.iter().copied(), bytes);
            }
            (SensorFormat::Newtons, Readings::Scaled(values)) => {
                let force =
                    |(value, part): (&f32, &Calibration)| part.force_at(Calibration::volts_of(*value)).0;
                write_newtons(address, number, values.iter().zip(parts).map(force), bytes);
            }
            (SensorFormat::Counts | SensorFormat::Blob, Readings::Newtons(_) | Readings::Scaled(_)) => {
                return Err(EncodeError::NoCounts);
            }
        }
        Ok(&self.bytes)
    }
}

/// Writes `packet` into `bytes` and replaces their contents.
pub(crate) fn write(packet: &OscPacket, bytes: &mut Vec<u8>) {
    bytes.clear();
    let Ok(_) = encoder::encode_into(packet, bytes);
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rosc::{OscMessage, OscType};

    use super::*;
    use crate::floor::Geometry;
    use crate::units::Instant;
    use crate::wire::{Batch, Decoder};

    fn floor() -> Floor {
        Floor::of(Geometry::of_paper_tiles(6, 3).unwrap())
    }

    fn round_trip(format: SensorFormat, packet: &SensorPacket) -> SensorPacket {
        let mut encoder = SensorEncoder::new(&floor(), format);
        let mut batch = Batch::default();
        let bytes = encoder.encode(packet).unwrap();
        Decoder::new(&floor()).decode(bytes, packet.received, &mut batch).unwrap();
        batch.packets.remove(0)
    }

    fn packet(board: u16, sequence: u32, readings: Readings) -> SensorPacket {
        SensorPacket { board, sequence, received: Instant::from_millis(3), readings }
    }

    proptest! {
        #[test]
        fn counts_come_back_as_sent(
            board in 0u16..3,
            sequence: u32,
            counts in prop::collection::vec(prop::option::weighted(0.9, any::<u16>()), 24),
        ) {
            let sent = packet(board, sequence, Readings::Counts(counts.into_iter().collect()));
            prop_assert_eq!(round_trip(SensorFormat::Counts, &sent), sent);
        }

        #[test]
        fn blobs_come_back_as_sent(
            board in 0u16..3,
            sequence: u32,
            counts in prop::collection::vec(any::<u16>().prop_map(Some), 24),
        ) {
            let sent = packet(board, sequence, Readings::Counts(counts.into_iter().collect()));
            prop_assert_eq!(round_trip(SensorFormat::Blob, &sent), sent);
        }

        /// Boards need no OSC library, and others read them with one.
        #[test]
        fn bytes_are_those_of_another_encoder(
            number: u32,
            counts in prop::collection::vec(any::<u16>(), 24),
        ) {
            let sent = packet(2, number, Readings::Counts(counts.iter().copied().map(Some).collect()));
            let blob = OscType::Blob(counts.iter().flat_map(|count| count.to_be_bytes()).collect());
            let ints = counts.iter().map(|&count| OscType::Int(count.into())).collect();
            for (format, values) in [(SensorFormat::Counts, ints), (SensorFormat::Blob, vec![blob])] {
                let args = [vec![OscType::Int(number.cast_signed())], values].concat();
                let theirs = OscPacket::Message(OscMessage { addr: "/underfoot/board/2".to_owned(), args });
                let mut encoder = SensorEncoder::new(&floor(), format);
                prop_assert_eq!(encoder.encode(&sent).unwrap(), encoder::encode(&theirs).unwrap());
            }
        }

        #[test]
        fn newtons_come_back_bit_by_bit(
            board in 0u16..3,
            sequence: u32,
            bits in prop::collection::vec(any::<u32>(), 24),
        ) {
            let sent = packet(board, sequence, Readings::Newtons(bits.iter().map(|&bits| f32::from_bits(bits)).collect()));
            let came = round_trip(SensorFormat::Newtons, &sent);
            prop_assert_eq!((came.board, came.sequence), (board, sequence));
            let Readings::Newtons(forces) = came.readings else { panic!("not newtons") };
            let came: Vec<_> = forces.iter().map(|force| force.to_bits()).collect();
            prop_assert_eq!(came, bits);
        }
    }

    #[test]
    fn counts_become_newtons_by_the_floors_own_calibration() {
        let mut floor = floor();
        floor.calibration[1][2] = Calibration::exponential(2.0, 1.0);
        let mut encoder = SensorEncoder::new(&floor, SensorFormat::Newtons);
        let mut batch = Batch::default();
        let sent = packet(0, 1, Readings::Counts([Some(13107); 24].into_iter().collect()));
        Decoder::new(&floor).decode(encoder.encode(&sent).unwrap(), sent.received, &mut batch).unwrap();
        let Readings::Newtons(forces) = &batch.packets[0].readings else { panic!("not newtons") };
        // 13107 counts correspond to 1 V.
        assert!((forces[6] - 2.0 * 1f32.exp()).abs() < 1e-4, "{}", forces[6]);
        assert!((forces[5] - 0.5 * 1.34f32.exp()).abs() < 1e-4, "{}", forces[5]);
    }

    #[test]
    fn what_cannot_be_written_is_refused() {
        let encode = |format, packet| SensorEncoder::new(&floor(), format).encode(&packet).map(|_| ());
        let newtons = Readings::Newtons([1.0; 24].into_iter().collect());
        let gap = Readings::Counts([None; 24].into_iter().collect());
        let few = Readings::Counts([Some(1); 4].into_iter().collect());
        assert_eq!(encode(SensorFormat::Counts, packet(0, 0, newtons.clone())), Err(EncodeError::NoCounts));
        assert_eq!(encode(SensorFormat::Blob, packet(0, 0, gap)), Err(EncodeError::NoCounts));
        assert_eq!(encode(SensorFormat::Newtons, packet(9, 0, newtons)), Err(EncodeError::NoBoard(9)));
        let verdict = encode(SensorFormat::Counts, packet(0, 0, few));
        assert_eq!(verdict, Err(EncodeError::Channels { board: 0, channels: 24, readings: 4 }));
    }
}
