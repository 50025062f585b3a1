//! Frames of the stream: the entries that the server took within some milliseconds, as bytes.
//!
//! All numbers are little-endian. A frame consists of the version (one byte), the time of its first entry in
//! microseconds on the server's clock (eight bytes), and its entries. Each entry consists of
//!
//! | bytes | field |
//! |---|---|
//! | 1 | the kind: a packet, silence, a request, a layout, a gap, the end, from 0 |
//! | 4 | the length of the message after the times |
//! | 4 | time at which the server took it, in microseconds after the frame's time |
//! | 4 | time of its arrival, in microseconds after (or, negative, before) that |
//! | ... | its message, as in a recording |

use thiserror::Error;

use super::VERSION;
use crate::source::log::{END, Entries, GAPS, LAYOUTS, LogEntry, PACKETS, REQUESTS, SILENCE};
use crate::units::Instant;
use crate::wire::Decoder;

/// The kinds of entries by their numbers.
const TOPICS: [&str; 6] = [PACKETS, SILENCE, REQUESTS, LAYOUTS, GAPS, END];

/// Maximum number of entries in one frame: those that a stadium's boards send in the milliseconds of its span.
const MOST_ENTRIES: usize = 8192;

/// The error for a frame that is truncated, damaged, too large or of another version; the receiver uses none of it.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("a frame of the stream makes no sense")]
pub struct BadFrame;

/// Appends a frame of these entries to `bytes`.
#[cfg(feature = "record")]
pub(super) fn write(entries: &Entries, bytes: &mut Vec<u8>) {
    let first = entries.first().map_or(Instant::START, |(taken, _)| *taken).micros();
    bytes.push(VERSION);
    bytes.extend(first.to_le_bytes());
    for (taken, entry) in entries {
        let kind = TOPICS.iter().position(|topic| *topic == entry.topic());
        bytes.push(kind.and_then(|kind| u8::try_from(kind).ok()).unwrap_or(u8::MAX));
        let length_at = bytes.len();
        bytes.extend([0; 4]);
        // A frame spans milliseconds: an offset of more than an hour is meaningless.
        let after = u32::try_from(taken.micros().saturating_sub(first)).unwrap_or(u32::MAX);
        bytes.extend(after.to_le_bytes());
        let came = entry.came(*taken).micros().cast_signed().saturating_sub(taken.micros().cast_signed());
        let came = i32::try_from(came).unwrap_or(if came < 0 { i32::MIN } else { i32::MAX });
        bytes.extend(came.to_le_bytes());
        let begins = bytes.len();
        entry.write(bytes);
        let length = u32::try_from(bytes.len() - begins).unwrap_or(u32::MAX);
        if let Some(place) = bytes.get_mut(length_at..length_at + 4) {
            place.copy_from_slice(&length.to_le_bytes());
        }
    }
}

/// The entries of a frame, each with the time at which the server took it.
pub(super) fn read(bytes: &[u8], decoder: &Decoder) -> Result<Entries, BadFrame> {
    read_all(bytes, decoder).ok_or(BadFrame)
}

fn read_all(bytes: &[u8], decoder: &Decoder) -> Option<Entries> {
    let (&version, bytes) = bytes.split_first()?;
    let (first, mut bytes) = bytes.split_first_chunk()?;
    let first = u64::from_le_bytes(*first);
    let mut entries = Entries::new();
    while let Some((&kind, rest)) = bytes.split_first().filter(|_| version == VERSION) {
        let (length, rest) = rest.split_first_chunk()?;
        let (after, rest) = rest.split_first_chunk()?;
        let (came, rest) = rest.split_first_chunk()?;
        let (message, rest) = rest.split_at_checked(u32::from_le_bytes(*length).try_into().ok()?)?;
        bytes = rest;
        let taken = first.checked_add(u32::from_le_bytes(*after).into())?;
        let came = Instant::from_micros(taken.saturating_add_signed(i32::from_le_bytes(*came).into()));
        let entry = LogEntry::read(TOPICS.get(usize::from(kind))?, message, came, decoder)?;
        entries.push((Instant::from_micros(taken), entry));
        if entries.len() > MOST_ENTRIES {
            return None;
        }
    }
    (version == VERSION).then_some(entries)
}
