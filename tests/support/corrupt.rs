//! Hostile and broken datagrams, for tests and benches.
#![allow(dead_code, unreachable_pub)]

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Makes hostile and broken datagrams; the same seed makes the same datagrams.
///
/// A test sends them beside a good stream, made from datagrams *already sent*: a damaged copy is then recognised as a
/// duplicate, while a copy damaged before the original is sent could pass as the original.
#[derive(Clone, Debug)]
pub struct Corruptor {
    rng: Pcg64Mcg,
}

impl Corruptor {
    /// A corruptor with its own random numbers.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { rng: Pcg64Mcg::seed_from_u64(seed) }
    }

    /// Returns a datagram of a random kind, made from `model` where the kind needs one.
    pub fn corrupt(&mut self, model: &[u8]) -> Vec<u8> {
        match self.rng.random_range(0..8) {
            0 => self.truncate(model),
            1 | 2 => self.flip(model),
            3 => self.not_a_number(model),
            4 => self.random_bytes(),
            5 => bundle_bomb(self.rng.random_range(5..4000)),
            6 => tag_bomb(self.rng.random_range(5..30_000)),
            _ => hostile_address(self.rng.random_range(1..60_000)),
        }
    }

    /// Returns the first bytes of `model`.
    pub fn truncate(&mut self, model: &[u8]) -> Vec<u8> {
        let length = self.rng.random_range(0..model.len().max(1));
        model.get(..length).unwrap_or_default().to_vec()
    }

    /// Flips one to four bits of `model`.
    pub fn flip(&mut self, model: &[u8]) -> Vec<u8> {
        let mut bytes = model.to_vec();
        for _ in 0..self.rng.random_range(1..=4) {
            let bit = 1 << self.rng.random_range(0..8);
            let place = self.rng.random_range(0..bytes.len().max(1));
            if let Some(byte) = bytes.get_mut(place) {
                *byte ^= bit;
            }
        }
        bytes
    }

    /// Sets up to eight of the last words of `model` to NaN, infinity or 1e38: the readings of a newton packet.
    pub fn not_a_number(&mut self, model: &[u8]) -> Vec<u8> {
        let mut bytes = model.to_vec();
        let (words, _) = bytes.as_chunks_mut();
        for word in words.iter_mut().rev().take(8) {
            let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -f32::NAN, 1e38];
            *word = odd[self.rng.random_range(0..odd.len())].to_be_bytes();
        }
        bytes
    }

    /// Returns up to 2000 random bytes, half of the time with the header of a bundle or a message.
    pub fn random_bytes(&mut self) -> Vec<u8> {
        let length = self.rng.random_range(0..2000);
        let mut bytes: Vec<u8> = match self.rng.random_range(0..4) {
            0 => b"#bundle\0".to_vec(),
            1 => b"/underfoot/board/0\0\0,".to_vec(),
            _ => Vec::new(),
        };
        bytes.extend((0..length).map(|_| self.rng.random::<u8>()));
        bytes
    }
}

/// Nested bundles, `levels` deep, 20 bytes each: they exhaust the stack of a recursive decoder.
#[must_use]
pub fn bundle_bomb(levels: usize) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(20 * levels);
    for level in (0..levels).rev() {
        bytes.extend(b"#bundle\0\0\0\0\0\0\0\0\x01");
        if level > 0 {
            let inside = u32::try_from(20 * level - 4).unwrap_or(u32::MAX);
            bytes.extend(inside.to_be_bytes());
        }
    }
    bytes
}

/// A message whose type tags open `depth` nested arrays, for the same purpose.
#[must_use]
pub fn tag_bomb(depth: usize) -> Vec<u8> {
    let mut bytes = b"/underfoot/board/0\0\0,".to_vec();
    bytes.resize(bytes.len() + depth, b'[');
    bytes.push(0);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    bytes
}

/// A message to an address of `length` slashes and stars.
#[must_use]
pub fn hostile_address(length: usize) -> Vec<u8> {
    let mut bytes: Vec<u8> = b"/*".iter().copied().cycle().take(length.max(1)).collect();
    bytes.push(0);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    bytes.extend(b",\0\0\0");
    bytes
}
