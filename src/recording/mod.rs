//! A floor's recording: everything that decides what happens on it, in an MCAP file, and the same again from it.
//!
//! [`Recorder`] keeps what a source gives and when; [`Recording`] gives it back as another source. A server asks its
//! source for a packet, for requests and for the time, and for nothing else: with the same answers it tells the same
//! events, to the bit. `docs/recordings.md` describes the file.

mod bytes;
mod chunk;
mod entry;
mod events;
mod messages;
mod order;
mod packets;
mod parts;
mod reader;
mod recorder;
mod records;
mod replay;
mod tap;
#[cfg(test)]
mod tests;
mod timeline;
mod transport;
mod writer;

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::schema::Diagnostics;

pub(crate) use entry::{Entry, decoder};
pub use packets::{PacketTap, TappedPackets};
pub use reader::Recording;
pub(crate) use recorder::read_layout;
pub use recorder::{Recorded, Recorder, WhenBehind};
pub use records::RecordingBytes;
pub use replay::{Progress, ReplaySource, Speed};
pub use tap::TappedSource;
pub(crate) use tap::{Entries, EntrySink};
pub use timeline::{Mark, MarkKind, Timeline};
pub use transport::Transport;

/// The topics of a recording.
pub(crate) const PACKETS: &str = "/underfoot/packets";
pub(crate) const SILENCE: &str = "/underfoot/silence";
pub(crate) const REQUESTS: &str = "/underfoot/requests";
pub(crate) const LAYOUTS: &str = "/underfoot/layouts";
pub(crate) const GAPS: &str = "/underfoot/gaps";
pub(crate) const END: &str = "/underfoot/end";
const EVENTS: &str = "/underfoot/events";

const TOPICS: [&str; 7] = [PACKETS, SILENCE, REQUESTS, LAYOUTS, GAPS, END, EVENTS];

/// The name of the metadata, and the version of all this.
const METADATA: &str = "underfoot";
const VERSION: &str = "1";

/// The key of the metadata that says that the sensors' noise was learnt, and what it says. Recordings of versions that
/// did not learn it lack it.
const NOISE: &str = "noise";
const LEARNT: &str = "learnt";

/// The attachments.
const FLOOR: &str = "floor.ron";
const LAYOUT: &str = "layout.ron";

/// Why there can be no recording, or why it can't be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The file can't be written or read.
    #[error("{}: {source}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file is not a recording of a floor, or ends before one begins.
    #[error("{}: {why}", path.display())]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// What is missing or wrong.
        why: String,
    },
    /// The floor or the layout can't be kept, or what was kept can't be read.
    #[error(transparent)]
    Diagnostics(#[from] Diagnostics),
}
