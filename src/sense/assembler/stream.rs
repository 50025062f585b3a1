//! Maps one board's packets from sequence numbers to slots of the sample clock.

use super::clock::{LeastDelay, SLOT_NS, SlotClock};
use super::numbering::PacketNumbers;
use super::pace::PacketPace;
use super::presence::{LossMeter, Presence, SILENT_NS};
use super::sequence::{PacketSequence, SequenceVerdict};
use super::status::BoardCounts;
use crate::wire::LinkCounters;

/// Age beyond its board's usual delay above which a sample after silence is useless: it was held up on the way, and
/// newer ones follow.
const TOO_OLD_NS: i64 = 20 * SLOT_NS;

/// Lead over all recent packets of the board above which a packet is out of order: a slot too early.
const EARLY_NS: i64 = 3 * SLOT_NS / 4;

/// Distance of a board's samples from their slots above which it slips: more than half a slot, so that a board on the
/// border does not slip to and fro.
const SLIP_NS: i64 = 3 * SLOT_NS / 4;

/// Lead over the receive clock above which a slot is not used: the board sends more than one packet a millisecond,
/// and that is not known yet.
const AHEAD_NS: i64 = 100 * SLOT_NS;

/// The packets of a board that sends once a millisecond, and their slots.
#[derive(Clone, Debug, Default)]
pub(super) struct BoardStream {
    pub(super) presence: Presence,
    pub(super) loss: LossMeter,
    /// The numbers of its packets.
    pub(super) numbers: PacketNumbers,
    /// Whether frames wait for it.
    pub(super) awaited: bool,
    pub(super) counts: BoardCounts,
    sequence: PacketSequence,
    arrivals: LeastDelay,
    pace: PacketPace,
    /// Slot of stream position 0.
    offset: i64,
    /// Slots by which `offset` has been moved since the stream began.
    slips: i64,
    /// Arrival of its last packet, usable or not; frames wait for boards that reported recently.
    last_packet_ns: i64,
    /// Packets that were counted as lost, repeated, out of order and late since the stream began.
    miscounts: Miscounts,
}

/// Counts that are wrong if the board turns out to have another rate or time base.
#[derive(Clone, Copy, Debug, Default)]
struct Miscounts {
    lost: u64,
    duplicate: u64,
    out_of_order: u64,
    late: u64,
}

/// The slot of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PacketSlot {
    /// Its slot.
    pub(super) slot: i64,
    /// Whether the packet came in time for it.
    pub(super) usable: bool,
    /// Whether its board has just rebooted.
    pub(super) restarted: bool,
}

impl BoardStream {
    /// Waits for the board as if it had reported at `now_ns`.
    pub(super) const fn expect(&mut self, now_ns: i64) {
        self.last_packet_ns = now_ns;
        self.awaited = true;
    }

    /// Whether the board has been silent for too long for frames to wait for it.
    pub(super) const fn is_overdue(&self, now_ns: i64) -> bool {
        self.awaited && now_ns - self.last_packet_ns >= SILENT_NS
    }

    /// Time at which it becomes silent or overdue without a packet; never if it is neither heard nor awaited.
    pub(super) fn patient_until_ns(&self) -> i64 {
        let overdue = if self.awaited { self.last_packet_ns + SILENT_NS } else { i64::MAX };
        self.presence.silent_at_ns().map_or(overdue, |silent| silent.min(overdue))
    }

    /// The furthest slot its packets have reached.
    pub(super) fn head_slot(&self) -> Option<i64> {
        self.sequence.position().map(|position| self.slot(position))
    }

    fn slot(&self, position: i64) -> i64 {
        position + self.offset
    }

    /// The pace so far of a board whose slots have run far ahead of the receive clock, because it sends several packets a
    /// millisecond.
    pub(super) fn fast_pace(&self, now_ns: i64, clock: &SlotClock) -> Option<PacketPace> {
        let position = self.sequence.position()?;
        let is_ahead = now_ns - clock.at_ns(self.slot(position)) <= -AHEAD_NS;
        is_ahead.then(|| self.pace.so_far(now_ns, position))?.filter(PacketPace::is_fast)
    }

    /// The measured pace, if it is not one packet a millisecond.
    pub(super) fn other_pace(&mut self) -> Option<PacketPace> {
        self.pace.adopt().then(|| self.pace.anew()).filter(|pace| !pace.is_one())
    }

    /// Ends its mapping to slots: the board has a rate of its own. Takes back what was counted meanwhile.
    pub(super) fn leave_slots(&mut self, counters: &mut LinkCounters) {
        let Miscounts { lost, duplicate, out_of_order, late } = std::mem::take(&mut self.miscounts);
        counters.lost = counters.lost.saturating_sub(lost);
        counters.duplicate = counters.duplicate.saturating_sub(duplicate);
        counters.out_of_order = counters.out_of_order.saturating_sub(out_of_order);
        counters.late = counters.late.saturating_sub(late);
        self.awaited = false;
        self.sequence = PacketSequence::default();
        self.arrivals.forget();
    }

    /// Begins to map its next packets to slots: it sends once a millisecond after all.
    pub(super) fn enter_slots(&mut self) {
        *self = Self {
            presence: self.presence.clone(),
            numbers: std::mem::take(&mut self.numbers),
            ..Self::default()
        };
        self.presence.set_period(SLOT_NS);
    }

    /// Counts a packet that came too late for its slot.
    pub(super) const fn note_late(&mut self, counters: &mut LinkCounters) {
        self.miscounts.late += 1;
        counters.late += 1;
    }

    /// Slots by which the board has been moved since its stream began.
    pub(super) const fn slips(&self) -> i64 {
        self.slips
    }

    /// Finds the slot of the packet numbered `sequence` that arrived at `now_ns`; `done` is the last slot made into a
    /// frame. Returns `None` for a dropped packet, and counts it.
    pub(super) fn place(
        &mut self,
        sequence: u32,
        now_ns: i64,
        clock: &SlotClock,
        done: i64,
        counters: &mut LinkCounters,
    ) -> Option<PacketSlot> {
        let head = self.head_slot();
        let offset = self.offset;
        let earliest = self.arrivals.least_ns();
        let early = |position: i64| {
            let delay = now_ns - clock.at_ns(position + offset);
            earliest.is_some_and(|earliest| delay < earliest - EARLY_NS)
        };

        let mut restarted = false;
        let (position, skipped) = match self.sequence.judge(sequence, early) {
            SequenceVerdict::Next { position, skipped } => {
                if head.is_none() {
                    self.offset = clock.slot_near(now_ns) - position;
                }
                self.pace.note(now_ns, position);
                self.miscounts.lost += u64::from(skipped);
                counters.lost += u64::from(skipped);
                self.counts.lost += u64::from(skipped);
                (position, Some(skipped))
            }
            SequenceVerdict::Straggler { position, missed } => {
                self.miscounts.lost = self.miscounts.lost.saturating_sub(u64::from(missed));
                counters.lost = counters.lost.saturating_sub(u64::from(missed));
                self.counts.lost = self.counts.lost.saturating_sub(u64::from(missed));
                (position, None)
            }
            SequenceVerdict::Restart { position } => {
                counters.restarts += 1;
                restarted = true;
                self.begin_anew(now_ns);
                self.offset = clock.slot_near(now_ns) - position;
                (position, Some(0))
            }
            SequenceVerdict::Duplicate => {
                self.miscounts.duplicate += 1;
                counters.duplicate += 1;
                self.counts.duplicate += 1;
                return None;
            }
            SequenceVerdict::OutOfOrder => {
                self.miscounts.out_of_order += 1;
                counters.out_of_order += 1;
                return None;
            }
        };

        let slot = self.slot(position);
        let usable = self.is_usable(slot, now_ns, clock, done);
        match skipped {
            _ if !self.presence.is_live() => {}
            Some(skipped) => self.loss.pass(skipped, usable),
            None if usable => self.loss.found(),
            None => {}
        }
        Some(PacketSlot { slot, usable, restarted })
    }

    fn begin_anew(&mut self, now_ns: i64) {
        self.slips = 0;
        self.miscounts = Miscounts::default();
        self.arrivals.forget();
        self.pace.forget();
        self.presence.interrupt(now_ns);
    }

    fn is_usable(&mut self, slot: i64, now_ns: i64, clock: &SlotClock, done: i64) -> bool {
        self.last_packet_ns = now_ns;
        let delay = now_ns - clock.at_ns(slot);
        self.arrivals.note(now_ns, delay);
        let usual = self.arrivals.least_ns().unwrap_or(0).max(0);
        let returning = self.presence.has_reported() && !self.presence.is_live();
        slot > done && delay > -AHEAD_NS && !(returning && delay - usual > TOO_OLD_NS)
    }

    /// Notes a packet that was used.
    pub(super) fn deliver(&mut self, now_ns: i64) {
        let was_live = self.presence.is_live();
        self.presence.deliver(now_ns);
        if !was_live {
            // Losses during an outage do not count afterwards.
            self.loss.forget();
        }
    }

    /// The least recent delay of its packets, once there are enough; called at intervals.
    pub(super) fn least_delay(&mut self, now_ns: i64) -> Option<i64> {
        self.arrivals.close(now_ns)
    }

    /// Moves the board to other slots if its packets lie `off_ns` from theirs; returns the number of slots.
    pub(super) fn slip(&mut self, off_ns: i64) -> i64 {
        if off_ns.abs() <= SLIP_NS {
            return 0;
        }
        let slots = (off_ns + off_ns.signum() * SLOT_NS / 2) / SLOT_NS;
        self.offset += slots;
        self.slips += slots;
        self.slots_moved(slots * SLOT_NS);
        slots
    }

    /// Adapts the delays to slots' times that have moved by `by_ns`.
    pub(super) fn slots_moved(&mut self, by_ns: i64) {
        self.arrivals.slots_moved(by_ns);
    }
}
