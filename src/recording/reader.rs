//! Opens a recording: its floor, its layout, and then its messages.

use std::collections::HashMap;
use std::io;
use std::path::Path;

use mcap::records::op;

use super::messages::{LogPart, MessageReader};
use super::order::Ordered;
use super::parts::{Attachment, metadata};
use super::records::{RawRecord, ReadState, RecordingBytes, Records};
use super::replay::{ReplaySource, Speed};
use super::{BEGINS, FLOOR, LAYOUT, LEARNT, METADATA, NOISE, READABLE, RecordingError};
use crate::floor::{Floor, FloorFile};
use crate::layout::Layout;
use crate::schema;
use crate::sense::Method;
use crate::source::log::read_layout;
use crate::units::Instant;
use underfoot_format::file::open_ordinary;

/// A recording that is open for replay.
#[derive(Debug)]
pub struct Recording {
    floor: Floor,
    layout: Layout,
    method: Method,
    begins: Option<Instant>,
    parts: Ordered,
}

/// Attachments and metadata of a recording, at any place in the file.
#[derive(Default)]
pub(super) struct Opening {
    floor: Option<String>,
    layout: Option<String>,
    method: Option<Method>,
    /// Beginning of the part on display.
    begins: Option<Instant>,
    /// Whether the recording program learnt the sensors' noise; earlier versions used newtons unprocessed.
    learnt: bool,
    /// Whether repeated readings are normal.
    noiseless: bool,
    /// Checksums by name, to detect later ones of the same name that differ.
    checksums: HashMap<&'static str, u32>,
}

impl Recording {
    /// Whether the file at `path` begins like a recording; false if it can't be read, or is a device or a pipe.
    #[must_use]
    pub fn is_at(path: &Path) -> bool {
        open_ordinary(path)
            .and_then(|file| Records::new(Box::new(file)))
            .is_ok_and(|records| records.is_some())
    }

    /// Opens the recording at `path` and reads its floor and its layout.
    ///
    /// # Errors
    /// [`RecordingError`] if the file can't be read, is not an ordinary file or not a recording of a floor, or is
    /// truncated before the recording begins.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let failed = |source| RecordingError::File { path: path.into(), source };
        Self::read(Box::new(open_ordinary(path).map_err(failed)?), path)
    }

    /// As [`Self::open`], for bytes from any origin; messages call them `name`.
    ///
    /// # Errors
    /// As for [`Self::open`].
    pub fn read(bytes: Box<dyn RecordingBytes>, name: &Path) -> Result<Self, RecordingError> {
        let (opening, parts) = Opening::read(bytes, name)?;
        let floor = schema::parse_floor(&opening.floor.unwrap_or_default(), FLOOR)?;
        let noiseless = floor.noiseless || opening.noiseless;
        let floor = Floor { file: FloorFile::new("the recording's floor"), noiseless, ..floor };
        let layout = read_layout(&opening.layout.unwrap_or_default(), &floor.geometry)?;
        let method = opening.method.unwrap_or_default();
        Ok(Self { floor, layout, method, begins: opening.begins, parts })
    }

    /// The recorded floor.
    #[must_use]
    pub const fn floor(&self) -> &Floor {
        &self.floor
    }

    /// The layout on the floor at the beginning.
    #[must_use]
    pub const fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The method that made contacts from tile forces.
    #[must_use]
    pub const fn method(&self) -> Method {
        self.method
    }

    /// Beginning of the part on display, of a [trimmed](Self::trim) recording. Its events before that are not meant to
    /// be seen: they bring the floor into the state that it had then.
    #[must_use]
    pub const fn begins(&self) -> Option<Instant> {
        self.begins
    }

    pub(super) fn into_parts(self) -> Ordered {
        self.parts
    }

    /// Returns the recording as a source.
    #[must_use]
    pub fn source(self, speed: Speed) -> ReplaySource {
        ReplaySource::new(self.parts, self.floor.geometry, speed)
    }

    /// Iterates over the recorded event lines; if the file is truncated or damaged, an error with place and reason
    /// follows.
    pub fn events(self) -> impl Iterator<Item = Result<Vec<u8>, String>> {
        let (mut parts, mut is_over) = (self.parts, false);
        std::iter::from_fn(move || {
            while !is_over {
                match parts.next_part() {
                    LogPart::Event(line) => return Some(Ok(line)),
                    LogPart::Entry(..) => {}
                    LogPart::Whole => is_over = true,
                    LogPart::Broken(why) => {
                        is_over = true;
                        return Some(Err(why));
                    }
                }
            }
            None
        })
    }
}

impl Opening {
    /// Reads the attachments and the metadata of a file, and returns its messages from the beginning.
    pub(super) fn read(
        bytes: Box<dyn RecordingBytes>,
        name: &Path,
    ) -> Result<(Self, Ordered), RecordingError> {
        let failed = |source| RecordingError::File { path: name.into(), source };
        let unreadable = |why: String| RecordingError::Unreadable { path: name.into(), why };
        let Some(mut records) = Records::new(bytes).map_err(failed)? else {
            return Err(unreadable("no recording of a floor begins there: it is not an MCAP file".into()));
        };
        let mut opening = Self::find(&mut records).map_err(failed)?.map_err(unreadable)?;
        records.rewind().map_err(failed)?;
        if !opening.learnt {
            let mut messages = MessageReader::new(records, name, opening.checksums.clone());
            opening.noiseless = messages.begin_with_newtons();
            records = messages.into_records();
            records.rewind().map_err(failed)?;
        }
        let messages = MessageReader::new(records, name, std::mem::take(&mut opening.checksums));
        Ok((opening, Ordered::new(messages)))
    }

    /// Finds the attachments and the metadata of a recording. The inner error has the reason why they are missing.
    fn find(records: &mut Records) -> io::Result<Result<Self, String>> {
        let mut found = Self::default();
        while !found.is_whole() {
            let Some(record) = records.next_other()? else {
                return Ok(Err(found.missing("it ends before its end")));
            };
            if record.opcode == op::FOOTER {
                return Ok(Err(found.missing("a tool may have left attachments or metadata out")));
            }
            if let Err(why) = found.take(&record, records.data()) {
                return Ok(Err(why));
            }
        }
        Ok(Ok(found))
    }

    const fn is_whole(&self) -> bool {
        self.floor.is_some() && self.layout.is_some() && self.method.is_some()
    }

    fn missing(&self, hint: &str) -> String {
        let names = [
            (FLOOR, self.floor.is_none()),
            (LAYOUT, self.layout.is_none()),
            ("the metadata \"underfoot\"", self.method.is_none()),
        ];
        let missing: Vec<&str> = names.into_iter().filter(|(_, is)| *is).map(|(name, _)| name).collect();
        format!("no recording of a floor begins there: it lacks {} ({hint})", missing.join(", "))
    }

    /// Stores a record that belongs to the opening; the error has the reason why it is invalid.
    fn take(&mut self, record: &RawRecord, data: &[u8]) -> Result<(), String> {
        let RawRecord { opcode, at, state, .. } = *record;
        match opcode {
            op::ATTACHMENT => {
                let name = Attachment::name(data);
                let Some(name) = [FLOOR, LAYOUT].into_iter().find(|own| name == Some(*own)) else {
                    return Ok(());
                };
                let attachment = Attachment::read(data).filter(|_| state == ReadState::Whole);
                let Some(attachment) = attachment.filter(|attachment| attachment.is_sound) else {
                    return Err(format!("{name}, at byte {at}, is damaged or cut"));
                };
                let slot = if name == FLOOR { &mut self.floor } else { &mut self.layout };
                if slot.is_none() {
                    let text = std::str::from_utf8(attachment.data);
                    *slot = Some(text.map_err(|_| format!("{name}, at byte {at}, is not UTF-8"))?.to_owned());
                    self.checksums.insert(name, crc32fast::hash(attachment.data));
                }
                Ok(())
            }
            op::METADATA if self.method.is_none() => {
                let Some((METADATA, entries)) = metadata(data).filter(|_| state == ReadState::Whole) else {
                    return Ok(());
                };
                let version = entries.get("version").copied().unwrap_or_default();
                if !READABLE.contains(&version) {
                    let readable = READABLE.join(" and ");
                    return Err(format!("it is of version {version:.32?}, this program reads {readable}"));
                }
                let method = entries.get("method").copied().unwrap_or_default();
                let known =
                    [Method::Eq4, Method::Tracker].into_iter().find(|known| known_as(*known) == method);
                self.method = Some(
                    known
                        .ok_or_else(|| format!("feet were told apart by {method:.32?}, which is unknown"))?,
                );
                self.begins = match entries.get(BEGINS).map(|begins| begins.parse()) {
                    Some(Ok(begins)) => Some(Instant::from_micros(begins)),
                    Some(Err(_)) => return Err("the beginning in its metadata is no number".into()),
                    None => None,
                };
                self.learnt = entries.get(NOISE) == Some(&LEARNT);
                self.checksums.insert(METADATA, crc32fast::hash(data));
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

/// Name of a method in the metadata.
pub(super) const fn known_as(method: Method) -> &'static str {
    match method {
        Method::Eq4 => "eq4",
        Method::Tracker => "tracker",
    }
}
