//! The time of the assembler, and the times at which boards may become silent.

use super::clock::SLOT_NS;

/// Time after the first packet during which a silent board does not count as missing.
const GATHERING_NS: i64 = 100_000_000;

/// The time on the source's clock, and the last and the next look for silent boards.
#[derive(Clone, Debug, Default)]
pub(super) struct Times {
    now_ns: i64,
    /// Arrival of the first packet.
    first_packet_ns: Option<i64>,
    swept_ns: i64,
    /// No board becomes silent before this time.
    patient_until_ns: i64,
}

impl Times {
    /// The latest time passed.
    pub(super) const fn now_ns(&self) -> i64 {
        self.now_ns
    }

    /// Advances time; an earlier time counts as the present one.
    pub(super) fn pass(&mut self, now_ns: i64) {
        self.now_ns = self.now_ns.max(now_ns);
    }

    /// Notes a packet that arrives now.
    pub(super) fn note_packet(&mut self) {
        self.first_packet_ns.get_or_insert(self.now_ns);
    }

    /// Whether the boards report for the first time, one after the other.
    pub(super) fn is_gathering(&self) -> bool {
        self.first_packet_ns.is_none_or(|first| self.now_ns - first < GATHERING_NS)
    }

    /// Begins to look for silent boards.
    pub(super) const fn start(&mut self) {
        self.swept_ns = self.now_ns;
    }

    /// Whether a board may have become silent; true at most once a millisecond.
    pub(super) const fn is_sweep_due(&mut self) -> bool {
        if self.now_ns - self.swept_ns < SLOT_NS {
            return false;
        }
        self.swept_ns = self.now_ns;
        self.now_ns >= self.patient_until_ns
    }

    /// Sets the time before which no board becomes silent.
    pub(super) const fn wait_until(&mut self, patient_until_ns: i64) {
        self.patient_until_ns = patient_until_ns;
    }
}
