//! Messages of boards, read directly from their bytes: thousands arrive every second, all of the same form.

use arrayvec::ArrayVec;

use super::guard::DatagramLimits;
use super::packet::{MAX_CHANNELS, Readings};
use crate::floor::CountRange;

/// A message in a datagram: its address and the bytes after it.
#[derive(Clone, Copy, Debug)]
pub(super) struct RawMessage<'a> {
    /// The address without its terminator; it may not be text.
    pub(super) address: &'a [u8],
    rest: &'a [u8],
}

impl<'a> RawMessage<'a> {
    /// Splits the address off; `None` if it has no terminator.
    pub(super) fn split(bytes: &'a [u8]) -> Option<Self> {
        let (address, rest) = text(bytes)?;
        Some(Self { address, rest })
    }

    /// Returns the address as text, cut at the maximum length of an address; empty if it is not text.
    pub(super) fn address_text(&self) -> &'a str {
        let text = std::str::from_utf8(self.address).unwrap_or_default();
        &text[..text.floor_char_boundary(DatagramLimits::SENSORS.address)]
    }

    /// Describes its type tags for people: `iffff`, `ib (a blob of 46 bytes)`, `no type tags`.
    pub(super) fn found(&self) -> String {
        /// Maximum number of type tags shown.
        const SHOWN: usize = 40;
        if self.rest.is_empty() {
            return "nothing".to_owned();
        }
        let Some((tags, arguments)) = text(self.rest) else { return "no type tags".to_owned() };
        let Some(tags) = tags.strip_prefix(b",") else { return "no type tags".to_owned() };
        let shown = tags.get(..SHOWN).unwrap_or(tags).escape_ascii();
        match tags {
            b"" => "nothing".to_owned(),
            b"ib" => {
                let length = arguments.get(4..8).and_then(|length| length.try_into().ok());
                format!("ib (a blob of {} bytes)", length.map_or(0, u32::from_be_bytes))
            }
            _ if tags.len() > SHOWN => format!("{shown}... ({} arguments)", tags.len()),
            _ => shown.to_string(),
        }
    }

    /// Whether its arguments may be readings: several numbers, or a blob.
    pub(super) fn looks_like_readings(&self) -> bool {
        let tags = text(self.rest).and_then(|(tags, _)| tags.strip_prefix(b",")).unwrap_or_default();
        let numbers = tags.iter().filter(|tag| b"ifdh".contains(tag)).count();
        numbers > 3 || tags.contains(&b'b')
    }

    /// Returns the number and the readings of a board with so many `channels`, whose counts have this `range`; `None`
    /// unless the whole message is that of a board within `limits`. A message with as many arguments as the board has
    /// channels has no number: then it is 0.
    pub(super) fn read(
        &self,
        limits: &DatagramLimits,
        channels: usize,
        range: CountRange,
    ) -> Option<(u32, Readings)> {
        let (tags, arguments) = text(self.rest)?;
        let tags = tags.strip_prefix(b",")?;
        if self.address.len() > limits.address || tags.len() > limits.tags {
            return None;
        }
        let are_counts = || tags.len() == channels && tags.iter().all(|tag| *tag == b'i');
        let is_unnumbered = matches!(tags, b"b" | [b'f', ..]) || are_counts();
        let (number, tags, arguments) = if is_unnumbered {
            (0, tags, arguments)
        } else {
            let (number, arguments) = arguments.split_first_chunk()?;
            // The number has 32 bits without a sign; OSC has only signed integers.
            (u32::from_be_bytes(*number), tags.strip_prefix(b"i")?, arguments)
        };
        let readings = match tags {
            b"b" => blob(arguments, range)?,
            [b'f', ..] => Readings::Newtons(values(tags, b'f', arguments, f32::from_be_bytes)?),
            _ if range == CountRange::WHOLE => {
                let count = |bytes| u16::try_from(i32::from_be_bytes(bytes)).ok();
                let counts = values(tags, b'i', arguments, count)?;
                if 2 * counts.iter().filter(|count| count.is_none()).count() > counts.len() {
                    // A finer converter than the floor file says: the counts tell which.
                    ranged(values(tags, b'i', arguments, i32::from_be_bytes)?, range, true)
                } else {
                    Readings::Counts(counts)
                }
            }
            _ => ranged(values(tags, b'i', arguments, i32::from_be_bytes)?, range, range.needs_fractions()),
        };
        Some((number, readings))
    }
}

/// Returns the bytes before the first zero, and those after its padding to four bytes.
fn text(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let length = bytes.iter().position(|byte| *byte == 0)?;
    let rest = bytes.get((length + 1).next_multiple_of(4)..)?;
    Some((bytes.get(..length)?, rest))
}

/// Returns one value of four bytes for each tag; `None` unless all tags are `tag` and no bytes are left over.
fn values<T>(
    tags: &[u8],
    tag: u8,
    arguments: &[u8],
    value: impl Fn([u8; 4]) -> T,
) -> Option<ArrayVec<T, MAX_CHANNELS>> {
    let (words, rest) = arguments.as_chunks();
    let is_alike = tags.iter().all(|one| *one == tag);
    if !is_alike || !rest.is_empty() || words.len() != tags.len() || words.len() > MAX_CHANNELS {
        return None;
    }
    Some(words.iter().map(|word| value(*word)).collect())
}

/// The readings of counts in this `range`, with fractions or as 16 bits.
fn ranged(
    counts: ArrayVec<impl Into<f64>, MAX_CHANNELS>,
    range: CountRange,
    has_fractions: bool,
) -> Readings {
    let counts = counts.into_iter().map(Into::into);
    if has_fractions {
        Readings::Scaled(counts.map(|count| range.scaled(count)).collect())
    } else {
        Readings::Counts(counts.map(|count| range.rounded(count)).collect())
    }
}

/// Reads counts of two bytes each, or three for a range of more than 16 bits, with their length before them and padding
/// behind.
fn blob(arguments: &[u8], range: CountRange) -> Option<Readings> {
    let (length, bytes) = arguments.split_first_chunk()?;
    let length = usize::try_from(u32::from_be_bytes(*length)).ok()?;
    let words = bytes.get(..length)?;
    if bytes.len() != length.next_multiple_of(4) {
        return None;
    }
    if range.has_three_bytes() {
        let (triples, odd) = words.as_chunks();
        let is_fit = odd.is_empty() && triples.len() <= MAX_CHANNELS;
        let word = |[high, middle, low]: &[u8; 3]| u32::from_be_bytes([0, *high, *middle, *low]);
        return is_fit.then(|| ranged(triples.iter().map(word).collect(), range, true));
    }
    let (pairs, odd) = words.as_chunks();
    if !odd.is_empty() || pairs.len() > MAX_CHANNELS {
        return None;
    }
    let words = pairs.iter().map(|pair| u16::from_be_bytes(*pair));
    if range == CountRange::WHOLE {
        return Some(Readings::Counts(words.map(Some).collect()));
    }
    Some(ranged(words.collect(), range, range.needs_fractions()))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rosc::{OscMessage, OscPacket, OscType, encoder};

    use super::*;
    use crate::wire::check;

    const ADDRESS: &str = "/underfoot/board/3";

    /// Decodes the same bytes with rosc, if they are a board's message.
    fn by_rosc(datagram: &[u8]) -> Option<(String, u32, Readings)> {
        let (_, OscPacket::Message(message)) = rosc::decoder::decode_udp(datagram).ok()? else { return None };
        let (sequence, values) = match message.args.split_first()? {
            (OscType::Int(sequence), values) => (sequence.cast_unsigned(), values),
            // Boards may leave the number out.
            (OscType::Float(_) | OscType::Blob(_), _) => (0, message.args.as_slice()),
            _ => return None,
        };
        let count = |value: &OscType| match value {
            OscType::Int(count) => Some(u16::try_from(*count).ok()),
            _ => None,
        };
        let force = |value: &OscType| match value {
            OscType::Float(force) => Some(*force),
            _ => None,
        };
        let readings = match values {
            [OscType::Blob(blob)] => {
                let pairs = blob.chunks(2).map(|pair| Some(u16::from_be_bytes(pair.try_into().ok()?)));
                Readings::Counts(pairs.map(|count| count.map(Some)).collect::<Option<_>>()?)
            }
            [OscType::Float(_), ..] => Readings::Newtons(values.iter().map(force).collect::<Option<_>>()?),
            _ => {
                let counts: ArrayVec<_, MAX_CHANNELS> = values.iter().map(count).collect::<Option<_>>()?;
                if 2 * counts.iter().filter(|count| count.is_none()).count() > counts.len() {
                    // Most are not of 16 bits: the readings keep them for the message about the converter.
                    let whole = |value: &OscType| value.clone().int().map(f64::from);
                    let whole = values.iter().filter_map(whole);
                    Readings::Scaled(whole.map(|count| CountRange::WHOLE.scaled(count)).collect())
                } else {
                    Readings::Counts(counts)
                }
            }
        };
        Some((message.addr, sequence, readings))
    }

    fn datagrams() -> impl Strategy<Value = Vec<u8>> {
        let ints = prop::collection::vec((-2..70_000_i32).prop_map(OscType::Int), 0..30);
        let finer = prop::collection::vec((-2..1 << 24).prop_map(OscType::Int), 0..30);
        let floats =
            prop::collection::vec(any::<i16>().prop_map(|n| OscType::Float(f32::from(n) / 7.0)), 1..30);
        let blob = prop::collection::vec(any::<u8>(), 0..60).prop_map(|bytes| vec![OscType::Blob(bytes)]);
        (any::<i32>(), prop_oneof![ints, finer, floats, blob]).prop_map(|(sequence, values)| {
            let args = std::iter::once(OscType::Int(sequence)).chain(values).collect();
            encoder::encode(&OscPacket::Message(OscMessage { addr: ADDRESS.into(), args })).unwrap()
        })
    }

    proptest! {
        /// These messages bypass the guard: for any damage to a datagram, the reader accepts nothing that the guard
        /// would reject, agrees with rosc, and reads every complete message.
        #[test]
        fn what_is_read_is_what_the_guard_lets_through_and_others_read(
            mut datagram in datagrams(),
            damages in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
            cut in prop::option::weighted(0.1, any::<prop::sample::Index>()),
        ) {
            for (at, byte) in damages {
                let at = at.index(datagram.len());
                datagram[at] = byte;
            }
            if let Some(cut) = cut {
                datagram.truncate(cut.index(datagram.len()));
            }
            let raw = RawMessage::split(&datagram);
            let read = raw.and_then(|raw| {
                Some((raw.address, raw.read(&DatagramLimits::SENSORS, usize::MAX, CountRange::WHOLE)?))
            });
            let is_sound = check(&datagram, &DatagramLimits::SENSORS).is_ok();
            let others = is_sound.then(|| by_rosc(&datagram)).flatten();
            match (read, others) {
                (Some((address, (sequence, readings))), others) if address == ADDRESS.as_bytes() => {
                    let (their_address, their_sequence, theirs) = others.expect("the guard and rosc take it");
                    prop_assert_eq!(address, their_address.as_bytes());
                    prop_assert_eq!(sequence, their_sequence);
                    prop_assert_eq!(format!("{readings:?}"), format!("{theirs:?}"));
                }
                // Damaged: the address belongs to no board.
                (Some(_), _) => {}
                (None, others) => prop_assert!(others.is_none(), "{others:?} is left unread"),
            }
        }
    }
}
