//! Chunks of an MCAP file: decompressed and verified before use.

use std::io::{self, Read};

use super::bytes::ByteReader;
use super::records::LONGEST_CHUNK;

/// The records of one chunk.
#[derive(Debug)]
pub(super) struct Chunk {
    bytes: Vec<u8>,
    next: usize,
    /// Whether the file ends within the chunk.
    is_cut: bool,
}

/// A fault of a chunk, as the end of a sentence about it.
pub(super) type ChunkFault = String;

/// The fields before a chunk's records.
struct Head<'b> {
    begins_ns: u64,
    ends_ns: u64,
    unpacked: u64,
    checksum: u32,
    compression: &'b str,
    packed: u64,
}

impl<'b> Head<'b> {
    fn read(fields: &mut ByteReader<'b>) -> Option<Self> {
        Some(Self {
            begins_ns: fields.u64()?,
            ends_ns: fields.u64()?,
            unpacked: fields.u64()?,
            checksum: fields.u32()?,
            compression: fields.text()?,
            packed: fields.u64()?,
        })
    }
}

impl Chunk {
    /// Decompresses a chunk's record; of a truncated one, as much as the file contains.
    pub(super) fn unpack(record: &[u8], is_cut: bool) -> Result<Self, ChunkFault> {
        let mut fields = ByteReader(record);
        let Some(head) = Head::read(&mut fields) else {
            let empty = Self { bytes: Vec::new(), next: 0, is_cut };
            return if is_cut { Ok(empty) } else { Err("its head makes no sense".into()) };
        };
        let time =
            format!("from {:.3} to {:.3} s, ", head.begins_ns as f64 * 1e-9, head.ends_ns as f64 * 1e-9);
        if head.unpacked > LONGEST_CHUNK || head.packed > LONGEST_CHUNK {
            let claim = head.unpacked.max(head.packed);
            return Err(format!("{time}claims {claim} bytes; chunks of up to {LONGEST_CHUNK} are read"));
        }
        let Some(packed) = fields.bytes(head.packed) else {
            if !is_cut {
                return Err(format!("{time}claims more bytes than it has"));
            }
            // A truncated chunk can't be verified.
            let bytes =
                decompress(head.compression, fields.0, head.unpacked).unwrap_or_else(|(bytes, _)| bytes);
            return Ok(Self { bytes, next: 0, is_cut });
        };
        let bytes = decompress(head.compression, packed, head.unpacked)
            .map_err(|(_, fault)| format!("{time}{fault}"))?;
        if bytes.len() as u64 != head.unpacked {
            return Err(format!(
                "{time}holds {} bytes, not the {} that it claims",
                bytes.len(),
                head.unpacked
            ));
        }
        // 0 means that there is no checksum.
        if head.checksum != 0 && crc32fast::hash(&bytes) != head.checksum {
            return Err(format!("{time}does not fit its checksum"));
        }
        Ok(Self { bytes, next: 0, is_cut })
    }

    /// The next record, as its kind and bytes; `None` at the end.
    pub(super) fn next(&mut self) -> Option<Result<(u8, &[u8]), ChunkFault>> {
        let mut fields = ByteReader(self.bytes.get(self.next..).filter(|rest| !rest.is_empty())?);
        let record = fields.bytes(1).and_then(|kind| {
            let (kind, length) = (*kind.first()?, fields.u64()?);
            Some((kind, fields.bytes(length)?))
        });
        match record {
            Some(record) => {
                self.next = self.bytes.len() - fields.0.len();
                Some(Ok(record))
            }
            None if self.is_cut => None,
            None => Some(Err("has a record that is longer than the chunk".into())),
        }
    }
}

/// Decompresses the frame at the beginning of the bytes, which it takes off them, up to a length.
type Unpack = fn(&mut &[u8], &mut Vec<u8>, u64) -> Result<(), ChunkFault>;

/// Decompresses up to `most` bytes of `packed`; on invalid data, returns the bytes before it and the fault.
fn decompress(compression: &str, packed: &[u8], most: u64) -> Result<Vec<u8>, (Vec<u8>, ChunkFault)> {
    let unpack: Unpack = match compression {
        "" => return Ok(packed.to_vec()),
        "zstd" => zstd_frame,
        "lz4" => lz4_frame,
        other => {
            let name: String = other.chars().take(32).collect();
            return Err((Vec::new(), format!("is compressed by {name:?}; zstd and lz4 are read")));
        }
    };
    let (mut rest, mut bytes) = (packed, Vec::new());
    while !rest.is_empty() && (bytes.len() as u64) < most {
        if let Some(behind) = behind_skippable(rest) {
            rest = behind;
            continue;
        }
        let before = (rest.len(), bytes.len());
        if let Err(fault) = unpack(&mut rest, &mut bytes, most) {
            return Err((bytes, format!("cannot be unpacked: {fault}")));
        }
        if before == (rest.len(), bytes.len()) {
            break;
        }
    }
    Ok(bytes)
}

/// The bytes behind a skippable frame, if `bytes` begins with one; zstd and lz4 use the same format for it.
fn behind_skippable(bytes: &[u8]) -> Option<&[u8]> {
    let mut fields = ByteReader(bytes);
    let is_skippable = fields.u32()? & 0xffff_fff0 == 0x184d_2a50;
    let length = fields.u32().filter(|_| is_skippable)?;
    Some(fields.bytes(length.into()).map_or(&[][..], |_| fields.0))
}

/// Decompresses one frame of `packed` and leaves the rest. It reads at most one byte more than `most`, enough to
/// detect an oversized frame.
fn zstd_frame(packed: &mut &[u8], bytes: &mut Vec<u8>, most: u64) -> Result<(), ChunkFault> {
    let mut decoder =
        ruzstd::decoding::StreamingDecoder::new(&mut *packed).map_err(|error| error.to_string())?;
    let room = most.saturating_add(1).saturating_sub(bytes.len() as u64);
    (&mut decoder).take(room).read_to_end(bytes).map_err(|error| error.to_string())?;
    let decoder = decoder.into_frame_decoder();
    let (written, found) = (decoder.get_checksum_from_data(), decoder.get_calculated_checksum());
    if written.is_some() && written != found {
        Err("its frame does not fit its checksum".into())
    } else {
        Ok(())
    }
}

/// As [`zstd_frame`].
fn lz4_frame(packed: &mut &[u8], bytes: &mut Vec<u8>, most: u64) -> Result<(), ChunkFault> {
    let room = most.saturating_add(1).saturating_sub(bytes.len() as u64);
    let mut decoder = lz4_flex::frame::FrameDecoder::new(&mut *packed).take(room);
    decoder.read_to_end(bytes).map(drop).map_err(|error| lz4_fault(&error))
}

/// The fault in words; the crate prints the names of its types.
fn lz4_fault(error: &io::Error) -> ChunkFault {
    use lz4_flex::frame::Error;
    match error.get_ref().and_then(|inner| inner.downcast_ref::<Error>()) {
        Some(Error::HeaderChecksumError | Error::BlockChecksumError | Error::ContentChecksumError) => {
            "its frame does not fit its checksum".into()
        }
        Some(Error::WrongMagicNumber) => "it is no lz4 frame".into(),
        Some(_) => "its frame is damaged".into(),
        None => error.to_string(),
    }
}
