//! A recording that is read, from its beginning and piece by piece.

use std::collections::HashMap;
use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use mcap::records::Record;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::entry::{self, Entry};
use super::recorder::read_layout;
use super::replay::{ReplaySource, Speed};
use super::{EVENTS, FLOOR, LAYOUT, LEARNT, METADATA, NOISE, RecordingError, VERSION};
use crate::floor::Floor;
use crate::layout::Layout;
use crate::schema;
use crate::sense::Method;
use crate::units::Instant;
use crate::wire::{Decoder, Readings};

/// The longest record that is read: a chunk, or a layout with thousands of controls.
const LONGEST: usize = 64 << 20;

/// A recording that is about to be played again.
#[derive(Debug)]
pub struct Recording {
    floor: Floor,
    layout: Layout,
    method: Method,
    messages: Messages,
}

impl Recording {
    /// Whether the file at `path` begins as a recording does; false if it can't be read.
    #[must_use]
    pub fn is_at(path: &Path) -> bool {
        let mut begins = [0; mcap::MAGIC.len()];
        File::open(path).is_ok_and(|mut file| file.read_exact(&mut begins).is_ok() && begins == mcap::MAGIC)
    }

    /// Opens the recording at `path` and reads the floor and the layout that it was made with.
    ///
    /// # Errors
    /// [`RecordingError`] if the file can't be read, is not a recording of a floor, or was cut off before one begins.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let unreadable = |why: String| RecordingError::Unreadable { path: path.into(), why };
        let file = File::open(path).map_err(|source| RecordingError::File { path: path.into(), source })?;
        let mut messages = Messages::new(file, path);
        let [mut floor, mut layout, mut method] = [None, None, None];
        let mut learnt = false;
        while floor.is_none() || layout.is_none() || method.is_none() {
            match messages.next_part() {
                Part::Attachment(name, text) if name == FLOOR => floor = Some(text),
                Part::Attachment(name, text) if name == LAYOUT => layout = Some(text),
                Part::Metadata { version, method: of, noise } if version == VERSION => {
                    (method, learnt) = (Some(of), noise == LEARNT);
                }
                Part::Metadata { version, .. } => {
                    return Err(unreadable(format!(
                        "it is of version {version}, this program reads {VERSION}"
                    )));
                }
                Part::Attachment(..) => {}
                Part::Entry(..) | Part::Event(_) | Part::Whole => {
                    return Err(unreadable(
                        "it has no floor and layout: it is not a recording of a floor".into(),
                    ));
                }
                Part::Broken(why) => {
                    return Err(unreadable(format!("no recording of a floor begins there: {why}")));
                }
            }
        }
        let mut floor = schema::parse_floor(&floor.unwrap_or_default(), FLOOR)?;
        // Versions that did not learn noise took newtons as they came.
        floor.noiseless |= !learnt && begins_with_newtons(path);
        let layout = read_layout(&layout.unwrap_or_default(), &floor.geometry)?;
        let method = if method.as_deref() == Some("eq4") { Method::Eq4 } else { Method::Tracker };
        Ok(Self { floor, layout, method, messages })
    }

    /// The floor.
    #[must_use]
    pub const fn floor(&self) -> &Floor {
        &self.floor
    }

    /// The layout that was on the floor at the beginning.
    #[must_use]
    pub const fn layout(&self) -> &Layout {
        &self.layout
    }

    /// How feet were told apart.
    #[must_use]
    pub const fn method(&self) -> Method {
        self.method
    }

    pub(super) fn into_messages(self) -> Messages {
        self.messages
    }

    /// What was recorded, as a source.
    #[must_use]
    pub fn source(self, speed: Speed) -> ReplaySource {
        ReplaySource::new(self.messages, self.floor.geometry, speed)
    }

    /// The lines of the events that were recorded; then, where the file is broken, why.
    pub fn events(self) -> impl Iterator<Item = Result<Vec<u8>, String>> {
        let (mut messages, mut is_over) = (self.messages, false);
        std::iter::from_fn(move || {
            while !is_over {
                match messages.next_part() {
                    Part::Event(line) => return Some(Ok(line)),
                    Part::Whole => is_over = true,
                    Part::Broken(why) => {
                        is_over = true;
                        return Some(Err(why));
                    }
                    _ => {}
                }
            }
            None
        })
    }
}

/// Whether the first packet of the recording at `path` holds newtons.
fn begins_with_newtons(path: &Path) -> bool {
    let Ok(file) = File::open(path) else { return false };
    let mut messages = Messages::new(file, path);
    loop {
        match messages.next_part() {
            Part::Entry(_, Entry::Packet(packet)) => {
                return matches!(packet.readings, Readings::Newtons(_));
            }
            Part::Whole | Part::Broken(_) => return false,
            _ => {}
        }
    }
}

/// What stands in the file, one after the other.
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all are packets, and packets are not allocated one by one"
)]
pub(super) enum Part {
    /// Its name and text.
    Attachment(String, String),
    /// The version, how feet were told apart, and whether noise was learnt.
    Metadata { version: String, method: String, noise: String },
    /// When the server took it, and what.
    Entry(Instant, Entry),
    /// A line.
    Event(Vec<u8>),
    /// The end of what was recorded.
    Whole,
    /// The file ends too early or makes no sense from here on; why.
    Broken(String),
}

/// The messages of a file.
pub(super) struct Messages {
    file: File,
    path: PathBuf,
    reader: LinearReader,
    topics: HashMap<u16, String>,
    decoder: Decoder,
}

impl Messages {
    fn new(file: File, path: &Path) -> Self {
        let options = LinearReaderOptions::default().with_record_length_limit(LONGEST);
        let reader = LinearReader::new_with_options(options);
        let (topics, decoder) = (HashMap::new(), entry::decoder());
        Self { file, path: path.into(), reader, topics, decoder }
    }

    /// Which file it is.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// What comes next; after the end or a break, that again.
    pub(super) fn next_part(&mut self) -> Part {
        loop {
            let (data, opcode) = match self.reader.next_event() {
                Some(Ok(LinearReadEvent::ReadRequest(wanted))) => {
                    match self.file.read(self.reader.insert(wanted.min(LONGEST))) {
                        Ok(read) => self.reader.notify_read(read),
                        Err(error) => return Part::Broken(error.to_string()),
                    }
                    continue;
                }
                Some(Ok(LinearReadEvent::Record { data, opcode })) => (data, opcode),
                Some(Err(error)) => return Part::Broken(error.to_string()),
                None => return Part::Whole,
            };
            let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
            match mcap::parse_record(opcode, data) {
                Ok(Record::Message { header, data }) => {
                    let [taken, came] = [header.log_time, header.publish_time]
                        .map(|nanos| Instant::from_micros(nanos / 1000));
                    let Some(topic) = self.topics.get(&header.channel_id) else { continue };
                    if topic == EVENTS {
                        return Part::Event(data.into_owned());
                    }
                    if let Some(entry) = Entry::read(topic, &data, came, &self.decoder) {
                        return Part::Entry(taken, entry);
                    }
                }
                Ok(Record::Channel(channel)) => {
                    self.topics.insert(channel.id, channel.topic);
                }
                Ok(Record::Attachment { header, data, .. }) => {
                    return Part::Attachment(header.name, text(&data));
                }
                Ok(Record::Metadata(metadata)) if metadata.name == METADATA => {
                    let of = |key: &str| metadata.metadata.get(key).cloned().unwrap_or_default();
                    return Part::Metadata { version: of("version"), method: of("method"), noise: of(NOISE) };
                }
                Ok(Record::DataEnd(_)) => return Part::Whole,
                Ok(_) => {}
                Err(error) => return Part::Broken(error.to_string()),
            }
        }
    }
}

impl fmt::Debug for Messages {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Messages").field("path", &self.path).finish_non_exhaustive()
    }
}
