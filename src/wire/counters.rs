//! What came in and what was not used.

use std::ops::{Add, AddAssign};

use serde::Serialize;

/// What came in and what was not used, since the start; nothing is dropped without being counted here.
///
/// A source counts datagrams and what it refused, the assembler what became
/// of the packets; their sum is the whole story.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct LinkCounters {
    /// Datagrams received, good or bad.
    pub datagrams: u64,
    /// Sensor packets accepted.
    pub packets: u64,
    /// Frames completed.
    pub frames: u64,
    /// Frames completed while the tare was still being measured; they are not passed on.
    pub held_back: u64,
    /// Packets that never came, by gaps in the boards' sequence numbers.
    pub lost: u64,
    /// Packets that came after their frame was done, or too old to act on, and were dropped.
    pub late: u64,
    /// Packets that came again and were dropped.
    pub duplicate: u64,
    /// Packets whose sequence number fits nothing seen so far; dropped unless the next two confirm it.
    pub out_of_order: u64,
    /// Times a board's sequence number started anew (reboot or reconnection).
    pub restarts: u64,
    /// Times a board's readings stood still for 100 ms, all of them and under a load, while its packets went on.
    pub frozen: u64,
    /// Times two or more sensors of a tile repeated what they had read, for 100 ms and under a load.
    pub repeats: u64,
    /// Times the load of a tile changed faster than a body changes it.
    pub jumps: u64,
    /// Samples left out or repeated because a board's crystal runs faster or slower than the others'.
    pub slips: u64,
    /// Datagrams refused because they are not well-formed OSC, or nest or grow past the limits.
    pub malformed: u64,
    /// Messages for an address that no board of this floor and no control has.
    pub unknown_address: u64,
    /// Messages for other receivers, in bundles of which the rest was used.
    pub skipped: u64,
    /// Messages for a board that don't carry what the floor says: missing sequence, wrong types, wrong count.
    pub wrong_shape: u64,
    /// Datagrams from senders that may not send them: packets or requests.
    pub foreign: u64,
    /// Datagrams beyond what one sender may send.
    pub limited: u64,
    /// Single readings that were NaN, infinite, outside 0 to 65535, or more than 50 kN.
    pub bad_readings: u64,
    /// Datagrams that the kernel dropped because the receive buffer was full, where it tells,
    /// and messages from apps that nobody took in time.
    pub overflowed: u64,
    /// Requests of apps that were understood and could not be met: no such control or page, a value that doesn't
    /// suit it, a control that is locked or in use.
    pub denied: u64,
    /// Labels from apps of which something was left out: characters that no label may hold, and those beyond 64.
    pub cleaned: u64,
    /// Times a sensor was found in trouble: broken, stuck, drifted too far, noisy.
    pub sensor_troubles: u64,
}

impl LinkCounters {
    /// Datagrams and messages that were refused, for whatever reason; without those that were skipped.
    #[must_use]
    pub const fn refused(&self) -> u64 {
        self.malformed + self.unknown_address + self.wrong_shape + self.foreign + self.limited
    }
}

impl Add for LinkCounters {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            datagrams: self.datagrams + other.datagrams,
            packets: self.packets + other.packets,
            frames: self.frames + other.frames,
            held_back: self.held_back + other.held_back,
            lost: self.lost + other.lost,
            late: self.late + other.late,
            duplicate: self.duplicate + other.duplicate,
            out_of_order: self.out_of_order + other.out_of_order,
            restarts: self.restarts + other.restarts,
            frozen: self.frozen + other.frozen,
            repeats: self.repeats + other.repeats,
            jumps: self.jumps + other.jumps,
            slips: self.slips + other.slips,
            malformed: self.malformed + other.malformed,
            unknown_address: self.unknown_address + other.unknown_address,
            skipped: self.skipped + other.skipped,
            wrong_shape: self.wrong_shape + other.wrong_shape,
            foreign: self.foreign + other.foreign,
            limited: self.limited + other.limited,
            bad_readings: self.bad_readings + other.bad_readings,
            overflowed: self.overflowed + other.overflowed,
            denied: self.denied + other.denied,
            cleaned: self.cleaned + other.cleaned,
            sensor_troubles: self.sensor_troubles + other.sensor_troubles,
        }
    }
}

impl AddAssign for LinkCounters {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
