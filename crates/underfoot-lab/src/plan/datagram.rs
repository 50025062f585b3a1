//! Size of a datagram on an Ethernet wire.

use underfoot::wire::SensorFormat;

/// Bytes that Ethernet adds to each packet: preamble 8, header 14, checksum 4, gap 12.
const ETHERNET_BYTES: u32 = 38;

/// IPv4 header and UDP header.
const IP_UDP_BYTES: u32 = 20 + 8;

/// Minimum payload of an Ethernet packet (bytes); Ethernet pads shorter ones.
const LEAST_PAYLOAD: u32 = 46;

/// Bytes of an OSC string: its letters and at least one zero byte, padded to a multiple of four bytes.
const fn text(letters: u32) -> u32 {
    (letters / 4 + 1) * 4
}

/// Bytes of a board's packet as OSC: address, type tags, sequence number, readings.
pub(super) const fn sensor_packet(address_letters: u32, channels: u32, format: SensorFormat) -> u32 {
    let (tags, readings) = match format {
        // A comma, the tag of the sequence number, and one per channel.
        SensorFormat::Counts | SensorFormat::Newtons => (2 + channels, 4 * channels),
        // The blob's length, and two bytes per channel, padded to a multiple of four bytes.
        SensorFormat::Blob => (3, 4 + (2 * channels).next_multiple_of(4)),
    };
    text(address_letters) + text(tags) + 4 + readings
}

/// Maximum number of contacts in one datagram, and the rate (Hz) at which each contact is reported.
const CONTACTS_PER_DATAGRAM: u32 = 20;
pub(super) const CONTACT_HZ: f64 = 100.0;

/// Bytes of a bundle's header, and of the message with the number of contacts, including its length field.
const CONTACTS_BYTES: u32 = 16 + 4 + text(19) + text(2) + 4;

/// Bytes of one contact: its length, address, type tags, and six numbers.
const CONTACT_BYTES: u32 = 4 + text(18) + text(7) + 24;

/// Returns the number of datagrams, and their bytes on the wire, for the contacts of one instant.
pub(super) fn contacts(count: u32) -> (u32, f64) {
    let datagrams = count.div_ceil(CONTACTS_PER_DATAGRAM).max(1);
    let bytes = f64::from(datagrams) * f64::from(on_wire(0) + CONTACTS_BYTES)
        + f64::from(count) * f64::from(CONTACT_BYTES);
    (datagrams, bytes)
}

/// Bytes on the wire of a datagram with a payload of `bytes`.
pub(super) const fn on_wire(bytes: u32) -> u32 {
    let packet = IP_UDP_BYTES + bytes;
    ETHERNET_BYTES + if packet < LEAST_PAYLOAD && bytes > 0 { LEAST_PAYLOAD } else { packet }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use underfoot::floor::{Floor, Geometry};
    use underfoot::outgoing::write_contacts;
    use underfoot::sense::{Contact, ForceFrame, Method, Sensing};
    use underfoot::units::{Instant, Newtons};
    use underfoot::wire::{Prefix, Readings, SensorEncoder, SensorPacket};

    #[test]
    fn packets_are_as_long_as_those_that_are_sent() {
        // Boards of 4 x `columns` channels with addresses of one to three digits.
        for columns in [1, 2, 3, 6, 8, 256] {
            let floor = Floor::of(Geometry::of_paper_tiles(columns, 12).unwrap());
            for format in [SensorFormat::Counts, SensorFormat::Newtons, SensorFormat::Blob] {
                let mut encoder = SensorEncoder::new(&floor, format);
                for (number, board) in (0..).zip(&floor.boards) {
                    let channels = board.channels.len();
                    let readings = Readings::Counts(vec![Some(1); channels].into_iter().collect());
                    let packet =
                        SensorPacket { board: number, sequence: 7, received: Instant::START, readings };
                    let sent = encoder.encode(&packet).unwrap().len();
                    let letters = board.address.len() as u32;
                    assert_eq!(
                        sensor_packet(letters, channels as u32, format) as usize,
                        sent,
                        "{format:?} {channels}"
                    );
                }
            }
        }
    }

    #[test]
    fn contacts_are_as_long_as_those_that_are_told() {
        let geometry = Geometry::of_paper_tiles(60, 2).unwrap();
        let mut sensing = Sensing::new(geometry, Method::Eq4);
        for feet in [0_u16, 1, 20, 21] {
            let mut frame = ForceFrame::empty(&geometry);
            frame.at = Instant::from_millis(feet.into());
            for foot in 0..feet {
                let at = Vec2::new(0.15 + 0.608 * f32::from(foot), 0.15);
                frame.add_load(&geometry, at, Newtons(300.0));
            }
            let seen: Vec<Contact> = sensing.update(&frame).to_vec();
            assert_eq!(seen.len(), usize::from(feet));
            let (mut datagrams, mut bytes) = (0, 0);
            write_contacts(&Prefix::default(), &seen, &mut Vec::new(), |datagram| {
                datagrams += 1;
                bytes += on_wire(datagram.len() as u32);
            });
            assert_eq!(contacts(feet.into()), (datagrams, f64::from(bytes)));
        }
    }

    #[test]
    fn a_board_of_32_channels_takes_two_megabits() {
        // 24 bytes of address, 36 of tags, 4 of sequence number, 128 of readings, 66 of headers: 258 bytes a
        // millisecond.
        let bytes = on_wire(sensor_packet(20, 32, SensorFormat::Counts));
        assert_eq!(bytes, 24 + 36 + 4 + 128 + 66);
        assert_eq!(on_wire(4), 38 + 46, "Ethernet fills up what is short");
    }
}
