//! The recording of a floor in an MCAP file: all inputs that determine the floor's behaviour, and their replay.
//!
//! `Recorder` stores the packets, requests and layouts of a floor with their times; [`Recording`] returns them as
//! the input of another. A server asks its input only for these and the time: with the same answers it reports the
//! same events, bit for bit. `docs/recordings.md` describes the file. Reading and replay need neither files nor threads
//! nor a clock, at the maximum speed.

mod bytes;
mod chunk;
#[cfg(feature = "record")]
mod events;
#[cfg(feature = "record")]
mod kept;
mod messages;
mod order;
#[cfg(feature = "record")]
mod pack;
mod parts;
mod reader;
#[cfg(feature = "record")]
mod recorder;
mod records;
mod replay;
#[cfg(feature = "record")]
mod restored;
#[cfg(feature = "record")]
mod switch;
#[cfg(feature = "record")]
mod tap;
#[cfg(test)]
#[cfg(feature = "record")]
mod tests;
mod timeline;
mod transport;
#[cfg(feature = "record")]
mod trim;
#[cfg(feature = "record")]
mod writer;

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::schema::Diagnostics;
use crate::source::log::{END, GAPS, LAYOUT, LAYOUTS, PACKETS, REQUESTS, SILENCE};

pub use reader::Recording;
#[cfg(feature = "record")]
pub use recorder::{Recorded, Recorder, WhenBehind};
pub use records::RecordingBytes;
pub use replay::{Progress, ReplaySource, Speed};
#[cfg(feature = "record")]
pub use switch::RecordingSwitch;
#[cfg(feature = "record")]
pub(crate) use tap::{EntrySink, tapped};
pub use timeline::{MarkKind, Timeline, TimelineMark};
pub use transport::Transport;
#[cfg(feature = "record")]
pub use trim::Trimmed;

/// Topic of the lines of events, beside those of the entries.
const EVENTS: &str = "/underfoot/events";

const TOPICS: [&str; 7] = [PACKETS, SILENCE, REQUESTS, LAYOUTS, GAPS, END, EVENTS];

/// Name of the metadata record, and version of new recordings.
const METADATA: &str = "underfoot";
const VERSION: &str = "2";

/// The versions that can be read: in the first, no packet has its readings split into bytes.
const READABLE: [&str; 2] = ["1", VERSION];

/// Key and value of the metadata that mark recordings of versions that learn the sensors' noise. Recordings of
/// earlier versions lack them.
const NOISE: &str = "noise";
const LEARNT: &str = "learnt";

/// Key of the metadata for the beginning of the part on display, in microseconds of the floor's clock; without it,
/// all is displayed.
const BEGINS: &str = "begins_us";

/// Name of the attachment of the floor; that of the layout is [`LAYOUT`].
const FLOOR: &str = "floor.ron";

/// Reasons why a recording can't be made or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The file can't be written or read.
    #[error("{}: {source}", path.display())]
    File {
        /// Path of the file.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// The file is not a recording of a floor, or ends before the recording begins.
    #[error("{}: {why}", path.display())]
    Unreadable {
        /// Path of the file.
        path: PathBuf,
        /// The missing or faulty part.
        why: String,
    },
    /// A recording can't begin now.
    #[error("{0}")]
    Switch(&'static str),
    /// The floor or the layout can't be stored, or the stored one can't be read.
    #[error(transparent)]
    Diagnostics(#[from] Diagnostics),
}
