//! Parsers for the attachments, metadata and other records of a recording.

use std::collections::BTreeMap;

use super::bytes::ByteReader;

/// An attachment's bytes, and whether they match its checksum.
pub(super) struct Attachment<'b> {
    pub(super) data: &'b [u8],
    pub(super) is_sound: bool,
}

impl<'b> Attachment<'b> {
    pub(super) fn read(record: &'b [u8]) -> Option<Self> {
        let mut fields = ByteReader(record);
        fields.bytes(16)?;
        let (_name, _media_type) = (fields.text()?, fields.text()?);
        let length = fields.u64()?;
        let data = fields.bytes(length)?;
        let checked = record.get(..record.len() - fields.0.len())?;
        // 0 means that there is no checksum.
        let checksum = fields.u32()?;
        let is_sound = checksum == 0 || checksum == crc32fast::hash(checked);
        Some(Self { data, is_sound })
    }

    /// The name alone, for which the first bytes of the record suffice.
    pub(super) fn name(record: &'b [u8]) -> Option<&'b str> {
        let mut fields = ByteReader(record);
        // The times of creation and logging.
        fields.bytes(16)?;
        fields.text()
    }
}

/// The name of a metadata record, and its entries.
pub(super) fn metadata(record: &[u8]) -> Option<(&str, BTreeMap<&str, &str>)> {
    let mut fields = ByteReader(record);
    Some((fields.text()?, fields.map()?))
}

/// The number and the topic of a channel.
pub(super) fn channel(record: &[u8]) -> Option<(u16, &str)> {
    let mut fields = ByteReader(record);
    let number = fields.u16()?;
    let _schema = fields.u16()?;
    Some((number, fields.text()?))
}

/// A message.
pub(super) struct McapMessage<'b> {
    pub(super) channel: u16,
    pub(super) sequence: u32,
    pub(super) log_ns: u64,
    pub(super) publish_ns: u64,
    pub(super) data: &'b [u8],
}

impl<'b> McapMessage<'b> {
    pub(super) fn read(record: &'b [u8]) -> Option<Self> {
        let mut fields = ByteReader(record);
        let (channel, sequence) = (fields.u16()?, fields.u32()?);
        let (log_ns, publish_ns) = (fields.u64()?, fields.u64()?);
        Some(Self { channel, sequence, log_ns, publish_ns, data: fields.0 })
    }
}

/// Numbers of messages and of chunks according to the file's summary.
pub(super) fn statistics(record: &[u8]) -> Option<(u64, u32)> {
    let mut fields = ByteReader(record);
    let messages = fields.u64()?;
    let (_schemas, _channels, _attachments, _metadata) =
        (fields.u16()?, fields.u32()?, fields.u32()?, fields.u32()?);
    Some((messages, fields.u32()?))
}
