use serde::Serialize;

/// What came in and what was not used, since the start; nothing is dropped without being counted here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct LinkCounters {
    /// Datagrams received, good or bad.
    pub datagrams: u64,
    /// Sensor packets accepted.
    pub packets: u64,
    /// Frames completed.
    pub frames: u64,
    /// Packets that never came, by gaps in the boards' sequence numbers.
    pub lost: u64,
    /// Packets that came after their frame was done and were dropped.
    pub late: u64,
    /// Packets that came again and were dropped.
    pub duplicate: u64,
    /// Times a board's sequence number started anew (reboot or reconnection).
    pub restarts: u64,
    /// Datagrams refused because they are not well-formed OSC, or nest or grow past the limits.
    pub malformed: u64,
    /// Messages for an address that no board of this floor and no control has.
    pub unknown_address: u64,
    /// Messages for a board that don't carry what the floor says: missing sequence, wrong types, wrong count.
    pub wrong_shape: u64,
    /// Single readings that were NaN, infinite or outside 0 to 65535.
    pub bad_readings: u64,
    /// Datagrams that the kernel dropped because the receive buffer was full, where it tells.
    pub overflowed: u64,
}

impl LinkCounters {
    /// Datagrams and messages that were refused, for whatever reason.
    #[must_use]
    pub const fn refused(&self) -> u64 {
        self.malformed + self.unknown_address + self.wrong_shape
    }
}
