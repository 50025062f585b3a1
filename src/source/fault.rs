//! Faults on the way of packets: losses, repetitions, delays, damage, outages.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::{SensorSource, SourceError};
use crate::units::Instant;
use crate::wire::{LinkCounters, Readings, SensorPacket};

/// What goes wrong on the way from the boards; the default is nothing.
///
/// Shares are between 0 (never) and 1 (always); what lies outside counts as
/// the nearer of the two, NaN as 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Faults {
    /// Share of packets lost, each by itself.
    pub loss: f64,
    /// Times at which all packets are lost, over and over.
    pub bursts: Option<Bursts>,
    /// Share of packets that come a second time, at once.
    pub duplicate: f64,
    /// Share of packets that take longer, and so are overtaken by others.
    pub delay: f64,
    /// The most that a delayed packet takes longer.
    pub delay_up_to: Duration,
    /// Share of packets with one damaged number: a bit of the sequence or one reading.
    pub damage: f64,
    /// Times at which boards are unplugged.
    pub outages: Vec<Outage>,
    /// Times at which nothing arrives, to come all at once at the end.
    pub stalls: Vec<Stall>,
}

/// Losses that come in bursts: one of `length` at the start of every `every`, but not of the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bursts {
    /// From one burst to the next.
    pub every: Duration,
    /// How long each lasts.
    pub length: Duration,
}

/// A time during which one board, or the whole floor, is unplugged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outage {
    /// Which board; `None` for all.
    pub board: Option<u16>,
    /// From when.
    pub from: Instant,
    /// Until when, not included.
    pub until: Instant,
}

/// A time during which packets are held back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stall {
    /// From when.
    pub from: Instant,
    /// When all that was held back arrives.
    pub until: Instant,
}

/// A source whose packets get lost, doubled, delayed or damaged on the way; the same seed does the same.
#[derive(Debug)]
pub struct FaultInjector<S> {
    inner: S,
    faults: Faults,
    rng: Pcg64Mcg,
    /// Packets on the way, the next to arrive first.
    on_the_way: BinaryHeap<Reverse<OnTheWay>>,
    admitted: u64,
    now: Instant,
}

impl<S: SensorSource> FaultInjector<S> {
    /// `inner` with these faults.
    #[must_use]
    pub fn new(inner: S, faults: Faults, seed: u64) -> Self {
        let rng = Pcg64Mcg::seed_from_u64(seed);
        Self { inner, faults, rng, on_the_way: BinaryHeap::new(), admitted: 0, now: Instant::START }
    }

    /// The source behind the faults.
    pub const fn inner_mut(&mut self) -> &mut S {
        &mut self.inner
    }

    fn chance(&mut self, share: f64) -> bool {
        // Drawn even for a share of 0, so that one fault's share does not change what the others do.
        self.rng.random::<f64>() < share
    }

    /// Decides what becomes of a packet.
    fn admit(&mut self, mut packet: SensorPacket) {
        let at = packet.received;
        let lost = self.chance(self.faults.loss);
        let doubled = self.chance(self.faults.duplicate);
        let delayed = self.chance(self.faults.delay);
        let damaged = self.chance(self.faults.damage);
        let delay = self.faults.delay_up_to.mul_f64(self.rng.random());
        let within = |from: Instant, until: Instant| from <= at && at < until;
        let unplugged = self.faults.outages.iter().any(|outage| {
            outage.board.is_none_or(|board| board == packet.board) && within(outage.from, outage.until)
        });
        if lost || unplugged || self.faults.bursts.is_some_and(|bursts| bursts.hit(at)) {
            return;
        }
        if damaged {
            self.damage(&mut packet);
        }
        let mut due = if delayed { at + delay } else { at };
        for stall in &self.faults.stalls {
            if stall.from <= due && due < stall.until {
                due = stall.until;
            }
        }
        if doubled {
            self.send(due, packet.clone());
        }
        self.send(due, packet);
    }

    fn send(&mut self, due: Instant, packet: SensorPacket) {
        self.admitted += 1;
        self.on_the_way.push(Reverse(OnTheWay { due, order: self.admitted, packet }));
    }

    fn damage(&mut self, packet: &mut SensorPacket) {
        let channels = packet.readings.len();
        if channels == 0 || self.rng.random::<bool>() {
            packet.sequence ^= 1 << self.rng.random_range(0..32);
            return;
        }
        let channel = self.rng.random_range(0..channels);
        match &mut packet.readings {
            Readings::Counts(counts) => counts[channel] = None,
            Readings::Newtons(forces) => forces[channel] = f32::NAN,
        }
    }

    /// The next packet that has arrived by now.
    fn arrive(&mut self) -> Option<SensorPacket> {
        if self.on_the_way.peek()?.0.due > self.now {
            return None;
        }
        let Reverse(OnTheWay { due, mut packet, .. }) = self.on_the_way.pop()?;
        packet.received = due;
        Some(packet)
    }
}

impl<S: SensorSource> SensorSource for FaultInjector<S> {
    /// Gives `None` when `patience` has passed on the inner source's clock without a packet getting
    /// through, or when that source gives `None`. What is still on its way when the inner source
    /// ends arrives before the end.
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        let begun = self.now();
        loop {
            if let Some(packet) = self.arrive() {
                return Ok(Some(packet));
            }
            match self.inner.next(patience) {
                Ok(Some(packet)) => {
                    self.now = self.now.max(packet.received);
                    self.admit(packet);
                }
                Ok(None) => {
                    self.now = self.now.max(self.inner.now());
                    return Ok(self.arrive());
                }
                Err(SourceError::Ended) if !self.on_the_way.is_empty() => {
                    let last = self.on_the_way.iter().map(|packet| packet.0.due).max();
                    self.now = self.now.max(last.unwrap_or_default());
                }
                Err(error) => return Err(error),
            }
            self.now = self.now.max(self.inner.now());
            if self.now.since(begun) >= patience
                && self.on_the_way.peek().is_none_or(|next| next.0.due > self.now)
            {
                return Ok(None);
            }
        }
    }

    fn now(&self) -> Instant {
        self.now.max(self.inner.now())
    }

    fn counters(&self) -> LinkCounters {
        self.inner.counters()
    }
}

impl Bursts {
    fn hit(self, at: Instant) -> bool {
        let every = self.every.as_micros().max(1);
        let at = u128::from(at.micros());
        at >= every && at % every < self.length.as_micros()
    }
}

/// A packet that has not arrived yet; ordered by arrival.
#[derive(Debug)]
struct OnTheWay {
    due: Instant,
    order: u64,
    packet: SensorPacket,
}

impl Ord for OnTheWay {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        (self.due, self.order).cmp(&(other.due, other.order))
    }
}

impl PartialOrd for OnTheWay {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for OnTheWay {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for OnTheWay {}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two boards, a packet each per millisecond, for a second.
    struct Boards(std::vec::IntoIter<SensorPacket>, Instant);

    fn boards() -> Boards {
        let packets: Vec<_> = (0..1000).flat_map(|ms| (0..2).map(move |board| packet(board, ms))).collect();
        Boards(packets.into_iter(), Instant::START)
    }

    fn packet(board: u16, ms: u32) -> SensorPacket {
        let readings = Readings::Counts([Some(7); 4].into_iter().collect());
        SensorPacket { board, sequence: ms, received: Instant::from_millis(ms.into()), readings }
    }

    impl SensorSource for Boards {
        fn next(&mut self, _: Duration) -> Result<Option<SensorPacket>, SourceError> {
            let packet = self.0.next().ok_or(SourceError::Ended)?;
            self.1 = packet.received;
            Ok(Some(packet))
        }

        fn now(&self) -> Instant {
            self.1
        }
    }

    /// All packets that get through, and how often the source found none within 10 ms.
    fn through(faults: Faults, seed: u64) -> (Vec<SensorPacket>, usize) {
        let mut source = FaultInjector::new(boards(), faults, seed);
        let (mut packets, mut silences) = (Vec::new(), 0);
        loop {
            match source.next(Duration::from_millis(10)) {
                Ok(Some(packet)) => packets.push(packet),
                Ok(None) => silences += 1,
                Err(SourceError::Ended) => return (packets, silences),
                Err(error) => panic!("{error}"),
            }
        }
    }

    #[test]
    fn without_faults_nothing_changes() {
        let (packets, silences) = through(Faults::default(), 1);
        assert_eq!(packets, boards().0.collect::<Vec<_>>());
        assert_eq!(silences, 0);
    }

    #[test]
    fn a_fifth_is_lost_and_another_seed_loses_others() {
        let lossy = Faults { loss: 0.2, ..Faults::default() };
        let (packets, _) = through(lossy.clone(), 1);
        assert!((1520..1680).contains(&packets.len()), "{}", packets.len());
        assert_eq!(packets, through(lossy.clone(), 1).0);
        assert_ne!(packets, through(lossy, 2).0);
    }

    #[test]
    fn delayed_packets_are_overtaken_and_stamped_when_they_arrive() {
        let slow = Faults { delay: 0.3, delay_up_to: Duration::from_millis(5), ..Faults::default() };
        let (packets, _) = through(slow, 1);
        assert_eq!(packets.len(), 2000);
        assert!(packets.is_sorted_by_key(|packet| packet.received));
        assert!(!packets.is_sorted_by_key(|packet| packet.sequence));
        let longest = packets.iter().map(|p| p.received.micros() - u64::from(p.sequence) * 1000).max();
        assert!((4000..=5000).contains(&longest.unwrap()));
    }

    #[test]
    fn an_unplugged_board_leaves_the_other_and_an_unplugged_floor_silence() {
        let during = |board| Faults {
            outages: vec![Outage {
                board,
                from: Instant::from_millis(100),
                until: Instant::from_millis(300),
            }],
            ..Faults::default()
        };
        let (packets, silences) = through(during(Some(1)), 1);
        assert_eq!((packets.len(), silences), (1800, 0));
        let (packets, silences) = through(during(None), 1);
        assert_eq!(packets.len(), 1600);
        assert!((19..=21).contains(&silences), "{silences} times 10 ms");
    }

    #[test]
    fn a_stall_holds_everything_back_and_lets_it_go_at_once() {
        let until = Instant::from_millis(300);
        let faults =
            Faults { stalls: vec![Stall { from: Instant::from_millis(100), until }], ..Faults::default() };
        let (packets, _) = through(faults, 1);
        assert_eq!(packets.len(), 2000);
        assert_eq!(packets.iter().filter(|packet| packet.received == until).count(), 402);
    }

    #[test]
    fn bursts_doubles_and_damage_do_what_they_say() {
        let bursts = Some(Bursts { every: Duration::from_millis(100), length: Duration::from_millis(20) });
        assert_eq!(through(Faults { bursts, ..Faults::default() }, 1).0.len(), 2000 - 9 * 2 * 20);
        assert_eq!(through(Faults { duplicate: 1.0, ..Faults::default() }, 1).0.len(), 4000);
        let (damaged, _) = through(Faults { damage: 1.0, ..Faults::default() }, 1);
        let whole: Vec<_> = boards().0.collect();
        assert!(damaged.iter().zip(&whole).all(|(damaged, whole)| damaged != whole));
    }
}
