//! Fields of MCAP records: little-endian numbers, strings and maps with their lengths before them.
//!
//! # Source
//! The MCAP format specification, "Serialization".

use std::collections::BTreeMap;

/// Bytes of a record, read field by field; a read returns `None` if they end too early or a string is not UTF-8.
#[derive(Clone, Copy, Debug)]
pub(super) struct ByteReader<'b>(pub(super) &'b [u8]);

impl<'b> ByteReader<'b> {
    pub(super) fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    pub(super) fn bytes(&mut self, count: u64) -> Option<&'b [u8]> {
        let (bytes, rest) = self.0.split_at_checked(usize::try_from(count).ok()?)?;
        self.0 = rest;
        Some(bytes)
    }

    pub(super) fn text(&mut self) -> Option<&'b str> {
        let length = self.u32()?;
        std::str::from_utf8(self.bytes(length.into())?).ok()
    }

    /// A map of strings; of a repeated key, the last value counts.
    pub(super) fn map(&mut self) -> Option<BTreeMap<&'b str, &'b str>> {
        let length = self.u32()?;
        let mut entries = Self(self.bytes(length.into())?);
        let mut map = BTreeMap::new();
        while !entries.0.is_empty() {
            let key = entries.text()?;
            map.insert(key, entries.text()?);
        }
        Some(map)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (array, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*array)
    }
}
