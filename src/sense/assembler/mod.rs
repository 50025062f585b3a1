//! Assembles the packets of boards into frames of the whole floor.

mod board;
mod buffers;
mod clock;
mod pace;
mod presence;
mod sample;
mod sequence;
mod stream;
mod swap;
mod tare;
mod window;
mod write;

use std::time::Duration;

use arrayvec::ArrayVec;

pub use tare::{Tare, TareOutcome, TareRules};

use self::board::BoardTrack;
use self::buffers::{BUFFERS, Buffers};
use self::clock::{SLOT_NS, SampleClock, nanos};
use self::presence::SILENT_NS;
use self::swap::Swaps;
use super::health::{Health, SensorHealth, Trouble};
use super::{CalibrationFault, ForceFrame, HoldDoubt, Quality};
use crate::floor::{Floor, SensorId, TileId};
use crate::units::{Instant, Newtons};
use crate::wire::{LinkCounters, LinkState, SensorPacket};

/// A slot counts as complete when a board has delivered one this many slots later.
const AHEAD: i64 = 2;

/// The same on a part of a floor, where other computers forward the packets of some boards. A computer that is busy
/// for a few milliseconds then causes a delay instead of the loss of a tenth of its boards' packets (our choice; six
/// programs on two cores lost 2 to 3 % of the forwarded packets with 2, and none with 6).
const AHEAD_OF_PART: i64 = 6;

/// Time without packets after which an incomplete slot is released, since its last packet.
const PATIENCE_NS: i64 = 3 * SLOT_NS;

/// Interval at which the boards' slots and the clock are compared with the receive clock.
const ALIGN_NS: i64 = 64 * SLOT_NS;

/// Lead of the slots of all boards over their packets above which the slots are moved back: steering would take a
/// minute, and a board that counts a thousandth too fast would pull the clock away.
const FAST_NS: i64 = 20 * SLOT_NS;

/// Assembles the packets of all boards into one calibrated, tared [`ForceFrame`] per millisecond.
///
/// ```text
/// loop {
///     match source.next(patience)? {
///         Some(packet) => assembler.take(&packet),
///         None => assembler.poll(source.now()),
///     }
///     while let Some(frame) = assembler.ready() { ... }
/// }
/// ```
///
/// **Slots.** Each board counts its own samples, and boards start at different times. A board's first packet receives
/// the common millisecond (slot) nearest to its arrival; from there its sequence number counts slots. Crystals drift:
/// a board more than 0.75 ms off the others is moved by a slot, which leaves out or repeats one sample. The fastest
/// packet of about 64 ms determines the delay, so jitter moves nothing.
///
/// **Rates.** The assembler measures within a second the pace of a board that sends more or fewer than 1000 packets a
/// second; the board's samples then go to the slots in which they arrive, the first where several do. Beyond
/// [`crate::wire::BOARD_RATES_HZ`] its sensors are [`Quality::Degraded`].
///
/// **Time.** A frame's `at` is its slot's time on a sample clock that follows the receive clock by at most 500 ppm,
/// or is set forward when it is more than 100 ms behind. It is never more than 100 ms ahead, at any packet rate. It
/// grows from frame to frame, by 1 ms unless slots were lost altogether. If packets carry exact millisecond stamps,
/// as those of a simulated floor do, `at` is exact to the microsecond.
///
/// **Completeness.** A frame is ready when every board that reported within the last 100 ms has delivered its slot or
/// a later one, or when any board is two slots ahead; six on a part of a larger floor. Boards without a sample in the
/// slot keep their last values. The assembler drops and counts packets that come later than that, come twice, or come
/// after silence and were more than 20 ms on their way.
///
/// **Trust.** A board without a usable sample for 100 ms becomes [`Quality::Stale`], and so does one that rebooted,
/// for at least one frame. Readings of a loaded board that all repeat those of the packet before are not usable if
/// the sensors' noise makes that improbable: the converters are frozen ([`BoardStatus::frozen`]). The sensors of a
/// tile become [`Quality::Stale`] as well if two of them repeat by themselves ([`Assembler::repeating`]). A stale
/// board returns with its next sample, but only after a clean second if outages follow each other within two seconds.
/// More than 10 % of lost packets within a second, a sensor at 98 % of its range, or a sensor that sends counts and
/// was never calibrated ([`Floor::uncalibrated`]) means [`Quality::Degraded`]; a reading that is not a number means
/// [`Quality::Faulty`].
///
/// **Health.** Each sensor is compared with the other three of its plate, and its zero is tracked while its tile is
/// empty and quiet; [`Trouble`] lists the detectable faults. These checks use the boards' own time, counted in slots
/// and independent of the steering of the sample clock.
///
/// The assembler has no clock of its own: `received` and `now` are on the source's clock; a time earlier than the last
/// counts as the last.
#[derive(Clone, Debug)]
pub struct Assembler {
    floor_tiles: usize,
    boards: Vec<BoardTrack>,
    buffers: Buffers,
    /// `None` before the first packet.
    clock: Option<SampleClock>,
    now_ns: i64,
    /// Arrival of the first packet.
    first_packet_ns: Option<i64>,
    swept_ns: i64,
    /// No board becomes silent before this time.
    patient_until_ns: i64,
    aligned_ns: i64,
    /// Slots that wait for boards, earliest first.
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
    /// Whether a board became silent and no frame has reported it yet.
    has_news: bool,
    /// Whether frames are released: not before the tare is known.
    started: bool,
    frame: ForceFrame,
    health: Health,
    swaps: Swaps,
    counters: LinkCounters,
    /// Space for sorting the boards' delays.
    delays: Vec<(i64, usize)>,
}

/// Time after the first packet during which a silent board does not count as missing.
const GATHERING_NS: i64 = 100_000_000;

#[derive(Clone, Copy, Debug)]
struct Waiting {
    slot: i64,
    buffer: usize,
    /// Number of awaited boards that have delivered this slot or a later one.
    passed: usize,
    /// Arrival of its last packet.
    received: Instant,
}

/// State of one board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardStatus {
    /// Quality of all its sensors; a single sensor may be worse.
    pub quality: Quality,
    /// Time since its last usable packet; `None` if none has come.
    pub age: Option<Duration>,
    /// Share of its packets that were lost or too late over the last second, 0 to 1.
    pub loss: f32,
    /// Whether it is stale because all its readings have been constant for 100 ms under a load.
    pub frozen: bool,
    /// Samples by which its crystal has run slower (positive) or faster than the common clock.
    pub slips: i64,
}

impl Assembler {
    /// An assembler for the boards of `floor`, with the floor's own tare.
    #[must_use]
    pub fn new(floor: &Floor) -> Self {
        Self::with_tare(floor, Tare::FromFloor)
    }

    /// An assembler for the boards of `floor`. With [`Tare::AtStart`] it releases no frame until the boards that
    /// reported at first have been tared; a board that appears later is stale until it is tared.
    #[must_use]
    pub fn with_tare(floor: &Floor, tare: Tare) -> Self {
        let boards: Vec<_> =
            (0..floor.boards.len()).map(|number| BoardTrack::new(floor, number, tare)).collect();
        let mut frame = ForceFrame::empty(&floor.geometry);
        frame.quality.fill([Quality::Stale; 4]);
        if !floor.noiseless {
            frame.hold_doubts.fill(Some(HoldDoubt::Unlearned));
        }
        Self {
            floor_tiles: floor.geometry.tile_count(),
            delays: Vec::with_capacity(boards.len()),
            buffers: Buffers::new(boards.len()),
            swaps: Swaps::new(&boards),
            boards,
            clock: None,
            now_ns: 0,
            first_packet_ns: None,
            swept_ns: 0,
            patient_until_ns: 0,
            aligned_ns: 0,
            waiting: ArrayVec::new(),
            awaited: 0,
            front: i64::MIN,
            ahead: if floor.geometry.is_part() { AHEAD_OF_PART } else { AHEAD },
            done: i64::MIN,
            flush: false,
            has_news: false,
            started: false,
            frame,
            health: Health::new(floor),
            counters: LinkCounters::default(),
        }
    }

    /// Takes one packet; the caller should then call [`Assembler::ready`] until it returns `None`.
    ///
    /// Counts and drops packets of boards that this floor does not have, and packets with another number of readings
    /// than the board has channels.
    pub fn take(&mut self, packet: &SensorPacket) {
        let number = usize::from(packet.board);
        match self.boards.get(number) {
            None => self.counters.unknown_address += 1,
            Some(board) if board.channel_count() != packet.readings.len() => self.counters.wrong_shape += 1,
            Some(_) => {
                self.pass_time(nanos(packet.received));
                self.first_packet_ns.get_or_insert(self.now_ns);
                self.sort_in(number, packet);
            }
        }
    }

    /// Advances time without a packet, so that silence is detected; `now` is on the source's clock.
    ///
    /// Call it at least every 10 ms to detect a lost floor within 120 ms.
    pub fn poll(&mut self, now: Instant) {
        self.pass_time(nanos(now));
        let waited = self.waiting.last().map_or(0, |waiting| self.now_ns - nanos(waiting.received));
        self.flush |= waited >= PATIENCE_NS;
    }

    /// The next frame, if one is complete; call until `None`. A frame with eight later ones waiting is dropped and
    /// its packets counted as late.
    pub fn ready(&mut self) -> Option<&ForceFrame> {
        loop {
            let (slot, buffer, received) = if self.is_due() {
                let first = self.waiting.remove(0);
                (first.slot, Some(first.buffer), first.received)
            } else if self.started && self.waiting.is_empty() && self.has_news {
                // No board delivers: the frame only reports that boards became silent. Before the first frame there
                // is nothing to report.
                let clock = self.clock.as_ref()?;
                let slot = clock.slot_before(self.now_ns).max(self.done.saturating_add(1));
                (slot, None, instant(self.now_ns))
            } else {
                self.flush = false;
                return None;
            };
            if self.complete(slot, buffer, received) {
                self.counters.frames += 1;
                return Some(&self.frame);
            }
            self.counters.held_back += 1;
        }
    }

    /// Whether a slot is complete or counts as complete: [`Assembler::ready`] then returns its frame, unless the tare
    /// is still unknown.
    pub(crate) fn is_due(&self) -> bool {
        self.waiting.first().is_some_and(|first| {
            let newest = self.waiting.last().map_or(first.slot, |last| last.slot);
            self.flush || first.passed >= self.awaited || newest - first.slot >= self.ahead
        })
    }

    /// State of the link as of the last packet or poll.
    ///
    /// While the boards report for the first time, one after the other, the link is still waiting.
    #[must_use]
    pub fn link_state(&self) -> LinkState {
        let presences = || self.boards.iter().map(|board| &board.stream.presence);
        let is_new = self.first_packet_ns.is_none_or(|first| self.now_ns - first < GATHERING_NS);
        if is_new && presences().any(|presence| !presence.has_reported()) {
            LinkState::Waiting
        } else if presences().all(presence::Presence::is_live) {
            LinkState::Live
        } else if presences().any(presence::Presence::is_live) {
            LinkState::Partial
        } else {
            LinkState::Lost
        }
    }

    /// Number of boards with usable packets, as of the last packet or poll, and number of boards of the floor.
    #[must_use]
    pub fn boards_live(&self) -> (u32, u32) {
        let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        let live = self.boards.iter().filter(|board| board.stream.presence.is_live());
        (count(live.count()), count(self.boards.len()))
    }

    /// State of board `number`, as of the last packet or poll; `None` if the floor has no such board.
    #[must_use]
    pub fn board(&self, number: u16) -> Option<BoardStatus> {
        let board = self.boards.get(usize::from(number))?;
        let age = |used: i64| Duration::from_nanos((self.now_ns - used).max(0).cast_unsigned());
        Some(BoardStatus {
            quality: board.quality(),
            age: board.stream.presence.used_ns().map(age),
            loss: board.stream.loss.share(),
            frozen: board.repeats() && !board.stream.presence.is_live(),
            slips: board.stream.slips(),
        })
    }

    /// Result of the tare; if boards differ, the most urgent one.
    #[must_use]
    pub fn tare_outcome(&self) -> TareOutcome {
        let urgency = |outcome: &TareOutcome| match outcome {
            TareOutcome::Measuring => 3,
            TareOutcome::Refused { .. } => 2,
            TareOutcome::Taken => 1,
            TareOutcome::FromFloor => 0,
        };
        let reporting = self.boards.iter().filter(|board| board.stream.presence.has_reported());
        let outcomes = reporting.map(BoardTrack::tare_outcome);
        let unheard = self.boards.first().map_or(TareOutcome::FromFloor, BoardTrack::tare_outcome);
        outcomes.max_by_key(urgency).unwrap_or(unheard)
    }

    /// The tare in use, per tile and corner as in [`Floor::tare`]; zero for sensors without a board.
    #[must_use]
    pub fn tare(&self) -> Vec<[Newtons; 4]> {
        let mut tare = vec![[Newtons::ZERO; 4]; self.floor_tiles];
        for (tile, corner, force) in self.boards.iter().flat_map(BoardTrack::tares) {
            tare[tile][corner.index()] = force;
        }
        tare
    }

    /// Number of sensors whose counts are converted by the nominal part's law, because the floor has no calibration
    /// for them; [`Floor::uncalibrated`] names them. Their forces may be off by a quarter and more, and are
    /// [`Quality::Degraded`].
    #[must_use]
    pub fn uncalibrated(&self) -> usize {
        self.boards.iter().map(BoardTrack::uncalibrated).sum()
    }

    /// Whether, at the start, the empty floor differed from the floor's tare on most of its tiles: the file belongs
    /// to another floor or is outdated. All sensors are [`Quality::Degraded`] then.
    #[must_use]
    pub fn is_foreign(&self) -> bool {
        self.health.is_foreign()
    }

    /// Number of changes of board places, and the boards that have changed places: each misplaced board comes with
    /// the board whose empty tiles it reads, which is misplaced too. Two boards have been swapped, more form a ring.
    /// Their sensors are [`Quality::Faulty`] until they are back in their places. Requires a tare from the floor
    /// file.
    pub fn swapped(&self) -> (u64, impl Iterator<Item = (u16, u16)> + '_) {
        self.swaps.places()
    }

    /// Writes the health of the sensors, as of the last frame, into `health`.
    pub fn health(&self, health: &mut SensorHealth) {
        health.recount(self.frame.quality.iter());
        health.uncalibrated = u32::try_from(self.uncalibrated()).unwrap_or(u32::MAX);
        health.foreign = self.is_foreign();
        health.troubles.clear();
        health.troubles.extend(self.troubles());
        health
            .troubles
            .sort_by_key(|(sensor, _)| (sensor.tile.row, sensor.tile.column, sensor.corner.index()));
    }

    /// The sensors with faults, as of the last frame.
    pub fn troubles(&self) -> impl Iterator<Item = (SensorId, Trouble)> + '_ {
        self.health.troubles()
    }

    /// Number of times that a sensor fault began or ended; constant as long as [`Assembler::troubles`] is.
    #[must_use]
    pub const fn trouble_changes(&self) -> u64 {
        self.health.changes()
    }

    /// Drift of each sensor's zero from its tare, as tracked, per tile and corner as in [`Floor::tare`]; at most 20 %
    /// of the sensor's range.
    #[must_use]
    pub fn drift(&self) -> impl ExactSizeIterator<Item = [Newtons; 4]> + '_ {
        self.health.drift()
    }

    /// Estimated creep of the floor's sensors, as a share of their load for each decade of time: 0 to 0.1. The creep
    /// correction is proportional to it; below 0.02 there is none.
    #[must_use]
    pub const fn creep(&self) -> f32 {
        self.health.creep()
    }

    /// Counters of received and dropped packets; the source counts datagrams and refusals.
    #[must_use]
    pub fn counters(&self) -> LinkCounters {
        LinkCounters {
            sensor_troubles: self.health.found(),
            jumps: self.jumps().0,
            repeats: self.repeating().0,
            ..self.counters
        }
    }

    /// Number of changes of a tile's load that are faster than those by a body (300 N in a millisecond), and the last
    /// such tile with its change in newtons. Such a tile is [`Quality::Faulty`] for 100 ms.
    #[must_use]
    pub fn jumps(&self) -> (u64, Option<(TileId, f32)>) {
        self.health.jumps()
    }

    /// Number of times that two or more sensors of a tile have repeated their readings for 100 ms under a load
    /// although their noise makes that improbable, and the tiles with such sensors now or in the last 100 ms. These
    /// are [`Quality::Stale`].
    pub fn repeating(&self) -> (u64, impl Iterator<Item = TileId> + '_) {
        self.health.repeating()
    }

    /// Advances time and detects silence, at most once a millisecond.
    fn pass_time(&mut self, now_ns: i64) {
        self.now_ns = self.now_ns.max(now_ns);
        if self.clock.is_none() || self.now_ns - self.swept_ns < SLOT_NS {
            return;
        }
        self.swept_ns = self.now_ns;
        if self.now_ns < self.patient_until_ns {
            return;
        }
        let mut gave_out = false;
        // Boards that report from now on have the full time-out again.
        self.patient_until_ns = self.now_ns + SILENT_NS;
        for board in &mut self.boards {
            if board.stream.presence.pass(self.now_ns) {
                self.counters.frozen += u64::from(board.repeats());
                board.interrupt_tare();
                self.has_news = true;
            }
            if board.stream.is_overdue(self.now_ns) {
                board.stream.awaited = false;
                gave_out = true;
            }
            self.patient_until_ns = self.patient_until_ns.min(board.stream.patient_until_ns());
        }
        if gave_out {
            self.count_awaited();
        }
    }

    /// Recounts the awaited boards and those that have passed each waiting slot.
    fn count_awaited(&mut self) {
        let awaited = || self.boards.iter().filter(|board| board.stream.awaited);
        self.awaited = awaited().count();
        for waiting in &mut self.waiting {
            waiting.passed = awaited().filter(|board| board.stream.head_slot() >= Some(waiting.slot)).count();
        }
    }

    /// Finds the packet's slot and stores it there, if it came in time.
    fn sort_in(&mut self, number: usize, packet: &SensorPacket) {
        let clock = self.clock.unwrap_or_else(|| self.start());
        let board = &mut self.boards[number];
        let head = board.stream.head_slot();
        let Some(place) =
            board.stream.place(packet.sequence, self.now_ns, &clock, self.done, &mut self.counters)
        else {
            return;
        };
        if place.restarted {
            board.interrupt_tare();
            self.has_news |= board.stream.presence.has_news();
        }
        if place.restarted || !board.stream.awaited {
            board.stream.awaited = true;
            if self.awaited == 0 {
                // After silence of all boards the others will probably return as well.
                self.expect_all();
            }
            self.count_awaited();
        } else {
            self.pass_slots(head, place.slot);
        }
        if place.usable {
            self.store(number, place.slot, packet);
        } else {
            self.counters.late += 1;
        }
        self.front = self.front.max(place.slot);
        self.align();
    }

    /// Waits for every board for a while, as if all had just reported.
    fn expect_all(&mut self) {
        self.boards.iter_mut().for_each(|board| board.stream.expect(self.now_ns));
        self.awaited = self.boards.len();
    }

    /// Starts the sample clock with the first packet.
    fn start(&mut self) -> SampleClock {
        self.expect_all();
        self.done = -1;
        (self.swept_ns, self.aligned_ns) = (self.now_ns, self.now_ns);
        *self.clock.insert(SampleClock::new(self.now_ns))
    }

    /// Counts a board that was at slot `head` and has now reached `slot`.
    fn pass_slots(&mut self, head: Option<i64>, slot: i64) {
        for waiting in &mut self.waiting {
            waiting.passed += usize::from(head < Some(waiting.slot) && waiting.slot <= slot);
        }
    }

    fn store(&mut self, number: usize, slot: i64, packet: &SensorPacket) {
        let place = self.waiting.partition_point(|waiting| waiting.slot < slot);
        if self.waiting.get(place).is_none_or(|waiting| waiting.slot != slot) {
            self.open(place, slot, number);
        }
        let Some(waiting) = self.waiting.iter_mut().find(|waiting| waiting.slot == slot) else { return };
        waiting.received = waiting.received.max(packet.received);
        let board = &mut self.boards[number];
        if board.has(waiting.buffer) {
            // The board has just slipped back by a slot: this sample is left out.
            return;
        }
        let buffer = waiting.buffer;
        if board.store(buffer, &packet.readings, &mut self.buffers, &self.health) {
            board.stream.deliver(self.now_ns);
        }
        self.counters.packets += 1;
        self.swaps.note(number, slot, self.buffers.sample(buffer, number), &self.boards);
        self.boards[number].set_swapped(self.swaps.of(number).is_some());
    }

    /// Inserts `slot`, which board `number` has reached, at `place` among the waiting slots.
    fn open(&mut self, mut place: usize, slot: i64, number: usize) {
        if self.waiting.is_full() {
            // Happens only if the caller left frames unread.
            let oldest = self.waiting.remove(0);
            self.done = oldest.slot;
            self.release(oldest.buffer);
            place = place.saturating_sub(1);
        }
        let taken = |buffer: &usize| self.waiting.iter().any(|waiting| waiting.buffer == *buffer);
        let Some(buffer) = (0..BUFFERS).find(|buffer| !taken(buffer)) else { return };
        let has_passed = |board: &&BoardTrack| board.stream.awaited && board.stream.head_slot() >= Some(slot);
        // The board that opens a slot is mostly the first to reach it: skip the others.
        let may_have_passed =
            if slot > self.front { &self.boards[number..=number] } else { self.boards.as_slice() };
        let passed = may_have_passed.iter().filter(has_passed).count();
        self.waiting.insert(place, Waiting { slot, buffer, passed, received: Instant::START });
    }

    fn release(&mut self, buffer: usize) {
        for board in &mut self.boards {
            self.counters.late += u64::from(board.clear(buffer));
        }
    }

    /// Makes the frame of `slot`; returns false if the tare is still being measured.
    fn complete(&mut self, slot: i64, buffer: Option<usize>, received: Instant) -> bool {
        let at_ns = self.clock.as_ref().map_or(0, |clock| clock.at_ns(slot));
        // Sampling time by the boards' own count. The steering of this computer's clock must not influence the sensor
        // checks; two computers with the same packets would find different faults.
        let sampled_ns = slot.max(0).saturating_mul(SLOT_NS);
        self.done = slot;
        let (mut is_taring, mut is_swapped, mut lacks_laws) = (false, false, false);
        let Self { boards, buffers, frame, health, counters, .. } = self;
        for board in boards {
            board.apply(buffer, sampled_ns, buffers, frame, health, counters);
            is_taring |= board.stream.awaited && board.is_taring();
            is_swapped |= board.is_swapped();
            lacks_laws |= board.lacks_laws();
        }
        self.started |= !is_taring;
        if self.started {
            let next = self.frame.at + Duration::from_micros(u64::from(self.counters.frames > 0));
            self.frame.at = instant(at_ns).max(next);
            self.frame.received = received;
            self.health.inspect(&mut self.frame, instant(sampled_ns));
            // On a floor with swapped boards all laws belong to other sensors.
            let faults = [
                (is_swapped, CalibrationFault::BoardsSwapped),
                // With nominal laws the empty floor matches no tare.
                (lacks_laws, CalibrationFault::Missing),
                (self.health.is_foreign(), CalibrationFault::OtherFloor),
            ];
            let fault = faults.into_iter().find(|(is_so, _)| *is_so);
            self.frame.calibration_fault = fault.map(|(_, fault)| fault);
            if std::mem::take(&mut self.has_news) {
                self.boards.iter_mut().for_each(|board| board.stream.presence.show());
            }
        }
        self.started
    }

    /// Compares each board's slots with the arrival of its packets, and the clock with all of them.
    fn align(&mut self) {
        let Some(clock) = &mut self.clock else { return };
        if self.now_ns - self.aligned_ns < ALIGN_NS {
            return;
        }
        self.aligned_ns = self.now_ns;
        self.delays.clear();
        let mut slipped = 0;
        for (number, board) in self.boards.iter_mut().enumerate() {
            let stream = &mut board.stream;
            slipped += u64::from(stream.adopt_pace(self.now_ns, clock));
            match stream.least_delay(self.now_ns) {
                Some(delay) if stream.keeps_time() => self.delays.push((delay, number)),
                // A board at another rate is no reference for the others and follows the receive clock by itself.
                Some(delay) => slipped += stream.slip(delay).unsigned_abs(),
                None => {}
            }
        }
        if !self.delays.is_empty() {
            let middle = (self.delays.len() - 1) / 2;
            let common = self.delays.select_nth_unstable(middle).1.0;
            // Nothing arrives before its sampling: slots that lie further ahead are moved back, and the clock is not.
            let common = if common < -FAST_NS { 0 } else { common };
            for &(delay, number) in &self.delays {
                slipped += self.boards[number].stream.slip(delay - common).unsigned_abs();
            }
            let jump = clock.correct(self.done, common);
            if jump != 0 {
                self.boards.iter_mut().for_each(|board| board.stream.slots_moved(jump));
            }
        }
        if slipped != 0 {
            self.counters.slips += slipped;
            self.front =
                self.boards.iter().filter_map(|board| board.stream.head_slot()).max().unwrap_or(i64::MIN);
            self.count_awaited();
        }
    }
}

/// The time `ns` nanoseconds after the clock's start; the start itself if that is negative.
fn instant(ns: i64) -> Instant {
    Instant::from_micros(ns.max(0).cast_unsigned() / 1000)
}
