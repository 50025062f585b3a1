//! The presence of a board: unheard, live, silent or on probation.

use super::clock::SLOT_NS;

/// Silence after which the values of a board at 30 Hz or more are stale.
pub(super) const SILENT_NS: i64 = 100 * SLOT_NS;

/// Periods of a slower board after which its values are stale, and the longest such time: with 8 ms until a program has
/// read the event, its holds end within 150 ms.
const SILENT_PERIODS: i64 = 3;
const MOST_SILENT_NS: i64 = 142 * SLOT_NS;

/// An outage within this time of the last return is flapping.
const FLAPPING_NS: i64 = 2000 * SLOT_NS;

/// Time for which a flapping board must deliver before it is live again.
const PROBATION_NS: i64 = 1000 * SLOT_NS;

/// Silence that restarts the probation, at least; two and a half periods of a slow board.
const PROBATION_GAP_NS: i64 = 20 * SLOT_NS;

/// Presence of one board, as a state machine:
///
/// ```text
/// Unheard  --data--> Live
/// Live     --100 ms without, or three periods--> Silent
/// Silent   --data, once a frame has shown it stale--> Live, or Probation if it was flapping
/// Probation--1 s of data without a gap of 20 ms--> Live
/// Probation--100 ms without--> Silent
/// ```
#[derive(Clone, Debug)]
pub(super) struct Presence {
    state: State,
    used_ns: Option<i64>,
    returned_ns: Option<i64>,
    /// Time from one packet to the next.
    period_ns: i64,
}

impl Default for Presence {
    fn default() -> Self {
        Self { state: State::Unheard, used_ns: None, returned_ns: None, period_ns: SLOT_NS }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    /// No packet yet.
    #[default]
    Unheard,
    Live,
    Silent {
        flapping: bool,
        /// Whether a frame has reported the outage; until then the board may not return, or readers of the frames
        /// would miss the outage.
        shown: bool,
    },
    Probation {
        since_ns: i64,
    },
}

impl Presence {
    /// Sets the time from one packet to the next.
    pub(super) const fn set_period(&mut self, period_ns: i64) {
        self.period_ns = period_ns;
    }

    /// Silence after which its values are stale.
    const fn silent_ns(&self) -> i64 {
        let periods = SILENT_PERIODS.saturating_mul(self.period_ns);
        if periods < SILENT_NS {
            SILENT_NS
        } else if periods > MOST_SILENT_NS {
            MOST_SILENT_NS
        } else {
            periods
        }
    }

    /// Whether it is live or on probation: without packets it becomes silent.
    pub(super) const fn is_heard(&self) -> bool {
        matches!(self.state, State::Live | State::Probation { .. })
    }

    /// Whether its values may be used.
    pub(super) const fn is_live(&self) -> bool {
        matches!(self.state, State::Live)
    }

    /// Whether it has ever sent a usable packet.
    pub(super) const fn has_reported(&self) -> bool {
        !matches!(self.state, State::Unheard)
    }

    /// Whether it became silent and no frame has reported it yet.
    pub(super) const fn has_news(&self) -> bool {
        matches!(self.state, State::Silent { shown: false, .. })
    }

    /// Arrival of its last usable packet.
    pub(super) const fn used_ns(&self) -> Option<i64> {
        self.used_ns
    }

    /// Notes a usable packet.
    pub(super) fn deliver(&mut self, now_ns: i64) {
        let gap = self.used_ns.map_or(0, |used| now_ns - used);
        self.used_ns = Some(now_ns);
        self.state = match self.state {
            State::Unheard | State::Live => State::Live,
            State::Silent { shown: false, .. } => self.state,
            State::Silent { flapping: true, .. } => State::Probation { since_ns: now_ns },
            State::Silent { flapping: false, .. } => self.return_at(now_ns),
            State::Probation { .. } if gap > PROBATION_GAP_NS.max(self.period_ns * 5 / 2) => {
                State::Probation { since_ns: now_ns }
            }
            State::Probation { since_ns } if now_ns - since_ns >= PROBATION_NS => self.return_at(now_ns),
            State::Probation { .. } => self.state,
        };
    }

    fn return_at(&mut self, now_ns: i64) -> State {
        self.returned_ns = Some(now_ns);
        State::Live
    }

    /// Advances time; returns true if the board has just become silent.
    pub(super) fn pass(&mut self, now_ns: i64) -> bool {
        let silent = self.used_ns.is_some_and(|used| now_ns - used >= self.silent_ns());
        silent && self.interrupt(now_ns)
    }

    /// Time at which it becomes silent without a usable packet; `None` if it is silent already or was never heard.
    pub(super) fn silent_at_ns(&self) -> Option<i64> {
        self.used_ns.filter(|_| self.is_heard()).map(|used| used + self.silent_ns())
    }

    /// Makes the board silent now, because its stream was interrupted; returns false if it was silent before.
    pub(super) fn interrupt(&mut self, now_ns: i64) -> bool {
        let flapping = match self.state {
            State::Live => self.returned_ns.is_some_and(|returned| now_ns - returned < FLAPPING_NS),
            State::Probation { .. } => true,
            State::Unheard | State::Silent { .. } => return false,
        };
        self.state = State::Silent { flapping, shown: false };
        true
    }

    /// Notes that a frame has reported its state.
    pub(super) const fn show(&mut self) {
        if let State::Silent { shown, .. } = &mut self.state {
            *shown = true;
        }
    }
}

/// Packets covered by the loss meter: one second of a board that sends once a millisecond.
const SECOND: u32 = 1000;

/// Buckets in that second.
const PER_SECOND: u32 = 10;

/// Buckets for that second, and the one in progress.
const BUCKETS: usize = 11;

/// Share of lost packets above which a board is degraded.
const DEGRADED: f32 = 0.10;

/// Share of lost packets below which it recovers.
const GOOD: f32 = 0.08;

/// The share of one board's packets that were lost or came too late, over the last second.
#[derive(Clone, Debug)]
pub(super) struct LossMeter {
    /// Expected and missed packets per bucket, the current one first.
    buckets: [(u32, u32); BUCKETS],
    /// Packets in a second.
    second: u32,
    degraded: bool,
}

impl Default for LossMeter {
    fn default() -> Self {
        Self { buckets: Default::default(), second: SECOND, degraded: false }
    }
}

impl LossMeter {
    /// Share of a second's packets that were missed, 0 to 1; an incomplete second counts in full.
    pub(super) fn share(&self) -> f32 {
        let (expected, missed) =
            self.buckets.iter().fold((0, 0), |sum, bucket| (sum.0 + bucket.0, sum.1 + bucket.1));
        missed as f32 / expected.max(self.second) as f32
    }

    /// Sets the rate of the board, in packets a second.
    pub(super) fn set_rate(&mut self, hz: f32) {
        // The cast saturates.
        self.second = (hz.round() as u32).max(PER_SECOND);
    }

    /// Whether the loss is too high.
    pub(super) const fn is_degraded(&self) -> bool {
        self.degraded
    }

    /// Counts one packet, used or not, after `skipped` missing ones.
    pub(super) fn pass(&mut self, skipped: u32, used: bool) {
        // An outage longer than the meter's span fills it only once.
        let skipped = skipped.min(self.second);
        self.buckets[0].0 += skipped + 1;
        self.buckets[0].1 += skipped + u32::from(!used);
        if self.buckets[0].0 >= self.second / PER_SECOND {
            let share = self.share();
            self.degraded = share > DEGRADED || (self.degraded && share >= GOOD);
            self.buckets.rotate_right(1);
            self.buckets[0] = (0, 0);
        }
    }

    /// Corrects the count for a packet that was counted as lost but came in time.
    pub(super) fn found(&mut self) {
        self.buckets[0].1 = self.buckets[0].1.saturating_sub(1);
    }

    /// Resets the meter: after an outage only later packets count.
    pub(super) fn forget(&mut self) {
        *self = Self { second: self.second, ..Self::default() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = SLOT_NS;

    /// Runs a board that delivers in each millisecond for which `up` is true, one frame each; returns the
    /// milliseconds in which it is live.
    fn live_during(span: i64, up: impl Fn(i64) -> bool) -> Vec<i64> {
        let mut presence = Presence::default();
        let mut live = Vec::new();
        for ms in 0..span {
            presence.pass(ms * MS);
            if up(ms) {
                presence.deliver(ms * MS);
            }
            if presence.is_live() {
                live.push(ms);
            }
            presence.show();
        }
        live
    }

    #[test]
    fn a_single_outage_ends_with_the_second_packet() {
        let live = live_during(1000, |ms| !(300..450).contains(&ms));
        assert!(live.contains(&398) && !live.contains(&399), "silent from 100 ms after 299");
        assert!(!live.contains(&449) && live.contains(&450));
    }

    #[test]
    fn gaps_below_100_ms_go_unnoticed() {
        assert_eq!(live_during(1000, |ms| !(300..398).contains(&ms)).len(), 1000);
    }

    #[test]
    fn a_slow_board_has_three_periods_and_142_ms_at_most() {
        for (period_ms, silent_ms) in [(1, 100), (10, 100), (33, 100), (40, 120), (50, 142), (100, 142)] {
            let mut presence = Presence::default();
            presence.set_period(period_ms * MS);
            presence.deliver(0);
            assert!(!presence.pass(silent_ms * MS - 1) && presence.pass(silent_ms * MS), "{period_ms} ms");
        }
    }

    #[test]
    fn a_flapping_board_stays_silent_until_it_is_clean_for_a_second() {
        // N12: 5 Hz, up to 2 s, then steady.
        let live = live_during(4000, |ms| ms >= 2000 || ms % 200 < 99);
        assert!(live.iter().all(|ms| !(400..3000).contains(ms)), "{live:?}");
        assert!(live.contains(&3000));
    }

    #[test]
    fn an_outage_is_shown_before_the_board_returns() {
        let mut presence = Presence::default();
        presence.deliver(0);
        assert!(presence.pass(200 * MS));
        presence.deliver(200 * MS);
        assert!(!presence.is_live() && presence.has_news());
        presence.show();
        presence.deliver(201 * MS);
        assert!(presence.is_live());
    }

    fn after(seconds: u32, lost: impl Fn(u32) -> bool) -> LossMeter {
        let mut meter = LossMeter::default();
        let mut skipped = 0;
        for number in 0..seconds * 1000 {
            if lost(number) {
                skipped += 1;
            } else {
                meter.pass(skipped, true);
                skipped = 0;
            }
        }
        meter
    }

    #[test]
    fn every_fifth_packet_lost_degrades_and_every_twentieth_does_not() {
        assert!(after(2, |number| number % 5 == 0).is_degraded());
        assert!(!after(2, |number| number % 20 == 0).is_degraded());
        let share = after(2, |number| number % 5 == 0).share();
        assert!((share - 0.2).abs() < 0.01, "{share}");
    }

    #[test]
    fn a_second_later_all_is_good_again() {
        assert!(!after(4, |number| number < 2000 && number % 5 == 0).is_degraded());
    }
}
