//! The packets of a universe: ArtDmx of Art-Net 4, and data packets of E1.31 (sACN).

use std::borrow::Cow;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::net::SocketAddrV4;

use artnet_protocol::{ArtCommand, Output, PortAddress};
use sacn::packet::{
    AcnRootLayerProtocol, DataPacketDmpLayer, DataPacketFramingLayer, E131_TERMINATE_STREAM_PACKET_COUNT,
    E131RootLayer, E131RootLayerData, NO_SYNC_UNIVERSE,
};
use underfoot::messages::{Destination, SendTarget};
use uuid::{Builder, Uuid};

use super::super::outlet::OutletError;
use super::universe::Universe;

/// Longest name of a source of sACN, in bytes; a zero ends it.
const LONGEST_NAME: usize = 63;

/// Writes the packets of one universe.
pub(super) struct UniversePackets {
    receiver: SocketAddrV4,
    sort: PacketSort,
}

enum PacketSort {
    ArtNet(PortAddress),
    Sacn(SacnStream),
}

/// The stream of one universe of sACN.
struct SacnStream {
    /// Receivers tell sources apart by it. It is the same in each process, so that one goes on where another ended.
    source: Uuid,
    name: String,
    universe: u16,
    priority: u8,
    sequence: u8,
}

impl UniversePackets {
    /// The packets for `target`; `None` if it is no universe.
    pub(super) fn new(target: &SendTarget) -> Option<Self> {
        Some(match &target.to {
            Destination::ArtNet(art_net) => {
                let universe = PortAddress::try_from(art_net.universe).ok()?;
                Self { receiver: art_net.node()?, sort: PacketSort::ArtNet(universe) }
            }
            Destination::Sacn(sacn) => {
                let receiver = sacn.receiver()?;
                let mut name = format!("underfoot {}", target.name);
                name.truncate(name.floor_char_boundary(LONGEST_NAME));
                let source = source(&target.name, receiver);
                let (universe, priority) = (sacn.universe, sacn.priority);
                let stream = SacnStream { source, name, universe, priority, sequence: 0 };
                Self { receiver, sort: PacketSort::Sacn(stream) }
            }
            _ => return None,
        })
    }

    /// The address that they go to.
    pub(super) const fn receiver(&self) -> SocketAddrV4 {
        self.receiver
    }

    /// The packets with the levels of `universe`: one, or for the first time those that a receiver follows whatever it had
    /// before.
    pub(super) fn of(&mut self, universe: &Universe, is_first: bool) -> Result<Vec<Vec<u8>>, OutletError> {
        match &mut self.sort {
            PacketSort::ArtNet(port_address) => {
                // The sequence number 0 turns their order off: the next process need not know the last number.
                let data = universe.levels().to_vec().into();
                let output = Output { data, port_address: *port_address, ..Output::default() };
                let packet = ArtCommand::Output(output).write_to_buffer();
                Ok(vec![packet.map_err(|error| unwritten(&error))?])
            }
            PacketSort::Sacn(stream) => {
                // A receiver drops the 20 numbers before the last one that it saw: never both of these.
                let (count, step) = if is_first { (2, 128) } else { (1, 1) };
                let next = |_| stream.next(step, universe, false);
                (0..count).map(next).collect()
            }
        }
    }

    /// The packets that end the stream; none for Art-Net, which has no end.
    pub(super) fn farewell(&mut self) -> Vec<Vec<u8>> {
        let PacketSort::Sacn(stream) = &mut self.sort else { return Vec::new() };
        let next = |_| stream.next(1, &Universe::default(), true).ok();
        (0..E131_TERMINATE_STREAM_PACKET_COUNT).filter_map(next).collect()
    }
}

impl SacnStream {
    /// The packet whose number is greater by `step` than the last one.
    fn next(&mut self, step: u8, universe: &Universe, ends: bool) -> Result<Vec<u8>, OutletError> {
        self.sequence = self.sequence.wrapping_add(step);
        // The start code 0: levels of lights.
        let values = std::iter::once(0).chain(universe.levels().iter().copied()).collect();
        let data = DataPacketFramingLayer {
            source_name: Cow::Borrowed(self.name.as_str()),
            priority: self.priority,
            synchronization_address: NO_SYNC_UNIVERSE,
            sequence_number: self.sequence,
            preview_data: false,
            stream_terminated: ends,
            force_synchronization: false,
            universe: self.universe,
            data: DataPacketDmpLayer { property_values: Cow::Owned(values) },
        };
        let pdu = E131RootLayer { cid: self.source, data: E131RootLayerData::DataPacket(data) };
        AcnRootLayerProtocol { pdu }.pack_alloc().map_err(|error| unwritten(&error))
    }
}

fn unwritten(error: &dyn std::fmt::Display) -> OutletError {
    OutletError::Refused(format!("a packet of DMX can't be written: {error}"))
}

/// The identifier of this computer's source for the target called `name` at `receiver`.
fn source(name: &str, receiver: SocketAddrV4) -> Uuid {
    // Linux gives each installation an identifier of its own.
    let computer = std::fs::read_to_string("/etc/machine-id")
        .ok()
        .or_else(|| std::env::var("COMPUTERNAME").ok())
        .or_else(|| std::env::var("HOSTNAME").ok());
    let half = |part: u8| {
        let mut hasher = DefaultHasher::new();
        (part, &computer, name, receiver).hash(&mut hasher);
        hasher.finish()
    };
    let bytes = (u128::from(half(0)) << 64) | u128::from(half(1));
    Builder::from_custom_bytes(bytes.to_be_bytes()).into_uuid()
}
