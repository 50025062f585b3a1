//! Counts of received and rejected packets.

use std::ops::{Add, AddAssign};

use serde::Serialize;

/// Counts of received and rejected packets since the start; every dropped packet is counted here.
///
/// A source counts datagrams and rejections, the assembler counts the use of the packets; the sum of both is
/// complete.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct LinkCounters {
    /// Datagrams received, valid or not.
    pub datagrams: u64,
    /// Sensor packets accepted.
    pub packets: u64,
    /// Frames completed.
    pub frames: u64,
    /// Frames completed while the tare was still being measured; they are not passed on.
    pub held_back: u64,
    /// Packets that did not arrive, by gaps in the boards' sequence numbers.
    pub lost: u64,
    /// Packets that arrived after their frame was complete, or too old to use, and were dropped.
    pub late: u64,
    /// Duplicate packets that were dropped.
    pub duplicate: u64,
    /// Packets with a sequence number that does not follow the ones before; dropped unless the next two confirm it.
    pub out_of_order: u64,
    /// Restarts of a board's sequence number (reboot or reconnection).
    pub restarts: u64,
    /// Times a board froze: all its readings stayed the same for 100 ms under a load while its packets continued.
    pub frozen: u64,
    /// Times two or more sensors of a tile repeated their readings for 100 ms under a load.
    pub repeats: u64,
    /// Times the load of a tile changed faster than a body can change it.
    pub jumps: u64,
    /// Samples dropped or repeated because a board's crystal runs faster or slower than the others'.
    pub slips: u64,
    /// Datagrams rejected because they are not well-formed OSC, or exceed the limits on nesting or size.
    pub malformed: u64,
    /// Messages with an address of neither a board of this floor nor a control.
    pub unknown_address: u64,
    /// Messages for other receivers, in bundles with used messages.
    pub skipped: u64,
    /// Messages for a board that differ from the floor file: missing sequence, wrong types, wrong count.
    pub wrong_shape: u64,
    /// Datagrams with packets or requests from senders that are not allowed to send them.
    pub foreign: u64,
    /// Datagrams beyond the rate limit of one sender.
    pub limited: u64,
    /// Single readings that were NaN, infinite, outside 0 to 65535, or more than 50 kN.
    pub bad_readings: u64,
    /// Datagrams that the kernel dropped because the receive buffer was full, where the kernel reports it, and
    /// messages from apps that were not processed in time.
    pub overflowed: u64,
    /// Valid requests of apps that were rejected: no such control or page, an unsuitable value, a control that is
    /// locked or in use.
    pub denied: u64,
    /// Labels from apps from which characters were removed: forbidden ones, and those beyond 64.
    pub cleaned: u64,
    /// Times a sensor developed a trouble: broken, stuck, drifted too far, noisy.
    pub sensor_troubles: u64,
    /// Times the thread that reads packets gave up its real-time priority, since it took a whole processor and did not
    /// keep up (Linux only).
    pub overruns: u64,
}

impl LinkCounters {
    /// Returns the number of rejected datagrams and messages; skipped messages do not count.
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
            overruns: self.overruns + other.overruns,
        }
    }
}

impl AddAssign for LinkCounters {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
