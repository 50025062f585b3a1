//! The number of sample clock slots between two packets of a board.

use arrayvec::ArrayVec;

use super::clock::SLOT_NS;

/// Time between two marks.
const MARK_NS: i64 = 250 * SLOT_NS;

/// Silence after which earlier marks are invalid: the board may have stopped counting meanwhile. Longer than a period
/// at 10 Hz.
const GAP_NS: i64 = 130 * SLOT_NS;

/// Maximum number of marks: eight seconds.
const MARKS: usize = 33;

/// Relative difference from the pace in use that a measured pace must have, for each number of marks. A burst of
/// delayed packets shifts half a second by a fifth, but not both of its halves, and eight seconds by less than a
/// thousandth. Crystals differ by 0.0002.
const DIFFERENCES: [(usize, f64); 3] = [(2, 0.05), (8, 0.006), (32, 0.0015)];

/// The pace of a board that sends once a millisecond.
const ONE: f64 = 1.0;

/// The number of slots between two packets, and its measurement.
///
/// At one packet a millisecond it is exactly 1, regardless of crystal drift: such boards steer the sample clock.
/// Boards at another rate have times of their own ([`super::timed`]).
#[derive(Clone, Debug)]
pub(super) struct PacketPace {
    /// Slots between two packets.
    slots: f64,
    /// Arrival times of packets, and their positions in the stream.
    marks: ArrayVec<(i64, i64), MARKS>,
    last_ns: i64,
}

impl Default for PacketPace {
    fn default() -> Self {
        Self { slots: ONE, marks: ArrayVec::new(), last_ns: 0 }
    }
}

impl PacketPace {
    /// The pace of a board at this rate, in packets a second.
    pub(super) fn of_rate(hz: f32) -> Self {
        Self { slots: 1000.0 / f64::from(hz), ..Self::default() }
    }

    /// The pace so far, with a new measurement of it.
    pub(super) fn anew(&self) -> Self {
        Self { slots: self.slots, ..Self::default() }
    }

    /// Rate in packets a second.
    pub(super) fn hz(&self) -> f32 {
        (1000.0 / self.slots) as f32
    }

    /// Time from packet to packet, in nanoseconds.
    pub(super) fn exact_period_ns(&self) -> f64 {
        self.slots * SLOT_NS as f64
    }

    /// The same in whole nanoseconds, at least 1.
    pub(super) fn period_ns(&self) -> i64 {
        (self.exact_period_ns() as i64).max(1)
    }

    /// The pace since the first mark, with a new measurement of it.
    pub(super) fn so_far(&self, now_ns: i64, position: i64) -> Option<Self> {
        let (begun, first) = self.marks.first()?;
        let packets = position - first;
        let slots = (now_ns - begun) as f64 / SLOT_NS as f64 / packets as f64;
        (packets > 0 && slots > 0.0).then(|| Self { slots, ..Self::default() })
    }

    /// Whether several packets come in a millisecond, beyond any error of a short measurement.
    pub(super) fn is_fast(&self) -> bool {
        const FAST: f64 = 0.8;
        self.slots < FAST
    }

    /// Whether it is one packet a millisecond.
    pub(super) fn is_one(&self) -> bool {
        self.slots == ONE
    }

    /// Notes the position of a packet further on than all before.
    pub(super) fn note(&mut self, now_ns: i64, position: i64) {
        if now_ns - self.last_ns > GAP_NS {
            self.marks.clear();
        }
        self.last_ns = now_ns;
        if self.marks.last().is_some_and(|(marked, _)| now_ns - marked < MARK_NS) {
            return;
        }
        if self.marks.is_full() {
            self.marks.remove(0);
        }
        self.marks.push((now_ns, position));
    }

    /// Adopts a measured pace that differs; returns whether it does.
    pub(super) fn adopt(&mut self) -> bool {
        let Some(slots) = DIFFERENCES.iter().find_map(|(spans, share)| self.measured(*spans, *share)) else {
            return false;
        };
        let (_, slightest) = DIFFERENCES[DIFFERENCES.len() - 1];
        let slots = if (slots - ONE).abs() < slightest { ONE } else { slots };
        let is_other = slots != self.slots;
        self.slots = slots;
        self.marks.clear();
        is_other
    }

    /// The pace over the last `spans` marks, if it and that of both halves differ by `share` from the one in use.
    fn measured(&self, spans: usize, share: f64) -> Option<f64> {
        let first = self.marks.len().checked_sub(spans + 1)?;
        let pace = |from: usize, to: usize| {
            let ((begun, position), (ended, later)) = (self.marks.get(from)?, self.marks.get(to)?);
            let packets = later - position;
            (packets > 0).then(|| (ended - begun) as f64 / SLOT_NS as f64 / packets as f64)
        };
        let middle = first + spans / 2;
        let [whole, early, late] =
            [pace(first, first + spans)?, pace(first, middle)?, pace(middle, first + spans)?];
        let off = |pace: f64| pace / self.slots - 1.0;
        let is_other = |pace: f64, share: f64| off(pace).abs() > share && off(pace) * off(whole) > 0.0;
        // A single gap shifts one half; another rate shifts both alike.
        let is_steady = (off(early) - off(late)).abs() <= 0.5 * off(whole).abs();
        (is_steady && is_other(whole, share) && is_other(early, 0.5 * share) && is_other(late, 0.5 * share))
            .then_some(whole)
    }

    /// Resets the measurement: the board starts anew.
    pub(super) fn forget(&mut self) {
        self.marks.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = SLOT_NS;

    /// The pace after packets with these arrival times, and the time of its last change.
    fn after(packets: impl Iterator<Item = i64>) -> (f64, i64) {
        let (mut pace, mut changed) = (PacketPace::default(), 0);
        for (position, arrives_ns) in (0..).zip(packets) {
            pace.note(arrives_ns, position);
            if pace.adopt() {
                changed = arrives_ns;
            }
        }
        (pace.slots, changed)
    }

    #[test]
    fn rates_are_measured_within_a_second() {
        for hz in [20, 100, 140, 500, 870, 1400, 2000, 4000] {
            let (slots, changed) = after((0..10 * hz).map(|n| n * 1000 * MS / hz));
            assert!((slots * hz as f64 / 1000.0 - 1.0).abs() < 0.01, "{hz} Hz: {slots} slots");
            assert!(changed < 1000 * MS, "{hz} Hz: after {changed} ns");
        }
    }

    #[test]
    fn an_oscillator_without_a_crystal_is_measured_within_nine_seconds() {
        for share in [0.98, 0.995, 1.002, 1.02] {
            let (slots, changed) = after((0..30_000).map(|n| (n as f64 * share * MS as f64) as i64));
            assert!((slots / share - 1.0).abs() < 0.001, "{share}: {slots}");
            assert!(changed < 9000 * MS);
        }
    }

    #[test]
    fn crystals_are_one_packet_a_millisecond() {
        for ppm in [-500, -200, 0, 200, 500] {
            let (slots, _) = after((0..30_000).map(|n| n * MS + n * MS / 1_000_000 * ppm));
            assert_eq!(slots, ONE, "{ppm} ppm");
        }
    }

    #[test]
    fn what_a_network_does_changes_no_pace() {
        // Every third millisecond a packet is 2 ms late; every 300 ms none comes for 90 ms, and then all at once.
        let late = |n: i64| {
            let ms = if n % 300 > 210 { n - n % 300 + 300 } else { n };
            ms * MS + if n % 3 == 0 { 2 * MS } else { 0 }
        };
        let mut arrivals: Vec<i64> = (0..30_000).map(late).collect();
        arrivals.sort_unstable();
        assert_eq!(after(arrivals.into_iter()).0, ONE);
        // After packet 5000 all packets are 80 ms late.
        let shifted = (0..30_000).map(|n| if n < 5000 { n * MS } else { (n + 80) * MS });
        assert_eq!(after(shifted).0, ONE);
    }

    #[test]
    fn a_board_that_was_silent_and_did_not_count_meanwhile_keeps_its_pace() {
        let silent = (0..30_000).map(|n| (n + 150 * (n / 400)) * MS);
        assert_eq!(after(silent).0, ONE);
    }
}
