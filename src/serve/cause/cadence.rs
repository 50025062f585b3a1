//! Sequence numbering and send rate of one board, from the numbers and arrival times of its packets.

use std::time::Duration;

use crate::units::Instant;
use crate::wire::LinkCause;

/// Minimum time over which a board is classified: 50 packets of a board at 100 Hz, which gives the rate to 2 %.
const SPAN: Duration = Duration::from_millis(500);

/// Minimum number of packets for a classification.
const FEWEST: u32 = 5;

/// Maximum step that counts as one: numbers in microseconds grow by a million per packet at 1 Hz.
const LARGEST_STEP: u32 = 1 << 24;

/// A restart: the number falls by more than `FALL`, to at most `LOW`. Packets that overtake each other fall less.
const FALL: u32 = 100;
const LOW: u32 = 16;

/// Tolerance on the last number before a restart, which varies when packets are lost.
const SLACK: u32 = 8;

/// How a board numbers its packets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Count {
    /// By steps of one.
    Steady,
    /// Always this number.
    Stands(u32),
    /// By this step.
    Steps(u32),
    /// Down.
    Falls,
    /// The numbers restart after this number, repeatedly.
    Restarts(u32),
    /// Two interleaved sequences, as from two boards.
    Mixed,
    /// In no order.
    Jumps,
}

/// The numbers and the times of one board's packets.
#[derive(Clone, Debug, Default)]
pub(super) struct Cadence {
    last: Option<u32>,
    before: u32,
    span: Option<Span>,
    wrap: Option<Wrap>,
    /// End of the last complete span, and its result.
    judged: Option<(Instant, CountedRate)>,
}

/// The numbering of one span, and its rates.
#[derive(Clone, Copy, Debug)]
pub(super) struct CountedRate {
    pub(super) count: Count,
    /// Packets a second; of a board that counts by one, with the lost ones.
    pub(super) hz: f32,
    /// Increase of the numbers a second, also over packets that did not come in.
    pub(super) numbers_hz: f32,
}

/// Packet counts of one span, by the difference from the previous number.
#[derive(Clone, Copy, Debug)]
struct Span {
    begun: Instant,
    packets: u32,
    same: u32,
    ones: u32,
    steps: u32,
    falls: u32,
    mixed: u32,
    jumps: u32,
    /// Sum, minimum and maximum of the steps.
    stepped: u64,
    least: u32,
    greatest: u32,
}

/// The number before a restart, and the number of such restarts in a row.
#[derive(Clone, Copy, Debug)]
struct Wrap {
    after: u32,
    times: u32,
}

impl Span {
    const fn at(begun: Instant) -> Self {
        Self {
            begun,
            packets: 0,
            same: 0,
            ones: 0,
            steps: 0,
            falls: 0,
            mixed: 0,
            jumps: 0,
            stepped: 0,
            least: u32::MAX,
            greatest: 0,
        }
    }

    /// Counts a number that differs by `step` from the previous one; `interleaves`: it follows the number before that
    /// one.
    fn add(&mut self, step: i32, interleaves: bool) {
        self.packets += 1;
        match step {
            0 => self.same += 1,
            1 => self.ones += 1,
            _ if interleaves => self.mixed += 1,
            -1 => self.falls += 1,
            2.. if step.unsigned_abs() <= LARGEST_STEP => {
                let step = step.unsigned_abs();
                self.steps += 1;
                self.stepped += u64::from(step);
                self.least = self.least.min(step);
                self.greatest = self.greatest.max(step);
            }
            _ => self.jumps += 1,
        }
    }

    /// Classifies the numbering of most packets.
    fn count(&self, last: u32) -> Count {
        let new = (self.packets - self.same) as f32;
        let share = |count: u32| count as f32 / new.max(1.0);
        if self.same as f32 >= 0.9 * self.packets as f32 {
            Count::Stands(last)
        } else if share(self.mixed) >= 0.3 {
            Count::Mixed
        } else if share(self.falls) >= 0.5 {
            Count::Falls
        } else if share(self.steps) >= 0.8 && self.greatest / 8 <= self.least {
            let mean = self.stepped as f64 / f64::from(self.steps);
            Count::Steps(mean.round() as u32)
        } else if share(self.ones) < 0.3 {
            Count::Jumps
        } else {
            Count::Steady
        }
    }

    /// The rates of a board with numbering `count`, over a span of `seconds`.
    fn rate(&self, count: Count, seconds: f32) -> CountedRate {
        let numbers_hz = (u64::from(self.ones) + self.stepped) as f32 / seconds;
        // Lost packets were samples as well.
        let hz = if count == Count::Steady { numbers_hz } else { self.packets as f32 / seconds };
        CountedRate { count, hz, numbers_hz }
    }
}

impl Cadence {
    /// Records the number of a packet that arrived at `received`.
    pub(super) fn note(&mut self, number: u32, received: Instant) {
        let Some(last) = self.last.replace(number) else {
            self.before = number;
            self.span = Some(Span::at(received));
            return;
        };
        let before = std::mem::replace(&mut self.before, last);
        let span = self.span.get_or_insert(Span::at(received));
        if number <= LOW && last > number.saturating_add(FALL) {
            self.begin_anew(last);
        } else {
            if self.wrap.is_some_and(|wrap| number > wrap.after.saturating_add(SLACK)) {
                self.wrap = None;
            }
            let step = number.wrapping_sub(last).cast_signed();
            span.add(step, number.wrapping_sub(before) == 1);
        }
        self.judge(received);
    }

    fn begin_anew(&mut self, last: u32) {
        let known = self.wrap.filter(|wrap| wrap.after.abs_diff(last) <= SLACK);
        self.wrap = Some(match known {
            Some(Wrap { after, times }) => Wrap { after: after.max(last), times: times + 1 },
            None => Wrap { after: last, times: 1 },
        });
    }

    fn judge(&mut self, now: Instant) {
        let Some(span) = self.span else { return };
        let passed = now.since(span.begun);
        if passed < SPAN || span.packets < FEWEST {
            return;
        }
        let count = match (span.count(self.before), self.wrap) {
            (Count::Steady, Some(wrap)) if wrap.times > 1 => Count::Restarts(wrap.after),
            (count, _) => count,
        };
        self.judged = Some((now, span.rate(count, passed.as_secs_f32())));
        self.span = Some(Span::at(now));
    }

    /// Returns the numbering and its rates; `None` if there is no recent classification.
    pub(super) fn judged(&self, now: Instant) -> Option<CountedRate> {
        /// Long enough for boards that send five packets in ten seconds.
        const LATELY: Duration = Duration::from_secs(10);
        let (at, found) = self.judged?;
        (now.since(at) < LATELY).then_some(found)
    }
}

impl Count {
    /// Returns the fault of board `board`, if this numbering is one.
    pub(super) const fn fault(self, board: u16) -> Option<LinkCause> {
        Some(match self {
            Self::Steady => return None,
            Self::Stands(number) => LinkCause::SequenceStands { board, number },
            Self::Steps(step) => LinkCause::SequenceStep { board, step },
            Self::Falls => LinkCause::SequenceFalls { board },
            Self::Restarts(after) => LinkCause::SequenceRestarts { board, after },
            Self::Mixed => LinkCause::SequenceMixed { board },
            Self::Jumps => LinkCause::SequenceJumps { board },
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Returns numbering and rate of a board after four seconds of `hz` packets a second with these numbers.
    fn judged(hz: u32, number: impl Fn(u32) -> u32) -> Option<(Count, f32)> {
        let mut cadence = Cadence::default();
        let packets = (0..4 * hz).map(|n| (number(n), u64::from(n) * 1_000_000 / u64::from(hz)));
        let mut end = Instant::START;
        for (number, at_us) in packets {
            end = Instant::from_micros(at_us);
            cadence.note(number, end);
        }
        cadence.judged(end).map(|found| (found.count, found.hz))
    }

    fn count(number: impl Fn(u32) -> u32) -> Count {
        judged(1000, number).unwrap().0
    }

    #[test]
    fn the_rate_of_a_board_that_counts_by_one_is_measured() {
        for hz in [20, 100, 140, 500, 1000, 2000, 4000] {
            let (count, measured) = judged(hz, |n| n).unwrap();
            assert_eq!(count, Count::Steady);
            assert!((measured / hz as f32 - 1.0).abs() < 0.03, "{hz}: {measured}");
        }
    }

    #[test]
    fn a_board_that_loses_every_third_packet_keeps_its_rate() {
        let (count, hz) = judged(1000, |n| n + n / 2).unwrap();
        assert_eq!(count, Count::Steady);
        assert!((hz - 1500.0).abs() < 20.0, "{hz}");
    }

    #[test]
    fn counts_that_are_none_are_told_apart() {
        assert_eq!(count(|_| 0), Count::Stands(0));
        assert_eq!(count(|n| 2 * n), Count::Steps(2));
        assert_eq!(count(|n| 1000 * n), Count::Steps(1000));
        // A little-endian counter.
        assert_eq!(count(u32::swap_bytes), Count::Steps(1 << 24));
        assert_eq!(count(|n| 100_000 - n), Count::Falls);
        assert_eq!(count(|n| n % 256), Count::Restarts(255));
        // Two programs that were started 3 s apart, and two that were started almost together.
        assert_eq!(count(|n| n / 2 + 3000 * (n % 2)), Count::Mixed);
        assert_eq!(count(|n| n / 2 + 5 * (n % 2)), Count::Mixed);
        assert_eq!(count(|n| n.wrapping_mul(2_654_435_761)), Count::Jumps);
    }

    #[test]
    fn milliseconds_as_numbers_are_a_step_at_100_hz_and_a_count_at_1000_hz() {
        assert_eq!(judged(100, |n| 10 * n + n % 2).unwrap().0, Count::Steps(10));
        assert_eq!(judged(1000, |n| n).unwrap().0, Count::Steady);
    }

    #[test]
    fn one_reboot_is_no_fault() {
        assert_eq!(count(|n| if n < 2000 { n + 500 } else { n - 2000 }), Count::Steady);
    }

    #[test]
    fn a_counter_of_16_bits_is_known_after_it_began_anew_twice() {
        let mut cadence = Cadence::default();
        let mut counts = Vec::new();
        for ms in 0..145_000_u32 {
            let now = Instant::from_millis(ms.into());
            cadence.note(ms % 65_536, now);
            if ms % 10_000 == 0 {
                counts.extend(cadence.judged(now).map(|found| found.count));
            }
        }
        assert_eq!(counts.first(), Some(&Count::Steady));
        assert_eq!(counts.last(), Some(&Count::Restarts(65_535)));
    }

    proptest! {
        /// Losses, repetitions and overtaking on the network are not faults of the board.
        #[test]
        fn losses_repetitions_and_overtaking_are_no_faults(
            seed: u32,
            lost_percent in 0_u32..40,
            repeated_percent in 0_u32..90,
        ) {
            let chance = |n: u32, salt: u32| (n ^ seed).wrapping_add(salt).wrapping_mul(2_654_435_761) >> 16 & 127;
            let mut cadence = Cadence::default();
            for n in 0..4000 {
                let now = Instant::from_millis(n.into());
                if chance(n, 1) * 100 / 128 < lost_percent {
                    continue;
                }
                // Some pairs of packets swap places.
                cadence.note(if n % 50 < 2 { n ^ 1 } else { n }, now);
                if chance(n, 2) * 100 / 128 < repeated_percent {
                    cadence.note(n, now);
                }
            }
            let CountedRate { count, hz, .. } = cadence.judged(Instant::from_millis(4000)).unwrap();
            prop_assert_eq!(count, Count::Steady);
            prop_assert!((hz / 1000.0 - 1.0).abs() < 0.2, "{}", hz);
        }
    }
}
