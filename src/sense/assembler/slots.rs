//! The slots that wait for boards, and whether they are complete.

use arrayvec::ArrayVec;

use super::board::BoardTrack;
use super::buffers::BUFFERS;
use super::clock::{SLOT_NS, nanos};
use crate::units::Instant;
use crate::wire::LinkCounters;

/// A slot counts as complete when a board has delivered one this many slots later.
const AHEAD: i64 = 2;

/// The same on a part of a floor, where other computers forward the packets of some boards. A computer that is busy
/// for a few milliseconds then causes a delay instead of the loss of a tenth of its boards' packets (our choice; six
/// programs on two cores lost 2 to 3 % of the forwarded packets with 2, and none with 6).
const AHEAD_OF_PART: i64 = 6;

/// Time without packets after which an incomplete slot is released, since its last packet.
const PATIENCE_NS: i64 = 3 * SLOT_NS;

/// A slot that waits for boards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waiting {
    pub(super) slot: i64,
    pub(super) buffer: usize,
    /// Number of awaited boards that have delivered this slot or a later one.
    passed: usize,
    /// Arrival of its last packet.
    pub(super) received: Instant,
}

/// The slots that wait for boards.
#[derive(Clone, Debug)]
pub(super) struct Slots {
    /// Earliest first.
    waiting: ArrayVec<Waiting, BUFFERS>,
    /// Number of boards for which frames wait.
    awaited: usize,
    /// Latest slot that any board had reached before the present packet.
    front: i64,
    /// Number of slots by which one board must be ahead for slots to wait no longer.
    ahead: i64,
    /// The last slot made into a frame.
    done: i64,
    /// Whether the waiting slots count as complete.
    flush: bool,
}

impl Slots {
    /// No slots. `is_part`: other computers forward the packets of some boards.
    pub(super) fn new(is_part: bool) -> Self {
        Self {
            waiting: ArrayVec::new(),
            awaited: 0,
            front: i64::MIN,
            ahead: if is_part { AHEAD_OF_PART } else { AHEAD },
            done: i64::MIN,
            flush: false,
        }
    }

    /// The last slot made into a frame.
    pub(super) const fn done(&self) -> i64 {
        self.done
    }

    pub(super) const fn set_done(&mut self, slot: i64) {
        self.done = slot;
    }

    /// Whether no slot waits.
    pub(super) fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Whether the first slot is complete or counts as complete.
    pub(super) fn is_due(&self) -> bool {
        self.waiting.first().is_some_and(|first| {
            let newest = self.waiting.last().map_or(first.slot, |last| last.slot);
            self.flush || first.passed >= self.awaited || newest - first.slot >= self.ahead
        })
    }

    /// Removes and returns the first slot if it is due.
    pub(super) fn take_due(&mut self) -> Option<Waiting> {
        self.is_due().then(|| self.waiting.remove(0))
    }

    /// Makes all waiting slots due if no packet has come for too long.
    pub(super) fn release_overdue(&mut self, now_ns: i64) {
        let waited = self.waiting.last().map_or(0, |waiting| now_ns - nanos(waiting.received));
        self.flush |= waited >= PATIENCE_NS;
    }

    /// Ends the release of slots that are not complete.
    pub(super) const fn end_release(&mut self) {
        self.flush = false;
    }

    /// Whether frames wait for any board.
    pub(super) const fn awaits_any(&self) -> bool {
        self.awaited > 0
    }

    /// Waits for all of so many boards; the slots at hand are not recounted.
    pub(super) const fn await_all(&mut self, boards: usize) {
        self.awaited = boards;
    }

    /// Recounts the awaited boards and those that have passed each waiting slot.
    pub(super) fn count_awaited(&mut self, boards: &[BoardTrack]) {
        let awaited = || boards.iter().filter(|board| board.stream.awaited);
        self.awaited = awaited().count();
        for waiting in &mut self.waiting {
            waiting.passed = awaited().filter(|board| board.stream.head_slot() >= Some(waiting.slot)).count();
        }
    }

    /// Recounts everything after boards have been moved to other slots.
    pub(super) fn rebuild(&mut self, boards: &[BoardTrack]) {
        self.front = boards.iter().filter_map(|board| board.stream.head_slot()).max().unwrap_or(i64::MIN);
        self.count_awaited(boards);
    }

    /// Counts a board that was at slot `head` and has now reached `slot`.
    pub(super) fn pass(&mut self, head: Option<i64>, slot: i64) {
        for waiting in &mut self.waiting {
            waiting.passed += usize::from(head < Some(waiting.slot) && waiting.slot <= slot);
        }
    }

    /// Notes that a board has reached `slot`.
    pub(super) fn reach(&mut self, slot: i64) {
        self.front = self.front.max(slot);
    }

    /// The buffer for a packet of board `number` that arrived at `received`; `slot` waits from now on if it did not
    /// before.
    pub(super) fn buffer(
        &mut self,
        slot: i64,
        number: usize,
        received: Instant,
        boards: &mut [BoardTrack],
        counters: &mut LinkCounters,
    ) -> Option<usize> {
        let place = self.waiting.partition_point(|waiting| waiting.slot < slot);
        if self.waiting.get(place).is_none_or(|waiting| waiting.slot != slot) {
            self.open(place, slot, number, boards, counters);
        }
        let waiting = self.waiting.iter_mut().find(|waiting| waiting.slot == slot)?;
        waiting.received = waiting.received.max(received);
        Some(waiting.buffer)
    }

    /// Inserts `slot`, which board `number` has reached, at `place` among the waiting slots.
    fn open(
        &mut self,
        mut place: usize,
        slot: i64,
        number: usize,
        boards: &mut [BoardTrack],
        counters: &mut LinkCounters,
    ) {
        if self.waiting.is_full() {
            // Happens only if the caller left frames unread.
            let oldest = self.waiting.remove(0);
            self.done = oldest.slot;
            let dropped = boards.iter_mut().map(|board| u64::from(board.clear(oldest.buffer)));
            counters.late += dropped.sum::<u64>();
            place = place.saturating_sub(1);
        }
        let taken = |buffer: &usize| self.waiting.iter().any(|waiting| waiting.buffer == *buffer);
        let Some(buffer) = (0..BUFFERS).find(|buffer| !taken(buffer)) else { return };
        let has_passed = |board: &&BoardTrack| board.stream.awaited && board.stream.head_slot() >= Some(slot);
        // The board that opens a slot is mostly the first to reach it: skip the others.
        let may_have_passed = if slot > self.front { &boards[number..=number] } else { &*boards };
        let passed = may_have_passed.iter().filter(has_passed).count();
        self.waiting.insert(place, Waiting { slot, buffer, passed, received: Instant::START });
    }
}
