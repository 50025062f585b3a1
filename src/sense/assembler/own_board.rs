//! Boards with a rate of their own, and their samples in frames.

use std::time::Duration;

use super::board::BoardTrack;
use super::clock::SlotClock;
use super::numbering::{NumberVerdict, TimeBase};
use super::own_rate::OwnRate;
use super::pace::PacketPace;
use super::timed::TimedStream;
use crate::sense::health::Health;
use crate::sense::{ForceFrame, TileSample};
use crate::wire::{LinkCounters, Readings, SensorPacket};

/// The effect of a board with a rate of its own on one frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Entered {
    /// Whether a new sample has entered the frame.
    pub(super) is_new: bool,
    /// Whether the board has just become silent.
    pub(super) fell_silent: bool,
}

impl BoardTrack {
    /// Notes the number of `packet`, which arrived at `now_ns`, and whether its readings differ from those of a packet
    /// before with the same number; returns true if the board has got another time base.
    pub(super) fn note_number(
        &mut self,
        packet: &SensorPacket,
        now_ns: i64,
        is_other: bool,
        counters: &mut LinkCounters,
    ) -> bool {
        let Some(NumberVerdict { base, hz }) = self.stream.numbers.note(packet.sequence, now_ns, is_other)
        else {
            return false;
        };
        match &mut self.own_rate {
            Some(own) => own.stream.rebase(base),
            None if base == TimeBase::Packets => false,
            None => {
                self.set_own_rate(TimedStream::new(base, PacketPace::of_rate(hz)), counters);
                true
            }
        }
    }

    /// Gives a board that does not send once a millisecond a rate of its own.
    pub(super) fn set_own_rate(&mut self, stream: TimedStream, counters: &mut LinkCounters) {
        let mut tiles = self.tiles();
        tiles.sort_unstable();
        tiles.dedup();
        self.stream.leave_slots(counters);
        self.forget_waiting();
        self.own_rate = Some(Box::new(OwnRate::new(stream, tiles)));
        self.follow_rate();
    }

    /// Returns a board to one packet a millisecond.
    pub(super) fn clear_own_rate(&mut self) {
        self.own_rate = None;
        self.stream.enter_slots();
    }

    /// Adapts time-outs and the meter of lost packets to its own rate.
    pub(super) fn follow_rate(&mut self) {
        if let Some(own) = &self.own_rate {
            self.stream.presence.set_period(own.stream.period_ns());
            self.stream.loss.set_rate(own.hz());
            self.stream.loss.forget();
        }
    }

    /// Adopts its own rate as measured; returns whether it has changed.
    pub(super) fn adopt_own_rate(&mut self) -> bool {
        let Some(own) = &mut self.own_rate else { return false };
        if !own.stream.adopt_pace() {
            return false;
        }
        if own.stream.pace().is_one() && own.stream.base() == TimeBase::Packets {
            self.clear_own_rate();
        } else {
            self.follow_rate();
        }
        true
    }

    /// Takes a packet at its own rate; `is_other` as for [`BoardTrack::note_number`].
    pub(super) fn take_at_own_rate(
        &mut self,
        packet: &SensorPacket,
        now_ns: i64,
        is_other: bool,
        clock: &SlotClock,
        counters: &mut LinkCounters,
    ) {
        let Some(own) = &mut self.own_rate else { return };
        let Some(restarted) = own.take(packet, now_ns, is_other, clock, &mut self.stream.loss, counters)
        else {
            return;
        };
        counters.packets += 1;
        if restarted {
            self.stream.presence.interrupt(now_ns);
            self.interrupt_tare();
        }
    }

    /// Lets its latest sample enter the frame of `slot`, which is at `at_ns`; without a new one, the last values stay.
    pub(super) fn enter(
        &mut self,
        slot: i64,
        at_ns: i64,
        sampled_ns: i64,
        frame: &mut ForceFrame,
        health: &mut Health,
        counters: &mut LinkCounters,
    ) -> Entered {
        let Some(mut own) = self.own_rate.take() else { return Entered::default() };
        let pending = own.enter(slot, counters);
        if let Some(pending) = &pending {
            self.note_kind(&pending.sample);
            let is_same = own.in_use.as_ref() == Some(&pending.sample);
            let repeats = is_same && !self.is_taring() && self.bears_load(&pending.sample, health);
            self.set_repeats(repeats);
            if !own.note_repeat(repeats) {
                self.stream.deliver(pending.arrived_ns);
            }
        }
        let fell_silent = self.stream.presence.pass(at_ns);
        if fell_silent {
            counters.frozen += u64::from(self.repeats());
            self.interrupt_tare();
            own.restart();
        }
        let is_new = pending.is_some();
        let age = Duration::from_nanos(own.age_ns(at_ns).unwrap_or(0).cast_unsigned());
        for tile in &own.tiles {
            if let Some(sample) = frame.samples.get_mut(*tile as usize) {
                *sample = TileSample { age, is_new };
            }
        }
        self.own_rate = Some(own);
        self.put(pending.as_ref().map(|pending| &pending.sample), sampled_ns, frame, health, counters);
        if let (Some(own), Some(pending)) = (&mut self.own_rate, pending) {
            own.in_use = Some(pending.sample);
        }
        Entered { is_new, fell_silent }
    }

    /// Whether `readings` equal those of the packet before, bit for bit; notes them for a board at its own rate.
    pub(super) fn repeats_packet(&mut self, readings: &Readings) -> Option<bool> {
        self.own_rate.as_mut().map(|own| own.last.replace(readings))
    }
}
