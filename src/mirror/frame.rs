//! Frames of the stream: what the server took within some milliseconds, as bytes.
//!
//! All numbers are little-endian. A frame is the version (one byte), the moment of its first entry in microseconds of
//! the server's clock (eight), and its entries, each of which is
//!
//! | bytes | what |
//! |---|---|
//! | 1 | its kind: a packet, silence, a request, a layout, a gap, the end, from 0 |
//! | 4 | the length of what follows the times |
//! | 4 | when the server took it, in microseconds after the frame's moment |
//! | 4 | when it came, in microseconds after (or, negative, before) that |
//! | ... | the message that a recording has of it |

use thiserror::Error;

use super::VERSION;
use crate::recording::{END, Entries, Entry, GAPS, LAYOUTS, PACKETS, REQUESTS, SILENCE};
use crate::units::Instant;
use crate::wire::Decoder;

/// The kinds of entries by their numbers.
const TOPICS: [&str; 6] = [PACKETS, SILENCE, REQUESTS, LAYOUTS, GAPS, END];

/// Most entries of one frame: what a stadium's boards send in the milliseconds that it spans.
const MOST_ENTRIES: usize = 8192;

/// A frame that is cut, damaged, too large or of another version; nothing of it is taken.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("a frame of the stream makes no sense")]
pub struct BadFrame;

/// Appends a frame of these entries to `bytes`.
pub(super) fn write(entries: &Entries, bytes: &mut Vec<u8>) {
    let first = entries.first().map_or(Instant::START, |(taken, _)| *taken).micros();
    bytes.push(VERSION);
    bytes.extend(first.to_le_bytes());
    for (taken, entry) in entries {
        let kind = TOPICS.iter().position(|topic| *topic == entry.topic());
        bytes.push(kind.and_then(|kind| u8::try_from(kind).ok()).unwrap_or(u8::MAX));
        let length_at = bytes.len();
        bytes.extend([0; 4]);
        // A frame spans milliseconds: what does not fit in an hour has no meaning.
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

/// The entries of a frame, each with the moment at which the server took it.
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
        let entry = Entry::read(TOPICS.get(usize::from(kind))?, message, came, decoder)?;
        entries.push((Instant::from_micros(taken), entry));
        if entries.len() > MOST_ENTRIES {
            return None;
        }
    }
    (version == VERSION).then_some(entries)
}
