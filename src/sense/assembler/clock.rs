//! The sample clock, steered by the arrival of packets.

use crate::units::Instant;

/// One slot of the sample clock, in nanoseconds: a frame each millisecond.
pub(super) const SLOT_NS: i64 = 1_000_000;

/// Largest difference in speed between sample clock and receive clock, in nanoseconds per slot (500 ppm).
const MAX_STEER_NS: i64 = 500;

/// Time over which an error is steered out, in slots (1 s).
const STEER_SLOTS: i64 = 1000;

/// Error above which the clock is set instead of steered; only ever forward.
const SET_NS: i64 = 100_000_000;

/// Nanoseconds on the receive clock, at most 146 years.
pub(super) fn nanos(instant: Instant) -> i64 {
    const END: u64 = 1 << 62;
    instant.micros().saturating_mul(1000).min(END).cast_signed()
}

/// Gives each slot (one millisecond of the boards) its time.
///
/// Runs at the receive clock's speed, corrected by at most 500 ppm, so that
/// frames are evenly spaced however unevenly packets arrive.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlotClock {
    base_slot: i64,
    base_ns: i64,
    slot_ns: i64,
}

impl SlotClock {
    /// A clock whose slot 0 is at `start_ns`.
    pub(super) const fn new(start_ns: i64) -> Self {
        Self { base_slot: 0, base_ns: start_ns, slot_ns: SLOT_NS }
    }

    /// Time of `slot`.
    pub(super) const fn at_ns(&self, slot: i64) -> i64 {
        self.base_ns.saturating_add(slot.saturating_sub(self.base_slot).saturating_mul(self.slot_ns))
    }

    /// The last slot not after `ns`.
    pub(super) const fn slot_before(&self, ns: i64) -> i64 {
        self.base_slot + (ns - self.base_ns).div_euclid(self.slot_ns)
    }

    /// The slot nearest to `ns`.
    pub(super) const fn slot_near(&self, ns: i64) -> i64 {
        self.slot_before(ns + self.slot_ns / 2)
    }

    /// Corrects the clock from `slot` on; `error_ns` is the delay of packets after their slots' times. Returns by how
    /// much the clock was set forward, zero if it was only steered.
    pub(super) fn correct(&mut self, slot: i64, error_ns: i64) -> i64 {
        self.base_ns = self.at_ns(slot);
        self.base_slot = slot;
        if error_ns > SET_NS {
            self.base_ns += error_ns;
            self.slot_ns = SLOT_NS;
            error_ns
        } else {
            self.slot_ns = SLOT_NS + (error_ns / STEER_SLOTS).clamp(-MAX_STEER_NS, MAX_STEER_NS);
            0
        }
    }
}

/// Minimum number of packets in a window for its least delay to be valid.
const ENOUGH: u32 = 16;

/// Minimum length of a window, so that one burst of delayed packets does not determine it.
const WINDOW_NS: i64 = 48_000_000;

/// The least delay of one board's packets: delays only add to the true time, so the least is nearest to it.
#[derive(Clone, Debug, Default)]
pub(super) struct LeastDelay {
    window: Option<Window>,
    last_least_ns: Option<i64>,
}

#[derive(Clone, Copy, Debug)]
struct Window {
    start_ns: i64,
    packets: u32,
    least_ns: i64,
}

impl LeastDelay {
    /// Notes a packet that arrived `delay_ns` after its slot's time; negative if before.
    pub(super) fn note(&mut self, now_ns: i64, delay_ns: i64) {
        let window = self.window.get_or_insert(Window { start_ns: now_ns, packets: 0, least_ns: delay_ns });
        window.packets = window.packets.saturating_add(1);
        window.least_ns = window.least_ns.min(delay_ns);
    }

    /// The least recent delay; `None` before the first packet.
    pub(super) fn least_ns(&self) -> Option<i64> {
        let window = self.window.map(|window| window.least_ns);
        window.into_iter().chain(self.last_least_ns).min()
    }

    /// Ends the window if it has enough packets, and returns its least delay.
    pub(super) fn close(&mut self, now_ns: i64) -> Option<i64> {
        let window = self.window?;
        if window.packets < ENOUGH || now_ns - window.start_ns < WINDOW_NS {
            return None;
        }
        self.window = None;
        self.last_least_ns = Some(window.least_ns);
        self.last_least_ns
    }

    /// Adapts the delays when the slots' times move by `by_ns`.
    pub(super) fn slots_moved(&mut self, by_ns: i64) {
        if let Some(window) = &mut self.window {
            window.least_ns -= by_ns;
        }
        if let Some(least) = &mut self.last_least_ns {
            *least -= by_ns;
        }
    }

    /// Resets everything: the board starts anew.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_without_error_is_exact_for_a_year() {
        let mut clock = SlotClock::new(5_000_000);
        let year = 365 * 86_400 * 1000;
        for slot in (0..year).step_by(100_000_000) {
            assert_eq!(clock.correct(slot, 0), 0);
            assert_eq!(clock.at_ns(slot), 5_000_000 + slot * SLOT_NS);
        }
    }

    #[test]
    fn small_errors_are_steered_out_without_a_jump_and_never_faster_than_500_ppm() {
        let mut clock = SlotClock::new(0);
        let mut slot = 0;
        let mut last = clock.at_ns(0);
        // The receive clock is 10 ms ahead: 20 s at 500 ppm, then an exponential rest.
        for _ in 0..500 {
            let error = slot * SLOT_NS + 10_000_000 - clock.at_ns(slot);
            assert_eq!(clock.correct(slot, error), 0);
            for _ in 0..64 {
                slot += 1;
                let step = clock.at_ns(slot) - last;
                assert!((SLOT_NS - 500..=SLOT_NS + 500).contains(&step), "{step}");
                last = clock.at_ns(slot);
            }
        }
        let error = slot * SLOT_NS + 10_000_000 - clock.at_ns(slot);
        assert!(error.abs() < 1000, "{error} ns left");
    }

    #[test]
    fn large_errors_set_the_clock_forward_but_never_back() {
        let mut clock = SlotClock::new(0);
        assert_eq!(clock.correct(10, 150_000_000), 150_000_000);
        assert_eq!(clock.at_ns(10), 160_000_000);
        assert_eq!(clock.correct(20, -150_000_000), 0);
        assert!(clock.at_ns(21) > clock.at_ns(20));
    }

    #[test]
    fn slots_are_found_by_time() {
        let clock = SlotClock::new(3_000_000);
        assert_eq!(clock.slot_before(3_999_999), 0);
        assert_eq!(clock.slot_before(4_000_000), 1);
        assert_eq!(clock.slot_near(3_500_000), 1);
        assert_eq!(clock.slot_before(2_999_999), -1);
    }

    #[test]
    fn a_burst_of_delayed_packets_is_no_reason_to_set_the_clock() {
        let mut arrivals = LeastDelay::default();
        for delay in (100..200).rev() {
            arrivals.note(0, delay * 1_000_000);
        }
        assert_eq!(arrivals.close(1_000_000), None);
        for now in 1..50 {
            arrivals.note(now * 1_000_000, 0);
        }
        assert_eq!(arrivals.close(50_000_000), Some(0));
    }
}
