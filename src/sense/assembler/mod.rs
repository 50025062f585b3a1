//! Assembles the packets of boards into frames of the whole floor.

mod align;
mod board;
mod buffers;
mod clock;
mod clocked;
mod numbering;
mod own_board;
mod own_rate;
mod pace;
mod pending;
mod presence;
mod sample;
mod sequence;
mod slots;
mod status;
mod stream;
mod swap;
mod tare;
mod timed;
mod times;
mod window;
mod write;

use std::time::Duration;

pub use numbering::TimeBase;
pub use status::{BoardCounts, BoardStatus, BoardTiming};
pub use tare::{Tare, TareOutcome, TareRules};

use self::align::Alignment;
use self::board::BoardTrack;
use self::buffers::Buffers;
use self::clock::{SLOT_NS, SlotClock, nanos};
use self::presence::SILENT_NS;
use self::slots::Slots;
use self::swap::Swaps;
use self::times::Times;
use super::health::Health;
use super::{CalibrationFault, ForceFrame, HoldDoubt, Quality, TileSample};
use crate::floor::Floor;
use crate::units::Instant;
use crate::wire::{LinkCounters, SensorPacket};

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
/// **Rates.** A board may send 20 to 4000 packets a second ([`crate::wire::BOARD_RATES_HZ`]; beyond, its sensors are
/// [`Quality::Degraded`]). The floor file names the rate, or it is measured within a second. The time of its samples
/// comes from a number that counts packets, from a number in milliseconds, or from their arrival ([`TimeBase`]). Frames
/// do not wait for such a board: where no other board makes frames, the clock does, one a millisecond. A sample enters
/// the first frame after its arrival, with its age ([`ForceFrame::samples`]); frames between two samples repeat the
/// last one and say so. Several samples in a millisecond are averaged.
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
/// **Trust.** A board without a usable sample for 100 ms becomes [`Quality::Stale`] (below 30 Hz: for three periods,
/// 142 ms at most), and so does one that rebooted,
/// for at least one frame. Readings of a loaded board that all repeat those of the packet before are not usable if
/// the sensors' noise makes that improbable: the converters are frozen ([`BoardStatus::frozen`]). The sensors of a
/// tile become [`Quality::Stale`] as well if two of them repeat by themselves ([`Assembler::repeating`]). A stale
/// board returns with its next sample, but only after a clean second if outages follow each other within two seconds.
/// More than 10 % of lost packets within a second, a sensor at 98 % of its range, or a sensor that sends counts and
/// was never calibrated ([`Floor::uncalibrated`]) means [`Quality::Degraded`]; a reading that is not a number means
/// [`Quality::Faulty`].
///
/// **Health.** Each sensor is compared with the other three of its plate, and its zero is tracked while its tile is
/// empty and quiet; [`crate::sense::Trouble`] lists the detectable faults. These checks use the boards' own time,
/// counted in slots and independent of the steering of the sample clock.
///
/// The assembler has no clock of its own: `received` and `now` are on the source's clock; a time earlier than the last
/// counts as the last.
#[derive(Clone, Debug)]
pub struct Assembler {
    floor_tiles: usize,
    boards: Vec<BoardTrack>,
    buffers: Buffers,
    slots: Slots,
    times: Times,
    /// `None` before the first packet.
    clock: Option<SlotClock>,
    alignment: Alignment,
    /// Number of boards with a rate of their own.
    own_rates: usize,
    /// Whether a board became silent and no frame has reported it yet.
    has_news: bool,
    /// Whether frames are released: not before the tare is known.
    started: bool,
    frame: ForceFrame,
    health: Health,
    swaps: Swaps,
    counters: LinkCounters,
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
        let own_rates = boards.iter().filter(|board| board.own_rate.is_some()).count();
        let mut frame = ForceFrame::empty(&floor.geometry);
        frame.quality.fill([Quality::Stale; 4]);
        if !floor.noiseless {
            frame.hold_doubts.fill(Some(HoldDoubt::Unlearned));
        }
        let mut assembler = Self {
            floor_tiles: floor.geometry.tile_count(),
            alignment: Alignment::new(boards.len()),
            own_rates,
            buffers: Buffers::new(boards.len()),
            swaps: Swaps::new(&boards),
            boards,
            slots: Slots::new(floor.geometry.is_part()),
            times: Times::default(),
            clock: None,
            has_news: false,
            started: false,
            frame,
            health: Health::new(floor),
            counters: LinkCounters::default(),
        };
        assembler.note_rates();
        assembler
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
                self.times.note_packet();
                self.sort_in(number, packet);
            }
        }
    }

    /// Advances time without a packet, so that silence is detected; `now` is on the source's clock.
    ///
    /// Call it at least every 10 ms to detect a lost floor within 120 ms.
    pub fn poll(&mut self, now: Instant) {
        self.pass_time(nanos(now));
        self.slots.release_overdue(self.times.now_ns());
    }

    /// The next frame, if one is complete; call until `None`. A frame with eight later ones waiting is dropped and
    /// its packets counted as late.
    pub fn ready(&mut self) -> Option<&ForceFrame> {
        loop {
            let (slot, buffer, received) = if let Some(first) = self.slots.take_due() {
                (first.slot, Some(first.buffer), first.received)
            } else if let Some(slot) = self.clocked_slot() {
                (slot, None, instant(self.times.now_ns()))
            } else if self.started && self.slots.is_empty() && self.has_news {
                // No board delivers: the frame only reports that boards became silent. Before the first frame there
                // is nothing to report.
                let clock = self.clock.as_ref()?;
                let now_ns = self.times.now_ns();
                (clock.slot_before(now_ns).max(self.slots.done().saturating_add(1)), None, instant(now_ns))
            } else {
                self.slots.end_release();
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
        self.slots.is_due()
    }

    /// Advances time and detects silence, at most once a millisecond.
    fn pass_time(&mut self, now_ns: i64) {
        self.times.pass(now_ns);
        if self.clock.is_none() || !self.times.is_sweep_due() {
            return;
        }
        let now_ns = self.times.now_ns();
        let mut gave_out = false;
        // Boards that report from now on have the full time-out again.
        let mut patient_until_ns = now_ns + SILENT_NS;
        for board in &mut self.boards {
            // The frames by the clock notice the silence of a board at its own rate.
            if board.own_rate.is_none() && board.stream.presence.pass(now_ns) {
                self.counters.frozen += u64::from(board.repeats());
                board.interrupt_tare();
                self.has_news = true;
            }
            if board.stream.is_overdue(now_ns) {
                board.stream.awaited = false;
                gave_out = true;
            }
            patient_until_ns = patient_until_ns.min(board.stream.patient_until_ns());
        }
        self.times.wait_until(patient_until_ns);
        if gave_out {
            self.slots.count_awaited(&self.boards);
        }
    }

    /// Finds the packet's slot and stores it there, if it came in time.
    fn sort_in(&mut self, number: usize, packet: &SensorPacket) {
        let clock = self.clock.unwrap_or_else(|| self.start());
        let (now_ns, done) = (self.times.now_ns(), self.slots.done());
        if self.is_at_own_rate(number, packet, &clock) {
            return;
        }
        let board = &mut self.boards[number];
        let head = board.stream.head_slot();
        let Some(place) = board.stream.place(packet.sequence, now_ns, &clock, done, &mut self.counters)
        else {
            return;
        };
        if place.restarted {
            board.interrupt_tare();
            self.has_news |= board.stream.presence.has_news();
        }
        if place.restarted || !board.stream.awaited {
            board.stream.awaited = true;
            if !self.slots.awaits_any() {
                // After silence of all boards the others will probably return as well.
                self.expect_all();
            }
            self.slots.count_awaited(&self.boards);
        } else {
            self.slots.pass(head, place.slot);
        }
        if place.usable {
            self.store(number, place.slot, packet);
        } else {
            self.note_unusable(number, &clock);
        }
        self.slots.reach(place.slot);
        self.align();
    }

    /// Waits for every board for a while, as if all had just reported.
    fn expect_all(&mut self) {
        let now_ns = self.times.now_ns();
        let counting = self.boards.iter_mut().filter(|board| board.own_rate.is_none());
        counting.for_each(|board| board.stream.expect(now_ns));
        self.slots.await_all(self.boards.len() - self.own_rates);
    }

    /// Starts the sample clock with the first packet.
    fn start(&mut self) -> SlotClock {
        self.expect_all();
        self.slots.set_done(-1);
        self.times.start();
        self.alignment.start(self.times.now_ns());
        *self.clock.insert(SlotClock::new(self.times.now_ns()))
    }

    fn store(&mut self, number: usize, slot: i64, packet: &SensorPacket) {
        let Self { slots, boards, counters, .. } = self;
        let Some(buffer) = slots.buffer(slot, number, packet.received, boards, counters) else { return };
        let board = &mut self.boards[number];
        if board.has(buffer) {
            // The board has just slipped back by a slot: this sample is left out.
            return;
        }
        if board.store(buffer, &packet.readings, &mut self.buffers, &self.health) {
            board.stream.deliver(self.times.now_ns());
        }
        self.counters.packets += 1;
        board.stream.counts.packets += 1;
        self.swaps.note(number, slot, self.buffers.sample(buffer, number), &self.boards);
        self.boards[number].set_swapped(self.swaps.of(number).is_some());
    }

    /// Makes the frame of `slot`; returns false if the tare is still being measured.
    fn complete(&mut self, slot: i64, buffer: Option<usize>, received: Instant) -> bool {
        let at_ns = self.clock.as_ref().map_or(0, |clock| clock.at_ns(slot));
        // Sampling time by the boards' own count. The steering of this computer's clock must not influence the sensor
        // checks; two computers with the same packets would find different faults.
        let sampled_ns = slot.max(0).saturating_mul(SLOT_NS);
        self.slots.set_done(slot);
        let (mut is_taring, mut is_swapped, mut lacks_laws) = (false, false, false);
        let Self { boards, buffers, frame, health, counters, .. } = self;
        frame.is_new = buffer.is_some() || self.has_news;
        if self.own_rates > 0 {
            frame.samples.fill(TileSample::NOW);
        }
        for board in boards {
            if board.own_rate.is_some() {
                let entered = board.enter(slot, at_ns, sampled_ns, frame, health, counters);
                frame.is_new |= entered.is_new | entered.fell_silent;
                self.has_news |= entered.fell_silent;
            } else {
                board.apply(buffer, sampled_ns, buffers, frame, health, counters);
            }
            is_taring |= board.awaits_tare();
            is_swapped |= board.is_swapped();
            lacks_laws |= board.lacks_laws();
        }
        self.started |= !is_taring;
        if self.started {
            let next = self.frame.at + Duration::from_micros(u64::from(self.counters.frames > 0));
            self.frame.at = instant(at_ns).max(next);
            self.frame.received = received;
            self.health.inspect(&mut self.frame, instant(sampled_ns));
            self.doubt_slow_boards();
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
        let Self { alignment, slots, boards, counters, .. } = self;
        let slipped = alignment.align(self.times.now_ns(), slots.done(), clock, boards, counters);
        let has_new_rates = alignment.take_new_rates();
        if slipped != 0 || has_new_rates {
            counters.slips += slipped;
            slots.rebuild(boards);
        }
        if has_new_rates {
            self.note_rates();
        }
    }
}

/// The time `ns` nanoseconds after the clock's start; the start itself if that is negative.
fn instant(ns: i64) -> Instant {
    Instant::from_micros(ns.max(0).cast_unsigned() / 1000)
}
