//! The cost of authentication, as a measurement.

use std::hint::black_box;
use std::time::Instant;

use underfoot::units;
use underfoot_cluster::auth::{AuthSession, Key, MessageKind, Role};

use crate::hall::say;

/// Messages of one measurement, and number of measurements; the fastest counts, as other programs disturb the rest.
const MESSAGES: usize = 500;
const ROUNDS: usize = 100;

/// Two sessions that have answered each other.
fn pair() -> [AuthSession; 2] {
    let mut ends = [1, 2].map(|nonce| AuthSession::new(Role::Neighbour, &Key::new([7; 32]), nonce, 8));
    let mut sealed = Vec::new();
    for round in 0..3 {
        let (from, to) = (round % 2, 1 - round % 2);
        ends[from].seal(MessageKind::Note, b"", units::Instant::from_millis(1000), &mut sealed);
        let _ = ends[to].open(&sealed, units::Instant::from_millis(1000));
    }
    ends
}

/// Microseconds for sealing and for opening a message of this kind and length.
fn cost(kind: MessageKind, bytes: usize) -> (f64, f64) {
    let [mut from, mut to] = pair();
    let (body, now) = (vec![b'x'; bytes], units::Instant::from_millis(1001));
    let mut sealed = vec![Vec::new(); MESSAGES];
    let each = |begun: Instant| begun.elapsed().as_secs_f64() * 1e6 / MESSAGES as f64;
    let mut least = (f64::MAX, f64::MAX);
    for _ in 0..ROUNDS {
        let begun = Instant::now();
        sealed.iter_mut().for_each(|out| from.seal(kind, black_box(&body), now, out));
        least.0 = least.0.min(each(begun));
        let begun = Instant::now();
        let opened = sealed.iter().filter(|sealed| to.open(black_box(sealed), now).is_ok()).count();
        least.1 = least.1.min(each(begun));
        assert_eq!(opened, MESSAGES);
    }
    least
}

#[test]
#[ignore = "a measurement"]
fn authentication_costs_microseconds() {
    for (name, kind, bytes) in [
        ("packet of a board of 32 channels", MessageKind::Packet, 96),
        ("packet of a board of 72 channels", MessageKind::Packet, 184),
        ("note with a cue", MessageKind::Note, 500),
        ("message about two feet", MessageKind::Note, 900),
        ("message about fifty feet", MessageKind::Note, 10_000),
    ] {
        let (sealing, opening) = cost(kind, bytes);
        say(&format!("{name}, {bytes} bytes: {sealing:.2} us to seal, {opening:.2} us to open"));
    }
}
