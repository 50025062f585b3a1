//! The sampling times of a board with a rate of its own, from its numbers and the arrival of its packets.

use super::clock::SLOT_NS;
use super::numbering::TimeBase;
use super::pace::PacketPace;
use super::presence::LossMeter;
use crate::wire::LinkCounters;

/// Rate (ns per s) at which the estimated way of the packets may grow: faster than clocks of boards drift and than
/// their rate is measured wrongly. It shrinks at once.
const LEAK_NS_PER_S: f64 = 5_000_000.0;

/// Maximum lead of a number over its packet's arrival, and its maximum lag, beyond which the number is no successor of
/// the last: at least 20 ms and two periods, and at least a second.
const LEAD_NS: i64 = 20 * SLOT_NS;
const LAG_NS: i64 = 1000 * SLOT_NS;

/// Age from which a sample is useless: newer ones follow. At least three periods.
const TOO_OLD_NS: i64 = 100 * SLOT_NS;

/// Number of packets that must agree before a jump of the numbers is accepted.
const CONFIRMED: u8 = 3;

/// Packets in the average of the jitter.
const JITTER_PACKETS: f64 = 64.0;

/// The packets of one board at its own rate, and the instants of its samples on the receive clock.
///
/// With numbers, a sample's instant is the board's own time plus the shortest way of recent packets, and never later
/// than its arrival: t = u + min(arrival - u). Without, it is the arrival, and so it is for a board that is asked for
/// each packet: the number counts answers, whose intervals depend on this computer.
#[derive(Clone, Debug)]
pub(super) struct TimedStream {
    base: TimeBase,
    /// Whether its board is asked for each packet.
    is_asked: bool,
    pace: PacketPace,
    /// `None` before the first packet.
    last: Option<LastPacket>,
    /// Number of packets sent so far, also lost ones.
    position: i64,
    /// Mean deviation of the packets' way from the shortest one; without numbers, of their intervals from the period.
    jitter_ns: f64,
    jump: Option<NumberJump>,
}

/// The last packet that was in order.
#[derive(Clone, Copy, Debug)]
struct LastPacket {
    number: u32,
    arrived_ns: i64,
    /// The board's own time.
    own_ns: i64,
    /// Its time on the receive clock less its own time.
    offset_ns: i64,
}

/// Numbers that do not follow the last ones, and may begin a new stream.
#[derive(Clone, Copy, Debug)]
struct NumberJump {
    number: u32,
    arrived_ns: i64,
    agreeing: u8,
}

/// A sample's instant on the receive clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SampleTime {
    pub(super) sampled_ns: i64,
    /// Whether its board has just rebooted.
    pub(super) restarted: bool,
}

impl TimedStream {
    /// A board of so many slots from packet to packet.
    pub(super) fn new(base: TimeBase, pace: PacketPace) -> Self {
        Self { base, is_asked: false, pace, last: None, position: 0, jitter_ns: 0.0, jump: None }
    }

    /// A board that is asked for each packet: its time base stays.
    pub(super) fn asked(pace: PacketPace) -> Self {
        Self { is_asked: true, ..Self::new(TimeBase::Arrival, pace) }
    }

    pub(super) const fn base(&self) -> TimeBase {
        self.base
    }

    pub(super) const fn pace(&self) -> &PacketPace {
        &self.pace
    }

    /// Time from one packet to the next.
    pub(super) fn period_ns(&self) -> i64 {
        self.pace.period_ns()
    }

    /// Mean deviation of the samples' times.
    pub(super) const fn jitter_ns(&self) -> i64 {
        self.jitter_ns as i64
    }

    /// Takes another time base, if its board is not asked; returns whether it does.
    pub(super) fn rebase(&mut self, base: TimeBase) -> bool {
        let is_other = base != self.base && !self.is_asked;
        if is_other {
            self.base = base;
            self.restart();
        }
        is_other
    }

    /// Begins anew: after a silence, nothing is known of the numbers.
    pub(super) fn restart(&mut self) {
        (self.last, self.jump) = (None, None);
        self.pace.forget();
    }

    /// Adopts a measured rate that differs; returns whether it does.
    pub(super) fn adopt_pace(&mut self) -> bool {
        self.pace.adopt()
    }

    /// Finds the instant of the sample of the packet with this `number` that arrived at `now_ns`; `is_other`: its
    /// readings differ from those of the packet before. Returns `None` for a dropped packet, and counts it.
    pub(super) fn place(
        &mut self,
        number: u32,
        now_ns: i64,
        is_other: bool,
        loss: &mut LossMeter,
        counters: &mut LinkCounters,
    ) -> Option<SampleTime> {
        let Some(last) = self.last else {
            self.begin(number, now_ns);
            return Some(SampleTime { sampled_ns: now_ns, restarted: false });
        };
        let now_ns = now_ns.max(last.arrived_ns);
        let step = i64::from(number.wrapping_sub(last.number).cast_signed());
        if self.base == TimeBase::Arrival {
            // Answers are counted, also those that are rejected.
            let rejected = if self.is_asked { (step - 1).max(0) } else { 0 };
            self.count(now_ns, rejected, loss, counters);
            let off = (now_ns - last.arrived_ns - self.period_ns()).abs();
            self.note_jitter(off);
            self.last = Some(LastPacket { number, arrived_ns: now_ns, ..last });
            return Some(SampleTime { sampled_ns: now_ns, restarted: false });
        }
        if step == 0 && !(self.base == TimeBase::Milliseconds && is_other) {
            counters.duplicate += 1;
            return None;
        }
        let passed_ns = self.own_ns(step);
        let lag_ns = now_ns - (last.own_ns + passed_ns + last.offset_ns);
        let most_lead_ns = LEAD_NS.max(2 * self.period_ns());
        if lag_ns < -most_lead_ns || lag_ns > LAG_NS.max(20 * self.period_ns()) {
            return self.jump(number, now_ns, counters);
        }
        self.jump = None;
        if step < 0 {
            // It was overtaken: its sample is older than the one in use.
            counters.late += 1;
            if self.skipped(2 * self.period_ns()) > 0 {
                counters.lost = counters.lost.saturating_sub(1);
                loss.found();
            } else {
                // Stamps are too coarse to show one lost packet: it was not counted as one.
                self.position += 1;
            }
            return None;
        }
        self.count(now_ns, self.skipped(passed_ns), loss, counters);
        let own_ns = last.own_ns + passed_ns;
        let leak_ns = ((now_ns - last.arrived_ns) as f64 * LEAK_NS_PER_S / 1e9) as i64;
        let offset_ns = (last.offset_ns + leak_ns).min(now_ns - own_ns);
        self.last = Some(LastPacket { number, arrived_ns: now_ns, own_ns, offset_ns });
        let sampled_ns = own_ns + offset_ns;
        self.note_jitter(now_ns - sampled_ns);
        if now_ns - sampled_ns > TOO_OLD_NS.max(3 * self.period_ns()) {
            counters.late += 1;
            return None;
        }
        Some(SampleTime { sampled_ns, restarted: false })
    }

    fn begin(&mut self, number: u32, now_ns: i64) {
        self.last = Some(LastPacket { number, arrived_ns: now_ns, own_ns: 0, offset_ns: now_ns });
        self.jump = None;
        self.position += 1;
        self.pace.note(now_ns, self.position);
    }

    /// The board's own time over so many steps of its number.
    fn own_ns(&self, step: i64) -> i64 {
        match self.base {
            TimeBase::Milliseconds => step.saturating_mul(SLOT_NS),
            TimeBase::Packets | TimeBase::Arrival => (step as f64 * self.pace.exact_period_ns()) as i64,
        }
    }

    /// The number of lost packets in so much of the board's own time; by milliseconds, the least that the two stamps
    /// allow, each of which is up to a millisecond early.
    fn skipped(&self, passed_ns: i64) -> i64 {
        let period_ns = self.period_ns();
        let periods = match self.base {
            TimeBase::Milliseconds => (passed_ns - SLOT_NS + period_ns - 1) / period_ns,
            TimeBase::Packets | TimeBase::Arrival => (passed_ns + period_ns / 2) / period_ns,
        };
        (periods - 1).max(0)
    }

    /// Counts a packet after `skipped` lost ones.
    fn count(&mut self, now_ns: i64, skipped: i64, loss: &mut LossMeter, counters: &mut LinkCounters) {
        // A clock of milliseconds does not tell a lost packet from a pause; both are a gap.
        self.position += skipped + 1;
        self.pace.note(now_ns, self.position);
        counters.lost += skipped.cast_unsigned();
        loss.pass(u32::try_from(skipped).unwrap_or(u32::MAX), true);
    }

    fn note_jitter(&mut self, off_ns: i64) {
        // A gap is none.
        let off_ns = off_ns.min(2 * self.period_ns()) as f64;
        self.jitter_ns += (off_ns - self.jitter_ns) / JITTER_PACKETS;
    }

    /// Notes a number that does not follow the last one; begins anew when three agree.
    fn jump(&mut self, number: u32, now_ns: i64, counters: &mut LinkCounters) -> Option<SampleTime> {
        let agreeing = match self.jump {
            Some(jump) if number == jump.number && self.base == TimeBase::Packets => {
                counters.duplicate += 1;
                return None;
            }
            Some(jump) => {
                let step = i64::from(number.wrapping_sub(jump.number).cast_signed());
                let lead_ns = self.own_ns(step) - (now_ns - jump.arrived_ns);
                let follows = step >= 0 && lead_ns.abs() < LEAD_NS.max(2 * self.period_ns());
                if follows { jump.agreeing + 1 } else { 1 }
            }
            None => 1,
        };
        self.jump = Some(NumberJump { number, arrived_ns: now_ns, agreeing });
        if agreeing < CONFIRMED {
            counters.out_of_order += 1;
            return None;
        }
        counters.restarts += 1;
        self.restart();
        self.begin(number, now_ns);
        Some(SampleTime { sampled_ns: now_ns, restarted: true })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A packet: its number, the instant of its sample and its arrival, in nanoseconds.
    type Packet = (u32, i64, i64);

    /// The samples that a stream of this base and rate gives for `packets`: true and found instants.
    fn placed(base: TimeBase, hz: f64, packets: &[Packet]) -> Vec<(i64, i64)> {
        let mut stream = TimedStream::new(base, PacketPace::of_rate(hz as f32));
        let (mut loss, mut counters) = (LossMeter::default(), LinkCounters::default());
        let mut place = |&(number, sampled_ns, arrives_ns): &Packet| {
            let found = stream.place(number, arrives_ns, true, &mut loss, &mut counters);
            stream.adopt_pace();
            found.map(|found| (sampled_ns, found.sampled_ns))
        };
        packets.iter().filter_map(&mut place).collect()
    }

    /// Packets of a board at `hz` whose clock is off by `share`, numbered from `first` on, each `way` on its way.
    fn sent(base: TimeBase, hz: f64, share: f64, first: u32, ways_ns: &[i64]) -> Vec<Packet> {
        let packet = |(n, way_ns): (u32, &i64)| {
            let own_ms = f64::from(n) * 1000.0 / hz;
            let number = match base {
                TimeBase::Packets => n,
                TimeBase::Milliseconds => own_ms as u32,
                TimeBase::Arrival => 0,
            };
            let sampled_ns = (own_ms * (1.0 + share) * 1e6) as i64;
            (first.wrapping_add(number), sampled_ns, sampled_ns + way_ns)
        };
        let mut packets: Vec<Packet> = (0..).zip(ways_ns).map(packet).collect();
        packets.sort_by_key(|packet| packet.2);
        packets
    }

    fn bases() -> impl Strategy<Value = TimeBase> {
        prop::sample::select(vec![TimeBase::Packets, TimeBase::Milliseconds])
    }

    fn rates() -> impl Strategy<Value = f64> {
        prop::sample::select(vec![20.0, 50.0, 80.0, 100.0, 200.0, 500.0, 2000.0, 4000.0])
    }

    proptest! {
        /// Numbers that wrap, ways with jitter that let packets overtake each other, lost packets, clocks that drift:
        /// the instants rise, lie before the arrival, and are right to within the shortest way and a few milliseconds.
        #[test]
        fn instants_are_those_of_the_samples(
            base in bases(),
            hz in rates(),
            share in -0.0005..0.0005,
            first in prop::sample::select(vec![0, u32::MAX - 40, u32::MAX / 2 - 40]),
            ways in prop::collection::vec((0_i64..15_000_000, prop::bool::weighted(0.9)), 200..600),
        ) {
            let ways_ns: Vec<i64> = ways.iter().map(|(way, _)| 500_000 + way).collect();
            let all = sent(base, hz, share, first, &ways_ns);
            let kept: Vec<Packet> =
                all.iter().zip(&ways).filter(|(_, (_, comes))| *comes).map(|(packet, _)| *packet).collect();
            let placed = placed(base, hz, &kept);
            prop_assert!(placed.len() * 2 > kept.len() || hz > 100.0, "{} of {}", placed.len(), kept.len());
            for pair in placed.windows(2) {
                prop_assert!(pair[1].1 >= pair[0].1 - 2_000_000, "{:?}", pair);
            }
            for (sampled_ns, found_ns) in placed.iter().skip(40) {
                prop_assert!((found_ns - sampled_ns).abs() < 16_000_000, "{} ns", found_ns - sampled_ns);
            }
        }

        /// One damaged number moves nothing; a board that starts anew is back after three packets.
        #[test]
        fn damaged_numbers_move_nothing_and_a_restart_is_followed(
            base in bases(),
            hz in rates(),
            bit in 12_u32..31,
        ) {
            let mut packets = sent(base, hz, 0.0, 100_000, &[1_000_000; 400]);
            packets[100].0 ^= 1 << bit;
            let end = packets[300].1;
            for packet in &mut packets[300..] {
                packet.0 = packet.0.wrapping_sub(90_000);
            }
            let placed = placed(base, hz, &packets);
            for (sampled_ns, found_ns) in &placed {
                prop_assert!((found_ns - sampled_ns).abs() < 3_000_000, "{} ns", found_ns - sampled_ns);
            }
            let later = placed.iter().filter(|(sampled_ns, _)| *sampled_ns >= end).count();
            prop_assert!(later >= 90, "{} after the restart", later);
        }
    }

    #[test]
    fn without_numbers_the_arrival_is_the_time() {
        let packets = sent(TimeBase::Arrival, 100.0, 0.0, 0, &[700_000; 50]);
        let placed = placed(TimeBase::Arrival, 100.0, &packets);
        assert_eq!(placed.len(), 50);
        assert!(placed.iter().all(|(sampled_ns, found_ns)| found_ns - sampled_ns == 700_000));
    }
}
