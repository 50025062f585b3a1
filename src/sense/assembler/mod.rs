//! Packets of boards in, frames of the whole floor out.

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

/// A slot is taken for complete when a board has delivered one this much later.
const AHEAD: i64 = 2;

/// The same on a part of a floor, where other computers forward what some boards send. One that is busy for a few
/// milliseconds costs a delay, not a tenth of its boards' packets (our choice; six programs on two cores lost 2 to 3 %
/// of what was forwarded with 2, and none with 6).
const AHEAD_OF_PART: i64 = 6;

/// A slot still incomplete this long after its last packet is passed on when time passes without packets.
const PATIENCE_NS: i64 = 3 * SLOT_NS;

/// How often the boards' slots and the clock are compared with the receive clock.
const ALIGN_NS: i64 = 64 * SLOT_NS;

/// Slots of all boards that lie this much ahead of their packets are moved back: steering would take a minute, and a
/// board that counts a thousandth too fast would lead the clock away.
const FAST_NS: i64 = 20 * SLOT_NS;

/// Puts the packets of all boards together into one calibrated, tared [`ForceFrame`] per millisecond.
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
/// **Slots.** Each board counts its own samples, and boards start at different
/// times. A board's first packet is given the common millisecond (slot) nearest
/// to its arrival; from there its sequence number counts slots. Crystals drift:
/// a board more than 0.75 ms off the others is moved by a slot, which leaves
/// out or repeats one sample. Delay is judged by the quickest packet of some
/// 64 ms, so that jitter moves nothing.
///
/// **Rates.** The pace of a board that sends more or fewer than 1000 packets a second is measured within a
/// second; its samples then go to the slots in which they arrive, the first where several do. Beyond
/// [`crate::wire::BOARD_RATES_HZ`] its sensors are [`Quality::Degraded`].
///
/// **Time.** A frame's `at` is its slot's time on a sample clock that follows
/// the receive clock by at most 500 ppm, or is set forward when it is more than
/// 100 ms behind. It is never more than 100 ms ahead, whatever boards send. It grows from frame to frame, by 1 ms unless slots were lost
/// altogether. Where packets are stamped with exact milliseconds, as by a
/// simulated floor, `at` is exact to the microsecond.
///
/// **Completeness.** A frame is ready when every board that reported within the last
/// 100 ms has delivered its slot or a later one, or when any board is two slots
/// ahead; six on a part of a larger floor. Boards without a sample in the slot keep their last values. What
/// comes later than that, comes twice, or comes after silence and was more than
/// 20 ms on its way, is dropped and counted.
///
/// **Trust.** A board without a usable sample for 100 ms becomes
/// [`Quality::Stale`], and so does one that rebooted, for at least one frame. Readings that
/// repeat those of the packet before, all of them and under a load, are not usable where the sensors'
/// noise makes that improbable: the converters stand still ([`BoardStatus::frozen`]). The sensors of a tile become
/// [`Quality::Stale`] as well if two of them do so by themselves ([`Assembler::repeating`]).
/// It returns with its next sample, but only after a clean second if outages
/// follow each other within two seconds. More than 10 % of lost packets within
/// a second, or a sensor at 98 % of its range, or one that sends counts and was never
/// calibrated ([`Floor::uncalibrated`]), means [`Quality::Degraded`]; a
/// reading that is not a number [`Quality::Faulty`].
///
/// **Health.** Each sensor is compared with the other three of its plate, and its
/// zero is followed while its tile is empty and quiet; [`Trouble`] says what can be found. Time is
/// the boards' own there: slots, however the sample clock is steered.
///
/// It has no clock of its own: `received` and `now` are on the source's clock;
/// one that is earlier than the last counts as the last.
#[derive(Clone, Debug)]
pub struct Assembler {
    floor_tiles: usize,
    boards: Vec<BoardTrack>,
    buffers: Buffers,
    /// `None` before the first packet.
    clock: Option<SampleClock>,
    now_ns: i64,
    /// When the first packet came.
    first_packet_ns: Option<i64>,
    swept_ns: i64,
    /// No board falls silent before this.
    patient_until_ns: i64,
    aligned_ns: i64,
    /// Slots that wait for boards, earliest first.
    waiting: ArrayVec<Waiting, BUFFERS>,
    /// How many boards frames wait for.
    awaited: usize,
    /// No board had reached a later slot before the packet that is sorted in.
    front: i64,
    /// By how many slots one board must be ahead for them to wait no longer.
    ahead: i64,
    /// The last slot made into a frame.
    done: i64,
    /// Whether the waiting slots are taken for complete.
    flush: bool,
    /// Whether a board fell silent and no frame has said so yet.
    has_news: bool,
    /// Whether frames are passed on: not before the tare is known.
    started: bool,
    frame: ForceFrame,
    health: Health,
    swaps: Swaps,
    counters: LinkCounters,
    /// Space for sorting the boards' delays.
    delays: Vec<(i64, usize)>,
}

/// How long after the first packet boards may still be silent without being missed.
const GATHERING_NS: i64 = 100_000_000;

#[derive(Clone, Copy, Debug)]
struct Waiting {
    slot: i64,
    buffer: usize,
    /// Awaited boards that have delivered this slot or a later one.
    passed: usize,
    /// When its last packet came.
    received: Instant,
}

/// How one board is doing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardStatus {
    /// How far its sensors can be trusted, each by itself perhaps less.
    pub quality: Quality,
    /// Time since its last usable packet; `None` if none has come.
    pub age: Option<Duration>,
    /// Share of its packets lost or too late over the last second, 0 to 1.
    pub loss: f32,
    /// Whether it is stale because all it reads has stood still for 100 ms under a load.
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

    /// An assembler for the boards of `floor`. With [`Tare::AtStart`] no frame
    /// is passed on until the boards that reported at first have been tared; one that
    /// appears later is stale until it is.
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

    /// Takes one packet; afterwards [`Assembler::ready`] should be called until it gives `None`.
    ///
    /// Packets of boards this floor does not have, or with another number of
    /// readings than the board has channels, are counted and dropped.
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

    /// Lets time pass without a packet, so that silence is noticed; `now` is on the source's clock.
    ///
    /// Call it at least every 10 ms for a lost floor to be noticed within 120 ms.
    pub fn poll(&mut self, now: Instant) {
        self.pass_time(nanos(now));
        let waited = self.waiting.last().map_or(0, |waiting| self.now_ns - nanos(waiting.received));
        self.flush |= waited >= PATIENCE_NS;
    }

    /// The next frame, if one is complete; call until `None`. A frame of which
    /// eight later ones wait is dropped and its packets counted as late.
    pub fn ready(&mut self) -> Option<&ForceFrame> {
        loop {
            let (slot, buffer, received) = if self.is_due() {
                let first = self.waiting.remove(0);
                (first.slot, Some(first.buffer), first.received)
            } else if self.started && self.waiting.is_empty() && self.has_news {
                // Nobody delivers: only the news that boards fell silent. Before the first frame it is news to nobody.
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

    /// Whether a slot is complete, or taken for it: [`Assembler::ready`] gives its frame, unless the tare is not known
    /// yet.
    pub(crate) fn is_due(&self) -> bool {
        self.waiting.first().is_some_and(|first| {
            let newest = self.waiting.last().map_or(first.slot, |last| last.slot);
            self.flush || first.passed >= self.awaited || newest - first.slot >= self.ahead
        })
    }

    /// Whether packets arrive, as of the last packet or poll.
    ///
    /// While the boards report for the first time, one after the other, the floor is still awaited.
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

    /// Of how many boards usable packets arrive, as of the last packet or poll, and how many the floor has.
    #[must_use]
    pub fn boards_live(&self) -> (u32, u32) {
        let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        let live = self.boards.iter().filter(|board| board.stream.presence.is_live());
        (count(live.count()), count(self.boards.len()))
    }

    /// How board `number` is doing, as of the last packet or poll; `None` if the floor has no such board.
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

    /// What became of the tare; while boards differ, the one that needs attention most.
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

    /// The tare in use, per tile and corner as in [`Floor::tare`]; zero for sensors that no board reads.
    #[must_use]
    pub fn tare(&self) -> Vec<[Newtons; 4]> {
        let mut tare = vec![[Newtons::ZERO; 4]; self.floor_tiles];
        for (tile, corner, force) in self.boards.iter().flat_map(BoardTrack::tares) {
            tare[tile][corner.index()] = force;
        }
        tare
    }

    /// Number of sensors whose counts are taken for those of a nominal part, since the floor says
    /// nothing of them; [`Floor::uncalibrated`] names them. Their forces may be off by a quarter
    /// and more, and are [`Quality::Degraded`].
    #[must_use]
    pub fn uncalibrated(&self) -> usize {
        self.boards.iter().map(BoardTrack::uncalibrated).sum()
    }

    /// Whether the empty floor, at the start, read otherwise than the floor's tare says on most of its tiles:
    /// it is the file of another floor, or one from long ago. All sensors are [`Quality::Degraded`] then.
    #[must_use]
    pub fn is_foreign(&self) -> bool {
        self.health.is_foreign()
    }

    /// The boards that have changed places, and how often they have: each that is out of its place comes with the one
    /// whose empty tiles it reads, which is out of its place too. Two have been swapped, more follow each other in a
    /// ring. Their sensors are [`Quality::Faulty`] until that is mended. Found only where the floor's tare comes from
    /// its file.
    pub fn swapped(&self) -> (u64, impl Iterator<Item = (u16, u16)> + '_) {
        self.swaps.places()
    }

    /// Writes how the sensors are doing, as of the last frame, into `health`.
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

    /// The sensors that are in trouble, as of the last frame.
    pub fn troubles(&self) -> impl Iterator<Item = (SensorId, Trouble)> + '_ {
        self.health.troubles()
    }

    /// How often a sensor fell into trouble or got out of it; unchanged if [`Assembler::troubles`] is.
    #[must_use]
    pub const fn trouble_changes(&self) -> u64 {
        self.health.changes()
    }

    /// How far each sensor's zero has drifted from its tare and was followed, per tile and corner as in
    /// [`Floor::tare`]; at most 20 % of the sensor's range.
    #[must_use]
    pub fn drift(&self) -> impl ExactSizeIterator<Item = [Newtons; 4]> + '_ {
        self.health.drift()
    }

    /// How much the floor's sensors are found to creep, as a share of their load for each decade of time: 0 to 0.1.
    /// What lingers of a load is taken off accordingly; below 0.02, nothing is.
    #[must_use]
    pub const fn creep(&self) -> f32 {
        self.health.creep()
    }

    /// What came in and what was dropped; datagrams and refusals are counted by the source.
    #[must_use]
    pub fn counters(&self) -> LinkCounters {
        LinkCounters {
            sensor_troubles: self.health.found(),
            jumps: self.jumps().0,
            repeats: self.repeating().0,
            ..self.counters
        }
    }

    /// How often the load of a tile changed faster than a body changes it (by 300 N in a millisecond), and the
    /// last such tile with its change in newtons. Such a tile is [`Quality::Faulty`] for 100 ms.
    #[must_use]
    pub fn jumps(&self) -> (u64, Option<(TileId, f32)>) {
        self.health.jumps()
    }

    /// How often two or more sensors of a tile have repeated, for 100 ms and under a load, what they had read before,
    /// although their noise makes that improbable; and the tiles whose sensors do so now or did in the last 100 ms. These
    /// are [`Quality::Stale`].
    pub fn repeating(&self) -> (u64, impl Iterator<Item = TileId> + '_) {
        self.health.repeating()
    }

    /// Moves time on and notices silence, at most once a millisecond.
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
        // Whoever reports from now on has as much time again.
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

    /// Counts anew which boards frames wait for and which have passed the waiting slots.
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
                // After silence on all boards the others are likely to return as well.
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

    /// Waits for every board a while, as if all had just reported.
    fn expect_all(&mut self) {
        self.boards.iter_mut().for_each(|board| board.stream.expect(self.now_ns));
        self.awaited = self.boards.len();
    }

    /// Starts the sample clock with the first packet of all.
    fn start(&mut self) -> SampleClock {
        self.expect_all();
        self.done = -1;
        (self.swept_ns, self.aligned_ns) = (self.now_ns, self.now_ns);
        *self.clock.insert(SampleClock::new(self.now_ns))
    }

    /// Notes that a board that was at slot `head` has now reached `slot`.
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
            // The board has just slipped back a slot: one of its samples is left out.
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

    /// Makes room for `slot`, which board `number` has reached, at `place` among the waiting ones.
    fn open(&mut self, mut place: usize, slot: i64, number: usize) {
        if self.waiting.is_full() {
            // Only if the caller left frames unread.
            let oldest = self.waiting.remove(0);
            self.done = oldest.slot;
            self.release(oldest.buffer);
            place = place.saturating_sub(1);
        }
        let taken = |buffer: &usize| self.waiting.iter().any(|waiting| waiting.buffer == *buffer);
        let Some(buffer) = (0..BUFFERS).find(|buffer| !taken(buffer)) else { return };
        let has_passed = |board: &&BoardTrack| board.stream.awaited && board.stream.head_slot() >= Some(slot);
        // Whoever opens a slot is mostly the first to reach it: no need to ask all the others.
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

    /// Makes the frame of `slot`; false if the tare is still being measured.
    fn complete(&mut self, slot: i64, buffer: Option<usize>, received: Instant) -> bool {
        let at_ns = self.clock.as_ref().map_or(0, |clock| clock.at_ns(slot));
        // When it was sampled by the boards' own count: how this computer's clock is steered changes nothing of what is
        // found of sensors, which two computers that sense the same would else find differently.
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
            // Whatever the laws are, on a floor with swapped boards they are those of other sensors.
            let faults = [
                (is_swapped, CalibrationFault::BoardsSwapped),
                // Through nominal laws the empty floor reads otherwise than any tare says.
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

    /// Compares each board's slots with its packets' arrival, and the clock with all of them.
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
                // At another rate it is no clock for the others, and follows the receive clock by itself.
                Some(delay) => slipped += stream.slip(delay).unsigned_abs(),
                None => {}
            }
        }
        if !self.delays.is_empty() {
            let middle = (self.delays.len() - 1) / 2;
            let common = self.delays.select_nth_unstable(middle).1.0;
            // Nothing arrives before it was sampled: slots that lie further ahead are moved back, and not the clock.
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

/// The moment `ns` nanoseconds after the clock's start; the start itself if that is negative.
fn instant(ns: i64) -> Instant {
    Instant::from_micros(ns.max(0).cast_unsigned() / 1000)
}
