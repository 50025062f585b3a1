//! The records of an MCAP file in sequence, each with its offset.
//!
//! # Source
//! The MCAP format specification, "File structure" and "Records".

use std::io::{self, BufReader, Read, Seek, SeekFrom};

use mcap::records::op;

/// Bytes of a seekable file: an ordinary file, or a buffer.
pub trait RecordingBytes: Read + Seek + Send {}

impl<T: Read + Seek + Send> RecordingBytes for T {}

/// Maximum length of a chunk in bytes, compressed or not. Tools write chunks of 1 to 4 MB; one of 256 MB is held in
/// memory whole.
pub(super) const LONGEST_CHUNK: u64 = 256 << 20;

/// Maximum length of any other record held in memory, in bytes: a layout with thousands of controls.
const LONGEST: u64 = 64 << 20;

/// Length of the head of a record: its kind, and the length of its content.
const HEAD: u64 = 9;

/// The records of a file.
pub(super) struct Records {
    reader: BufReader<Box<dyn RecordingBytes>>,
    /// Offset of the next record.
    at: u64,
    /// Checksum of all bytes up to there; `None` after the data section.
    checksum: Option<crc32fast::Hasher>,
    data: Vec<u8>,
}

/// One record; its bytes are [`Records::data`].
#[derive(Clone, Copy, Debug)]
pub(super) struct RawRecord {
    pub(super) opcode: u8,
    /// Offset of its first byte in the file.
    pub(super) at: u64,
    /// The length in its head.
    pub(super) length: u64,
    /// How far it was read.
    pub(super) state: ReadState,
}

/// How far a record was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ReadState {
    Whole,
    /// The file ends within it.
    Cut,
    /// It is longer than its maximum: only its first bytes are kept.
    Long,
}

impl Records {
    /// The records of `bytes`; `None` if they do not begin as an MCAP file.
    pub(super) fn new(bytes: Box<dyn RecordingBytes>) -> io::Result<Option<Self>> {
        let mut records = Self {
            reader: BufReader::with_capacity(1 << 16, bytes),
            at: 0,
            checksum: None,
            data: Vec::new(),
        };
        Ok(records.rewind()?.then_some(records))
    }

    /// Goes back to the first record; false if the file does not begin as an MCAP file.
    pub(super) fn rewind(&mut self) -> io::Result<bool> {
        self.reader.seek(SeekFrom::Start(0))?;
        let mut checksum = crc32fast::Hasher::new();
        self.read(mcap::MAGIC.len() as u64)?;
        checksum.update(&self.data);
        (self.at, self.checksum) = (mcap::MAGIC.len() as u64, Some(checksum));
        Ok(self.data == mcap::MAGIC)
    }

    /// Content of the current record, without its kind and length.
    pub(super) fn data(&self) -> &[u8] {
        &self.data
    }

    /// The next record; `None` at the end of the file, or if it ends within the head of a record.
    pub(super) fn next(&mut self) -> io::Result<Option<RawRecord>> {
        let Some((opcode, length, head)) = self.next_head()? else { return Ok(None) };
        let at = self.at;
        let most = if opcode == op::CHUNK { LONGEST_CHUNK } else { LONGEST };
        let mut record = RawRecord { opcode, at, length, state: ReadState::Whole };
        let kept = if length > most { length.min(FIRST_BYTES) } else { length };
        let mut read = self.read(kept)?;
        // The checksum does not cover the record that contains it.
        if let Some(checksum) = self.checksum.as_mut().filter(|_| opcode != op::DATA_END) {
            checksum.update(&head);
            checksum.update(&self.data);
        }
        if length > most {
            record.state = ReadState::Long;
            read += self.pass_over(length - kept)?;
        }
        if read < length {
            record.state = ReadState::Cut;
        }
        self.at = self.at.saturating_add(HEAD).saturating_add(read);
        Ok(Some(record))
    }

    /// The next record that is neither a chunk nor a message; skips those without reading them.
    pub(super) fn next_other(&mut self) -> io::Result<Option<RawRecord>> {
        loop {
            let at = self.at;
            let Some((opcode, length, _)) = self.next_head()? else { return Ok(None) };
            if !matches!(opcode, op::CHUNK | op::MESSAGE | op::MESSAGE_INDEX) {
                self.reader.seek_relative(-(HEAD as i64))?;
                return self.next();
            }
            // An impossible length ends the search, as the end of the file does.
            let Ok(skip) = i64::try_from(length) else { return Ok(None) };
            self.reader.seek_relative(skip)?;
            self.at = at.saturating_add(HEAD).saturating_add(length);
        }
    }

    /// Checksum of all bytes before the end of the data section, the record just read; stops the computation.
    pub(super) fn end_checksum(&mut self) -> Option<u32> {
        self.checksum.take().map(crc32fast::Hasher::finalize)
    }

    /// Offset of the next record.
    pub(super) const fn at(&self) -> u64 {
        self.at
    }

    fn next_head(&mut self) -> io::Result<Option<(u8, u64, [u8; HEAD as usize])>> {
        let mut head = [0; HEAD as usize];
        let mut filled = 0;
        while let Some(rest) = head.get_mut(filled..).filter(|rest| !rest.is_empty()) {
            match self.reader.read(rest) {
                Ok(0) => return Ok(None),
                Ok(read) => filled += read,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        let [opcode, length @ ..] = head;
        Ok(Some((opcode, u64::from_le_bytes(length), head)))
    }

    /// Reads up to `count` bytes into `data`; the allocation grows with the bytes present, not with `count`.
    fn read(&mut self, count: u64) -> io::Result<u64> {
        self.data.clear();
        (&mut self.reader).take(count).read_to_end(&mut self.data).map(|read| read as u64)
    }

    fn pass_over(&mut self, count: u64) -> io::Result<u64> {
        let (mut rest, mut buffer) = (count, [0; 1 << 12]);
        while rest > 0 {
            let most = usize::try_from(rest).unwrap_or(usize::MAX).min(buffer.len());
            let part = buffer.get_mut(..most).unwrap_or_default();
            let read = match self.reader.read(part) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                read => read?,
            };
            if read == 0 {
                break;
            }
            if let Some(checksum) = &mut self.checksum {
                checksum.update(part.get(..read).unwrap_or_default());
            }
            rest -= read as u64;
        }
        Ok(count - rest)
    }
}

/// Bytes kept of a record that is too long: enough for the channel of a message, and the name of an attachment.
const FIRST_BYTES: u64 = 1 << 10;
