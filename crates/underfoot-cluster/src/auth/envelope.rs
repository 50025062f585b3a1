//! The bytes of a message: its sender, its answers, its body, and the MAC over all of it.
//!
//! ```text
//! "uf" format kind   nonce counter sent    count   count x (nonce sent received)   body   MAC
//!  2   1      1      8     8       8       2       24                                     32 bytes, big-endian
//! ```

use blake3::Hash;

/// First bytes of every message, with which neither OSC nor JSON begins. The last one is the number of this format.
const MAGIC: [u8; 3] = *b"uf\x01";

/// Bytes of the MAC.
const TAG: usize = 32;

/// Bytes of one answer.
const ANSWER: usize = 24;

/// The purpose of a message. Each kind has its own key, so that none passes for another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MessageKind {
    /// From a node to gateways.
    Node = 1,
    /// From a gateway to nodes.
    Gateway = 2,
    /// From a node to a neighbour: cues over the border.
    Note = 3,
    /// From a node to a neighbour: the packet of a board.
    Packet = 4,
}

impl MessageKind {
    pub(super) const ALL: [Self; 4] = [Self::Node, Self::Gateway, Self::Note, Self::Packet];

    /// The context from which its key is derived.
    pub(super) const fn context(self) -> &'static str {
        match self {
            Self::Node => "underfoot-cluster 2026 messages of nodes to gateways",
            Self::Gateway => "underfoot-cluster 2026 messages of gateways to nodes",
            Self::Note => "underfoot-cluster 2026 notes of nodes to neighbours",
            Self::Packet => "underfoot-cluster 2026 packets of boards to neighbours",
        }
    }
}

/// Receipt of a message, for its sender.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Echo {
    /// Time of sending, in microseconds of the sender's clock.
    pub sent: u64,
    /// Time of receipt, in microseconds of the receiver's clock.
    pub received: u64,
}

/// Sender, number and time of a message.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EnvelopeHead {
    /// The sender's nonce.
    pub from: u64,
    /// The message's number, from 1.
    pub counter: u64,
    /// Time of sending, in microseconds of the sender's clock.
    pub sent: u64,
}

/// The parts of a message.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnvelopeParts<'m> {
    pub(super) head: EnvelopeHead,
    answers: &'m [u8],
    /// Start and end of the body among the bytes.
    pub(super) body: (usize, usize),
}

impl EnvelopeParts<'_> {
    /// Its answer to the program with this `nonce`.
    pub(super) fn answer_to(&self, nonce: u64) -> Option<Echo> {
        let mut answers = self.answers.chunks_exact(ANSWER).filter_map(|mut answer| {
            Some((take_u64(&mut answer)?, take_u64(&mut answer)?, take_u64(&mut answer)?))
        });
        answers.find(|(to, ..)| *to == nonce).map(|(_, sent, received)| Echo { sent, received })
    }
}

/// Writes a message into `out`, replacing its content.
pub(super) fn write(
    (kind, key): (MessageKind, &[u8; TAG]),
    head: &EnvelopeHead,
    answers: impl Iterator<Item = (u64, Echo)>,
    body: &[u8],
    out: &mut Vec<u8>,
) {
    out.clear();
    out.extend(MAGIC);
    out.push(kind as u8);
    for number in [head.from, head.counter, head.sent] {
        out.extend(number.to_be_bytes());
    }
    let count_at = out.len();
    out.extend([0; 2]);
    let mut count = 0_u16;
    for (to, Echo { sent, received }) in answers.take(u16::MAX.into()) {
        count += 1;
        for number in [to, sent, received] {
            out.extend(number.to_be_bytes());
        }
    }
    if let Some(place) = out.get_mut(count_at..count_at + 2) {
        place.copy_from_slice(&count.to_be_bytes());
    }
    out.extend(body);
    let tag = blake3::keyed_hash(key, out);
    out.extend(tag.as_bytes());
}

/// The kind of a message; `None` for bytes of another format.
pub(super) fn kind(bytes: &[u8]) -> Option<MessageKind> {
    let (&number, _) = bytes.strip_prefix(&MAGIC)?.split_first()?;
    MessageKind::ALL.into_iter().find(|kind| *kind as u8 == number)
}

/// Whether the MAC at the end of `bytes` is right for `key`. The comparison takes the same time for any differing
/// byte.
pub(super) fn is_genuine(bytes: &[u8], key: &[u8; TAG]) -> bool {
    bytes
        .split_last_chunk::<TAG>()
        .is_some_and(|(content, tag)| blake3::keyed_hash(key, content) == Hash::from(*tag))
}

/// The parts of a message; `None` if it is cut short.
pub(super) fn parts(bytes: &[u8]) -> Option<EnvelopeParts<'_>> {
    let (content, _) = bytes.split_last_chunk::<TAG>()?;
    let mut rest = content.get(MAGIC.len() + 1..)?;
    let (from, counter, sent) = (take_u64(&mut rest)?, take_u64(&mut rest)?, take_u64(&mut rest)?);
    let (count, rest) = rest.split_first_chunk::<2>()?;
    let (answers, body) = rest.split_at_checked(usize::from(u16::from_be_bytes(*count)) * ANSWER)?;
    Some(EnvelopeParts {
        head: EnvelopeHead { from, counter, sent },
        answers,
        body: (content.len() - body.len(), content.len()),
    })
}

fn take_u64(bytes: &mut &[u8]) -> Option<u64> {
    let (number, rest) = bytes.split_first_chunk::<8>()?;
    *bytes = rest;
    Some(u64::from_be_bytes(*number))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const KEY: [u8; TAG] = [7; TAG];

    fn written(answers: &[(u64, Echo)], body: &[u8]) -> Vec<u8> {
        let mut out = Vec::new();
        let head = EnvelopeHead { from: 1, counter: 2, sent: 3 };
        write((MessageKind::Note, &KEY), &head, answers.iter().copied(), body, &mut out);
        out
    }

    #[test]
    fn a_message_is_read_as_it_was_written() {
        let answers = [4, 5].map(|to| (to, Echo { sent: 10 * to, received: 100 * to }));
        let bytes = written(&answers, b"body");
        assert_eq!(kind(&bytes), Some(MessageKind::Note));
        assert!(is_genuine(&bytes, &KEY));
        let parts = parts(&bytes).unwrap();
        assert_eq!(parts.head, EnvelopeHead { from: 1, counter: 2, sent: 3 });
        assert_eq!(&bytes[parts.body.0..parts.body.1], b"body");
        assert_eq!(parts.answer_to(5), Some(Echo { sent: 50, received: 500 }));
        assert_eq!(parts.answer_to(6), None);
    }

    #[test]
    fn every_bit_counts() {
        let bytes = written(&[(4, Echo::default())], b"body");
        for bit in 0..bytes.len() * 8 {
            let mut changed = bytes.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            assert!(!is_genuine(&changed, &KEY), "bit {bit}");
        }
        assert!(!is_genuine(&bytes, &[8; TAG]), "another key");
        assert!(!is_genuine(&bytes[..bytes.len() - 1], &KEY));
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_without_a_panic(bytes in prop::collection::vec(any::<u8>(), 0..120)) {
            let _ = (kind(&bytes), is_genuine(&bytes, &KEY));
            for bytes in [bytes.clone(), [&MAGIC, &bytes[..]].concat()] {
                if let Some(parts) = parts(&bytes) {
                    prop_assert!(bytes.get(parts.body.0..parts.body.1).is_some());
                    let _ = parts.answer_to(0);
                }
            }
        }
    }
}
