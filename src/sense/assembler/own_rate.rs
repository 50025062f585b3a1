//! A board with a rate of its own: its stream, its samples on their way to frames, and the age of the one in use.

use super::clock::{SLOT_NS, SlotClock};
use super::pending::{PendingSample, PendingSamples};
use super::presence::{LossMeter, Presence};
use super::sample::BoardSample;
use super::timed::TimedStream;
use crate::wire::{BOARD_RATES_HZ, LinkCounters, SensorPacket};

/// Period below which the packets of a millisecond are averaged.
const AVERAGED_NS: i64 = 4 * SLOT_NS / 5;

/// Longest period of boards whose tiles hold a control that acts while it is held: 50 Hz with its error.
const HOLDS_NS: i64 = 21 * SLOT_NS;

/// Tolerance of the supported range of rates.
const TOLERANCE: f32 = 0.05;

/// Number of equal readings in a row that a board too slow to hold anything may send under a load by chance.
const CHANCE_REPEATS: u32 = 2;

/// A board that does not send once a millisecond.
#[derive(Clone, Debug)]
pub(super) struct OwnRate {
    pub(super) stream: TimedStream,
    pending: PendingSamples,
    /// Readings of its last packet.
    pub(super) last: BoardSample,
    /// The sample in use; `None` before the first one.
    pub(super) in_use: Option<BoardSample>,
    /// Indices of its tiles.
    pub(super) tiles: Vec<u32>,
    /// Instant of the sample in use; `None` before the first one.
    sampled_ns: Option<i64>,
    /// Samples so far.
    samples: i64,
    /// Number of last samples in a row that repeat the one before under a load.
    repeated: u32,
}

impl OwnRate {
    pub(super) fn new(stream: TimedStream, tiles: Vec<u32>) -> Self {
        Self {
            stream,
            pending: PendingSamples::default(),
            last: BoardSample::EMPTY,
            in_use: None,
            tiles,
            sampled_ns: None,
            samples: 0,
            repeated: 0,
        }
    }

    /// Rate in packets a second.
    pub(super) fn hz(&self) -> f32 {
        self.stream.pace().hz()
    }

    /// Whether its rate is outside of the supported range.
    pub(super) fn is_odd(&self) -> bool {
        let [lowest, highest] = BOARD_RATES_HZ;
        !(lowest * (1.0 - TOLERANCE)..=highest * (1.0 + TOLERANCE)).contains(&self.hz())
    }

    /// Whether it is too slow for controls that act while they are held.
    pub(super) fn is_slow(&self) -> bool {
        self.stream.period_ns() > HOLDS_NS
    }

    /// Time from one sample in a frame to the next, in milliseconds; at least 1.
    pub(super) fn interval_ms(&self) -> f32 {
        (self.stream.period_ns() as f32 / SLOT_NS as f32).max(1.0)
    }

    /// Whether its frames come by the clock: it sends, or has to be found silent.
    pub(super) fn needs_frames(&self, presence: &Presence) -> bool {
        presence.is_heard() || presence.has_news() || !self.pending.is_empty()
    }

    /// Takes a packet; `is_other`: its readings differ from those of the packet before. Returns whether its board has
    /// just rebooted; `None` for a dropped packet, which is counted.
    pub(super) fn take(
        &mut self,
        packet: &SensorPacket,
        now_ns: i64,
        is_other: bool,
        clock: &SlotClock,
        loss: &mut LossMeter,
        counters: &mut LinkCounters,
    ) -> Option<bool> {
        let place = self.stream.place(packet.sequence, now_ns, is_other, loss, counters)?;
        if place.restarted {
            self.pending.clear();
        }
        // The first frame after its arrival, whether or not that frame is made before the next packet comes.
        let slot = clock.slot_before(now_ns) + 1;
        let averages = self.stream.period_ns() < AVERAGED_NS;
        if self.pending.add(slot, place.sampled_ns, now_ns, &packet.readings, averages) {
            counters.slips += 1;
        }
        Some(place.restarted)
    }

    /// Removes and returns the sample that enters the frame of `slot`.
    pub(super) fn enter(&mut self, slot: i64, counters: &mut LinkCounters) -> Option<PendingSample> {
        let (pending, dropped) = self.pending.take(slot)?;
        counters.slips += dropped;
        self.sampled_ns = Some(pending.sampled_ns);
        self.samples += 1;
        Some(pending)
    }

    /// Samples so far.
    pub(super) const fn samples(&self) -> i64 {
        self.samples
    }

    /// Notes whether the last sample repeats the one before under a load; returns whether it counts as frozen.
    pub(super) fn note_repeat(&mut self, repeats: bool) -> bool {
        self.repeated = if repeats { self.repeated.saturating_add(1) } else { 0 };
        self.repeated > if self.is_slow() { CHANCE_REPEATS } else { 0 }
    }

    /// Age of the sample in use at `at_ns`; `None` before the first one.
    pub(super) fn age_ns(&self, at_ns: i64) -> Option<i64> {
        self.sampled_ns.map(|sampled_ns| (at_ns - sampled_ns).max(0))
    }

    /// Begins anew after a silence.
    pub(super) fn restart(&mut self) {
        self.stream.restart();
    }
}
