//! Faults between the boards and the floor program: lost, duplicated, delayed and damaged packets, and outages.

mod nemesis;
mod spec;
#[cfg(test)]
mod tests;

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::{SensorSource, SourceError};
use crate::units::Instant;
use crate::wire::{LinkCounters, Readings, SensorPacket};

pub use self::spec::BadFault;

/// Faults on the way from the boards; by default none.
///
/// Shares are between 0 (never) and 1 (always); values outside are clamped, and NaN counts as 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinkFaults {
    /// Share of packets lost, independently of each other.
    pub loss: f64,
    /// Repeated intervals in which all packets are lost.
    pub bursts: Option<Bursts>,
    /// Share of packets that arrive twice, without delay.
    pub duplicate: f64,
    /// Share of packets that are delayed, so that others overtake them.
    pub delay: f64,
    /// Maximum extra delay of a delayed packet.
    pub delay_up_to: Duration,
    /// Share of packets with one damaged number: a bit of the sequence or one reading.
    pub damage: f64,
    /// Intervals in which boards are unplugged.
    pub outages: Vec<Outage>,
    /// Intervals in which boards repeat the same readings.
    pub frozen: Vec<Outage>,
    /// Time at which the receiving thread panics, as by a bug.
    pub panic_at: Option<Instant>,
    /// Pairs of boards that use each other's address.
    pub swapped: Vec<(u16, u16)>,
    /// Intervals in which nothing arrives; the held-back packets arrive together at the end.
    pub stalls: Vec<Stall>,
}

/// Losses in bursts: one of `length` at the start of every period `every`, except the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bursts {
    /// Period of the bursts.
    pub every: Duration,
    /// Duration of each burst.
    pub length: Duration,
}

/// An interval with a fault of one board or of the whole floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outage {
    /// The board; `None` for all.
    pub board: Option<u16>,
    /// Start of the interval.
    pub from: Instant,
    /// End of the interval, exclusive.
    pub until: Instant,
}

/// An interval in which packets are held back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stall {
    /// Start of the interval.
    pub from: Instant,
    /// Time at which all held-back packets arrive.
    pub until: Instant,
}

/// A source whose packets get lost, duplicated, delayed or damaged; the same seed gives the same faults.
#[derive(Debug)]
pub struct FaultInjector<S> {
    inner: S,
    faults: LinkFaults,
    rng: Pcg64Mcg,
    /// Packets on the way, the next to arrive first.
    on_the_way: BinaryHeap<Reverse<OnTheWay>>,
    /// The repeated readings of each frozen board.
    stuck: Vec<(u16, Readings)>,
    admitted: u64,
    now: Instant,
}

impl<S: SensorSource> FaultInjector<S> {
    /// `inner` with these faults.
    #[must_use]
    pub fn new(inner: S, faults: LinkFaults, seed: u64) -> Self {
        let rng = Pcg64Mcg::seed_from_u64(seed);
        Self {
            inner,
            faults,
            rng,
            on_the_way: BinaryHeap::new(),
            stuck: Vec::new(),
            admitted: 0,
            now: Instant::START,
        }
    }

    /// Replaces the faults from now on; packets on the way arrive as already decided.
    pub fn set_faults(&mut self, faults: LinkFaults) {
        self.faults = faults;
    }

    /// The source behind the faults.
    pub const fn inner_mut(&mut self) -> &mut S {
        &mut self.inner
    }

    fn chance(&mut self, share: f64) -> bool {
        // Draws a number even for a share of 0, so that the share of one fault does not change the others.
        self.rng.random::<f64>() < share
    }

    /// Applies the faults to a packet: drops, damages, delays or duplicates it.
    fn admit(&mut self, mut packet: SensorPacket) {
        let at = packet.received;
        let lost = self.chance(self.faults.loss);
        let doubled = self.chance(self.faults.duplicate);
        let delayed = self.chance(self.faults.delay);
        let damaged = self.chance(self.faults.damage);
        let delay = self.faults.delay_up_to.mul_f64(self.rng.random());
        for &(one, other) in &self.faults.swapped {
            packet.board = if packet.board == one {
                other
            } else if packet.board == other {
                one
            } else {
                packet.board
            };
        }
        let board = packet.board;
        let unplugged = self.faults.outages.iter().any(|outage| outage.hits(board, at));
        if lost || unplugged || self.faults.bursts.is_some_and(|bursts| bursts.hit(at)) {
            return;
        }
        self.freeze(&mut packet);
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

    #[expect(clippy::panic, reason = "it is what was asked for")]
    fn panic_if_due(&self, now: Instant) {
        if self.faults.panic_at.is_some_and(|at| now >= at) {
            panic!("a panic that was asked for, to rehearse one");
        }
    }

    /// Gives the packet of a frozen board the readings from the start of the freeze.
    fn freeze(&mut self, packet: &mut SensorPacket) {
        let (board, at) = (packet.board, packet.received);
        let known = self.stuck.iter().position(|(stuck, _)| *stuck == board);
        let is_frozen = self.faults.frozen.iter().any(|outage| outage.hits(board, at));
        match (is_frozen, known) {
            (true, Some(known)) => packet.readings.clone_from(&self.stuck[known].1),
            (true, None) => self.stuck.push((board, packet.readings.clone())),
            (false, Some(known)) => drop(self.stuck.swap_remove(known)),
            (false, None) => {}
        }
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
            Readings::Scaled(values) | Readings::Newtons(values) => values[channel] = f32::NAN,
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
    /// Returns `None` when `patience` has passed on the inner source's clock without a packet, or when the inner
    /// source returns `None`. Packets on the way when the inner source ends arrive before the end.
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        let begun = self.now();
        self.panic_if_due(begun);
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

impl Outage {
    /// Whether the outage affects a packet that `board` sends at `at`.
    fn hits(&self, board: u16, at: Instant) -> bool {
        self.board.is_none_or(|concerned| concerned == board) && self.from <= at && at < self.until
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
