//! Makes inputs from others: cut, repeated, mixed, with misplaced bits, numbers and words.

use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Words with a meaning for readers of text and numbers.
const WORDS: [&[u8]; 40] = [
    b"(",
    b")",
    b"[",
    b"]",
    b"{",
    b"}",
    b"\"",
    b"'",
    b",",
    b":",
    b"//",
    b"/*",
    b"*/",
    b"\\",
    b"r#\"",
    b"#",
    b"-",
    b"+",
    b"NaN",
    b"inf",
    b"-inf",
    b"1e400",
    b"-1e-400",
    b"18446744073709551616",
    b"-9223372036854775809",
    b"0x",
    b"1_0",
    b"None",
    b"Some(",
    b"true",
    b"version: 999,",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"\r\n",
    b"\0",
    b"\xf0\x9f\x91\xa3",
    b"#bundle\0",
    b"/underfoot/board/0\0\0",
    b",[[[[",
    b"\x7f\xff\xff\xff",
];

/// Greatest number of changes in one input.
const MOST: u32 = 8;

/// Makes an input from `corpus`; one in fifty is random.
pub fn make(corpus: &[Vec<u8>], most_bytes: usize, rng: &mut Pcg64Mcg, input: &mut Vec<u8>) {
    input.clear();
    if corpus.is_empty() || rng.random_range(0..50) == 0 {
        let length = rng.random_range(0..256);
        input.extend((0..length).map(|_| rng.random::<u8>()));
    } else {
        input.extend(&corpus[rng.random_range(0..corpus.len())]);
    }
    for _ in 0..rng.random_range(1..=MOST) {
        change(corpus, rng, input);
    }
    input.truncate(most_bytes);
}

/// A range within `length` bytes, short ones more often.
fn stretch(length: usize, rng: &mut Pcg64Mcg) -> std::ops::Range<usize> {
    if length == 0 {
        return 0..0;
    }
    let from = rng.random_range(0..length);
    let most = (length - from).min(1 << rng.random_range(0..12_u32));
    from..from + rng.random_range(0..=most)
}

fn change(corpus: &[Vec<u8>], rng: &mut Pcg64Mcg, input: &mut Vec<u8>) {
    let at = rng.random_range(0..=input.len());
    match rng.random_range(0..10) {
        0 => input.truncate(at),
        1 => drop(input.drain(stretch(input.len(), rng))),
        2 => {
            let piece = input[stretch(input.len(), rng)].to_vec();
            let times = 1 << rng.random_range(0..6_u32);
            splice(input, at, &piece.repeat(times));
        }
        3 if !corpus.is_empty() => {
            let other = &corpus[rng.random_range(0..corpus.len())];
            splice(input, at, &other[stretch(other.len(), rng)]);
        }
        4 | 5 => {
            if let Some(byte) = input.get_mut(at) {
                *byte ^= 1 << rng.random_range(0..8_u32);
            }
        }
        6 => {
            if let Some(byte) = input.get_mut(at) {
                *byte = rng.random();
            }
        }
        7 => {
            // Replaces a digit by another one, or by many.
            if let Some(found) = (at..input.len()).find(|&place| input[place].is_ascii_digit()) {
                let digits = b"0987654321".repeat(rng.random_range(0..4));
                input.splice(found..=found, digits.into_iter().chain([b'0' + rng.random_range(0..10_u8)]));
            }
        }
        8 => {
            // A 32-bit number, as in OSC.
            let number = [0_u32, 1, u32::MAX, i32::MAX as u32, 0x8000_0000, rng.random()];
            let bytes = number[rng.random_range(0..number.len())].to_be_bytes();
            let place = at & !3;
            if place + 4 <= input.len() {
                input[place..place + 4].copy_from_slice(&bytes);
            }
        }
        _ => splice(input, at, WORDS[rng.random_range(0..WORDS.len())]),
    }
}

fn splice(input: &mut Vec<u8>, at: usize, piece: &[u8]) {
    input.splice(at..at, piece.iter().copied());
}
