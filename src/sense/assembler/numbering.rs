//! How a board numbers its packets: by ones, by a clock of milliseconds, or not at all.

use super::clock::SLOT_NS;

/// Source of the time of a board's samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TimeBase {
    /// The number counts packets: time = number / rate.
    #[default]
    Packets,
    /// The number is a time in milliseconds.
    Milliseconds,
    /// The packets have no useful number: their arrival is their time, with the jitter of the way.
    Arrival,
}

impl TimeBase {
    /// Its name in JSON: `packets`, `milliseconds` or `arrival`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Packets => "packets",
            Self::Milliseconds => "milliseconds",
            Self::Arrival => "arrival",
        }
    }
}

/// Time over which the numbers are classified; two spans must agree.
const SPAN_NS: i64 = 250 * SLOT_NS;

/// Minimum number of packets in a span: a board at 20 Hz sends five.
const FEWEST: u32 = 5;

/// Packets with one number and different readings, from the start on, after which a board has no useful number, and
/// the time after which the first such packet is enough: a network repeats a packet sooner.
const UNNUMBERED: u32 = 3;
const UNNUMBERED_NS: i64 = 15 * SLOT_NS;

/// Rates that so few packets may show, in packets a second.
const FEW_HZ: [f32; 2] = [10.0, 4000.0];

/// Share of repeated numbers above which a number stands still.
const STANDS: f64 = 0.9;

/// Minimum mean step of a clock of milliseconds. Below it, a number that counts 1000 packets a second and loses some
/// looks the same, and means the same time.
const LEAST_STEP: f64 = 1.8;

/// Minimum share of repeated numbers with other readings of a board that sends several packets a millisecond. Packets
/// that are damaged on the way and come again are fewer.
const REPEATED: f64 = 0.3;

/// Maximum relative difference between the steps of a clock of milliseconds and the time of arrival: a burst of
/// delayed packets at one end of a span.
const OFF: f64 = 0.12;

/// The time base of a board's numbers, and the rate of its packets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NumberVerdict {
    pub(super) base: TimeBase,
    /// Packets a second that arrived.
    pub(super) hz: f32,
}

/// The numbers of one board's packets, over the present span and the one before.
#[derive(Clone, Debug, Default)]
pub(super) struct PacketNumbers {
    last: Option<u32>,
    begun_ns: i64,
    /// Steps of the present span: all, those of one, those of zero, and those of zero with other readings.
    steps: u32,
    ones: u32,
    same: u32,
    same_news: u32,
    /// Sum and sum of squares of the other steps.
    sum: i64,
    squares: f64,
    /// Whether any number differed from the one before.
    has_moved: bool,
    /// The verdict of the last span.
    before: Option<TimeBase>,
}

impl PacketNumbers {
    /// The number of the last packet.
    pub(super) const fn last(&self) -> Option<u32> {
        self.last
    }

    /// Notes the number of a packet that arrived at `now_ns`; `is_other`: its readings differ from those of the packet
    /// before, if that has the same number. Returns the time base on which two spans agree, when a span ends, or that
    /// of a board without useful numbers from the start on.
    pub(super) fn note(&mut self, number: u32, now_ns: i64, is_other: bool) -> Option<NumberVerdict> {
        let Some(last) = self.last.replace(number) else {
            self.begun_ns = now_ns;
            return None;
        };
        self.steps += 1;
        match number.wrapping_sub(last).cast_signed() {
            1 => self.ones += 1,
            0 => {
                self.same += 1;
                self.same_news += u32::from(is_other);
                let is_enough = self.same_news >= UNNUMBERED || now_ns - self.begun_ns >= UNNUMBERED_NS;
                if self.same_news > 0 && is_enough && self.same == self.steps && !self.has_moved {
                    let ms = ((now_ns - self.begun_ns) as f32 / SLOT_NS as f32).max(0.1);
                    let hz = (1000.0 * self.steps as f32 / ms).clamp(FEW_HZ[0], FEW_HZ[1]);
                    return Some(NumberVerdict { base: TimeBase::Arrival, hz });
                }
            }
            step => {
                self.sum += i64::from(step);
                self.squares += f64::from(step) * f64::from(step);
            }
        }
        if now_ns - self.begun_ns < SPAN_NS || self.steps < FEWEST {
            return None;
        }
        self.end_span(now_ns)
    }

    fn end_span(&mut self, now_ns: i64) -> Option<NumberVerdict> {
        self.has_moved |= self.same < self.steps;
        let ms = (now_ns - self.begun_ns) as f64 / SLOT_NS as f64;
        let verdict = self.verdict(ms);
        let hz = (1000.0 * f64::from(self.steps) / ms) as f32;
        let agreed =
            verdict.filter(|verdict| self.before == Some(*verdict)).map(|base| NumberVerdict { base, hz });
        let Self { last, has_moved, .. } = *self;
        *self = Self { last, has_moved, begun_ns: now_ns, before: verdict, ..Self::default() };
        agreed
    }

    /// The time base of a span of `ms` milliseconds; `None` if the numbers follow none.
    fn verdict(&self, ms: f64) -> Option<TimeBase> {
        let (steps, same) = (f64::from(self.steps), f64::from(self.same));
        let sum = f64::from(self.ones) + self.sum as f64;
        if same >= STANDS * steps {
            // A program that hangs and repeats its last packet has counted before.
            let is_alive = !self.has_moved || 2 * self.same_news >= self.same;
            return is_alive.then_some(TimeBase::Arrival);
        }
        let follows_the_clock = (sum / ms - 1.0).abs() < OFF;
        let mean = sum / steps;
        // Steps between lost packets are geometric, with a variance of m (m - 1); those of a clock are even.
        let variance = (f64::from(self.ones) + self.squares) / steps - mean * mean;
        let is_even = variance < 0.5 * mean * (mean - 1.0);
        let is_repeated = same >= REPEATED * steps && 2 * self.same_news >= self.same;
        if follows_the_clock && (is_repeated || mean >= LEAST_STEP && is_even) {
            return Some(TimeBase::Milliseconds);
        }
        (2 * self.ones >= self.steps && sum > 0.0).then_some(TimeBase::Packets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The time base after three seconds of packets with these numbers and arrival times in milliseconds.
    fn base(packets: impl Iterator<Item = (u32, f64)>) -> Option<TimeBase> {
        let mut numbers = PacketNumbers::default();
        packets
            .filter_map(|(number, ms)| numbers.note(number, (ms * SLOT_NS as f64) as i64, true))
            .last()
            .map(|found| found.base)
    }

    /// Pseudorandom, 0 to 1.
    fn chance(at: u32) -> f64 {
        let mixed = at.wrapping_add(1).wrapping_mul(2_654_435_761);
        f64::from((mixed ^ mixed >> 13).wrapping_mul(2_246_822_519) >> 8) / f64::from(1_u32 << 24)
    }

    const RATES: [u32; 9] = [20, 50, 80, 100, 200, 500, 1000, 2000, 4000];

    #[test]
    fn each_time_base_is_known_at_each_rate() {
        for hz in RATES {
            let at = |n: u32| f64::from(n) * 1000.0 / f64::from(hz) + 2.0 * chance(n);
            let packets = || (0..3 * hz).map(|n| (n, at(n)));
            assert_eq!(base(packets()), Some(TimeBase::Packets), "{hz} Hz");
            assert_eq!(base(packets().map(|(_, ms)| (7, ms))), Some(TimeBase::Arrival), "{hz} Hz");
            let stamped = base(packets().map(|(n, ms)| ((u64::from(n) * 1000 / u64::from(hz)) as u32, ms)));
            // At 1000 Hz both are the same.
            let expected = if hz == 1000 { TimeBase::Packets } else { TimeBase::Milliseconds };
            assert_eq!(stamped, Some(expected), "{hz} Hz");
        }
    }

    #[test]
    fn a_number_that_counts_and_loses_packets_is_no_clock() {
        for lost in [0.1, 0.3, 0.5, 0.8] {
            let packets = (0..3000).filter(|n| chance(*n) >= lost).map(|n| (n, f64::from(n)));
            assert_ne!(base(packets), Some(TimeBase::Milliseconds), "{lost} lost");
        }
    }

    #[test]
    fn packets_that_come_twice_are_no_clock() {
        let mut numbers = PacketNumbers::default();
        let packets = (0..6000_u32).map(|n| (n / 2, i64::from(n / 2) * SLOT_NS));
        let last = packets.filter_map(|(number, at)| numbers.note(number, at, false)).last();
        assert_ne!(last.map(|found| found.base), Some(TimeBase::Milliseconds));
    }

    #[test]
    fn packets_that_are_damaged_and_come_again_are_no_clock() {
        let packets = (0..3000).flat_map(|n| {
            let again = (chance(n) < 0.2).then_some((n, f64::from(n) + 0.3));
            [Some((n, f64::from(n))), again].into_iter().flatten()
        });
        assert_eq!(base(packets), Some(TimeBase::Packets));
    }

    #[test]
    fn a_board_that_hangs_and_repeats_its_last_packet_has_no_time() {
        let mut numbers = PacketNumbers::default();
        for n in 0..3000_u32 {
            let base = numbers.note(n.min(1000), i64::from(n) * SLOT_NS, false);
            assert_ne!(base.map(|found| found.base), Some(TimeBase::Arrival));
        }
    }
}
