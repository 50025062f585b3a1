//! The results of a source in the order in which the server took them, and as the bytes of messages: of a recording, or
//! of the stream to windows elsewhere.

mod read;
#[cfg(feature = "record")]
mod write;

use crate::floor::{Floor, Geometry};
use crate::layout::Layout;
use crate::schema::{self, Diagnostics, Kinds};
use crate::units::Instant;
use crate::wire::{Decoder, Request, SensorPacket};

/// Topics of the messages.
pub(crate) const PACKETS: &str = "/underfoot/packets";
pub(crate) const SILENCE: &str = "/underfoot/silence";
pub(crate) const REQUESTS: &str = "/underfoot/requests";
pub(crate) const LAYOUTS: &str = "/underfoot/layouts";
pub(crate) const GAPS: &str = "/underfoot/gaps";
pub(crate) const END: &str = "/underfoot/end";

/// Name of the layout of a recording or of a server, also in messages.
pub(crate) const LAYOUT: &str = "layout.ron";

/// One result of a source, in the order in which the server took it.
#[derive(Clone, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all are packets, and packets are not allocated one by one"
)]
pub(crate) enum LogEntry {
    /// A packet arrived.
    Packet(SensorPacket),
    /// No packet arrived while the server waited.
    Silence,
    /// An app sent a request.
    Request(Request),
    /// The floor got another layout, in this text.
    Layout(String),
    /// This many entries were lost.
    Gap(u64),
    /// The source ended.
    End,
}

/// Entries, each with the time at which the server took it.
pub(crate) type Entries = Vec<(Instant, LogEntry)>;

/// Marks of the form of readings: converter counts with a bit for each that is present, or newtons.
const COUNTS: u8 = 0;
const NEWTONS: u8 = 1;

/// The same with the bytes of the readings split: the lowest bytes of all, then the next, up to the highest. The
/// high bytes are nearly the same in each packet of a board, so that they compress.
const SPLIT_COUNTS: u8 = 2;
const SPLIT_NEWTONS: u8 = 3;

/// Counts with fractions, in both forms.
const SCALED: u8 = 4;
const SPLIT_SCALED: u8 = 5;

/// The decoder for requests: recordings always use the default prefix, whatever the floor's prefix is.
pub(crate) fn decoder() -> Decoder {
    Decoder::new(&Floor::default())
}

/// The layout in a message.
pub(crate) fn read_layout(text: &str, geometry: &Geometry) -> Result<Layout, Diagnostics> {
    Ok(schema::parse_layout(text, LAYOUT, &Kinds::builtin(), geometry)?.layout)
}
